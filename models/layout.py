"""Flat vectors with named fields, as the compiled loop reads and writes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import accumulate

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from onpath.models.arrays import Array

Fields = dict[str, ca.SX]
"""Fields of a symbolic vector by name, each (size, 1)."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The fields of a flat vector: names and sizes, in order.

    Attributes:
        fields: (name, size) of every field.
        slices: name -> slice of the vector.
        size: length of the vector.
    """

    fields: tuple[tuple[str, int], ...]
    slices: dict[str, slice] = field(init=False, repr=False, compare=False)
    size: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        ends = list(accumulate(size for _, size in self.fields))
        starts = [0, *ends]
        named = zip(self.fields, starts, ends, strict=False)
        object.__setattr__(self, "slices", {name: slice(i, j) for (name, _), i, j in named})
        object.__setattr__(self, "size", starts[-1])

    def symbols(self, name: str) -> tuple[ca.SX, Fields]:
        """A symbolic vector (size, 1) and its fields, each (field size, 1).

        Args:
            name: of the CasADi symbol.
        """
        vector = ca.SX.sym(name, self.size)
        return vector, {field: vector[where] for field, where in self.slices.items()}

    def join(self, values: Mapping[str, ca.SX]) -> ca.SX:
        """The symbolic vector with these fields, (size, 1)."""
        return ca.vertcat(*[ca.densify(values[name]) for name, _ in self.fields])

    def pack(self, values: Mapping[str, ArrayLike]) -> Array:
        """The numeric vector with these fields, shape (size,).

        Numbers are not checked here: users' input is checked where it arrives.

        Raises:
            ValueError: a field is missing, unknown, or of the wrong size.
        """
        if values.keys() != self.slices.keys():
            odd = values.keys() ^ self.slices.keys()
            raise ValueError(f"missing or unknown: {', '.join(sorted(odd))}")
        numbers = list[float]()
        for name, size in self.fields:
            given = _numbers(values[name])
            if len(given) != size:
                raise ValueError(f"{name}: expected {size} numbers, got {values[name]}")
            numbers += given
        return np.array(numbers)

    def unpack(self, vectors: Array) -> dict[str, Array]:
        """Views of the fields of one or many vectors, shape (..., size) -> (..., field size)."""
        return {name: vectors[..., where] for name, where in self.slices.items()}


def _numbers(value: ArrayLike) -> list[float]:
    """The value as a list of floats; a float takes a short cut, because most fields are floats."""
    return [value] if isinstance(value, float) else np.asarray(value, dtype=float).ravel().tolist()
