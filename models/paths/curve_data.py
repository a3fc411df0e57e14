"""Curves from their data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from onpath.models.paths.curves import Curve, SeriesCurve, by_terms
from onpath.models.paths.spline_curves import SplineCurve


def curve_from(data: Mapping[str, Any]) -> Curve:
    """The inverse of `Curve.data`, to the last bit of what is computed from it."""
    if "points" in data:
        return SplineCurve(**data)
    values: dict[str, Any] = {**data, "series": by_terms([*data["series"]])}
    return SeriesCurve(**values)
