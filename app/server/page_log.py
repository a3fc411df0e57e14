"""Tells a page the log of a real arm that is drawn over its plots."""

from __future__ import annotations

from collections.abc import Callable

from onpath.app.channel.messages import encoded
from onpath.app.channel.motion_messages import LogMessage
from onpath.app.lab.snapshots.page_snapshot import LogSnapshot
from onpath.app.view.log_curves import fields_of_efforts, fields_on_path, times_of

NO_LOG = encoded(LogMessage())


class PageLog:
    """What one page is told of the log.

    Its curves are made in another thread: finding its closest points on the path takes up to 50 ms.

    Args:
        submit: runs a function in another thread.
    """

    def __init__(self, submit: Callable[[Callable[[], None]], None]) -> None:
        self._submit = submit
        self._wanted: LogSnapshot | None = None
        self._made: tuple[LogSnapshot, bytes] | None = None
        self._told = NO_LOG  # a page knows of no log at first

    def restart(self) -> None:
        """The page has connected again, and knows nothing."""
        self._told = NO_LOG

    def news(self, log: LogSnapshot | None) -> bytes | None:
        """The message that the page has to be told now, if any."""
        if log is not self._wanted:
            self._wanted = log
            if log is not None:
                self._submit(lambda: self._make(log))
        if log is None:
            message = NO_LOG
        elif self._made is not None and self._made[0] is log:
            message = self._made[1]
        else:
            return None
        if message is self._told:
            return None
        self._told = message
        return message

    def _make(self, log: LogSnapshot) -> None:
        if log is not self._wanted:
            return
        motion = log.log.motion
        along = fields_on_path(motion, log.frame, log.curve, is_level_set=log.is_level_set)
        fields = (*along, *fields_of_efforts(motion))
        times = times_of(motion)
        self._made = log, encoded(LogMessage(file=log.log.file, times=times, fields=fields))
