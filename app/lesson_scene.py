"""Sets a session up as a lesson's step wants it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app import commands as c
from app.apply import apply
from lessons.schema import Scene

if TYPE_CHECKING:
    from app.session import Session

PATH = "circle"


def apply_scene(session: Session, scene: Scene, robot: str) -> None:
    """Robot, path and parameters of a scene, from the start.

    Args:
        robot: the lesson's, where the scene names none.
    """
    if not scene.keep:
        apply(c.ChooseRobot(scene.robot or robot), session)
        apply(c.ResetParameters(), session)
        apply(c.SetCopy(True), session)
        apply(c.SetRate(1.0), session)
        if session.editor.design.name != (scene.path or PATH):
            apply(c.ChoosePath(scene.path or PATH), session)
    elif scene.path:
        apply(c.ChoosePath(scene.path), session)
    for name, value in scene.set.items():
        apply(c.SetParameter(name, value), session)
    session.editor.settle()
    session.reset()
    session.running = scene.running
