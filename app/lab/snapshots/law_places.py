"""Where the robots are on the path, for the poles of laws whose poles vary along it."""

from __future__ import annotations

from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.page_snapshot import LawPlaces, PageSnapshot
from onpath.models.control.laws.registry import law_named
from onpath.models.control.place import Place, place_at

INTERVAL = 1.0  # [s] of simulated time between updates, so that the numbers can be read


def law_places(simulation: Simulation, time: float, before: PageSnapshot | None) -> LawPlaces:
    """The places of the robots at the instant that is shown, each where its law aims.

    They are updated after `INTERVAL`, when anything else has changed, and while the lab is paused.

    Args:
        time: the time that is shown, [s].
        before: the previous whole snapshot of the same lab.
    """
    aims = {side: law_named(law) for side, law in simulation.chosen_laws.items()}
    aims = {side: law for side, law in aims.items() if law.channels is not None}
    version = (simulation.entry.name, simulation.editor.version, *simulation.chosen_laws.values())
    old = None if before is None else before.places
    if old is not None and old.version == version:
        fresh = simulation.running and 0 <= time - old.time < INTERVAL
        if fresh or time == old.time or not aims:
            return old
    robot, parameters = simulation.robot, simulation.parameters
    past = None if simulation.viewing is None else simulation.history.at(simulation.viewing)
    instant = simulation.instant() if past is None else past.instant()
    curve = simulation.editor.curve if past is None else past.curve
    fields = simulation.sample_layout.unpack(instant.sample)
    places = dict[str, Place]()
    for row, side in enumerate(simulation.runs):
        if side in aims:
            theta, rate = (float(fields[name][row, 0]) for name in (aims[side].aim, "theta_rate"))
            places[side] = place_at(robot, parameters, curve, theta, rate)
    return LawPlaces(time, version, places)
