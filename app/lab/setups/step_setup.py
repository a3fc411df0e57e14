"""The set-up of a lesson's step."""

from __future__ import annotations

from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.lessons.schema import Lesson


def setup_of(lesson: Lesson, index: int) -> Setup:
    """A step's set-up, which depends on the lesson only, not on earlier changes in the lab.

    Args:
        index: of the step.
    """
    scene = lesson.scene_at(index)
    robot, path = scene.robot or lesson.front.robot, Path(scene.path or Path().name)
    return Setup(
        robot=robot,
        robots={robot: RobotSetup(dict(scene.set), path, scene.start.numbers)},
        laws=scene.laws.named,
    )
