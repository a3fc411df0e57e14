"""Captions: in a few words, what each robot is doing, with its distance from the path."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot

import numpy as np

from onpath.app.lab.snapshots.snapshot import PathSnapshot, RobotSnapshot, Snapshot
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import law_named

OFF = 0.005
"""Distance at which a robot counts as off the path [m]."""
STILL, NEAR = 2e-3, 3e-3
"""Speed below which a robot is at rest [m/s], and distance within which it is at an end [m]."""
PULLED = 0.05
"""Force above which a robot counts as pulled [N]."""
BOUNDED = "_bounded"
"""Ends the names of captions that also say that the integral action is at its bound."""
RETURNS, FULL = 0.5, 0.99
"""Shares above which a law counts as returning from far away, and its integral as bounded."""


class Captions:
    """A caption for each robot; empty while the robot does what its law's title says.

    While a robot is held back, its caption has the largest distance since then, because the
    distance of one that is torn off swings to and fro.

    Attributes:
        shown: the captions for the latest snapshot, by side.
        brief: whether only what a newcomer sees is said, and nothing of integral action.
    """

    def __init__(self, words: Words) -> None:
        self._words = words
        self._before = dict[str, float]()  # `max_distance` when a robot was first seen held back
        self._largest = dict[str, float]()  # distance since then
        self.shown = dict[str, str]()
        self.brief = False

    def follow(self, snapshot: Snapshot) -> dict[str, str]:
        """The captions for a snapshot, by side. Call it with snapshots in order of time."""
        robots = snapshot.robots.items()
        self.shown = {side: self._of(side, robot, snapshot) for side, robot in robots}
        return self.shown

    def _of(self, side: str, robot: RobotSnapshot, snapshot: Snapshot) -> str:
        is_held = side in snapshot.held_back
        distance = self._largest_held(side, robot) if is_held else robot.distance
        if not is_held:
            self._before.pop(side, None)
        kind = "stopped" if side in snapshot.stopped else _kind(robot, is_held, distance)
        if not kind and is_at_end(robot, snapshot.path):
            kind = "at_end"
        if self.brief:
            kind = kind.removesuffix(BOUNDED)
        return self._words(f"caption.{kind}", mm=self._millimetres(distance)) if kind else ""

    def _millimetres(self, distance: float) -> str:
        """A distance [m] in whole millimetres, or tenths where it has tenths only."""
        mm = 1e3 * distance
        return self._words.written(f"{mm:.{1 if 0.05 <= mm < 1 else 0}f}")

    def _largest_held(self, side: str, robot: RobotSnapshot) -> float:
        """Largest distance since a robot has been held back, [m].

        Snapshots miss the peaks of the distance, but `max_distance` does not.
        """
        if side not in self._before:
            self._before[side], self._largest[side] = robot.max_distance, 0.0
        grown = robot.max_distance if robot.max_distance > self._before[side] else 0.0
        self._largest[side] = max(self._largest[side], robot.distance, grown)
        return self._largest[side]


def is_at_end(robot: RobotSnapshot, path: PathSnapshot) -> bool:
    """Whether a robot rests at an end of an open path."""
    if abs(robot.speed) > STILL or path.curve.closed:
        return False
    return bool(np.linalg.norm(path.points[[0, -1]] - robot.end, axis=1).min() < NEAR)


def _kind(robot: RobotSnapshot, is_held: bool, distance: float) -> str:
    """Name of the caption for what a robot does, given whether its law runs by the clock."""
    by_clock, is_off = law_named(robot.law).by_clock, distance >= OFF
    if is_held:
        return ("torn_off" if is_off else "held") if by_clock else "off" if is_off else "waits"
    bounded = robot.integral_used > FULL
    if hypot(*robot.force.tolist()) > PULLED:
        return "pulled_far" if robot.far > RETURNS else "pulled_bounded" if bounded else "pulled"
    if not is_off:
        return ""
    if robot.far > RETURNS:
        return "returns"
    return "chases" if by_clock else "off_bounded" if bounded else "off"


def spoken(captions: Mapping[str, str], titles: Mapping[str, str], words: Words) -> str:
    """One line with the captions of all robots that have one, to be spoken."""
    sentences = [
        words("caption.spoken", robot=titles[side], caption=caption)
        for side, caption in captions.items()
        if caption
    ]
    return " ".join(sentences)
