"""The wall, the brakes and the start of a lab, as its scene draws them and its page shows them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from onpath.app.lab.segments import Segment
from onpath.app.lab.simulation import Simulation
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import settings_layout
from onpath.models.closed_loop.obstacles import Wall, wall_force
from onpath.models.closed_loop.start import Start, left_of
from onpath.models.control.sides import LEFT, SIDES
from onpath.models.paths.curves import Curve
from onpath.models.systems.robots import Robot

NOWHERE = np.zeros((0, 3))


def drawn_wall(simulation: Simulation) -> Array:
    """`Motion.wall`, at the instant that is shown."""
    lifted = _lifted(simulation)
    if lifted is None:
        return NOWHERE
    if simulation.viewing is None and simulation.wall is not None:
        return _placed(simulation.robot, simulation.wall)
    return _wall_rows(simulation.robot, lifted)


def drawn_brakes(simulation: Simulation) -> dict[str, Array]:
    """`Snapshot.brakes`."""
    if simulation.viewing is not None:
        return {}
    pushes, rows = simulation.forces.pushes, dict[str, Array]()
    for side in SIDES:
        if side in simulation.forces.held and (hold := pushes[side].hold) is not None:
            anchor, blocked = hold
            slides = pushes[side].hold_normal is None
            rows[side] = _brake_rows(simulation.robot, anchor.tobytes(), blocked.tobytes(), slides)
    return rows


@lru_cache(maxsize=256)
def _brake_rows(robot: Robot, anchor: bytes, blocked: bytes, slides: bool) -> Array:
    """One of `Snapshot.brakes`; the same array for the same arguments."""
    point, direction = np.frombuffer(anchor), np.frombuffer(blocked)
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    origin, right, up = robot.position(robot.frame.lift(corners))
    at, ahead = robot.position(np.stack([point, point + direction]))
    free = np.cross(np.cross(right - origin, up - origin), ahead - at)
    return np.stack([at, ahead - at, slides * free / np.linalg.norm(free)])


def wall_then(robot: Robot, past: Segment) -> Array:
    """`Motion.wall` during a segment of a history."""
    lifted = _lifted_then(robot, past)
    return NOWHERE if lifted is None else _wall_rows(robot, lifted)


def wall_forces(simulation: Simulation) -> dict[str, float]:
    """Forces between each end-point and the wall that is shown, by side, [N]; empty without one."""
    lifted = _lifted(simulation)
    if simulation.wall is None:
        return {}
    forces: dict[str, float] = {side: 0.0 for side in SIDES}
    if lifted is not None:
        robot, n = simulation.robot, simulation.robot.system.n
        past = None if simulation.viewing is None else simulation.history.at(simulation.viewing)
        instant = past.instant() if past else simulation.instant()
        plant = robot.plant(simulation.parameters)
        for side, state in zip(SIDES, instant.states, strict=True):
            forces[side] = wall_force(robot, plant, state[:n], state[n : 2 * n], lifted)
    return forces


@lru_cache(maxsize=256)
def drawn_start(robot: Robot, curve: Curve, start: Start) -> Array:
    """`Motion.start`; the same array for the same arguments."""
    z, first = start.place(curve), curve.at(np.array(start.theta), 1)
    rate = start.along * first / np.linalg.norm(first) + start.across * left_of(curve, start.theta)
    return robot.position(robot.frame.lift(np.stack([z, z + rate])))


def _lifted(simulation: Simulation) -> tuple[Array, Array] | None:
    """Point and normal of the wall at the instant that is shown; None if there is none."""
    past = None if simulation.viewing is None else simulation.history.at(simulation.viewing)
    if past is None:
        return None if simulation.wall is None else simulation.wall.lifted(simulation.robot.frame)
    return _lifted_then(simulation.robot, past)


def _lifted_then(robot: Robot, past: Segment) -> tuple[Array, Array] | None:
    """Point and normal of the wall during a segment; None if there was none."""
    drive = past.drives[LEFT]
    settings = settings_layout(robot.system, drive.kind).unpack(drive.settings)
    if not settings["wall_active"][0]:
        return None
    return settings["wall_place"], settings["wall_normal"]


@lru_cache(maxsize=256)
def _placed(robot: Robot, wall: Wall) -> Array:
    return _wall_rows(robot, wall.lifted(robot.frame))


def _wall_rows(robot: Robot, lifted: tuple[Array, Array]) -> Array:
    """`Motion.wall` from a point and the normal of the wall."""
    place, normal = lifted
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    origin, right, up = robot.position(robot.frame.lift(corners))
    middle, ahead = robot.position(np.stack([place, place + normal]))
    outward = ahead - middle
    along = np.cross(np.cross(right - origin, up - origin), outward)
    return np.stack([middle, along / np.linalg.norm(along), outward / np.linalg.norm(outward)])
