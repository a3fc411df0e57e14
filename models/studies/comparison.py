"""A fair comparison of control laws, with the same robot, path, gains and obstructions for all.

Where motors are too weak, every law runs twice: with torques that are cut, and with the remedy of
the parameter `at_limit`, which is not part of any law. `across_first` applies to all laws that
command an acceleration. `slow_down` also limits the wanted speed of path following and typed laws;
a law with a timetable cannot deviate from it.

Every run begins on the path with the wanted velocity along it, or beside it if the obstruction says
so. Nothing happens for `BEFORE`, then the obstruction acts, and then nothing happens for `AFTER`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import ManyLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    pushed,
    settings_vector,
)
from onpath.models.closed_loop.start import driven_rates
from onpath.models.control.bend_limit import speed_on
from onpath.models.control.forecast import check_possible
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import values_of
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import drawn_distance
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.guessed_numbers import told_guesses
from onpath.models.systems.parameters import Parameters, time_step
from onpath.models.systems.robots import Robot, RobotEntry

BEFORE, AFTER = 0.5, 2.0  # [s]
CURVE_STEP = 0.02  # [s] between the points of an outcome's curve
RIGHT_ANGLE = np.array([[0.0, 1.0], [-1.0, 0.0]])  # turns a tangent to the right, outwards


@dataclass(frozen=True, slots=True)
class Obstruction:
    """An obstruction of the robot, the same for all laws.

    Attributes:
        name: as on the command line and in files.
        seconds: its duration.
        places: number of places on the path at which it acts, one in each run.
        hold: whether a brake holds the end-point along the path.
        hand: displacement (along, across) to which a hand pulls the end-point, [m], or None.
        wall: distance along the path's tangent at which a wall stands in the way, [m], or None.
        torque: limit of the torques, as a share of the largest torque of unobstructed path
            following; 0: as in the parameters.
        speed: factor of the wanted speed while it acts.
        at_limit: what happens at a torque limit; empty: as in the parameters.
        off: distance from the path at the start, [m].
        rests: whether the robot starts at rest.
    """

    name: str
    seconds: float = 2.0
    places: int = 4
    hold: bool = False
    hand: tuple[float, float] | None = None
    wall: float | None = None
    torque: float = 0.0
    speed: float = 1.0
    at_limit: str = ""
    off: float = 0.0
    rests: bool = False


OBSTRUCTIONS = {
    each.name: each
    for each in (
        Obstruction("none", places=1),
        Obstruction("brake", places=8, hold=True),
        Obstruction("push_across", seconds=1.0, hand=(0.0, 0.03)),
        Obstruction("push_ahead", seconds=1.0, hand=(0.04, 0.0)),
        Obstruction("push_back", seconds=1.0, hand=(-0.04, 0.0)),
        Obstruction("wall", wall=0.01),
        Obstruction("weak_motors", torque=0.4),
        Obstruction("weak_motors_cut", torque=0.4, at_limit="cut"),
        Obstruction("too_fast", torque=1.0, speed=2.0),
        Obstruction("too_fast_cut", torque=1.0, speed=2.0, at_limit="cut"),
        Obstruction("start_off_at_rest", off=0.015, rests=True),
        Obstruction("start_off_moving", off=0.015),
    )
}


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of one run.

    Attributes:
        law, obstruction, place: of the run; the place is θ at its start, [rad].
        max_distance_m: largest distance to the path, whatever the law measures.
        mean_distance_m: mean distance over the run.
        delay_s: by how much the end-point is late at the end, at the wanted speed; negative: early.
            Laps are counted by the closest point, so that a cut through the inside loses one.
        peak_force_N, impulse_Ns: of the force on the end-point.
        energy_given_J: largest work of the end-point on the hand, brake or wall.
        overspeed: largest relative excess of the rate along the path after the release.
        rms_torque_Nm: over the run and all motors.
        stopped_at_s: time at which the run was stopped as diverged, or None; all measures are then
            infinity, which ranks last.
        largest_torques: of each motor, until the run was stopped, if it was, [N m] or [N].
        distances_m: to the path, every `CURVE_STEP` from the start, until the run was stopped.
    """

    law: str
    obstruction: str
    place: float
    max_distance_m: float
    mean_distance_m: float
    delay_s: float
    peak_force_N: float
    impulse_Ns: float
    energy_given_J: float
    overspeed: float
    rms_torque_Nm: float
    stopped_at_s: float | None
    largest_torques: tuple[float, ...]
    distances_m: tuple[float, ...]


MEASURES = (
    "max_distance_m",
    "mean_distance_m",
    "delay_s",
    "peak_force_N",
    "impulse_Ns",
    "energy_given_J",
    "overspeed",
    "rms_torque_Nm",
)
"""The numbers of an outcome for which larger is worse."""


_Run = tuple[dict[str, Array], int | None]
"""The log of a run, and the row in which it was stopped, if it was."""


@dataclass(frozen=True, slots=True, eq=False)
class Contest:
    """The conditions that all laws share.

    Attributes:
        entry: the robot.
        parameters: its parameters; the wanted motion is along the path at `speed`.
        curve: the path.
    """

    entry: RobotEntry
    parameters: Parameters
    curve: Curve

    @property
    def robot(self) -> Robot:
        """The robot for the parameters."""
        return self.entry.make(self.parameters)

    def laws(self) -> list[str]:
        """The laws of the registry that can take part."""
        return [name for name in LAWS if self.admits(name)]

    def admits(self, name: str) -> bool:
        """Whether a law, registered or typed, can take part: it suits the robot and moves along.

        Raises:
            ValueError: there is no such law.
        """
        law, composite = law_named(name), getattr(self.parameters, "output", "") == "composite"
        suits = law.suits(self.robot.system) and (law.commands_acceleration or not composite)
        return law.travels and suits


def compare(
    contest: Contest, laws: Sequence[str], obstructions: Sequence[str]
) -> Iterator[list[Outcome]]:
    """The outcomes of one law under one obstruction after the other, a list for each pair.

    Raises:
        CodedError: no run is possible.
    """
    robot = contest.robot
    q = robot.rest(robot.frame.lift(contest.curve.at(np.array(0.0))))
    for law in laws:
        check_possible(robot, law, contest.parameters, q)
    torque = _largest_torque(contest)
    for law in laws:
        for name in obstructions:
            obstruction = OBSTRUCTIONS[name]
            places = 2 * np.pi * np.arange(obstruction.places) / obstruction.places - np.pi / 2
            runs = _runs(contest, law, obstruction, places, torque)
            pairs = zip(places.tolist(), runs, strict=True)
            yield [_outcome(contest, law, obstruction, at, run) for at, run in pairs]


def with_cut(names: Sequence[str]) -> list[str]:
    """The obstructions' names; one with a torque limit is followed by its variant with a cut."""
    both = (each for name in names for each in (name, f"{name}_cut"))
    return list(dict.fromkeys(each for each in both if each in OBSTRUCTIONS))


def worst(outcomes: Sequence[Outcome]) -> dict[str, float | None]:
    """The worst value of each measure over all places; `stopped_at_s` is the earliest, or None."""
    stops = [o.stopped_at_s for o in outcomes if o.stopped_at_s is not None]
    found: dict[str, float | None] = {
        name: max((getattr(o, name) for o in outcomes), key=abs) for name in MEASURES
    }
    return found | {"stopped_at_s": min(stops, default=None)}


def beyond_efforts(robot: Robot, outcomes: Iterable[Outcome]) -> Message | None:
    """Which motor exceeds its limit in the robot's file most, over all runs; None if none does."""
    return exceeded(robot, np.max([each.largest_torques for each in outcomes], axis=0))


def by_law(results: Mapping[tuple[str, str], Sequence[Outcome]]) -> dict[str, list[Outcome]]:
    """All outcomes of each law."""
    found = dict[str, list[Outcome]]()
    for (law, _), outcomes in results.items():
        found.setdefault(law, []).extend(outcomes)
    return found


def row_of(outcome: Outcome) -> dict[str, Any]:
    """A run as a row of a table: its conditions and measures."""
    row = dataclasses.asdict(outcome)
    del row["largest_torques"], row["distances_m"]
    return row


def _largest_torque(contest: Contest) -> float:
    """The least `torque_limit` without effect on unobstructed path following."""
    ((log, _),) = _runs(contest, "path_following", OBSTRUCTIONS["none"], np.zeros(1), 0.0)
    return float((np.abs(log["u"]) / np.array(contest.robot.system.strength)).max())


def _outcome(
    contest: Contest, law: str, obstruction: Obstruction, place: float, run: _Run
) -> Outcome:
    log, fault = run
    dt, speed = time_step(contest.parameters), speed_on(contest.parameters, contest.curve)
    torques = np.abs(log["u"][:fault]).max(axis=0, initial=0.0)
    seen = log["y"][:fault][::5]
    theta = log["theta"][:fault, 0][::5]
    distance = np.zeros(len(seen))
    if len(seen):
        distance = drawn_distance(contest.robot.frame, contest.curve, seen, theta)
    curve = tuple(distance[:: round(CURVE_STEP / dt / 5)].tolist())
    if fault is not None:
        measures = dict.fromkeys(MEASURES, np.inf)
        return Outcome(
            law=law,
            obstruction=obstruction.name,
            place=place,
            **measures,
            stopped_at_s=fault * dt,
            largest_torques=tuple(torques.tolist()),
            distances_m=curve,
        )
    seconds = len(log["theta"]) * dt
    force = np.linalg.norm(log["force"], axis=1)
    steps = np.diff(log["y"], axis=0, append=log["y"][-1:])
    given = -np.cumsum((log["force"] * steps).sum(1))
    after = round((BEFORE + obstruction.seconds) / dt)
    rates = log["theta_rate"][after:, 0] / speed
    expected = place + speed * seconds
    return Outcome(
        law=law,
        obstruction=obstruction.name,
        place=place,
        max_distance_m=float(distance.max()),
        mean_distance_m=float(distance.mean()),
        delay_s=float(expected - log["theta"][-1, 0]) / speed,
        peak_force_N=float(force.max()),
        impulse_Ns=float(force.sum() * dt),
        energy_given_J=max(float(given.max()), 0.0) + 0.0,
        overspeed=max(float(rates.max()) - 1, 0.0) if rates.size else 0.0,
        rms_torque_Nm=float(np.sqrt((log["u"] ** 2).mean())),
        stopped_at_s=None,
        largest_torques=tuple(torques.tolist()),
        distances_m=curve,
    )


def _runs(
    contest: Contest, law: str, obstruction: Obstruction, places: Array, torque: float
) -> list[_Run]:
    """The runs at all places, which advance together."""
    robot, curve, usual = contest.robot, contest.curve, contest.parameters
    dt = time_step(usual)
    acting = dataclasses.replace(usual, speed=usual.speed * obstruction.speed)
    if obstruction.torque:
        limit, at_limit = obstruction.torque * torque, obstruction.at_limit or usual.at_limit
        acting = dataclasses.replace(acting, torque_limit=limit, at_limit=at_limit)
    kernel = kernel_of(robot, kind_of(law, usual, curve))
    states = np.stack([_start(contest, kernel, obstruction, at) for at in places.tolist()])
    legs = (BEFORE, usual, False), (obstruction.seconds, acting, True), (AFTER, usual, False)
    tables, rows = [curve.table()] * len(places), list[Array]()
    for seconds, parameters, obstructed in legs:
        loop = _loop(robot, kind_of(law, parameters, curve))
        free = settings_vector(robot, kernel, parameters, curve, FREE)
        settings = [
            pushed(kernel, free, _push(contest, kernel, state, obstruction) if obstructed else FREE)
            for state in states
        ]
        states, log = loop.run_many(states, settings, tables, round(seconds / dt))
        rows.append(log)
    return [
        (kernel.log.unpack(whole), None if fault is None else fault[0])
        for whole in np.concatenate(rows, axis=1)
        for fault in [fault_in(robot, kernel.log, law, whole, usual)]
    ]


def _start(contest: Contest, kernel: Kernel, obstruction: Obstruction, place: float) -> Array:
    """The state at the start: on the path or beside it, with the path's velocity or at rest."""
    robot, curve = contest.robot, contest.curve
    first = curve.at(np.array(place), 1)
    outside = RIGHT_ANGLE @ first / np.linalg.norm(first)
    q = robot.rest(robot.frame.lift(curve.at(np.array(place)) + obstruction.off * outside))
    if obstruction.rests:
        return first_state(robot, kernel, curve, q)
    speed = speed_on(contest.parameters, curve)
    rate = robot.frame.lift(speed * first) - robot.frame.lift(np.zeros(2))
    v = driven_rates(robot, contest.parameters, q, rate)
    state = kernel.state.unpack(first_state(robot, kernel, curve, q, v))
    return kernel.state.pack({**state, "theta_rate": speed, "theta": place, "theta_ref": place})


def _push(contest: Contest, kernel: Kernel, state: Array, obstruction: Obstruction) -> Push:
    """The external action of the obstruction at the present end-point."""
    robot, curve = contest.robot, contest.curve
    fields = kernel.state.unpack(state)
    y, theta = robot.endpoint(fields["q"]), float(fields["theta"][0])
    anchor, tangent = brake_at(robot, curve, y, theta)
    first = curve.at(np.array(theta), 1)
    outside = robot.frame.lift(RIGHT_ANGLE @ first) - robot.frame.lift(np.zeros(2))
    outside = outside / np.linalg.norm(outside)
    hand = wall = None
    if obstruction.hand is not None:
        hand = y + obstruction.hand[0] * tangent + obstruction.hand[1] * outside
    if obstruction.wall is not None:
        wall = y + obstruction.wall * tangent, -tangent
    return Push(hand=hand, hold=(anchor, tangent) if obstruction.hold else None, wall=wall)


@lru_cache(maxsize=64)
def _loop(robot: Robot, kind: Kind) -> ManyLoop:
    from onpath.models.closed_loop.translated_loop import fastest_batch  # loads LLVM

    return fastest_batch(kernel_of(robot, kind))


def as_data(contest: Contest, results: Mapping[tuple[str, str], Sequence[Outcome]]) -> Any:
    """The content of `--json`; numbers have nine significant digits.

    `beyond_efforts` has what each law asks of the motors beyond the limits of the robot's file,
    `guesses` what that file leaves open.
    """
    beyond = {law: beyond_efforts(contest.robot, each) for law, each in by_law(results).items()}
    return {
        "robot": contest.entry.name,
        "parameters": values_of(contest.parameters),
        "guesses": told_guesses(contest.entry.guesses),
        "beyond_efforts": {law: str(found) for law, found in beyond.items() if found},
        "laws": {
            law: {
                name: [_rounded(row_of(o)) for o in outcomes]
                for (other, name), outcomes in results.items()
                if other == law
            }
            for law in dict.fromkeys(law for law, _ in results)
        },
    }


def _rounded(values: dict[str, Any]) -> dict[str, Any]:
    return {
        name: float(f"{value:.9g}") if isinstance(value, float) else value
        for name, value in values.items()
        if name not in ("law", "obstruction")
    }
