"""Does by itself what a lesson's script says, at its times."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.lab import commands as c
from onpath.app.lab.external_forces import displaced
from onpath.lessons.record import ROLES
from onpath.lessons.schema import Action, Script
from onpath.models.control.laws import NAMES
from onpath.models.errors import CodedError

if TYPE_CHECKING:
    from collections.abc import Callable

    from onpath.app.lab.session import Session

CONTROLLERS = {role: controller for controller, role in ROLES.items()}


class ScriptPlayer:
    """A script that is being played; its times count from the session's time zero.

    Args:
        script: what to do.
        stop: pause the session at the script's end.

    Attributes:
        finished: whether it has come to its end, and not only been given up.
    """

    def __init__(self, script: Script, stop: bool = True) -> None:
        self._until = script.until
        self._waiting = sorted(script.do, key=lambda action: action.at)
        self._stop = stop
        self._before = 0.0  # simulated before the last reset, [s]
        self._run: int | None = None
        self.finished = False

    def play(self, session: Session) -> bool:
        """Do what is due; call it before every frame. True when it is over, or overtaken.

        Raises:
            ValueError: an action that the lab refuses; the script is then over.
        """
        if self._run is None:
            self._run = session.run_number
        if session.run_number != self._run:
            return True  # somebody else has begun anew
        while self._waiting and self._waiting[0].at <= self._now(session) + 1e-9:
            before = session.time
            perform(self._waiting.pop(0), session)
            if session.run_number != self._run:
                self._run, self._before = session.run_number, self._before + before
        if self._now(session) < self._until - 1e-9:
            return False
        if self._stop:
            session.running = False
        self.finished = True
        return True

    def _now(self, session: Session) -> float:
        return self._before + session.time


def perform(action: Action, session: Session) -> None:
    """Do one thing to a session.

    Raises:
        ValueError: the lab refuses it.
    """
    _DEEDS[action.what](action, session)


def _hold(action: Action, session: Session) -> None:
    session.grips.hold(_whom(action), bool(action.hold), session.editor.curve)


def _pull(action: Action, session: Session) -> None:
    name = CONTROLLERS[action.only or "follower"]
    away, y = np.array(action.pull) / 1e3, session.runs[name].shown()["y"]
    session.grips.grab(name, displaced(session.robot.frame, y, away), _whom(action))


def _whom(action: Action) -> list[str]:
    return [CONTROLLERS[action.only]] if action.only else list(NAMES)


def _set(action: Action, session: Session) -> None:
    for name, value in (action.set or {}).items():
        c.SetParameter(name, value).apply(session)


def _move(action: Action, session: Session) -> None:
    assert action.move is not None
    index, right, up = action.move
    points = session.editor.design.points
    if not 0 <= index < len(points):
        raise CodedError("error.no_point", index=index, count=len(points))
    c.MovePoint(index, points[index] + np.array([right, up]) / 1e3).apply(session)


def _asked(make: Callable[[Action], c.Command]) -> Callable[[Action, Session], None]:
    return lambda action, session: make(action).apply(session)


_DEEDS: dict[str, Callable[[Action, Session], None]] = {
    "hold": _hold,
    "pull": _pull,
    "release": _asked(lambda _: c.Release()),
    "set": _set,
    "path": _asked(lambda action: c.ChoosePath(action.path or "")),
    "move": _move,
    "robot": _asked(lambda action: c.ChooseRobot(action.robot or "")),
    "reset": _asked(lambda _: c.Reset()),
    "run": _asked(lambda action: c.SetRunning(action.run)),
    "identify": _asked(lambda _: c.Identify()),
}
