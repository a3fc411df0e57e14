"""The set-up of a lesson's step."""

from __future__ import annotations

from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.schema import Lesson


def setup_of(lesson: Lesson, index: int) -> Setup:
    """A step's set-up, which depends on the lesson only, not on earlier changes in the lab.

    Args:
        index: of the step.
    """
    return setup_of_scene(lesson.scene_at(index), lesson.front.robot)


def setup_of_scene(scene: StepSetup, robot: str) -> Setup:
    """The set-up of a scene.

    Args:
        robot: if the scene names none.
    """
    robot, path = scene.robot or robot, Path(scene.path or Path().name)
    return Setup(
        robot=robot,
        robots={robot: RobotSetup(dict(scene.set), path, scene.start.numbers)},
        laws=scene.laws.named,
    )
