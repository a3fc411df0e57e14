"""Advances the closed loops of many labs together; loops of one kind are rows of the same arrays.

A lab's frame is a generator: it yields the ticks that it needs, and is resumed once they have been
simulated together with those of all other labs.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence

import numpy as np
from msgspec import Struct

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.loop_states import Slot, joined
from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import not_finite
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import Loop
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import near_distances
from onpath.models.systems.efforts import efforts
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

DISTANCE_INTERVAL = 4  # rows between evaluations of the distance, where the loop does not log it


class Ticks(Struct, frozen=True, eq=False):
    """The ticks that a lab needs.

    Attributes:
        runs: the closed loops to advance, and the loop that computes each.
        count: number of ticks.
        time: at the beginning of the ticks, [s].
        dt: length of a tick, [s].
        parameters: of the robots.
        curve: the path.
        table: the path's coefficients for the loops.
    """

    runs: Sequence[tuple[ClosedLoopRun, Loop]]
    count: int
    time: float
    dt: float
    parameters: Parameters
    curve: Curve
    table: Array


Frame = Generator[Ticks]
"""A lab's frame, see above. If its ticks cannot be simulated, the error is raised inside it."""
NO_FRAME: Frame = (nothing for nothing in ())
"""A frame without ticks."""
Row = tuple[ClosedLoopRun, Ticks]
"""One closed loop of a frame."""


def raise_error(error: Exception) -> None:
    """Raise an error."""
    raise error


def advance_together(
    frames: Iterable[Frame], report: Callable[[Exception], None] = raise_error
) -> None:
    """Run the frames of some labs to their ends.

    Args:
        report: called with the error of a frame, which does not affect the others.
    """
    waiting = _resumed([(frame, None) for frame in frames], report)
    while waiting:
        errors = _simulate([ticks for _, ticks in waiting])
        waiting = _resumed([(frame, errors.get(id(ticks))) for frame, ticks in waiting], report)


def _resumed(
    frames: Iterable[tuple[Frame, Exception | None]], report: Callable[[Exception], None]
) -> list[tuple[Frame, Ticks]]:
    """Resume frames, some with an error, until each ends or needs ticks."""
    waiting = list[tuple[Frame, Ticks]]()
    for frame, error in frames:
        try:
            waiting.append((frame, next(frame) if error is None else frame.throw(error)))
        except StopIteration:
            pass
        except Exception as raised:
            report(raised)
    return waiting


def _simulate(wanted: Iterable[Ticks]) -> dict[int, Exception]:
    """Simulate the ticks; returns errors by the `id` of the ticks concerned."""
    kinds: dict[tuple[Loop, Robot, int], list[Row]] = {}
    for ticks in wanted:
        for run, loop in ticks.runs:
            kinds.setdefault((loop, run.robot, ticks.count), []).append((run, ticks))
    errors: dict[int, Exception] = {}
    for (loop, _, _), rows in kinds.items():
        try:
            _advance(loop, rows)
        except Exception:  # one row caused it: find out which
            for row in rows:
                try:
                    _advance(loop, [row])
                except Exception as error:
                    errors[id(row[1])] = error
    return errors


def _advance(loop: Loop, members: Sequence[Row]) -> None:
    """Advance closed loops of one robot and kind by equally many ticks, all or none."""
    first, ticks = members[0]
    log = loop.layouts.log
    before, largest = _gathered([run.slot for run, _ in members])
    states, rows = loop.run_many(
        before,
        [run.settings for run, _ in members],
        [each.table for _, each in members],
        ticks.count,
    )
    if efforts(first.robot) is not None:
        torques = np.abs(rows[..., log.slices["u"]]).max(axis=1)
        for (run, _), largest_of_run in zip(members, torques, strict=True):
            run.check_torques(largest_of_run)
    faults = _faults(members, states, rows[..., log.slices["q"]], rows[..., log.slices["v"]])
    good = [i for i, fault in enumerate(faults) if fault is None]
    if good:
        moved = rows
        if len(good) < len(rows):
            states, moved, largest = states[good], rows[good], largest[good]
        curves = [members[i][1].curve for i in good]
        distances, counted = _distances(first.robot, first.kind, curves, moved, log)
        most = np.fmax(largest, np.fmax.reduce(counted, axis=1))
        after = joined(states, moved[:, -1], distances[:, -1], most)
        for row, i in enumerate(good):
            members[i][0].slot = after, row
    for (run, wanted), log_rows, fault in zip(members, rows, faults, strict=True):
        if fault is not None:
            run.stop(fault, log_rows, wanted.curve, wanted.time + fault[0] * wanted.dt)


def _gathered(slots: Sequence[Slot]) -> tuple[Array | Sequence[Array], Array]:
    """States and largest distances of closed loops of one kind, one row for each."""
    first = slots[0][0]
    same = len(first.records) == len(slots)
    if same and all(states is first and row == i for i, (states, row) in enumerate(slots)):
        return first.states, first.largest  # the same loops as in the last frame
    records = [(states.records[i], states.size) for states, i in slots]
    return [record[:size] for record, size in records], np.array([r[-1] for r, _ in records])


def _faults(
    members: Sequence[Row], states: Array, q: Array, v: Array
) -> list[tuple[int, Message] | None]:
    """The first invalid tick of each closed loop and the reason; None if all are valid."""
    first, ticks = members[0]
    robot = first.robot
    finite = np.isfinite(states)
    flat = (-1, q.shape[-1])
    if finite.all() and robot.fault(q.reshape(flat), v.reshape(flat), ticks.parameters) is None:
        return [None] * len(members)
    faults = [robot.fault(q[i], v[i], each.parameters) for i, (_, each) in enumerate(members)]
    return [
        (ticks.count, not_finite(run.kind.law)) if fault is None and not numbers.all() else fault
        for fault, numbers, (run, _) in zip(faults, finite, members, strict=True)
    ]


def _distances(
    robot: Robot, kind: Kind, curves: Sequence[Curve], rows: Array, log: Layout
) -> tuple[Array, Array]:
    """Distances of the end-points from their paths in some rows and the last, (runs, rows), [m].

    Then the same with 0 where the pen is raised.

    On a drawing, a robot that a clock has moved off the path may meet it again at another stroke
    than the one on which θ was left behind: its distance is from where its reference is.
    """
    system, slices = robot.system, log.slices
    exact = system.controlled_output is system.output and not kind.encoder
    aim = law_named(kind.law).aim if kind.spline else "theta"
    some, theta = rows, slices[aim].start
    if exact and not kind.level_set and system.p == 2 and aim == "theta":
        distances = np.abs(rows[..., slices["xi"].start])
    else:
        some = rows[:, (rows.shape[1] - 1) % DISTANCE_INTERVAL :: DISTANCE_INTERVAL]
        distances = near_distances(robot.frame, curves, some[..., slices["y"]], some[..., theta])
    if not kind.spline:
        return distances, distances
    down = [curve.draws(each) for curve, each in zip(curves, some[..., theta], strict=True)]
    return distances, np.where(down, distances, 0.0)
