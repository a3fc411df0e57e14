"""Files that a browser has sent, read in a process of their own.

A file may be hostile. It is read with limits of size and time, and in that process, so that a
library that crashes or never returns cannot stop the lab; see `ExportProcess`.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from importlib import import_module
from typing import TypeVar

from onpath.app.common.error_log import log_error
from onpath.app.exports import log_upload, path_upload
from onpath.app.exports.export_process import (
    ExportError,
    ExportLate,
    ExportProcess,
    ExportStopped,
)
from onpath.app.exports.log_upload import LogUpload, ReadLog
from onpath.app.exports.path_upload import Read, Upload
from onpath.models.errors import CodedError, Message

STARTING = 60.0  # [s] that the process may take to start
SECONDS = 15.0  # [s] that one file may take
process = ExportProcess()
_queue = ThreadPoolExecutor(1, "uploads")
"""Passes the files of all tabs to the process, one at a time."""
Found = TypeVar("Found")
Refuse = Callable[[Exception | Message], None]
"""Takes the reason why nothing has been read."""


def import_libraries() -> None:
    """Import what is slow to import, so that a file's time limit does not include it."""
    for name in ("scipy.interpolate", "scipy.signal", "scipy.spatial", "svgpathtools", "tinycss2"):
        with suppress(ImportError):  # the last two are an extra
            import_module(name)


class UploadReader:
    """Reads the files of one tab, one at a time.

    A function is called in another thread with what has been read, or with the reason if nothing
    has.
    """

    def __init__(self) -> None:
        self._busy = False

    def read(
        self, upload: Upload, language: str, take: Callable[[Read], None], refuse: Refuse
    ) -> None:
        """Read a path in the background.

        Args:
            language: of the remarks.
        """
        self._begin(
            lambda: process.call(SECONDS, path_upload.read_upload, upload, language), take, refuse
        )

    def read_log(self, upload: LogUpload, take: Callable[[ReadLog], None], refuse: Refuse) -> None:
        """Read the log of a real arm in the background."""
        self._begin(lambda: process.call(SECONDS, log_upload.read_log, upload), take, refuse)

    def _begin(
        self, read: Callable[[], Found], take: Callable[[Found], None], refuse: Refuse
    ) -> None:
        if self._busy:
            refuse(Message("error.file_busy"))
            return
        self._busy = True

        def work() -> None:
            try:
                process.call(STARTING, import_libraries)
                take(read())
            except ExportStopped:
                return  # the server is stopping
            except ExportError as error:
                log_error(error)
                late = isinstance(error, ExportLate)
                refuse(CodedError("error.file_takes_long" if late else "error.file_failed"))
            finally:
                self._busy = False

        with suppress(RuntimeError):  # the interpreter is shutting down
            _queue.submit(work)
