"""What lesson 7 and the READMEs tell of the limit of alpha, from the pencil of matrices at home."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from onpath.app.lab.lab import Lab
from onpath.models.arrays import Array
from onpath.models.control.rank_test import decoupling_matrices
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.flexible_five_bar import HOME
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics
from tests.support.lab import loop_cache
from tests.support.stated_numbers import agrees, assert_stated, said, stated_in_readme

pytestmark = pytest.mark.thorough

LESSON, LINKS = "07", load_links()


def coefficients(modes: int) -> Array:
    """c_j = phi_j(l) integral of s phi_j / l of a beam turned at its end."""
    beam = beam_modes(modes, LINKS.beam)
    return beam.tip * beam.moment / LINKS.beam


def limit(modes: int, damping: Any) -> float:
    """Smallest alpha with an exponent to the right, at home.

    With the output held (I - alpha c phi^T) f'' = -D f' - omega^2 f, c and phi as vectors.

    Args:
        damping: of each omega_j, [1/s], omega_j -> D_j.
    """
    beam = beam_modes(modes, LINKS.beam)
    omega = 2 * np.pi * LINKS.frequency * beam.overtones

    def grows(alpha: float) -> bool:
        inertia = np.eye(modes) - alpha * np.outer(beam.moment, beam.tip) / LINKS.beam
        rates = (
            -np.linalg.solve(inertia, np.diag(omega**2)),
            -np.linalg.solve(inertia, np.diag(damping(omega))),
        )
        whole = np.block([[np.zeros((modes, modes)), np.eye(modes)], [rates[0], rates[1]]])
        exponents = np.linalg.eigvals(whole)
        return bool(exponents.real.max() > 1e-7 * np.abs(exponents).max())

    low, high = next((a - 0.01, a) for a in np.arange(0.3, 1, 0.01) if grows(a))
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (low, middle) if grows(middle) else (middle, high)
    return float(high)


def equal(omega: Array) -> Array:
    return 2 * 0.01 * omega


def test_the_numbers_of_one_mode() -> None:
    beam = beam_modes(1, LINKS.beam)
    turned, shifted = float(coefficients(1)[0]), float(beam.tip[0] * beam.area[0])
    assert_stated(said(LESSON, "and $c = #$ follows from"), [turned])
    assert_stated(said(LESSON, "(If that end were *shifted*, $c$ would be #.)"), [shifted])
    assert_stated(said(LESSON, "$(1-c)\\,a = #\\,a$"), [1 - turned])
    assert_stated(said(LESSON, "$1 - \\alpha c = 0$: $\\alpha = 1/c = #$."), [1 / turned])
    texts = said(LESSON, "their sum tends to 1: it is #, #, #, # with one to four modes.")
    assert_stated(texts, np.cumsum(coefficients(4)).tolist())
    assert abs(coefficients(6).sum() - 1) < abs(coefficients(4).sum() - 1)


def test_the_limit_is_one_of_the_damping() -> None:
    one, three = said(LESSON, "The limit is # for one mode and # for three.")
    assert_stated([one, three], [limit(1, equal), limit(3, equal)])
    texts = said(LESSON, "grows from α = # on, in the home pose (# with four modes or more).")
    assert_stated(texts, [limit(3, equal), limit(4, equal)])
    assert agrees(texts[1], limit(6, equal))
    meet, _ = said(LESSON, "Without damping they would meet at α = #, at # Hz")
    assert_stated([meet], [limit(3, np.zeros_like)])
    texts = said(LESSON, "So between # and # it is *damping* that destabilises")
    assert limit(3, equal) < float(texts[0]) + 1e-3 and float(texts[1]) < limit(3, np.zeros_like)
    first = 2 * np.pi * LINKS.frequency
    stiff = limit(3, lambda omega: 2 * 0.01 * omega**2 / first)
    heavy = limit(3, lambda omega: 2 * 0.01 * first * np.ones_like(omega))
    texts = said(
        LESSON, "in proportion to its stiffness, the limit would be #, in proportion to its mass #."
    )
    assert_stated(texts, [stiff, heavy])
    assert_stated(stated_in_readme("with this damping, it is stable up to #."), [limit(3, equal)])


def inside(modes: int, away: float, alpha: float = 1.0) -> tuple[float, float]:
    """Critical α, and the largest real part of the exponents, with the link's end at d, at rest."""
    own = FlexibleParameters(modes=modes, d=away)
    zero, robot = flexible_zero_dynamics(modes), robot_for(own)
    q, plant = robot.rest(robot.frame.lift(np.zeros(2))), robot.plant(own)
    exponents = zero.exponents(q, zero.with_alpha(plant, np.array([alpha])))
    return zero.critical_alpha(q, plant), float(exponents[0, 0].real)


def test_the_limit_is_one_of_the_pose_and_of_the_modes() -> None:
    texts = stated_in_readme(
        "with three modes, the limit of `alpha` is # at d = # m, # at # m, # at # m, which is home,"
        " and # at # m."
    )
    assert_stated(texts[::2], [inside(3, float(away))[0] for away in texts[1::2]])
    texts = said(
        LESSON,
        "With three modes the limit is # if the link's end is # m in front of the waist instead of"
        " #, and # at # m.",
    )
    found = [inside(3, float(away))[0] for away in (texts[1], texts[4])]
    assert_stated([texts[0], texts[3]], found)
    assert all(inside(modes, 0.5)[1] > 0 for modes in range(1, 7))  # "with one to six modes"
    first, last = map(float, stated_in_readme("From # to # m, `alpha=1` is unstable with two"))
    for away in np.arange(first, last + 1e-9, 0.025):
        assert all(inside(modes, float(away))[1] > 0 for modes in range(2, 7)), away
    *stable, unstable = map(
        float, stated_in_readme("it is stable at # m and # m, and unstable from # m on.")
    )
    assert all(inside(1, away)[1] < 0 for away in stable)
    assert all(inside(1, float(away))[1] > 0 for away in np.arange(unstable, 0.66, 0.025))


@pytest.mark.parametrize("alpha", [0.0, 0.75, 1.0])
def test_the_rank_is_full_on_the_path_of_the_lesson_for_mark_and_tip(alpha: float) -> None:
    """Theorem 2.1 holds for the output whose zero dynamics are unstable as well."""
    own = replace(ROBOTS["flexible"].parameters(), alpha=alpha)
    robot, path = robot_for(own), Lab(loop_cache(), ROBOTS["flexible"]).simulation.editor.curve
    places = path.at(np.linspace(0, 2 * np.pi, 120, endpoint=False))
    q = np.stack([robot.rest(robot.frame.lift(z)) for z in places])
    matrices = decoupling_matrices(robot, own, q)
    signs = np.sign(np.linalg.det(matrices))
    assert (signs == signs[0]).all()  # nowhere between the places, either
    values = np.linalg.svd(matrices, compute_uv=False)
    assert (values[:, -1] / values[:, 0]).min() > 0.02


def frequencies(alpha: float, **changes: float) -> Array:
    """Of the zero dynamics at home, with three modes, rising, [Hz]."""
    zero = flexible_zero_dynamics(3)
    parameters = zero.system.parameter_vector(LINKS.lumped(alpha) | changes)
    exponents = zero.exponents(np.concatenate([HOME, np.zeros(3)]), parameters)[0]
    return np.sort(exponents.imag[exponents.imag > 0]) / (2 * np.pi)


def test_frequencies_inside() -> None:
    texts = said(
        LESSON,
        "the lowest rises (#, #, # Hz at α = 0, 0.5, 0.7) while the second sinks (#, #, # Hz).",
    )
    found = [frequencies(alpha)[:2] for alpha in (0.0, 0.5, 0.7)]
    assert_stated(texts, [float(f[0]) for f in found] + [float(f[1]) for f in found])
    alpha, meeting = said(LESSON, "Without damping they would meet at α = #, at # Hz")
    lowest, second = frequencies(float(alpha) - 1e-5, zeta=0.0)[:2]
    assert agrees(meeting, float(lowest + second) / 2) and second - lowest < 0.5
    assert_stated(said(LESSON, "The inside swings at # Hz"), [float(frequencies(-1.0)[0])])
