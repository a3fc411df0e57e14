"""Frees the objects of a page as soon as its tab has closed or the page is rebuilt.

Widgets and nodes refer to their API, which refers to them, and to callbacks, which refer to the
owners of the widgets. Without this module, only the garbage collector would find the five thousand
objects of a page, and tabs can come and go faster than it runs. This uses private parts of viser,
which tests pin.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import viser


def clear_page(client: viser.ClientHandle) -> None:
    """Remove all that a page is made of, and forget its callbacks."""
    clear_widgets(client)
    commands = list(client.gui._command_handle_from_uuid.values())
    client.gui.reset()
    _forget_callbacks(commands, [])


def clear_widgets(client: viser.ClientHandle) -> None:
    """Remove all widgets and nodes of a page, and forget their callbacks.

    viser's commands stay: until the page is built anew, its browser goes on sending their keys.
    """
    gui = client.gui
    widgets: list[Any] = list(gui._gui_input_handle_from_uuid.values())
    containers: dict[str, Any] = gui._container_handle_from_uuid
    clear_scene(client)
    for each in [*containers["root"]._children.values(), *gui._panel_handle_from_uuid.values()]:
        each.remove()
    for window in list(gui._modal_handle_from_uuid.values()):
        window.close()
    _forget_callbacks(widgets, [])


def clear_scene(client: viser.ClientHandle) -> None:
    """Remove all nodes of a page, and forget their callbacks."""
    nodes = list(client.scene._handle_from_node_name.values())
    client.scene.reset()
    _forget_callbacks([], nodes)


def release_page(client: viser.ClientHandle) -> None:
    """Forget the widgets, nodes and unsent messages of a client that has disconnected."""
    gui, scene = client.gui, client.scene
    nodes = list(scene._handle_from_node_name.values())
    inputs, commands = gui._gui_input_handle_from_uuid, gui._command_handle_from_uuid
    _forget_callbacks([*inputs.values(), *commands.values()], nodes)
    for node in nodes:
        node._impl.drag_cb.clear()
    containers: list[Any] = list(gui._container_handle_from_uuid.values())
    for container in containers:
        container._children.clear()
    inputs.clear()
    commands.clear()
    scene._handle_from_node_name.clear()
    scene._children_from_node_name.clear()
    connection = client._websock_connection
    buffer = connection.get_message_buffer()
    with buffer.buffer_lock:
        buffer.message_from_id.clear()
        buffer.id_from_redundancy_key.clear()
        buffer.ids_from_entity_state_key.clear()
    # Not cleared, since viser may be looking up the handlers of a message.
    connection._incoming_handlers = defaultdict(list)


def _forget_callbacks(widgets: list[Any], nodes: list[Any]) -> None:
    """Forget all callbacks except those of drags, which viser calls when a drag ends."""
    for widget in widgets:
        state = widget._impl
        for name in ("update_cb", "trigger_cb"):
            getattr(state, name, []).clear()
        state.sync_cb = None
    for node in nodes:
        node._impl.click_cb.clear()
