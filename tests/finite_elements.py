"""A beam of Hermite elements: what the assumed modes are checked against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from models.system import Array


@dataclass(frozen=True)
class Elements:
    """A clamped-free beam; coordinates are deflection and slope of every node but the root.

    Attributes:
        nodes: all nodes with the root, shape (n + 1,), [m].
        mass, stiffness: shape (2n, 2n).
    """

    nodes: Array
    mass: Array
    stiffness: Array

    def vibration(self, count: int) -> tuple[Array, Array]:
        """The first angular frequencies, (count,), and shapes at all nodes, (n + 1, count)."""
        squared, vectors = eigh(self.stiffness, self.mass, subset_by_index=[0, count - 1])
        return np.sqrt(squared), np.vstack([np.zeros(count), vectors[::2]])

    def rigid(self, deflection: Array, slope: float) -> Array:
        """Coordinates of a shape given at all nodes, its slope constant."""
        return np.column_stack([deflection[1:], np.full(self.nodes.size - 1, slope)]).ravel()


def clamped_free(count: int, length: float, rigidity: float, density: float) -> Elements:
    """`count` cubic Hermite elements of equal length, consistent mass."""
    h, n = length / count, 2 * (count + 1)
    stiffness, mass = np.zeros((n, n)), np.zeros((n, n))
    bending = np.array(
        [[12, 6 * h, -12, 6 * h], [0, 4 * h**2, -6 * h, 2 * h**2], [0, 0, 12, -6 * h], [0, 0, 0, 0]]
    )
    bending[3, 3] = 4 * h**2
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
    return Elements(np.linspace(0, length, count + 1), mass[2:, 2:], stiffness[2:, 2:])
