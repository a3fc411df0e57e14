"""Restores a set-up in a session."""

from __future__ import annotations

from onpath.app.lab.path_editor import BLEND
from onpath.app.lab.session import Session
from onpath.app.lab.setups.plan import planned, wanted_robot
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.models.control.sides import checked_laws
from onpath.models.errors import CodedError
from onpath.models.systems.parameters import rise_of


def restore(session: Session, setup: Setup) -> None:
    """Apply a set-up, with both robots at the start of the path. The old path is one undo away.

    Raises:
        ValueError: the set-up is impossible; the session is unchanged.
    """
    wanted = planned(setup, session.presets)
    for name in (session.entry.name, *session.earlier):
        wanted.setdefault(name, wanted_robot(name, RobotSetup(), session.presets))
    for robot in wanted.values():
        if reasons := robot.path_faults:
            raise CodedError("error.cannot_follow", robot=robot.entry.label, reasons=reasons)
        robot.check_start()
    laws = checked_laws(setup.laws, wanted[setup.robot].entry)
    session.rate, session.copy = setup.rate, setup.copy
    session.exaggeration, session.hold_direction = setup.exaggeration, setup.hold
    for name in sorted(wanted, key=lambda name: name == setup.robot):
        robot = wanted[name]
        session.choose_robot(robot.entry)
        session.editor.robot = robot.entry.make(robot.parameters)
        if (rise := rise_of(robot.parameters)) != session.editor.rise:
            session.editor.raise_to(rise, robot.design)
        session.editor.commit(robot.design)
        session.editor.select(None)
        session.editor.advance(BLEND)
        session.set_parameters(robot.parameters)
        session.start, session.wall = robot.start, robot.wall
    session.reset(laws)
