"""Named slices of flat vectors: what the compiled loop takes and gives, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from models.system import Array


@lru_cache(maxsize=256)
def _slices(fields: tuple[tuple[str, int], ...]) -> dict[str, slice]:
    result: dict[str, slice] = {}
    start = 0
    for name, size in fields:
        result[name] = slice(start, start + size)
        start += size
    return result


@dataclass(frozen=True, slots=True)
class Layout:
    """Fields of a vector: names and sizes, in order."""

    fields: tuple[tuple[str, int], ...]

    @property
    def size(self) -> int:
        """Length of the vector."""
        return sum(size for _, size in self.fields)

    @property
    def slices(self) -> dict[str, slice]:
        """Where each field lies."""
        return _slices(self.fields)

    def symbols(self, name: str) -> tuple[ca.SX, dict[str, ca.SX]]:
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
        names = [name for name, _ in self.fields]
        odd = set(names).symmetric_difference(values)
        if odd:
            raise ValueError(f"missing or unknown: {', '.join(sorted(odd))}")
        parts = [np.ravel(values[name]) for name in names]
        if all(part.size == size for part, (_, size) in zip(parts, self.fields, strict=True)):
            whole = np.concatenate(parts, dtype=float)
            if np.isfinite(whole).all():
                return whole
        vector = np.empty(self.size)
        for name, where in self.slices.items():
            value = np.asarray(values[name], dtype=float).ravel()
            if value.size != where.stop - where.start or not np.all(np.isfinite(value)):
                raise ValueError(
                    f"{name}: expected {where.stop - where.start} finite numbers, got {value}"
                )
            vector[where] = value
        return vector

    def unpack(self, vectors: Array) -> dict[str, Array]:
        """Views of the fields, shape (..., size) -> (..., field size)."""
        return {name: vectors[..., where] for name, where in self.slices.items()}
