"""Robots that are pulled, braked and walled in at random, many at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.kernel import build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import ManyLoop
from onpath.models.closed_loop.obstacles import DIRECTIONS, Wall, brake_in
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    first_state,
    kind_of,
    pushed,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import fastest_batch
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import path_distance
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters, time_step
from onpath.models.systems.robots import Robot

STEP = 0.016  # [s] between the movements of a hand, about a frame of the display
BACK, WATCHED = 1.5, 2.2  # [s] after the release: from then on it must be back; until then we watch
FARTHEST = 0.2  # [m], of a hand from the middle of the path's plane

Actor = Callable[[float, Array, float], Push]
"""(time [s], end-point, θ of the closest point) -> what acts then."""


@dataclass(frozen=True)
class Trouble:
    """Something that acts on a robot from `begin` to `end`, [s]."""

    what: str
    begin: float
    end: float
    acts: Actor

    def judged(self, t: float) -> bool:
        """Whether the distance at a time counts: while it acts, and from `BACK` after it on."""
        return self.begin <= t < self.end or t >= self.end + BACK


@dataclass(frozen=True)
class Result:
    """What became of one robot.

    Attributes:
        fault: when it stopped [s] and why; None if it did not.
        off: largest distance while something acted, [m].
        late: largest distance from `BACK` after that, [m].
    """

    trouble: Trouble
    fault: tuple[float, str] | None
    off: float
    late: float


@lru_cache(maxsize=4)
def loop_of(robot: Robot, kind: Kind) -> ManyLoop:
    return fastest_batch(build_kernel(robot.system, robot.frame, kind, robot.substeps, robot.grip))


def parameters_of(name: str, **changes: float | str) -> Parameters:
    """A robot's parameters as the lab begins with them, but for some changes."""
    return replace(ROBOTS[name].parameters(), **changes)


def runs_untouched(
    name: str, parameters: Parameters, law: str, path: str = "circle", seconds: float = 10.0
) -> bool:
    """Whether a robot runs along its path without a fault if nobody touches it."""
    return untouched(name, parameters, law, presets()[path].curve, seconds) is not None


def untouched(
    name: str, parameters: Parameters, law: str, curve: Curve, seconds: float = 10.0
) -> float | None:
    """Largest distance of a robot that nobody touches, [m], from 1 s on; None if it stops."""
    robot = ROBOTS[name].make(parameters)
    loop, start = loop_of(robot, kind_of(law, parameters, curve)), begin_at(robot, curve, 0.0)
    layouts = loop.layouts
    settings = settings_vector(robot, layouts, parameters, curve, FREE)
    ticks = round(seconds / time_step(parameters))
    state = first_state(robot, layouts, curve, start)
    _, (rows,) = loop.run_many([state], [settings], [curve.table()], ticks)
    if fault_in(robot, layouts.log, law, rows, parameters) is not None:
        return None
    moved = layouts.log.unpack(rows)["y"][round(1 / time_step(parameters)) :]
    return float(path_distance(robot.frame, curve, moved).max())


def troubled(
    name: str, parameters: Parameters, law: str, seed: int, count: int, path: str | Curve = "circle"
) -> list[Result]:
    """Robots that begin at random places, each with a trouble of its own."""
    rng = np.random.default_rng(seed)
    robot = ROBOTS[name].make(parameters)
    curve = path if isinstance(path, Curve) else presets()[path].curve
    loop, dt = loop_of(robot, kind_of(law, parameters, curve)), time_step(parameters)
    layouts, table, ticks = loop.layouts, curve.table(), round(STEP / dt)
    troubles = [_trouble(rng, robot, curve) for _ in range(count)]
    begins = [begin_at(robot, curve, float(theta)) for theta in rng.uniform(-3, 3, count)]
    states = np.stack([first_state(robot, layouts, curve, begin) for begin in begins])
    settings = [settings_vector(robot, layouts, parameters, curve, FREE) for _ in troubles]
    for number, own in enumerate(settings):
        own[layouts.settings.slices["seed"]] = number
    faults: list[tuple[float, str] | None] = [None] * count
    off, late = np.zeros(count), np.zeros(count)
    for step in range(round((max(each.end for each in troubles) + WATCHED) / STEP)):
        t = step * STEP
        alive = [i for i in range(count) if faults[i] is None and t < troubles[i].end + WATCHED]
        if not alive:
            break
        inputs = [
            pushed(layouts, settings[i], _push(robot, loop, troubles[i], states[i], t))
            for i in alive
        ]
        states[alive], rows = loop.run_many(states[alive], inputs, [table] * len(alive), ticks)
        for i, own in zip(alive, rows, strict=True):
            fault = fault_in(robot, layouts.log, law, own, parameters)
            if fault is not None:
                faults[i] = t + fault[0] * dt, str(fault[1])
        well = [k for k, i in enumerate(alive) if faults[i] is None and troubles[i].judged(t)]
        if not well:
            continue
        y = rows[well][:, :, layouts.log.slices["y"]].reshape(-1, robot.system.p)
        distances = path_distance(robot.frame, curve, y).reshape(-1, ticks).max(axis=1)
        for k, distance in zip(well, distances.tolist(), strict=True):
            i = alive[k]
            if troubles[i].begin <= t < troubles[i].end:
                off[i] = max(off[i], distance)
            else:
                late[i] = max(late[i], distance)
    found = zip(troubles, faults, off.tolist(), late.tolist(), strict=True)
    return [Result(trouble, fault, far, after) for trouble, fault, far, after in found]


def begin_at(robot: Robot, curve: Curve, theta: float) -> Array:
    return robot.rest(robot.frame.lift(curve.at(np.array(theta))))


def _push(robot: Robot, loop: ManyLoop, trouble: Trouble, state: Array, t: float) -> Push:
    if not trouble.begin <= t < trouble.end:
        return FREE
    fields = loop.layouts.state.unpack(state)
    return trouble.acts(t, robot.endpoint(fields["q"]), float(fields["theta"][0]))


def _trouble(rng: np.random.Generator, robot: Robot, curve: Curve) -> Trouble:
    """A hand that stays, circles or jumps about; a brake; or a wall; for 0.3 to 5 s."""
    what = str(rng.choice(["stays", "circles", "jumps", "brake", "wall"]))
    begin = 1 + float(rng.uniform(0, 1.2))
    end = begin + float(rng.uniform(0.3, 5))
    makers = {"brake": _brake, "wall": _wall}
    return Trouble(what, begin, end, makers.get(what, _hand)(rng, robot, curve, what, begin))


def _hand(rng: np.random.Generator, robot: Robot, _: Curve, what: str, begin: float) -> Actor:
    middle, reach = robot.frame.lift(np.zeros(2)), robot.reach
    angle, radius = rng.uniform(0, 2 * np.pi), rng.uniform(0.03, FARTHEST)
    turn = rng.uniform(-15, 15) if what == "circles" else 0.0
    times = begin + np.cumsum(rng.uniform(0.05, 0.5, 60))
    places = rng.uniform(-FARTHEST, FARTHEST, (60, 2))

    def acts(t: float, _y: Array, _theta: float) -> Push:
        a = angle + turn * t
        z = radius * np.array([np.cos(a), np.sin(a)])
        if what == "jumps":
            z = np.array([np.interp(t, times, own) for own in places.T])
        return Push(np.clip(robot.frame.lift(z), middle - reach, middle + reach))

    return acts


def _brake(rng: np.random.Generator, robot: Robot, curve: Curve, *_: object) -> Actor:
    direction, brakes = str(rng.choice(DIRECTIONS)), list[Push]()

    def acts(_t: float, y: Array, theta: float) -> Push:
        if not brakes:  # it holds where it closes
            brakes.append(Push(None, *brake_in(robot, curve, y, theta, direction)))
        return brakes[0]

    return acts


def _wall(rng: np.random.Generator, robot: Robot, curve: Curve, *_: object) -> Actor:
    z = curve.at(np.array(rng.uniform(-np.pi, np.pi))) * rng.uniform(0.2, 1.1)
    wall = Wall(float(z[0]), float(z[1]), float(rng.uniform(0, 2 * np.pi)))
    push = Push(wall=wall.lifted(robot.frame))
    return lambda _t, _y, _theta: push
