"""Assumed modes of a uniform beam, clamped at s = 0 and free at s = l (Euler-Bernoulli).

w(s, t) = sum_j phi_j(s) f_j(t), with the integral of phi_i phi_j over the beam delta_ij.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from models.system import Array

MOST_MODES = 6


@dataclass(frozen=True)
class Beam:
    """The first modes of a clamped-free beam.

    Attributes:
        length: l, [m].
        modes: N, 1 to MOST_MODES.
    """

    length: float
    modes: int

    def __post_init__(self) -> None:
        if not 1 <= self.modes <= MOST_MODES or self.length <= 0:
            raise ValueError(
                f"expected 1 to {MOST_MODES} modes and a positive length,"
                f" got {self.modes} and {self.length}"
            )

    @cached_property
    def beta(self) -> Array:
        """Roots of cos(b) cosh(b) = -1, shape (N,); omega_j = beta_j^2 sqrt(EI / rho) / l^2."""
        b: Array = np.pi * (np.arange(self.modes) + 0.5)
        for _ in range(8):  # Newton
            slope = -np.sin(b) - np.tanh(b) / np.cosh(b)
            b -= (np.cos(b) + 1 / np.cosh(b)) / slope
        return b

    @property
    def tip(self) -> Array:
        """phi_j(l), shape (N,), [m^-1/2]."""
        return 2 * (-1.0) ** np.arange(self.modes) / np.sqrt(self.length)

    @property
    def integral(self) -> Array:
        """Integral of phi_j, shape (N,), [m^1/2]."""
        return 2 * (1 - self._defect) / self.beta * np.sqrt(self.length)

    @property
    def moment(self) -> Array:
        """Integral of s phi_j, shape (N,), [m^3/2]."""
        return 2 / self.beta**2 * self.length**1.5

    @property
    def _defect(self) -> Array:
        """1 - (sinh b - sin b) / (cosh b + cos b), some 1e-7 for the sixth mode."""
        b = self.beta
        return (np.exp(-b) + np.cos(b) + np.sin(b)) / (np.cosh(b) + np.cos(b))

    def shapes(self, s: Array) -> Array:
        """phi_j(s), shape (...,) -> (..., N), [m^-1/2].

        cosh - sigma sinh is written in exponentials: the two differ by 1e-7 of themselves.
        """
        x = np.asarray(s, dtype=float)[..., None] / self.length * self.beta
        defect = self._defect
        falling, rising = (1 - defect / 2) * np.exp(-x), defect / 2 * np.exp(x)
        waves = (1 - defect) * np.sin(x) - np.cos(x)
        return (falling + rising + waves) / np.sqrt(self.length)
