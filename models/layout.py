"""Named slices of flat vectors: what the compiled loop takes and gives, by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import accumulate

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from onpath.models.arrays import Array

Fields = dict[str, ca.SX]
"""A symbolic vector's fields by name, each (size, 1)."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Fields of a vector: names and sizes, in order.

    Attributes:
        slices: where each field lies.
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
        """A symbolic vector and its fields, each (size, 1)."""
        vector = ca.SX.sym(name, self.size)
        return vector, {field: vector[where] for field, where in self.slices.items()}

    def join(self, values: Mapping[str, ca.SX]) -> ca.SX:
        """A symbolic vector from its fields."""
        return ca.vertcat(*[ca.densify(values[name]) for name, _ in self.fields])

    def pack(self, values: Mapping[str, ArrayLike]) -> Array:
        """A numeric vector from its fields.

        Raises:
            ValueError: a field is missing, unknown, of the wrong size, or not finite.
        """
        if values.keys() != self.slices.keys():
            odd = values.keys() ^ self.slices.keys()
            raise ValueError(f"missing or unknown: {', '.join(sorted(odd))}")
        numbers = list[float]()
        for name, size in self.fields:
            own = _numbers(values[name])
            if len(own) != size or not all(map(math.isfinite, own)):
                raise ValueError(f"{name}: expected {size} finite numbers, got {values[name]}")
            numbers += own
        return np.array(numbers)

    def unpack(self, vectors: Array) -> dict[str, Array]:
        """Views of the fields, shape (..., size) -> (..., field size)."""
        return {name: vectors[..., where] for name, where in self.slices.items()}


def _numbers(value: ArrayLike) -> list[float]:
    return [value] if isinstance(value, float) else np.asarray(value, dtype=float).ravel().tolist()
