"""The course's derivations: each line is what CasADi finds, and none can be read off its page."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import product
from math import sqrt

import casadi as ca
import numpy as np
import pytest

from onpath.lessons.derivation.judged import MOST_LINES, judged, points_of, value_of
from onpath.lessons.derivation.typed import LONGEST
from onpath.lessons.given import MOST_TEXT
from onpath.lessons.schema import Derivation, Lesson, Text
from onpath.models.arrays import Array
from tests.support.built_in import built_in_course
from tests.support.pupil import expanded

COURSE, _ = built_in_course()
NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
READS = 0.1  # most lines that somebody may pass who only computes with the page's numbers


def asked(language: str) -> Iterator[tuple[Lesson, int, int, Derivation]]:
    """All derivations of the course: lesson, step, block and derivation."""
    for name in COURSE.lessons:
        lesson = COURSE.lesson(name, language)
        for index, step in enumerate(lesson.steps):
            for place, block in enumerate(step.blocks):
                if isinstance(block, Derivation):
                    yield lesson, index, place, block


@pytest.mark.parametrize("language", ["en", "de"])
def test_whoever_types_what_is_right_is_right(language: str) -> None:
    found = list(asked(language))
    assert len(found) >= 9
    for _, _, _, block in found:
        typed = [expanded(block, i) for i in range(len(block.line))]
        assert all(len(row) <= LONGEST for row in typed)
        states = judged(block, "\n".join(typed))
        assert all(state.good and state.closed for state in states)
    assert 2 * MOST_LINES * (LONGEST + 1) <= MOST_TEXT


@pytest.mark.parametrize("language", ["en", "de"])
def test_each_known_mistake_is_answered_by_its_name(language: str) -> None:
    """Also after a first line that is right; no mistake is taken for another one, or for right."""
    for lesson, _, _, block in asked(language):
        typed = [expanded(block, i) for i in range(len(block.line))]
        for i, line in enumerate(block.line):
            for number, wrong in enumerate(line.wrong):
                row = expanded(block, i, wrong.formula)
                state = judged(block, "\n".join([*typed[:i], row]))[i]
                assert [each.known for each in state.tries] == [number], (lesson.name, row)


def test_hardly_a_line_can_be_read_off_its_page() -> None:
    """By the numbers on the page, their sums, products, quotients and roots."""
    numbers = passed = 0
    for language in ("en", "de"):
        for lesson, index, _, block in asked(language):
            seen = numbers_on(lesson, index)
            guesses = {*seen, *map(sqrt, seen)} | {
                value
                for a, b in product(seen, repeat=2)
                for value in (a + b, a - b, a * b, a / b if b else 0.0)
            }
            values = points_of(block)
            for line in block.line:
                right = value_of(line.formula, values)
                values |= {line.name: right} if line.name else {}
                numbers += 1
                passed += line.tolerance > 0 and any(
                    abs(guess - right[0]) <= line.tolerance for guess in guesses
                )
    assert passed <= READS * numbers, (passed, numbers)


def numbers_on(lesson: Lesson, index: int) -> set[float]:
    """The numbers in a step's texts, folds included, and in what its derivations ask."""
    texts = [lesson.steps[index].title]
    for block in lesson.steps[index].blocks:
        if isinstance(block, Text):
            texts.append(block.html.striptags())
        elif isinstance(block, Derivation):
            texts += [block.question, *(line.question for line in block.line)]
    found = NUMBER.findall(" ".join(re.sub(r"<[^>]*>", " ", text) for text in texts))
    return {float(each.replace(",", ".")) for each in found}


Symbols = dict[str, ca.SX]


def turned(angle: ca.SX) -> ca.SX:
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def chord(of: Symbols) -> list[ca.SX]:
    apart = of["r"] * (turned(of["phi"]) - ca.DM([1, 0]))
    return [ca.norm_2(apart)]


def tip(of: Symbols) -> list[ca.SX]:
    """The derivatives of half the squared distance, for the tip and for the flat side."""
    a, b, depth, theta = of["a"], of["b"], of["lambda"], ca.SX.sym("theta")
    curve = ca.vertcat(a * ca.cos(theta), b * ca.sin(theta))
    first, second = ca.jacobian(curve, theta), ca.jacobian(ca.jacobian(curve, theta), theta)

    def bend(place: ca.SX, at: float) -> ca.SX:
        half = ca.sumsqr(place - curve) / 2
        return ca.substitute(ca.jacobian(ca.jacobian(half, theta), theta), theta, at)

    def border(place: ca.SX, at: float) -> ca.SX:
        found = bend(place, at)  # is linear in the depth
        slope = ca.jacobian(found, depth)
        return depth - found / slope

    place, side = ca.vertcat(a - depth, 0), ca.vertcat(0, b - depth)
    squares = ca.sumsqr(first), ca.dot(place - curve, second)
    at_tip = [ca.substitute(each, theta, 0) for each in squares]
    return [*at_tip, bend(place, 0), border(place, 0), ca.SX(45**2 / 60), border(side, np.pi / 2)]


def edge(of: Symbols) -> list[ca.SX]:
    return [ca.cos(ca.asin(of["rho"] / (2 * of["l"])))]


def mixed(of: Symbols) -> list[ca.SX]:
    """The mixed derivative of the kinetic energy."""
    rates, q = ca.SX.sym("rates", 2), ca.vertcat(0.3, 0.3 + of["delta"])
    angles = ca.SX.sym("q", 2)
    one, two = turned(angles[0]), turned(angles[1])

    def term(mass: ca.SX, place: ca.SX) -> ca.SX:
        energy = mass / 2 * ca.sumsqr(ca.jacobian(place, angles) @ rates)
        return ca.substitute(ca.jacobian(ca.jacobian(energy, rates).T, rates)[0, 1], angles, q)

    third = term(of["m3"], of["l2"] * two + of["c3"] * one)
    fourth = term(of["m4"], of["l1"] * one - of["c4"] * two)
    return [third, fourth, ca.SX(np.pi / 2), of["c4"] * third / -fourth]


def sixteen(of: Symbols) -> list[ca.SX]:
    """The derivatives of the end-point by the chain rule."""
    theta, x, rates, second = (
        ca.SX.sym("theta"),
        ca.SX.sym("x"),
        ca.SX.sym("rates", 2),
        ca.SX.sym("second", 2),
    )
    place = (of["r"] - x) * turned(theta)
    state = ca.vertcat(theta, x)
    velocity = ca.jacobian(place, state) @ rates
    acceleration = ca.jacobian(velocity, state) @ rates + ca.jacobian(velocity, rates) @ second
    along = ca.vertcat(-ca.sin(theta), ca.cos(theta))
    across = -turned(theta)
    here = ca.vertcat(theta, x, rates, second)
    wanted = ca.vertcat(ca.dot(along, acceleration), ca.dot(across, acceleration))

    def at(value: ca.SX, angle: ca.SX, inwards: ca.SX) -> ca.SX:
        now = ca.vertcat(0.7, of["x"], of["w"], of["s"], angle, inwards)
        return ca.substitute(value, here, now)

    slope, rest = ca.jacobian(wanted, second), at(wanted, ca.SX(0), ca.SX(0))
    given = ca.vertcat(of["A"], of["B"])
    solved = ca.solve(at(slope, ca.SX(0), ca.SX(0)), given - rest)
    return [at(ca.dot(along, velocity), ca.SX(0), ca.SX(0)), rest[0], rest[1], solved[0], solved[1]]


def rank(of: Symbols) -> list[ca.SX]:
    """The determinants of the path's and the arm's factor, and of D with both functions."""
    y, q = ca.SX.sym("y", 2), ca.SX.sym("q", 2)
    outputs = ca.vertcat(ca.atan2(y[1], y[0]), -ca.norm_2(y))
    squared = ca.vertcat(ca.atan2(y[1], y[0]), ca.sumsqr(y))
    here = of["R"] * ca.DM([0.6, 0.8])
    path = ca.substitute(ca.det(ca.jacobian(outputs, y)), y, here)
    other = ca.substitute(ca.det(ca.jacobian(squared, y)), y, here)
    place = of["l"] * (turned(q[0]) - turned(q[1]))
    mass = ca.diag(ca.vertcat(of["M11"], of["M22"]))
    arm = ca.det(ca.jacobian(place, q) @ ca.inv(mass))
    arm = ca.substitute(arm, q, ca.vertcat(of["q1"], of["q2"]))
    return [path, arm, path * arm, ca.SX(np.pi), other / path]


def peak(of: Symbols) -> list[ca.SX]:
    """The zero of the rate, which is the exponential times something linear in time."""
    time, root = ca.SX.sym("t"), ca.sqrt(of["K1"])
    way = of["v0"] * time * ca.exp(-root * time)
    straight = ca.jacobian(way, time) * ca.exp(root * time)
    slope = ca.substitute(ca.jacobian(straight, time), time, 0)
    furthest = -ca.substitute(straight, time, 0) / slope
    return [furthest, ca.substitute(way, time, furthest)]


def offset(of: Symbols) -> list[ca.SX]:
    """The balance is linear in the offset."""
    delta, needed = ca.SX.sym("delta"), of["omega"] ** 2
    need = (of["r"] + delta) * needed
    left = need - (1 + of["epsilon"]) * (need + of["K1"] * delta)
    return [-ca.substitute(left, delta, 0) / ca.jacobian(left, delta)]


def inside(of: Symbols) -> list[ca.SX]:
    """The demand is linear in the mark's acceleration."""
    mark = ca.SX.sym("a")
    bending = -of["c"] * mark - of["omega"] ** 2 * of["w"]
    left = mark + of["alpha"] * bending
    found = -ca.substitute(left, mark, 0) / ca.jacobian(left, mark)
    return [found, -ca.substitute(bending, mark, found) / of["w"]]


def pendulum(of: Symbols) -> list[ca.SX]:
    """The heading's acceleration is linear in that of the pen; the swing by its derivative."""
    faster, heading = ca.SX.sym("faster"), ca.SX.sym("phi")
    pen = of["d"] * faster - of["a"] * ca.sin(of["psi"] - heading)
    found = -ca.substitute(pen, faster, 0) / ca.jacobian(pen, faster)
    stiffness = ca.substitute(-ca.jacobian(found, heading), heading, of["psi"])
    centre = ca.substitute(ca.substitute(stiffness, of["a"], 0.2), of["d"], 0.06)
    return [ca.substitute(found, heading, of["phi"]), ca.sqrt(centre)]


def drag(of: Symbols) -> list[ca.SX]:
    """Velocity and acceleration of a point on a circle, and what of them is along n."""
    time, place = ca.SX.sym("t"), ca.SX.sym("k")
    rate, heading = of["Omega"], of["Omega"] * time + np.pi / 2 + of["beta"]
    pen = of["R"] * turned(rate * time)
    moved = ca.jacobian(pen, time)
    pull = ca.jacobian(moved, time) + place * moved
    left = ca.substitute(ca.dot(pull, turned(heading + np.pi / 2)), time, 0.3)
    ahead = ca.substitute(left, of["beta"], 0) - place * of["d"] * rate
    still = -ca.substitute(ahead, place, 0) / ca.jacobian(ahead, place)
    return [ca.substitute(left, place, of["k"]), still]


def one_joint(of: Symbols) -> list[ca.SX]:
    """The state form of a joint: its equation of motion is linear in the torque."""
    torque = ca.SX.sym("u")
    faster = (torque - of["b"] * of["v"] - of["G"] * ca.cos(of["q"])) / of["M"]
    return [of["v"], ca.substitute(faster, torque, 0), ca.jacobian(faster, torque)]


def along_motions(of: Symbols) -> list[ca.SX]:
    """Derivatives of the output along the motion without torque, and along the torque."""
    state = ca.vertcat(of["q"], of["v"])
    free = ca.vertcat(of["v"], -of["b"] * of["v"] / of["M"])
    once = ca.jtimes(of["l"] * ca.cos(of["q"]), state, free)
    return [once, ca.jtimes(once, state, free), ca.jacobian(once, of["v"]) / of["M"]]


def mirrored(of: Symbols) -> list[ca.SX]:
    """The pose with the elbow on the other side."""
    first, second = of["q2"] - np.pi, of["q1"] + np.pi
    elbow = ca.substitute(second - first, of["q2"], of["q1"] + of["delta"])
    return [of["l"] * ca.cos(first), -of["l"] * ca.cos(second), elbow]


def theorem(of: Symbols) -> list[ca.SX]:
    """The matrix of (11) for the five-bar."""
    q = ca.vertcat(of["q1"], of["q2"])
    end = of["l"] * ca.vertcat(ca.cos(q[0]) - ca.cos(q[1]), ca.sin(q[0]) - ca.sin(q[1]))
    matrix = ca.jacobian(end, q) @ ca.diag(1 / ca.vertcat(of["M11"], of["M22"]))
    return [matrix[0, 0], matrix[0, 1], ca.det(matrix)]


def bent_tip(of: Symbols) -> list[ca.SX]:
    """How a point between mark and tip answers the torque."""
    torque, bent = ca.SX.sym("u"), ca.SX.sym("w")
    mark = of["k"] * torque
    bending = -of["c"] * mark - of["omega"] ** 2 * bent
    return [ca.jacobian(mark + of["alpha"] * bending, torque)]


def bent_beam(of: Symbols) -> list[ca.SX]:
    """The last two rows of (20) and (21): two equations, linear in the accelerations and u."""
    torque, faster = ca.SX.sym("u"), ca.SX.sym("faster", 2)
    coupling = of["rho"] * of["psi"]
    waist = of["J"] * faster[0] + coupling * faster[1] - torque
    shape = faster[1] + coupling * faster[0] + of["omega"] / of["rho"]
    rows = ca.vertcat(waist, shape)
    found = ca.solve(ca.jacobian(rows, faster), -ca.substitute(rows, faster, ca.SX.zeros(2)))
    inertia = 1 / ca.jacobian(found[0], torque)
    bending = -ca.substitute(shape, faster, ca.vertcat(of["a"], 0))
    pull = ca.substitute(found[0], torque, 0) * inertia
    push = ca.jacobian(found[1], torque) * inertia / of["M"]
    return [bending, inertia, pull, push]


def bent_side(of: Symbols) -> list[ca.SX]:
    """How (22) answers the column of motor 3 at rest, and the radius at which it does not."""
    turn, shape, waist = ca.SX.sym("q3"), ca.SX.sym("f"), 1 / of["M"]
    side = of["R"] * ca.sin(turn) + of["phi"] * shape * ca.cos(turn)
    joints = ca.vertcat(turn, shape)
    slopes = ca.substitute(ca.jacobian(side, joints), joints, ca.SX.zeros(2))
    answer = slopes @ ca.vertcat(waist, -of["rho"] * of["psi"] * waist)
    slope = ca.jacobian(answer, of["R"])  # it is linear in the radius
    return [answer, of["R"] - answer / slope]


def left_over(of: Symbols) -> list[ca.SX]:
    """Twice the coordinates; less the relative degrees of three outputs."""
    state = 2 * (of["m"] + 3)
    return [state, state - 3 * 2]


def turn(_of: Symbols) -> list[ca.SX]:
    """Where the rate is zero, by Newton's method, and what has passed until then, by Simpson's."""

    def rate(time: float) -> float:
        return -2 + 4 * np.exp(-5 * time)

    zero = 0.1
    for _ in range(20):
        zero += rate(zero) / (20 * np.exp(-5 * zero))
    way = zero / 6 * (rate(0) + 4 * rate(zero / 2) + rate(zero))
    return [ca.SX(zero), ca.SX(way), ca.SX(50 * way)]


ORACLES: list[tuple[str, int, Callable[[Symbols], list[ca.SX]]]] = [
    ("02-what-is-the-error", 0, chord),
    ("02-what-is-the-error", 1, tip),
    ("03-the-five-bar", 0, edge),
    ("03-the-five-bar", 1, mixed),
    ("04-across-and-along", 0, sixteen),
    ("04-across-and-along", 1, rank),
    ("05-invariance", 0, peak),
    ("06-exact-cancellation", 0, offset),
    ("07-flexible-link", 0, inside),
    ("07b-where-the-theorem-decides", 0, pendulum),
    ("07b-where-the-theorem-decides", 1, drag),
    ("09-read-the-paper", 0, one_joint),
    ("09-read-the-paper", 1, along_motions),
    ("09-read-the-paper", 2, mirrored),
    ("09b-the-theorem-and-section-iii", 0, theorem),
    ("09b-the-theorem-and-section-iii", 1, bent_tip),
    ("09c-sections-iv-and-v", 0, bent_beam),
    ("09c-sections-iv-and-v", 1, bent_side),
    ("09c-sections-iv-and-v", 2, left_over),
    ("09c-sections-iv-and-v", 3, turn),
]


@pytest.mark.parametrize(("name", "number", "oracle"), ORACLES)
def test_casadi_finds_the_same(
    name: str, number: int, oracle: Callable[[Symbols], list[ca.SX]]
) -> None:
    blocks = [block for lesson, _, _, block in asked("en") if lesson.name == name]
    block = blocks[number]
    symbols = {each: ca.SX.sym(each) for each in block.names}
    function = ca.Function("oracle", list(symbols.values()), oracle(symbols))
    values = points_of(block)
    found = function.call([ca.DM(each).T for each in values.values()])
    known: dict[str, Array] = dict(values)
    for line, wanted in zip(block.line, found, strict=False):
        right = value_of(line.formula, known)
        known |= {line.name: right} if line.name else {}
        tolerance = line.tolerance or 1e-9
        desired = np.broadcast_to(np.array(wanted).ravel(), right.shape)
        np.testing.assert_allclose(right, desired, rtol=1e-9, atol=tolerance)
    assert len(blocks) == sum(each == name for each, _, _ in ORACLES)
