"""Files that pages send, in the parts of viser's transfer: the only way for a page to send one.

A page sends one file at a time, of limited size, in limited time, and a few in a row. The upload
button is told of a file that is refused. The page is then told that the file has arrived, because
viser's page would otherwise wait for ever, and send no other file.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any
from weakref import WeakKeyDictionary

import viser
from viser import _messages as wire
from viser._gui_handles import UploadedFile

from onpath.app.common.allowance import Allowance
from onpath.models.errors import Message

MOST_PARTS = 64  # of a file; viser's page sends parts of 0.5 MB
MOST_TOGETHER = 50_000_000  # [B], announced by all pages whose files are under way
SECONDS = 30.0  # [s] from the first message of a file to its last
FILES, FILES_PER_SECOND = 10, 0.1  # in a row, and in the long run, of one page
LONGEST_NAME = 200  # [characters]

Refuse = Callable[[Message], None]


def take_files(
    button: viser.GuiUploadButtonHandle, take: Callable[[str, bytes], None], refuse: Refuse
) -> None:
    """Take the files of an upload button.

    Args:
        take: called with name and content of a file, on the event loop; must not block.
        refuse: called with the reason if one is refused before it has arrived, in the same way.
    """

    async def uploaded(_: Any) -> None:
        file = button.value
        button._impl.value = UploadedFile("", b"")  # keeps no memory until the next one comes
        take(file.name[:LONGEST_NAME], file.content)

    callback: Any = uploaded
    callback.refuse = refuse  # where `FileUploads` finds it
    button.on_upload(callback)


@dataclass(frozen=True, slots=True, eq=False)
class _Transfer:
    """A file under way."""

    gui: viser.GuiApi
    name: str
    button: Any
    size: int

    @property
    def state(self) -> Any:
        """viser's record of it; None once it has arrived, or its page has gone."""
        return self.gui._current_file_upload_states.get(self.name)


class FileUploads:
    """Limits the files of all pages of a server. Runs on the event loop.

    Args:
        largest: size of a file, [B]; 0 refuses all that are not empty.
    """

    def __init__(self, largest: int) -> None:
        self._largest = largest
        self._transfers = list[_Transfer]()
        self._allowances: WeakKeyDictionary[viser.GuiApi, Allowance] = WeakKeyDictionary()

    def begins(self, gui: viser.GuiApi, message: wire.FileTransferStartUpload) -> bool:
        """Whether a file may be sent; if not, its button is told why."""
        button = gui._gui_input_handle_from_uuid.get(message.source_component_uuid)
        if not isinstance(button, viser.GuiUploadButtonHandle) or button.disabled:
            return False
        self._transfers = [each for each in self._transfers if each.state is not None]
        transfer = _Transfer(gui, message.transfer_uuid, button, message.size_bytes)
        if reason := self._refusal(transfer, message):
            self._refuse(transfer, reason)
            return False
        self._transfers.append(transfer)
        asyncio.get_running_loop().call_later(SECONDS, partial(self._expire, transfer))
        return True

    def takes(self, gui: viser.GuiApi, message: wire.FileTransferPart) -> bool:
        """Whether a part is expected; a file with a part that is not, is refused."""
        found = (t for t in self._transfers if t.gui is gui and t.name == message.transfer_uuid)
        transfer = next(found, None)
        if transfer is None or (state := transfer.state) is None:
            return False
        parts, count = state["parts"], state["part_count"]
        size = state["transferred_bytes"] + len(message.content)
        is_new = message.part_index not in parts and message.part_index in range(count)
        is_last = len(parts) + 1 == count
        if is_new and (size == transfer.size if is_last else size <= transfer.size):
            return True
        self._end(transfer, Message("error.file_incoherent"))
        return False

    def _refusal(
        self, transfer: _Transfer, message: wire.FileTransferStartUpload
    ) -> Message | None:
        """Why a file may not be sent now."""
        gui, parts = transfer.gui, message.part_count
        if not 0 <= transfer.size <= self._largest:
            return Message("error.file_size", {"most": f"{self._largest / 1e6:g}"})
        if any(each.gui is gui for each in self._transfers):
            return Message("error.file_busy")
        if not (1 <= parts <= MOST_PARTS if transfer.size else parts == 0):
            return Message("error.file_incoherent")
        allowance = self._allowances.setdefault(gui, Allowance(FILES, FILES_PER_SECOND))
        together = sum(each.size for each in self._transfers) + transfer.size
        if together > MOST_TOGETHER or not allowance.take():
            return Message("error.file_often")
        return None

    def _expire(self, transfer: _Transfer) -> None:
        if transfer in self._transfers and transfer.state is not None:
            self._end(transfer, Message("error.file_late"))

    def _end(self, transfer: _Transfer, reason: Message) -> None:
        """Forget a file under way, and tell why."""
        transfer.gui._current_file_upload_states.pop(transfer.name, None)
        self._transfers.remove(transfer)
        self._refuse(transfer, reason)

    def _refuse(self, transfer: _Transfer, reason: Message) -> None:
        size = max(transfer.size, 0)
        done = wire.FileTransferPartAck(
            source_component_uuid=transfer.button._impl.uuid,
            transfer_uuid=transfer.name,
            transferred_bytes=size,
            total_bytes=size,
        )
        transfer.gui._websock_interface.queue_message(done)
        for callback in transfer.button._impl.update_cb:
            if refuse := getattr(callback, "refuse", None):
                refuse(reason)
