"""The set-up that a lesson's step asks for."""

from __future__ import annotations

from onpath.app.lab.setup import Path, RobotSetup, Setup
from onpath.lessons.schema import Lesson


def setup_of(lesson: Lesson, index: int, exaggeration: float = 1.0) -> Setup:
    """A step's set-up: of the lesson alone, not of what was done in the lab before.

    Args:
        index: of the step.
        exaggeration: how many times larger a deflection is drawn, as in the lab before.
    """
    scene = lesson.scene_at(index)
    robot, path = scene.robot or lesson.front.robot, Path(scene.path or Path().name)
    own = {robot: RobotSetup(dict(scene.set), path)}
    return Setup(robot, own, exaggeration=exaggeration)
