"""What right answers of the concept test claim of ships, cranes and hovercraft, in small models.

Each test has the title of its question.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from onpath.models.arrays import Array

RADIUS, SPEED = 50.0, 5.0
"""[m] and [m/s], of circles on water."""
K1, K2 = 0.04, 0.4
"""Spring and brake per mass, [1/s²] and [1/s]."""
Point = Array
Push = Callable[[float, Point, Point], Point]


def moved(push: Push, place: Point, velocity: Point, seconds: float) -> tuple[Array, Array]:
    """Places and velocities of a mass of 1 under a push, every hundredth of a second."""
    dt, places, velocities = 0.01, [place], [velocity]
    for n in range(round(seconds / dt)):
        velocity = velocity + dt * push(n * dt, place, velocity)
        place = place + dt * velocity
        places.append(place)
        velocities.append(velocity)
    return np.array(places), np.array(velocities)


def on_circle(angle: float) -> tuple[Point, Point]:
    """A place on the circle, and the direction along it."""
    return RADIUS * np.array([np.cos(angle), np.sin(angle)]), np.array(
        [-np.sin(angle), np.cos(angle)]
    )


def off_circle(places: Array) -> Array:
    """How far outside the circle, [m]."""
    return np.linalg.norm(places, axis=1) - RADIUS


def kept(speed: Callable[[float], float], believed: float = 1.0, spring: float = K1) -> Push:
    """Keeps a mass of 1 on the circle, and its speed along it at a wanted one."""

    def push(t: float, place: Point, velocity: Point) -> Point:
        out = place / np.linalg.norm(place)
        along = np.array([-out[1], out[0]])
        rate, across = velocity @ along, velocity @ out
        off = np.linalg.norm(place) - RADIUS
        inwards = believed * rate**2 / np.linalg.norm(place) + spring * off + K2 * across
        return -inwards * out + (speed(t) - rate) * along

    return push


def drawn(angle: Callable[[float], float], rate: Callable[[float], float]) -> Push:
    """Draws a mass of 1 to a point on the circle, given by its angle and the rate of it."""

    def push(t: float, place: Point, velocity: Point) -> Point:
        point, along = on_circle(angle(t))
        needed = -(rate(t) ** 2) * point
        return needed - K1 * (place - point) - K2 * (velocity - RADIUS * rate(t) * along)

    return push


def test_of_the_spot() -> None:
    """A light that waits"""
    spot, seen = {"angle": 0.0}, list[float]()

    def push(t: float, place: Point, velocity: Point) -> Point:
        wanted = SPEED / RADIUS * (1 if t < 5 else -1)
        point, along = on_circle(spot["angle"])
        rate = wanted + 0.004 * float((place - point) @ along)  # slower if the craft is behind
        force = drawn(lambda _: spot["angle"], lambda _: rate)(t, place, velocity)
        spot["angle"] += 0.01 * rate
        seen.append(rate)
        return force

    places, _ = moved(push, on_circle(0)[0], SPEED * on_circle(0)[1], 60)
    off = np.abs(off_circle(places))
    assert off[:500].max() < 0.05 < 0.3 < off[500:].max() and off[-1] < 0.05
    assert abs(seen[500]) < SPEED / RADIUS and seen[-1] == pytest.approx(-SPEED / RADIUS, rel=0.1)


def test_of_the_boats() -> None:
    """Two boats on a lake"""
    rate = SPEED / RADIUS
    chased = drawn(lambda t: rate * t, lambda _: rate)
    for start in (np.array([0.0, 0.0]), np.array([90.0, 20.0]), np.array([-30.0, -60.0])):
        places, _ = moved(chased, start, np.zeros(2), 120)
        assert np.linalg.norm(places[-1] - on_circle(rate * 120)[0]) < 0.1  # drawn in
    behind, along = on_circle(-np.pi / 2)
    places, _ = moved(chased, behind, SPEED * along, 120)
    off = np.abs(off_circle(places))
    assert off[0] < 1e-9 and off.max() > 5 and off[-1] < 0.1


def test_of_the_fans() -> None:
    """Two fans at the stern"""
    at_stern = np.array([[-1.0, 0.5, 0.0], [-1.0, -0.5, 0.0]])
    forces = np.array([[1.0, 0.0], [1.0, 0.0]])  # of a unit of thrust, in the craft's axes
    assert np.linalg.matrix_rank(forces) == 1 and np.all(forces[:, 1] == 0)
    turns = [x * f[1] - y * f[0] for (x, y, _), f in zip(at_stern, forces, strict=True)]
    assert turns[0] * turns[1] < 0  # unequal pushes turn it


def test_of_the_cargo() -> None:
    """With cargo"""
    runs = [
        moved(kept(lambda _: SPEED, 1 / 1.1, spring), *_begun(), 120)[0] for spring in (K1, 2 * K1)
    ]
    soft, stiff = (off_circle(places) for places in runs)
    for off in (soft, stiff):
        assert np.ptp(off[-6300:]) < 0.01  # the same all the way round
    assert 0.1 < stiff[-1] < soft[-1] < 5
    right, _ = moved(kept(lambda _: SPEED), *_begun(), 63)
    assert np.abs(off_circle(right)).max() < 0.05


def _begun() -> tuple[Point, Point]:
    place, along = on_circle(0)
    return place, SPEED * along


def test_of_the_wind() -> None:
    """Wind from the side"""
    wind = 0.1

    def push(t: float, place: Point, velocity: Point) -> Point:
        return np.array([0.0, wind - K1 * place[1] - K2 * velocity[1]])

    places, _ = moved(push, np.zeros(2), np.array([SPEED, 0.0]), 120)
    assert places[-1, 1] == pytest.approx(wind / K1, rel=1e-3) and wind / K1 > 1


def test_of_the_glide() -> None:
    """Gliding sideways"""
    for stiff in (1, 10, 30):

        def push(t: float, place: Point, velocity: Point, stiff: float = stiff) -> Point:
            return np.array([0.0, -(stiff**2) * K1 * place[1] - stiff * K2 * velocity[1]])

        places, _ = moved(push, np.zeros(2), np.array([SPEED, 1.0]), 60)
        assert places[50, 1] > 0.001 and abs(places[-1, 1]) < 1e-3


def test_of_the_trolley() -> None:
    """Half the speed"""
    places, velocities = moved(kept(lambda t: SPEED if t < 10 else SPEED / 2), *_begun(), 40)
    assert np.abs(off_circle(places)).max() < 0.05
    assert np.linalg.norm(velocities[-1]) == pytest.approx(SPEED / 2, rel=1e-3)


def test_of_the_lights() -> None:
    """Two lights"""
    near, far = 200.0, 400.0  # the lights, on the x axis

    def angle(place: Point) -> float:
        return float(np.arctan2(place[1], near - place[0]) - np.arctan2(place[1], far - place[0]))

    def by(measured: Callable[[Point], float]) -> Array:
        def push(t: float, place: Point, velocity: Point) -> Point:
            return np.array([0.0, -K1 * measured(place) - K2 * velocity[1]])

        return moved(push, np.array([-300.0, 40.0]), np.array([1.0, 0.0]), 400)[0][:, 1]

    slope = 1 / near - 1 / far
    by_angle, by_distance = by(lambda place: angle(place) / slope), by(lambda place: place[1])
    assert np.abs(by_angle - by_distance).max() > 5  # another way
    assert abs(by_angle[-1]) < 0.2 and abs(by_distance[-1]) < 0.2  # to the same line
    assert all(angle(np.array([x, 0.0])) == 0 for x in (-300.0, 0.0, 100.0))


def test_of_the_trailer() -> None:
    """Backwards with a trailer"""
    length, speed, dt = 3.0, -1.0, 0.01
    bend = 0.01  # between trailer and line; the tractor's axle, with the hitch, is kept on it
    for _ in range(2000):
        bend -= dt * speed / length * np.sin(bend)
    assert abs(bend) > 1
    # If the trailer's axle keeps to the line, the trailer lies along it, the hitch moves along it,
    # and the tractor, whose axle has the hitch, lies along it as well: nothing is left free.
