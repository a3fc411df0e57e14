"""What each command does to a session."""

from __future__ import annotations

import math
from functools import singledispatch
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.lab import commands as c
from onpath.app.lab.identify import identify_model
from onpath.app.lab.looking_back import go_on, look_back, return_to_present, undo_going_on
from onpath.app.lab.setup import capture, restore
from onpath.app.lab.share_code import decode, encode
from onpath.models.control.laws import NAMES
from onpath.models.errors import CodedError
from onpath.models.paths.path_design import PathDesign, drawn
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import changed, out_of_range, unknown_name

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@singledispatch
def apply(command: object, session: Session) -> None:
    """Apply a command to a session.

    Raises:
        ValueError: it makes no sense now; the message tells the user why.
    """
    raise ValueError(f"unknown command {type(command).__name__}")


@apply.register(c.SetParameter)
def _(command: c.SetParameter, session: Session) -> None:
    before = session.parameters
    session.set_parameters(changed(before, command.name, command.value))
    if session.parameters != before:
        session.note("set", command.name)


@apply.register(c.ResetParameters)
def _(_: c.ResetParameters, session: Session) -> None:
    session.set_parameters(session.entry.lab)


@apply.register(c.Identify)
def _(_: c.Identify, session: Session) -> None:
    identify_model(session)
    session.note("identify")


@apply.register(c.ChooseRobot)
def _(command: c.ChooseRobot, session: Session) -> None:
    if command.name not in ROBOTS:
        raise unknown_name(command.name, list(ROBOTS), "robot")
    session.choose_robot(ROBOTS[command.name])


@apply.register(c.StepOnce)
def _(_: c.StepOnce, session: Session) -> None:
    return_to_present(session)
    session.step_once()


@apply.register(c.Reset)
def _(_: c.Reset, session: Session) -> None:
    session.reset()


@apply.register(c.LookAt)
def _(command: c.LookAt, session: Session) -> None:
    look_back(session, _finite(command.ago))


@apply.register(c.GoOn)
def _(_: c.GoOn, session: Session) -> None:
    go_on(session)


@apply.register(c.UndoGoOn)
def _(_: c.UndoGoOn, session: Session) -> None:
    undo_going_on(session)


@apply.register(c.SetCopy)
def _(command: c.SetCopy, session: Session) -> None:
    session.copy = bool(command.on)


@apply.register(c.SetExaggeration)
def _(command: c.SetExaggeration, session: Session) -> None:
    factor = _finite(command.factor)
    if not c.EXAGGERATIONS[0] <= factor <= c.EXAGGERATIONS[-1]:
        raise out_of_range("exaggeration", f"{factor:g}", "1", f"{c.EXAGGERATIONS[-1]:g}")
    session.exaggeration = factor


@apply.register(c.SelectPoint)
def _(command: c.SelectPoint, session: Session) -> None:
    session.editor.select(command.index)


@apply.register(c.EndMove)
def _(_: c.EndMove, session: Session) -> None:
    _finish(session)


@apply.register(c.SetRunning)
def _(command: c.SetRunning, session: Session) -> None:
    running = not session.running if command.running is None else command.running
    if running:
        return_to_present(session)
    session.running = running


@apply.register(c.SetRate)
def _(command: c.SetRate, session: Session) -> None:
    rate = _finite(command.rate)
    if not c.RATES[0] <= rate <= c.RATES[-1]:
        raise out_of_range("speed", f"{rate:g}", f"{c.RATES[0]:g}", f"{c.RATES[-1]:g}")
    session.rate = rate


@apply.register(c.Hold)
def _(command: c.Hold, session: Session) -> None:
    return_to_present(session)
    if command.controller is not None:
        _known(command.controller)
    everyone: list[str] = list(NAMES)
    names = everyone if command.controller is None else session.targets(command.controller)
    on = not session.grips.held.intersection(names) if command.on is None else command.on
    session.grips.hold(names, on, session.editor.curve)


@apply.register(c.Grab)
def _(command: c.Grab, session: Session) -> None:
    _known(command.controller)
    return_to_present(session)
    target, together = _point(command.target), session.targets(command.controller)
    session.grips.grab(command.controller, session.robot.unplace(target), together)


@apply.register(c.Release)
def _(command: c.Release, session: Session) -> None:
    if command.controller in (None, session.grips.grabbed):
        session.grips.release()


@apply.register(c.MoveHand)
def _(command: c.MoveHand, session: Session) -> None:
    return_to_present(session)
    name = session.grips.grabbed or NAMES[-1]
    target = session.grips.hands.get(name, session.runs[name].shown()["y"])
    plane = session.robot.frame
    z = plane.planar(target) + np.array([_finite(command.right), _finite(command.up)])
    there = target + plane.lift(z) - plane.lift(plane.planar(target))
    session.grips.grab(name, there, session.targets(name))


@apply.register(c.LookBack)
def _(command: c.LookBack, session: Session) -> None:
    now = session.time if session.viewing is None else session.viewing
    look_back(session, session.time - now + _finite(command.by))


@apply.register(c.SelectNext)
def _(_: c.SelectNext, session: Session) -> None:
    editor = session.editor
    editor.select((-1 if editor.selected is None else editor.selected) + 1)
    if editor.selected is None:
        editor.select(0)


@apply.register(c.ChoosePath)
def _(command: c.ChoosePath, session: Session) -> None:
    if command.name not in session.presets:
        raise unknown_name(command.name, list(session.presets), "path")
    _commit(session, session.presets[command.name])


@apply.register(c.MovePoint)
def _(command: c.MovePoint, session: Session) -> None:
    editor = session.editor
    z = session.robot.frame.planar(session.robot.unplace(_point(command.target)))
    if editor.proposed is None or editor.selected != command.index:
        editor.select(command.index)
    editor.propose((editor.proposed or editor.design).moved(command.index, z))
    if command.finished:
        _finish(session)


@apply.register(c.Arrow)
def _(command: c.Arrow, session: Session) -> None:
    index = session.editor.selected
    if index is None:
        if command.right > 0:
            return_to_present(session)
            session.step_once()
        return
    design = session.editor.design
    step = np.array([_finite(command.right), _finite(command.up)])
    _commit(session, design.moved(index, design.points[index] + step))


@apply.register(c.PlacePoint)
def _(command: c.PlacePoint, session: Session) -> None:
    index = _selected(session)
    design = session.editor.design
    old = design.points[index]
    new = [
        o if n is None else _finite(n)
        for o, n in zip(old, (command.first, command.second), strict=True)
    ]
    if not np.allclose(old, new, atol=1e-6):
        _commit(session, design.moved(index, np.array(new)))


@apply.register(c.AddPoint)
def _(_: c.AddPoint, session: Session) -> None:
    editor = session.editor
    index = 0 if editor.selected is None else editor.selected
    _commit(session, editor.design.added(index))
    editor.select(min(index + 1, len(editor.design.points) - 1))


@apply.register(c.RemovePoint)
def _(_: c.RemovePoint, session: Session) -> None:
    _commit(session, session.editor.design.removed(_selected(session)))


@apply.register(c.DrawPath)
def _(command: c.DrawPath, session: Session) -> None:
    stroke = np.asarray(command.stroke, dtype=float)
    if stroke.ndim != 2 or stroke.shape[1] != 3 or len(stroke) > 5000:
        raise CodedError("error.stroke_without_points")
    points = session.robot.frame.planar(session.robot.unplace(stroke))
    _commit(session, drawn(points, session.editor.design.curve))


@apply.register(c.Undo)
def _(_: c.Undo, session: Session) -> None:
    session.show_message(
        "" if session.editor.undo() else session.lessons.words("say.nothing_to_undo")
    )


@apply.register(c.Redo)
def _(_: c.Redo, session: Session) -> None:
    session.show_message(
        "" if session.editor.redo() else session.lessons.words("say.nothing_to_redo")
    )


@apply.register(c.Share)
def _(_: c.Share, session: Session) -> None:
    session.shared = encode(capture(session))


@apply.register(c.UseShared)
def _(command: c.UseShared, session: Session) -> None:
    restore(session, decode(command.text))
    session.show_message("")


def _commit(session: Session, design: PathDesign) -> None:
    session.editor.propose(design)
    _finish(session)


def _finish(session: Session) -> None:
    """End an edit of the path and say why if it is refused."""
    before = session.editor.design
    if session.editor.finish():
        if session.editor.design is not before:
            session.note("path", session.editor.design.name)
        session.clear_message()
        return_to_present(session)
    elif session.editor.faults:
        words = session.lessons.words
        reasons = "; ".join(words.sentence(fault.reason) for fault in session.editor.faults)
        return_to_present(session)
        session.show_message(words("say.refused", reasons=reasons), "warning")


def _selected(session: Session) -> int:
    if session.editor.selected is None:
        raise CodedError("say.select_first")
    return session.editor.selected


def _finite(value: float) -> float:
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        result = math.nan
    if not math.isfinite(result):
        raise CodedError("error.not_a_number")
    return result


def _point(value: np.ndarray) -> np.ndarray:
    point = np.asarray(value, dtype=float)
    if point.shape != (3,) or not np.all(np.isfinite(point)):
        raise CodedError("error.not_a_point")
    return point


def _known(controller: str) -> None:
    if controller not in NAMES:
        raise unknown_name(controller, list(NAMES), "robot")
