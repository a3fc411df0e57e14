"""Feeds a page with snapshots of a lab, whenever the page is due for an update.

This is the only module that knows both labs and pages: pages only receive snapshots.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import is_

from typing_extensions import override

from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.page.page import Page
from onpath.app.server.followed_lab import FollowedLab
from onpath.app.server.page_data import EVERY, PageData
from onpath.app.server.tab_visibility import CountingDisplay
from onpath.app.simulation.display_rate import AT_EASE, is_turn


class LabFeed(CountingDisplay):
    """Shows a lab on a page.

    Args:
        offset: spreads the pages over the frames.
        nickname: returns the student's nickname in the class; empty if there is none.
        followed: the student's lab that a teacher's page shows instead, or None.
        data: what the page is told through its data channel, if it has one.
    """

    def __init__(
        self,
        page: Page,
        offset: int,
        nickname: Callable[[], str] = str,
        followed: FollowedLab | None = None,
        data: PageData | None = None,
    ) -> None:
        self.page, self._data = page, data
        self._offset, self._nickname, self._followed = offset, nickname, followed
        self._lab: Lab | None = None
        self._shown: tuple[object, ...] = ()
        self._last: PageSnapshot | Motion | None = None
        self._whole: PageSnapshot | None = None

    @property
    @override
    def is_outdated(self) -> bool:
        return self.page.is_outdated and self.page.is_ready

    @override
    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        if stride == AT_EASE and self._source(lab, 1.0)[0].simulation.forces.grabbed:
            return True  # every frame of delay is felt while dragging
        return is_turn(frame + self._offset, stride)

    @override
    def show(self, lab: Lab, frame: int, stride: float) -> None:
        if self.page.is_ready and self.is_turn(lab, frame, stride):
            self._show_motion(lab)
        if self._data is None:
            return
        lab = self._source(lab, 1.0)[0]
        if self._last is not None:
            is_turn_of_data = is_turn(frame + self._offset, max(stride, EVERY))
            self._data.follow(lab, self._last, is_turn_of_data, self.page.settle)

    def _show_motion(self, lab: Lab) -> None:
        lab, _, student = self._source(lab, 1.0)
        if self._has_news(lab):
            self._last = motion = take_motion(lab, self._last, student)
            self.page.show(motion)

    @override
    def refresh(self, lab: Lab, achieved: float) -> None:
        lab, achieved, student = self._source(lab, achieved)
        if not self.page.is_ready:
            return
        self._has_news(lab)  # remembers what is shown now
        snapshot = take_page_snapshot(lab, achieved, self._whole, student, self._nickname())
        self._last = self._whole = snapshot
        self.page.show(snapshot)
        self.page.exporter.serve(lab)
        if self._data is not None:
            self._data.tell(snapshot, self.page)

    def _source(self, lab: Lab, achieved: float) -> tuple[Lab, float, int]:
        """The displayed lab, its achieved speed, and its student's number; see `PageKey`."""
        student, found = 0, self._followed.find() if self._followed is not None else None
        if found is not None:
            scheduled, student = found
            lab, achieved = scheduled.lab, scheduled.achieved
        if lab is not self._lab:
            self._lab, self._last, self._whole = lab, None, None
        return lab, achieved, student

    def _has_news(self, lab: Lab) -> bool:
        """Whether anything in the scene has changed since it was last shown."""
        simulation, shown = lab.simulation, self._shown
        self._shown = now = (
            *(run.slot for run in simulation.runs.values()),
            simulation.viewing,
            simulation.editor.version,
            simulation.settings.larger,
            lab.lessons.progress,
        )
        return len(now) != len(shown) or not all(map(is_, now, shown))

    @override
    def send(self) -> None:
        self.page.send()
        if self._data is not None:
            self._data.send()

    def close(self) -> None:
        """Release the page's resources, and end its data channel. Thread-safe."""
        if self._data is not None:
            self._data.close()
        self.page.close()

    @property
    @override
    def updates(self) -> int:
        return self.page.updates
