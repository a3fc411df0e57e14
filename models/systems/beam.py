"""Assumed modes of a uniform beam, clamped at s = 0 and free at s = l (Euler-Bernoulli).

w(s, t) = sum_j phi_j(s) f_j(t), with the integral of phi_i phi_j over the beam delta_ij: the shapes
know nothing of the beam's mass. Mass-normalised ones, rho integral of phi_i phi_j = delta_ij, are
these over sqrt(rho), and their modal coordinates sqrt(rho) f_j.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array

MOST_MODES = 6


@dataclass(frozen=True, slots=True, eq=False)
class BeamModes:
    """The first modes of a clamped-free beam.

    Attributes:
        length: l, [m].
        roots: beta_j, roots of cos(b) cosh(b) = -1, shape (N,).
        tip: phi_j(l), shape (N,), [m^-1/2].
        area: integral of phi_j, shape (N,), [m^1/2].
        moment: integral of s phi_j, shape (N,), [m^3/2].
    """

    length: float
    roots: Array
    tip: Array
    area: Array
    moment: Array

    @property
    def overtones(self) -> Array:
        """omega_j / omega_1, shape (N,)."""
        return (self.roots / self.roots[0]) ** 2

    def frequencies(self, rigidity: float, density: float) -> Array:
        """omega_j, shape (N,), [rad/s].

        Args:
            rigidity: EI, [N m^2].
            density: rho, [kg/m].
        """
        return self.roots**2 * np.sqrt(rigidity / density) / self.length**2

    def shapes(self, s: Array) -> Array:
        """phi_j(s), shape (...,) -> (..., N), [m^-1/2].

        cosh - sigma sinh is written in exponentials: the two differ by 1e-7 of themselves.
        """
        x = np.asarray(s, dtype=float)[..., None] / self.length * self.roots
        defect = _defect(self.roots)
        falling, rising = (1 - defect / 2) * np.exp(-x), defect / 2 * np.exp(x)
        waves = (1 - defect) * np.sin(x) - np.cos(x)
        return (falling + rising + waves) / np.sqrt(self.length)


def beam_modes(count: int, length: float) -> BeamModes:
    """The first `count` modes of a beam of some length, [m].

    Raises:
        ValueError: fewer than one mode or more than `MOST_MODES`.
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


def rigidity(frequency: float, length: float, density: float) -> float:
    """EI of a beam whose first frequency is given, [N m^2].

    Args:
        frequency: of the first mode, clamped, [Hz].
        length: [m].
        density: [kg/m].
    """
    wave = float(beam_modes(1, length).roots[0]) / length
    return density * (2 * np.pi * frequency) ** 2 / wave**4


def _defect(b: Array) -> Array:
    """1 - (sinh b - sin b) / (cosh b + cos b), some 1e-7 for the sixth mode."""
    return (np.exp(-b) + np.cos(b) + np.sin(b)) / (np.cosh(b) + np.cos(b))
