"""Feeds a page with snapshots of a lab, whenever the page is due for an update.

This is the only module that knows both labs and pages: pages only receive snapshots.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import is_

import viser
from typing_extensions import override

from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.scene.client_scene import ClientScene
from onpath.app.server.followed_lab import Followed
from onpath.app.server.page_data import EVERY, PageData
from onpath.app.simulation.display_rate import AT_EASE, is_turn
from onpath.app.simulation.scheduled_lab import LabDisplay


class LabFeed(LabDisplay):
    """Shows a lab on a page.

    Args:
        data: what the page is told.
        make: builds the robots' picture.
        send: sends what has been handed over for all pages.
        offset: spreads the pages over the frames.
        nickname: returns the student's nickname in the class; empty if there is none.
        followed: the lab that is shown instead, such as a student's on a teacher's page, or None.

    Attributes:
        scene: the robots' picture, as long as it is there.
        make: builds it.
    """

    def __init__(
        self,
        data: PageData,
        make: Callable[[viser.ClientHandle, PageSnapshot, int], ClientScene],
        send: Callable[[], None],
        offset: int,
        nickname: Callable[[], str] = str,
        followed: Followed | None = None,
    ) -> None:
        self.scene: ClientScene | None = None
        self._data, self.make, self._send = data, make, send
        self._offset, self._nickname, self._followed = offset, nickname, followed
        self._lab: Lab | None = None
        self._shown: tuple[object, ...] = ()
        self._last: PageSnapshot | Motion | None = None
        self._whole: PageSnapshot | None = None

    @property
    def _ready(self) -> ClientScene | None:
        """The robots' picture, unless it is missing or being built."""
        scene = self.scene  # another thread may remove it
        return scene if scene is not None and scene.is_ready else None

    @property
    @override
    def is_outdated(self) -> bool:
        scene = self._ready
        return scene is not None and scene.is_outdated

    @override
    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        if stride == AT_EASE and self._source(lab, 1.0)[0].simulation.forces.grabbed:
            return True  # every frame of delay is felt while dragging
        return is_turn(frame + self._offset, stride)

    @override
    def show(self, lab: Lab, frame: int, stride: float) -> None:
        if self.is_turn(lab, frame, stride):
            self._show_motion(lab)
        lab = self._source(lab, 1.0)[0]
        if self._last is not None:
            is_turn_of_data = is_turn(frame + self._offset, max(stride, EVERY))
            self._data.follow(lab, self._last, is_turn_of_data, self._settle)

    def _show_motion(self, lab: Lab) -> None:
        lab, _, student = self._source(lab, 1.0)
        if self._has_news(lab):
            self._last = motion = take_motion(lab, self._last, student)
            if (scene := self._ready) is not None:
                scene.show(motion)

    def _settle(self) -> None:
        if (scene := self._ready) is not None:
            scene.settle()

    @override
    def refresh(self, lab: Lab, achieved: float) -> None:
        lab, achieved, student = self._source(lab, achieved)
        self._has_news(lab)  # remembers what is shown now
        snapshot = take_page_snapshot(lab, achieved, self._whole, student, self._nickname())
        self._last = self._whole = snapshot
        if (scene := self._ready) is not None:
            scene.show(snapshot)
        self._data.tell(snapshot, self.scene, lab.simulation.robot)

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
        scene = self.scene
        if scene is not None:
            scene.send()
        self._send()

    def first(self) -> PageSnapshot:
        """The lab as a page is to show it first."""
        return take_page_snapshot(self._data.own, 1.0, nickname=self._nickname())

    def furnish(self, scene: ClientScene) -> None:
        """Show the lab in the robots' picture, too. Not in the simulation thread."""
        before, self.scene = self.scene, scene
        if before is not None:
            before.close()

    def unfurnish(self, client: viser.ClientHandle) -> None:
        """Go on without the robots' picture, if it is still this client's."""
        scene = self.scene
        if scene is not None and scene.client is client:
            self.scene = None
            scene.close()

    def close(self) -> None:
        """Release the page's resources. Thread-safe."""
        self._data.close()
        scene, self.scene = self.scene, None
        if scene is not None:
            scene.close()
