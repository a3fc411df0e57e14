"""The structural choices of a closed loop, beyond its robot."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.models.control.implicit_level import ImplicitLevel
from onpath.models.paths.curves import ORDERS, SPACE_TABLE_SHAPE, TABLE_SHAPE
from onpath.models.paths.spline_curves import TABLE_POINTS


@dataclass(frozen=True, slots=True)
class Kind:
    """The choices that need a kernel of their own; everything else is a run-time setting.

    Attributes:
        law: name of a law of `models/control/laws`.
        closed: whether the path is a closed curve.
        level_set: whether λ is the paper's s(y) instead of the signed distance.
        encoder: whether the controller gets quantised angles instead of the exact state.
        free: whether the loop may omit external forces, torque limits, dry friction and held
            torques, for speed. It is equivalent to the full loop while none of these act.
        space: whether the path is a space curve.
        level: with `level_set`, λ of a path given by an equation; None for that of a conic.
        output: the controlled output of a flexible robot: "redefined" (with a share α of the
            deflection) or "composite" (the tip, see models/control/composite_control.py).
        across_first: whether a torque limit first reduces the motion along the path; see
            `admissible_along`.
        delay: whether a torque takes effect some time after the measurement (delay.py).
        stiction: whether joints stick, by Karnopp's model (stiction.py).
        noise: whether sensors are noisy (noise.py).
        observer: whether an observer (observer.py) gives the velocities behind encoders or noise,
            instead of a filter.
        further_gains: names of gains of other laws that the settings have besides the law's own:
            the laws of a figure share one vector.
        spline: whether the path consists of pieces (models/paths/spline_curves.py), not of one
            series.
    """

    law: str
    closed: bool = True
    level_set: bool = False
    encoder: bool = False
    free: bool = False
    output: str = "redefined"
    across_first: bool = False
    delay: bool = False
    stiction: bool = False
    noise: bool = False
    observer: bool = False
    space: bool = False
    level: ImplicitLevel | None = None
    further_gains: tuple[str, ...] = ()
    spline: bool = False

    @property
    def table_shape(self) -> tuple[int, int]:
        """Shape of `Curve.table` of its paths."""
        if self.spline:
            return self.dimension, TABLE_POINTS
        return SPACE_TABLE_SHAPE if self.space else TABLE_SHAPE

    @property
    def dimension(self) -> int:
        """d of its paths."""
        return 3 if self.space else 2

    @property
    def value_rows(self) -> int:
        """Numbers in σ, σ', σ'' and σ''' together."""
        return ORDERS * self.dimension
