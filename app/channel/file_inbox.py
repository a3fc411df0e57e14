"""A file that a page sends through its data channel, part by part. Runs on the event loop."""

from __future__ import annotations

import time
from collections.abc import Callable
from weakref import WeakSet

from onpath.app.channel.file_messages import DropFile, SendFile, SendPart
from onpath.app.common.allowance import Allowance
from onpath.models.errors import CodedError

MOST_BYTES = 1_000_000  # [B] of a file with a path
MOST_TOGETHER = 50_000_000  # [B], of the files of all pages that are under way
SECONDS = 30.0  # [s] that a file may take from its first message to its last
FILES, FILES_PER_SECOND = 10, 0.1
"""Files that a page may send in a burst, and per second in the long run."""


class FileInbox:
    """Takes the files of one page, one at a time, of limited size, in limited time, a few in a row.

    Args:
        largest: size of a file, [B].
        clock: monotonic time, [s].

    Attributes:
        file: that is under way, or None.
        received: how much of it has come, [B].
    """

    def __init__(self, largest: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._largest, self._clock = largest, clock
        self._allowance = Allowance(FILES, FILES_PER_SECOND, clock)
        self._content, self._since = bytearray(), 0.0
        self.file: SendFile | None = None
        _inboxes.add(self)

    @property
    def received(self) -> int:
        """How much has come of the file that is under way, [B]."""
        return len(self._content)

    def begin(self, file: SendFile) -> bytes | None:
        """Expect the parts of a file; returns its content if there are none, as it is empty.

        Raises:
            CodedError: it is too large, or not its turn.
        """
        self.expire()
        if self.file is not None:
            raise CodedError("error.file_busy")
        if file.size > self._largest:
            raise CodedError("error.file_size", most=f"{self._largest / 1e6:g}")
        together = sum(each.file.size for each in _inboxes if each.file is not None)
        if together + file.size > MOST_TOGETHER or not self._allowance.take():
            raise CodedError("error.file_often")
        if not file.size:
            return b""
        self.file, self._since = file, self._clock()
        return None

    def take(self, part: SendPart) -> bytes | None:
        """Add a part; returns the content of the file if it is whole now.

        Raises:
            CodedError: the part is not expected, and its file is forgotten.
        """
        if self.expire():
            raise CodedError("error.file_late")
        file = self.file
        if file is None or file.number != part.number:
            raise CodedError("error.file_incoherent")
        if not 0 < len(part.content) <= file.size - self.received:
            self.forget()
            raise CodedError("error.file_incoherent")
        self._content += part.content
        if self.received < file.size:
            return None
        content = bytes(self._content)
        self.forget()
        return content

    def drop(self, message: DropFile) -> None:
        """Forget a file that the page does not send any further."""
        if self.file is not None and self.file.number == message.number:
            self.forget()

    def expire(self) -> bool:
        """Forget the file under way if it takes too long; whether it did."""
        is_late = self.file is not None and self._clock() > self._since + SECONDS
        if is_late:
            self.forget()
        return is_late

    def forget(self) -> None:
        """Forget the file that is under way."""
        self.file, self._content = None, bytearray()


_inboxes: WeakSet[FileInbox] = WeakSet()
