"""A file that a page sends through its data channel, part by part. Runs on the event loop."""

from __future__ import annotations

import time
from collections.abc import Callable
from weakref import WeakSet

from onpath.app.channel.file_messages import DropFile, LogFile, SendFile, SendPart
from onpath.app.common.allowance import Allowance
from onpath.models.errors import CodedError

MOST_BYTES = 1_000_000  # [B] of a file with a path
MOST_LOG_BYTES = 8_000_000  # [B] of the log of a real arm
MOST_TOGETHER = 50_000_000  # [B], of the files of all pages that are under way, and that are kept
SECONDS = 30.0  # [s] that a file may take from its first message to its last
FILES, FILES_PER_SECOND = 10, 0.1
"""Files that a page may send in a burst, and per second in the long run."""
AGAIN, AGAIN_PER_SECOND = 30, 1.0
"""How often a page may have its last file read again, likewise."""


class FileInbox:
    """Takes the files of one page, one at a time, of limited size, in limited time, a few in a row.

    Args:
        largest: size of a file with a path, [B].
        clock: monotonic time, [s].

    Attributes:
        file: that is under way, or None.
        received: how much of it has come, [B].
        kept: number and content of the last one that was whole, which can be read again.
    """

    def __init__(
        self,
        largest: int,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._largest, self._clock = largest, clock
        self._allowance = Allowance(FILES, FILES_PER_SECOND, clock)
        self._content, self._since = bytearray(), 0.0
        self._repeats = Allowance(AGAIN, AGAIN_PER_SECOND, clock)
        self.file: SendFile | None = None
        self.kept: tuple[int, bytes] | None = None
        _inboxes.add(self)

    @property
    def received(self) -> int:
        """How much has come of the file that is under way, [B]."""
        return len(self._content)

    def begin(self, file: SendFile) -> bytes | None:
        """Expect the parts of a file; returns its content if none need come.

        It is empty, or the same that came last.

        Raises:
            CodedError: it is too large, or not its turn.
        """
        self.expire()
        if self.file is not None:
            raise CodedError("error.file_busy")
        if file.again and self.kept is not None and self.kept[0] == file.again:
            if not self._repeats.take():
                raise CodedError("error.file_often")
            self.kept = (file.number, self.kept[1])
            return self.kept[1]
        largest = MOST_LOG_BYTES if isinstance(file.use, LogFile) else self._largest
        if file.size > largest:
            raise CodedError("error.file_size", most=f"{largest / 1e6:g}")
        self.kept = None
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
        kept = sum(len(each.kept[1]) for each in _inboxes if each.kept is not None)
        if kept + len(content) <= MOST_TOGETHER:  # else it comes again when it is wanted again
            self.kept = (file.number, content)
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
