"""Assumed modes of a uniform Euler-Bernoulli beam, clamped at s = 0 and free at s = l.

The deflection is w(s, t) = Σ_j φ_j(s) f_j(t) with shapes normalised to ∫ φ_i φ_j ds = δ_ij,
independent of the beam's mass:

    φ_j(s) = (cosh x - cos x - σ_j (sinh x - sin x)) / sqrt(l),   x = β_j s / l,
    cos β_j cosh β_j = -1,   σ_j = (sinh β_j - sin β_j) / (cosh β_j + cos β_j).

Mass-normalised shapes, with ρ ∫ φ_i φ_j ds = δ_ij, are φ_j / sqrt(ρ); their modal coordinates are
sqrt(ρ) f_j.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array

MOST_MODES = 6


@dataclass(frozen=True, slots=True, eq=False)
class BeamModes:
    """The first N modes of a clamped-free beam.

    Attributes:
        length: l, [m].
        roots: β_j, shape (N,).
        tip: φ_j(l) = ±2 / sqrt(l), shape (N,), [m^-1/2].
        area: ∫ φ_j ds = 2 σ_j sqrt(l) / β_j, shape (N,), [m^1/2].
        moment: ∫ s φ_j ds = 2 l^1.5 / β_j², shape (N,), [m^3/2].
    """

    length: float
    roots: Array
    tip: Array
    area: Array
    moment: Array

    @property
    def overtones(self) -> Array:
        """Frequency ratios ω_j / ω_1 = (β_j / β_1)², shape (N,)."""
        return (self.roots / self.roots[0]) ** 2

    def shapes(self, s: Array) -> Array:
        """φ_j(s), shape (...,) -> (..., N), [m^-1/2].

        cosh x - σ sinh x is written as (1 - d/2) e^-x + d/2 e^x with d = 1 - σ, because the two
        terms agree to 1e-7 for the sixth mode, and their difference would lose those digits.

        Args:
            s: distance from the clamped end, [m].
        """
        x = np.asarray(s, dtype=float)[..., None] / self.length * self.roots
        defect = _defect(self.roots)
        falling, rising = (1 - defect / 2) * np.exp(-x), defect / 2 * np.exp(x)
        waves = (1 - defect) * np.sin(x) - np.cos(x)
        return (falling + rising + waves) / np.sqrt(self.length)


def beam_modes(count: int, length: float) -> BeamModes:
    """The first `count` modes of a beam, with β_j from Newton's method.

    Args:
        count: N.
        length: l, [m].

    Raises:
        ValueError: `count` is not between 1 and `MOST_MODES`.
    """
    if not 1 <= count <= MOST_MODES:
        raise ValueError(f"modes: {count} is not between 1 and {MOST_MODES}")
    b: Array = np.pi * (np.arange(float(count)) + 0.5)
    for _ in range(8):  # Newton
        b = b + (np.cos(b) + 1 / np.cosh(b)) / (np.sin(b) + np.tanh(b) / np.cosh(b))
    return BeamModes(
        length=length,
        roots=b,
        tip=2 * (-1.0) ** np.arange(count) / np.sqrt(length),
        area=2 * (1 - _defect(b)) / b * np.sqrt(length),
        moment=2 / b**2 * length**1.5,
    )


def _defect(b: Array) -> Array:
    """d = 1 - σ = (e^-b + cos b + sin b) / (cosh b + cos b), about 1e-7 for the sixth mode."""
    return (np.exp(-b) + np.cos(b) + np.sin(b)) / (np.cosh(b) + np.cos(b))
