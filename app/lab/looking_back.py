"""Viewing the past of a lab, continuing from it, and undoing that.

Only continuing discards history. What it discards can be restored until the next continuation,
a reset, or a change of the robot. Time continues with the present path, parameters and control
laws; a law that was not in force at that instant begins there as after any change of law.
"""

from __future__ import annotations

from copy import copy

from onpath.app.lab.events import EventLog
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.segments import Segment
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.timeline import Timeline
from onpath.models.control.laws.own import short_name


def look_back(simulation: Simulation, ago: float) -> None:
    """Pause and view the state `ago` seconds before now, or the oldest one stored."""
    simulation.forces.release()
    simulation.look_at(simulation.time - min(ago, simulation.history.span()))


def forget_history(simulation: Simulation) -> None:
    """Delete the history, and do not keep arrays in memory that hold the states of other labs."""
    simulation.history.clear()
    for run in simulation.runs.values():
        run.unshare()
    simulation.instant()  # otherwise it would keep the previous instant, with those arrays


def go_on(simulation: Simulation) -> tuple[float, float] | None:
    """Continue from the viewed instant; the later history is discarded.

    Returns:
        The instant and the duration discarded, [s]; None if the present was being viewed.
    """
    segment = None if simulation.viewing is None else simulation.history.at(simulation.viewing)
    replaced = None
    if segment is not None:
        replaced = _timeline(simulation)
        _take(simulation, _branch(simulation, segment))
        simulation.note("let_go")
        simulation.note("release")
        for side, drive in segment.drives.items():
            if (law := simulation.laws[side]) != drive.kind.law:
                simulation.note("law", short_name(law), (side,))
        simulation.undo_timeline = replaced
    simulation.viewing, simulation.running = None, True
    return None if replaced is None else (simulation.time, replaced.time - simulation.time)


def undo_going_on(simulation: Simulation) -> bool:
    """Restore the discarded history, paused at its end, and discard the current one.

    Returns:
        Whether there was a history to restore.
    """
    discarded = simulation.undo_timeline
    if discarded is None:
        return False
    simulation.forces.release()
    simulation.viewing = None
    simulation.running = False
    simulation.undo_timeline = _timeline(simulation)
    _take(simulation, discarded)
    return True


def _timeline(simulation: Simulation) -> Timeline:
    simulation.history.settle()  # its samples depend on the current parameters
    return Timeline(
        time=simulation.time,
        curve=simulation.editor.curve,
        history=simulation.history,
        runs=simulation.runs,
        forces=simulation.forces,
        events=simulation.events,
    )


def _take(simulation: Simulation, timeline: Timeline) -> None:
    """Switch to the end of a timeline, with the current path and parameters."""
    simulation.time, simulation.history = timeline.time, timeline.history
    simulation.runs, simulation.forces = timeline.runs, timeline.forces
    simulation.events = timeline.events
    simulation.forces.set_wall(simulation.wall)
    for run in simulation.runs.values():
        if run.robot is not simulation.robot:
            push = simulation.forces.pushes[run.side]
            run.change_robot(simulation.robot, simulation.parameters, simulation.editor.curve, push)
    if timeline.curve is not simulation.editor.curve:
        for run in simulation.runs.values():
            run.change_path(simulation.editor.curve)


def _branch(simulation: Simulation, segment: Segment) -> Timeline:
    """A timeline that ends where a segment of the current one begins, without external forces."""
    runs = {name: copy(run) for name, run in simulation.runs.items()}
    for name, run in runs.items():
        run.restore(segment.drives[name], segment.curve)
    kept = [
        e for e in simulation.events if e.run != simulation.run_number or e.time <= segment.time
    ]
    return Timeline(
        time=segment.time,
        curve=segment.curve,
        history=simulation.history.before(segment),
        runs=runs,
        forces=ExternalForces(simulation.robot, runs, simulation.note),
        events=EventLog(kept),
    )
