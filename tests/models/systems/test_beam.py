"""Laws of the clamped-free beam: theory and quadrature to 1e-9, finite elements to 1e-4."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.systems.beam import MOST_MODES, beam_modes
from tests.support.finite_elements import beam_of_elements, rigidity

LENGTH = 0.5
# cos(beta) cosh(beta) = -1 to sixteen digits (Blevins, Formulas for natural frequency, table 8-1)
ROOTS = (
    *(1.875104068711961, 4.694091132974175, 7.854757438237613),
    *(10.99554073487547, 14.13716839104647, 17.27875953208824),
)


def quadrature() -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [0, LENGTH], exact beyond rounding here."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    return LENGTH * (nodes + 1) / 2, LENGTH * weights / 2


def test_roots_are_those_of_the_tables() -> None:
    roots = beam_modes(MOST_MODES, LENGTH).roots
    assert roots == pytest.approx(ROOTS, rel=1e-14)
    assert np.abs(np.cos(roots) + 1 / np.cosh(roots)).max() < 1e-14


def test_shapes_are_orthonormal_and_their_integrals_those_of_quadrature() -> None:
    modes = beam_modes(MOST_MODES, LENGTH)
    s, weights = quadrature()
    shapes = modes.shapes(s)
    assert np.abs((shapes * weights[:, None]).T @ shapes - np.eye(MOST_MODES)).max() < 1e-9
    assert np.abs(weights @ shapes - modes.area).max() < 1e-9
    assert np.abs((weights * s) @ shapes - modes.moment).max() < 1e-9
    assert np.abs(modes.shapes(np.array(LENGTH)) - modes.tip).max() < 1e-9


def test_shapes_solve_the_beam_equation_with_a_clamped_root_and_a_free_tip() -> None:
    modes = beam_modes(MOST_MODES, LENGTH)
    ends, inner = np.array([-1.0, 1.0]), np.linspace(-0.8, 0.8, 9)
    for j, root in enumerate(modes.roots):
        degree = 14 + round(root)
        x = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
        values = modes.shapes(LENGTH * (x + 1) / 2)[:, j]
        shape = np.polynomial.Chebyshev.fit(x, values, degree, domain=[-1, 1])
        slope, bending, shear, load = (shape.deriv(k) for k in (1, 2, 3, 4))
        size, wave = np.abs(values).max(), root / 2
        assert abs(shape(ends[0])) < 1e-10 * size and abs(slope(ends[0])) < 1e-9 * size * wave
        assert abs(bending(ends[1])) < 1e-8 * size * wave**2
        assert abs(shear(ends[1])) < 1e-6 * size * wave**3
        assert np.abs(load(inner) - wave**4 * shape(inner)).max() < 1e-7 * size * wave**4


def test_fewer_modes_are_the_first_of_more() -> None:
    for count in range(1, MOST_MODES):
        fewer, more = beam_modes(count, LENGTH), beam_modes(MOST_MODES, LENGTH)
        for name in ("roots", "tip", "area", "moment"):
            assert np.array_equal(getattr(fewer, name), getattr(more, name)[:count])


def test_finite_elements_have_the_same_frequencies_and_shapes() -> None:
    density = 0.2
    stiffness = rigidity(4.0, LENGTH, density)
    modes = beam_modes(MOST_MODES, LENGTH)
    expected = modes.roots**2 * np.sqrt(stiffness / density) / LENGTH**2
    assert expected[0] == pytest.approx(2 * np.pi * 4.0, rel=1e-14)
    elements = beam_of_elements(40, LENGTH, stiffness, density)
    frequencies, shapes = elements.vibration(MOST_MODES)
    assert frequencies == pytest.approx(expected, rel=1e-4)
    own = modes.shapes(elements.nodes)
    turned = np.sqrt(density) * shapes * np.sign(shapes[-1]) * np.sign(own[-1])
    assert np.abs(turned - own).max() < 1e-3 * np.abs(own).max()


@pytest.mark.parametrize("count", [0, 7, -1])
def test_a_number_of_modes_that_does_not_exist_is_refused(count: int) -> None:
    with pytest.raises(ValueError, match="between 1 and 6"):
        beam_modes(count, LENGTH)
