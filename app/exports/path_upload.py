"""A path in a file that a browser has sent, read in a process of its own.

The file may be hostile. It is read with limits of size and time, and in that process, so that a
library that crashes or never returns cannot stop the lab; see `ExportProcess`.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module

from onpath.app.channel.file_inbox import MOST_BYTES
from onpath.app.common.error_log import log_error
from onpath.app.exports.export_process import (
    ExportError,
    ExportLate,
    ExportProcess,
    ExportStopped,
)
from onpath.app.lab.commands import FollowCurve
from onpath.lessons.words import Words
from onpath.models.errors import Coded, CodedError, Message
from onpath.models.path_files.placing import Placing
from onpath.models.path_files.reading import path_of
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import SeriesCurve
from onpath.models.paths.nearest_path import nearest_path
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

STARTING = 60.0  # [s] that the process may take to start
SECONDS = 15.0  # [s] that one file may take
process = ExportProcess()
_queue = ThreadPoolExecutor(1, "path files")
"""Passes the files of all tabs to the process, one at a time."""


@dataclass(frozen=True, slots=True, eq=False)
class Upload:
    """A file from a browser, and the robot that is to follow its path.

    Attributes:
        name, content: of the file.
        placing: what is done with it.
        robot: name of the robot, with these parameters.
    """

    name: str
    content: bytes
    placing: Placing
    robot: str
    parameters: Parameters


def read_upload(upload: Upload, language: str) -> FollowCurve | Message | ValueError:
    """The command that follows the path in a file, or why there is none. Runs in the process."""
    try:
        read = path_of(upload.content, upload.name, upload.placing, MOST_BYTES)
    except Coded as error:
        return error.message
    except ValueError as error:
        return error
    curve, words = read.curve, Words(language)
    assert isinstance(curve, SeriesCurve)
    margin, nearest = ROBOTS[upload.robot].make(upload.parameters).margin, None
    if curve_faults(margin, curve):
        nearest = nearest_path(margin, curve)
    return FollowCurve(
        closed=curve.closed,
        terms=curve.terms(),
        given=curve.given,
        deviation=curve.deviation,
        nearest=None if nearest is None else nearest.terms(),
        apart=0.0 if nearest is None else nearest.deviation,
        remarks=" ".join(words.sentence(remark) for remark in read.remarks),
    )


def import_libraries() -> None:
    """Import what is slow to import, so that a file's time limit does not include it."""
    for name in ("scipy.interpolate", "scipy.spatial", "svgpathtools", "tinycss2"):
        with suppress(ImportError):  # the last two are an extra
            import_module(name)


class PathReader:
    """Reads the files of one tab, one at a time."""

    def __init__(self) -> None:
        self._busy = False

    def read(
        self,
        upload: Upload,
        language: str,
        follow: Callable[[FollowCurve], None],
        refuse: Callable[[Exception | Message], None],
    ) -> None:
        """Read a file in the background, and call one of the functions in another thread.

        Args:
            language: of the remarks.
            follow: takes the command that follows the path.
            refuse: takes the reason if there is none.
        """
        if self._busy:
            refuse(Message("error.file_busy"))
            return
        self._busy = True

        def work() -> None:
            try:
                process.call(STARTING, import_libraries)
                found = process.call(SECONDS, read_upload, upload, language)
                if isinstance(found, FollowCurve):
                    follow(found)
                else:
                    refuse(found)
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
