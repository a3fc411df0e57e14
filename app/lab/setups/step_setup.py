"""The set-up of a lesson's step."""

from __future__ import annotations

from typing import Any

from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.schema import Lesson
from onpath.models.closed_loop.lab_settings import settings_kept


def setup_of(lesson: Lesson, index: int) -> Setup:
    """A step's set-up, which depends on the lesson only, not on earlier changes in the lab.

    Args:
        index: of the step.
    """
    return setup_from(lesson.setup_at(index), lesson.front.robot)


def setup_from(setup: StepSetup, robot: str) -> Setup:
    """The set-up of a lab for that of a step.

    Args:
        robot: if the step names none.
    """
    robot, path = setup.robot or robot, Path(setup.path or Path().name)
    own: dict[str, Any] = {f"start_{name}": value for name, value in setup.start.numbers.items()}
    own |= {name: setup.set[name] for name in settings_kept("code", True) if name in setup.set}
    settings = {name: setup.set[name] for name in settings_kept("code") if name in setup.set}
    parameters = {n: value for n, value in setup.set.items() if n not in own | settings}
    return Setup(
        robot=robot,
        robots={robot: RobotSetup(parameters, path, own)},
        laws=setup.laws.named,
        settings=settings,
    )
