"""The exercises with pencil and paper, and in Python, come out as the lessons tell."""

from __future__ import annotations

import re
from contextlib import redirect_stdout
from io import StringIO

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.systems.five_bar import five_bar, load_links
from tests.support.stated_numbers import assert_stated, said, text, value

SYSTEM, LUMPED = five_bar(), load_links().lumped()
PLANT = np.array([LUMPED[name] for name in SYSTEM.parameter_names])
RADIUS, DIAGONALS = 0.05, (("M11", "M22"), ("b1", "b2"))
PYTHON = re.compile(r"^~~~python\n(.*?)^~~~$", re.DOTALL | re.MULTILINE)


def decoupling_matrix(outputs: ca.SX, q: Array, v: Array, u: Array) -> tuple[Array, Array]:
    """What multiplies u in the second derivatives of two functions of the state, and those."""
    rate = ca.jtimes(outputs, SYSTEM.q, SYSTEM.v)
    second = ca.jtimes(rate, SYSTEM.q, SYSTEM.v) + ca.jtimes(rate, SYSTEM.v, SYSTEM.acceleration)
    taken = [SYSTEM.q, SYSTEM.v, SYSTEM.tau, SYSTEM.parameters]
    function = ca.Function("D", taken, [ca.jacobian(second, SYSTEM.tau), second])
    matrix, at = function(q, v, u, PLANT)
    return np.array(matrix), np.array(at).ravel()


@pytest.mark.parametrize("seed", range(4))
def test_the_solution_of_the_derivation_in_lesson_4(seed: int) -> None:
    rng = np.random.default_rng(seed)
    q, v, u = np.array([np.pi / 2, np.pi]) + 0.3 * rng.normal(size=2), *rng.normal(size=(2, 2))
    (s1, s2), (c1, c2), length = np.sin(q), np.cos(q), LUMPED["l1"]
    jacobian = length * np.array([[-s1, s2], [c1, -c2]])
    turning = length * np.array([[-c1 * v[0], c2 * v[1]], [-s1 * v[0], s2 * v[1]]])
    mass, friction = (np.diag([LUMPED[name] for name in pair]) for pair in DIAGONALS)
    y = length * np.array([c1 - c2 - 1, s1 - s2 - 1])
    away = float(np.linalg.norm(y))
    tangent, normal = np.array([-y[1], y[0]]) / away, -y / away
    moved = jacobian @ np.linalg.inv(mass)
    acceleration, rate = moved @ (u - friction @ v) + turning @ v, jacobian @ v
    theta_rate, across_rate = tangent @ rate / away, normal @ rate

    place = ca.atan2(SYSTEM.output[1], SYSTEM.output[0])
    across = RADIUS - ca.sqrt(ca.dot(SYSTEM.output, SYSTEM.output))
    matrix, second = decoupling_matrix(ca.vertcat(place, across), q, v, u)
    assert second == pytest.approx(
        [
            (tangent @ acceleration + 2 * across_rate * theta_rate) / away,
            normal @ acceleration - away * theta_rate**2,
        ]
    )
    assert matrix == pytest.approx(np.vstack([tangent @ moved / away, normal @ moved]))
    masses = LUMPED["M11"] * LUMPED["M22"]
    determinant = length**2 * np.sin(q[0] - q[1]) / (away * masses)
    assert np.linalg.det(matrix) == pytest.approx(determinant)

    level = ca.dot(SYSTEM.output, SYSTEM.output) - RADIUS**2
    other, _ = decoupling_matrix(ca.vertcat(place, level), q, v, u)
    assert np.linalg.det(other) == pytest.approx(-2 * away * determinant)


@pytest.mark.thorough  # it takes 10 s
def test_the_capstone_of_lesson_8_prints_what_its_solution_tells() -> None:
    (begun, solved), other = (PYTHON.findall(text("08", language)) for language in ("en", "de"))
    assert other == [begun, solved]
    assert len(printed(begun)) == 1
    *places, softest, soft, stiff = printed(solved)
    held = {round(degrees): (rest, computed) for degrees, rest, computed in places}
    (apart,) = said("08", "values differ by less than # %, since")
    assert all(100 * abs(a - b) < value(apart) * abs(a) for a, b in held.values())
    most, *where = said("08", "furthest off, by # mm, when held at #° or #°.")
    assert_stated([most] * 2, [abs(held[round(value(degrees))][0]) for degrees in where])
    assert value(most) + 0.05 > max(abs(rest) for rest, _ in held.values())
    between = said("08", "Between #° and #°, #° and #°, #° and #°, #° and #° ξ₁ changes sign")
    ends = [round(value(degrees)) % 360 for degrees in between]
    told = set(map(frozenset, zip(ends[::2], ends[1::2], strict=True)))
    signs = [(degrees, np.sign(rest)) for degrees, (rest, _) in sorted(held.items())]
    turns = zip(signs, [*signs[1:], signs[0]], strict=True)
    assert told == {frozenset((a % 360, b % 360)) for (a, x), (b, y) in turns if x != y}
    texts = said(
        "08", "With K1 = # the largest distance is # mm, with # it is # mm, with # it is #"
    )
    assert_stated(texts, [*softest, *soft, *stiff])


def printed(program: str) -> list[list[float]]:
    """The numbers in each line that a program prints."""
    with redirect_stdout(StringIO()) as out:
        exec(program, {"__name__": "__main__"})
    return [
        [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", line)]
        for line in out.getvalue().splitlines()
    ]
