"""Restores a set-up in a simulation."""

from __future__ import annotations

from onpath.app.lab.path_editor import BLEND
from onpath.app.lab.setups.plan import own_settings, planned
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.simulation import Simulation
from onpath.models.closed_loop.lab_settings import settings_kept
from onpath.models.control.sides import checked_laws
from onpath.models.errors import CodedError
from onpath.models.systems.parameters import rise_of


def restore(simulation: Simulation, setup: Setup) -> None:
    """Apply a set-up, with both robots at the start of the path. The old path is one undo away.

    Raises:
        ValueError: the set-up is impossible; the simulation is unchanged.
    """
    wanted = planned(setup)
    for robot in wanted.values():
        if reasons := robot.path_faults:
            raise CodedError("error.cannot_follow", robot=robot.entry.label, reasons=reasons)
        robot.check_start()
    laws = checked_laws(setup.laws, wanted[setup.robot].entry)
    settings = own_settings(setup.settings)
    simulation.set(**{name: getattr(settings, name) for name in settings_kept("code")})
    for name in sorted(wanted, key=lambda name: name == setup.robot):
        robot = wanted[name]
        simulation.choose_robot(robot.entry)
        simulation.editor.robot = robot.entry.make(robot.parameters)
        if (rise := rise_of(robot.parameters)) != simulation.editor.rise:
            simulation.editor.raise_to(rise, robot.design)
        simulation.editor.commit(robot.design)
        simulation.editor.select(None)
        simulation.editor.advance(BLEND)
        simulation.set_parameters(robot.parameters)
        kept = settings_kept("code", of_robot=True)
        simulation.set(**{name: getattr(robot.own, name) for name in kept})
    for name in set(simulation.earlier) - set(wanted):
        del simulation.earlier[name]  # it restarts when it is chosen
    simulation.reset(laws)
