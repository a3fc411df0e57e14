"""The log of a real arm as curves over time, for plots."""

from __future__ import annotations

import numpy as np

from onpath.app.lab.plot_rows import XI, rounding
from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame
from onpath.models.studies.log_motion import LoggedMotion, along_path

LogField = tuple[str, float, tuple[tuple[int | None, ...], ...]]
"""As in `LogMessage.fields`."""


def times_of(motion: LoggedMotion) -> tuple[float, ...]:
    """The times of a log's rows, to 0.1 ms, [s]."""
    return tuple(np.round(motion.t, 4).tolist())


def fields_on_path(
    motion: LoggedMotion, frame: Frame, curve: Curve, *, is_level_set: bool
) -> tuple[LogField, ...]:
    """Where a log is on a path, as far as that is known; θ goes on where it passes ±π.

    Args:
        is_level_set: whether ξ₁ is an area, which a log does not tell.
    """
    found = along_path(motion, frame, curve, level_set=is_level_set)
    if curve.closed:
        known = np.isfinite(found["theta"])
        found["theta"][known] = np.unwrap(found["theta"][known])
    return tuple(
        _field(name, x[:, None])
        for name, x in found.items()
        if not (is_level_set and name in XI) and not np.isnan(x).all()
    )


def fields_of_efforts(motion: LoggedMotion) -> tuple[LogField, ...]:
    """Torques, and forces if there are any, which do not depend on a path."""
    torque = _field("u", motion.u)
    has_forces = np.nan_to_num(motion.force).any()
    return (torque, _field("force", motion.force)) if has_forces else (torque,)


def _field(name: str, values: Array) -> LogField:
    unit = rounding(name, is_level_set=False)
    return name, unit, tuple(tuple(map(_whole, column)) for column in (unit * values.T).tolist())


def _whole(value: float) -> int | None:
    return round(value) if np.isfinite(value) else None
