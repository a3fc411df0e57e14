"""A beam of Hermite elements, the reference for the assumed modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from onpath.models.arrays import Array
from onpath.models.systems.beam import beam_modes


@dataclass(frozen=True)
class Elements:
    """A uniform beam; coordinates are deflection and slope of every node.

    Attributes:
        nodes: shape (n,), [m].
        mass, stiffness: shape (2n, 2n), of the free beam.
    """

    nodes: Array
    mass: Array
    stiffness: Array

    def vibration(self, count: int) -> tuple[Array, Array]:
        """First angular frequencies, (count,), and shapes, (n, count), if clamped at the root."""
        inner = slice(2, None)
        squared, vectors = eigh(
            self.stiffness[inner, inner], self.mass[inner, inner], subset_by_index=[0, count - 1]
        )
        return np.sqrt(squared), np.vstack([np.zeros(count), vectors[::2]])

    def on_hub(self, inertia: float) -> tuple[Array, Array]:
        """M and K if the root is clamped to a rotating hub; coordinates (angle, deflection).

        The lateral position of a point s of the beam is s angle + w(s).

        Args:
            inertia: of the hub alone, [kg m^2].
        """
        turning = np.column_stack([self.nodes, np.ones(self.nodes.size)]).ravel()
        carried = self.mass @ turning
        mass = np.block(
            [
                [np.array([[inertia + turning @ carried]]), carried[None, 2:]],
                [carried[2:, None], self.mass[2:, 2:]],
            ]
        )
        stiffness = np.zeros_like(mass)
        stiffness[1:, 1:] = self.stiffness[2:, 2:]
        return mass, stiffness


def beam_of_elements(count: int, length: float, rigidity: float, density: float) -> Elements:
    """Assemble `count` cubic Hermite elements of equal length, with consistent mass."""
    h, n = length / count, 2 * (count + 1)
    stiffness, mass = np.zeros((n, n)), np.zeros((n, n))
    bending = np.array(
        [
            [12, 6 * h, -12, 6 * h],
            [0, 4 * h**2, -6 * h, 2 * h**2],
            [0, 0, 12, -6 * h],
            [0, 0, 0, 4 * h**2],
        ]
    )
    inertia = np.array(
        [
            [156, 22 * h, 54, -13 * h],
            [0, 4 * h**2, 13 * h, -3 * h**2],
            [0, 0, 156, -22 * h],
            [0, 0, 0, 4 * h**2],
        ]
    )
    for i in range(count):
        where = slice(2 * i, 2 * i + 4)
        stiffness[where, where] += rigidity / h**3 * (bending + np.triu(bending, 1).T)
        mass[where, where] += density * h / 420 * (inertia + np.triu(inertia, 1).T)
    return Elements(np.linspace(0, length, count + 1), mass, stiffness)


def rigidity(frequency: float, length: float, density: float) -> float:
    """EI = ρ (2π f_1)² l⁴ / β_1⁴ of a beam with a given first frequency, [N m²].

    Args:
        frequency: f_1, clamped, [Hz].
        length: l, [m].
        density: ρ, [kg/m].
    """
    wave = float(beam_modes(1, length).roots[0]) / length
    return density * (2 * np.pi * frequency) ** 2 / wave**4
