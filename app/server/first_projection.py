"""How robots are seen where their picture is not there, or not yet."""

from __future__ import annotations

from collections.abc import Callable

from onpath.app.scene.projection import seen_at_first
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.view.state_message import Projection
from onpath.models.systems.robots import Robot


class FirstProjection:
    """How the robots of a page are seen before a camera has reported.

    A robot's stage is made in another thread: reading the meshes of an arm takes up to half a
    second, and the simulation thread serves all labs.

    Args:
        submit: runs a function in another thread.
    """

    def __init__(self, submit: Callable[[Callable[[], None]], None]) -> None:
        self._submit = submit
        self._robot: Robot | None = None
        self._seen: Projection | None = None

    def of(self, robot: Robot) -> Projection | None:
        """That of a robot; until it is there, that of the robot before, or None."""
        if robot is not self._robot:
            self._robot = robot
            self._submit(lambda: self._see(robot))
        return self._seen

    def _see(self, robot: Robot) -> None:
        seen = seen_at_first(stage_of(robot), robot)
        if robot is self._robot:
            self._seen = seen
