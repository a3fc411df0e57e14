"""Sets a session up as a lesson's step wants it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from onpath.app.lab.setup import Path, RobotSetup, Setup, restore
from onpath.lessons.schema import Lesson

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


def setup_of(lesson: Lesson, index: int) -> Setup:
    """A step's set-up: of the lesson alone, not of what was done in the lab before."""
    scene = lesson.scene_at(index)
    robot, path = scene.robot or lesson.front.robot, Path(scene.path or Path().name)
    return Setup(robot, {robot: RobotSetup(dict(scene.set), path)})


def set_up(session: Session, lesson: Lesson, index: int) -> None:
    """Both robots at the start, everything as the step wants it but how large it is drawn.

    Raises:
        ValueError: a robot cannot follow the step's path; then the session is as it was.
    """
    restore(session, replace(setup_of(lesson, index), exaggeration=session.exaggeration))
    session.editor.select(None)
