"""The private parts of viser that this folder uses.

At the start they are looked up in the installed viser, without importing it, so that the log says
what may fail with an untested version.
"""

from __future__ import annotations

import hashlib
import re
from importlib.util import find_spec
from pathlib import Path

from onpath.app.common.error_log import log_warning

TESTED = "1.1.1"
PAGE = "client/build/index.html"
TESTED_PAGE = "8c05b8bfea1ed54773a7616d1d868ebf0b45055ff8da8fc1603ccb2a7858f079"
"""SHA-256 of viser's page, on whose canvas and worker our scripts rely."""
TOUCHED = {
    "_assignable_props_api.py": "AssignablePropsBase _impl _prop_hints",
    "_messages.py": (
        "ImageMessage ImageProps LocalStorageGetItemRequestMessage"
        " LocalStorageGetItemResponseMessage Message SceneNodeClickMessage"
        " SceneNodeDragMessage SceneNodeUpdateMessage SetCameraFovMessage"
        " SetCameraLookAtMessage SetCameraPositionMessage SetCameraUpDirectionMessage"
        " SetPositionMessage ShareUrlDisconnect ShareUrlRequest ViewerCameraMessage"
    ),
    "_scene_api.py": (
        "_children_from_node_name _encode_image_binary _handle_from_node_name _owner_id"
        " _queue_scene_message _websock_interface print_awaited_callback_error"
        " print_threadpool_errors"
    ),
    "_scene_handles.py": "_impl _make click_cb drag_cb",
    "_viser.py": (
        "_event_loop _initial_camera _scene_lifecycle_lock _state _thread_executor"
        " _viser_server _websock_connection _websock_server print_awaited_callback_error"
        " print_task_error print_threadpool_errors"
    ),
    "infra/_async_message_buffer.py": (
        "AsyncMessageBuffer buffer_lock id_from_redundancy_key ids_from_entity_state_key"
        " message_event message_from_id"
    ),
    "infra/_infra.py": (
        "WebsockClientConnection WebsockMessageHandler WebsockServer"
        " _append_aligned_buffers _broadcast_buffer _handle_incoming_message"
        " _incoming_handlers _live_connections _record_handles _state"
    ),
    "infra/_messages.py": "deserialize",
}
"""Names in viser's modules, by file."""


def untested_parts(viser: Path) -> list[str]:
    """What is untested or missing in a version of viser, as parts of a sentence; empty if nothing.

    Args:
        viser: the folder of the package.
    """
    found = re.search(r'__version__ = "(.*)"', _text(viser / "__init__.py"))
    version = found.group(1) if found else "of unknown version"
    faults = [] if version == TESTED else [f"viser {version} is untested, {TESTED} is tested"]
    for file, names in TOUCHED.items():
        source = _text(viser / file)
        missing = [name for name in names.split() if name not in source]
        if missing:
            faults.append(f"{file} has no {', '.join(missing)}")
    page = viser / PAGE
    if not page.is_file():
        faults.append("its page is missing")
    elif hashlib.sha256(page.read_bytes()).hexdigest() != TESTED_PAGE:
        faults.append("its page is not the tested one")
    return faults


def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8") if file.is_file() else ""


def check_viser() -> None:
    """Log what is untested or missing in the installed viser, in one line, and continue."""
    package = find_spec("viser")
    folders = package.submodule_search_locations if package is not None else None
    faults = untested_parts(Path(folders[0])) if folders else []
    if faults:
        log_warning("parts of the lab may fail with this viser: %s", "; ".join(faults))
