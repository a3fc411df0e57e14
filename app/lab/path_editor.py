"""Editing the path of a session: selection, validity, undo, and the blend from old to new."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onpath.models.paths.curve_faults import Fault, curve_faults
from onpath.models.paths.curves import Curve, blend
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.robots import Robot

BLEND = 0.3  # [s]
DEPTH = 100


@dataclass(frozen=True, slots=True, eq=False)
class Blend:
    """The followed path: `target`, or a blend from `before` to `target` after an edit.

    Attributes:
        progress: from 0 (`before`) to 1 (`target`).
    """

    target: Curve
    before: Curve | None = None
    progress: float = 1.0

    @property
    def curve(self) -> Curve:
        """The followed curve; closed and open curves are not blended."""
        if self.before is None:
            return self.target
        return blend(self.before, self.target, self.progress) if self.mixes else self.before

    @property
    def mixes(self) -> bool:
        """Whether the two curves can be blended."""
        return self.before is not None and self.before.closed == self.target.closed


class PathEditor:
    """The path as edited, and as followed while an edit blends in.

    Attributes:
        robot: must be able to follow the path.
        design: the last valid design.
        proposed: the design being dragged, valid or not; None if there is none.
        faults: errors of the last refused edit.
        selected: index of the selected control point.
        version: changes whenever the drawing does.
        blend: the followed path and its blend.
        curve: the curve that the robots follow now.
        table: its coefficients for the loop.
    """

    def __init__(self, robot: Robot, design: PathDesign) -> None:
        self.robot = robot
        self._past: list[PathDesign] = []
        self._future: list[PathDesign] = []
        self.design = design
        self.proposed: PathDesign | None = None
        self.faults: list[Fault] = []
        self.selected: int | None = None
        self.version = 0
        self._follow(Blend(design.curve))

    def select(self, index: int | None) -> None:
        """Select a control point; an invalid index selects none."""
        valid = index is not None and 0 <= index < len(self.design.points)
        self.selected = index if valid else None
        self.version += 1

    def propose(self, design: PathDesign) -> bool:
        """Show an unfinished edit, and follow it if it is valid. Returns whether it is."""
        self.proposed = design
        self.faults = curve_faults(self.robot.margin, design.curve)
        self.version += 1
        if not self.faults:
            self._blend_to(design.curve)
        return not self.faults

    def finish(self) -> bool:
        """End an edit: keep it if valid, else return to the last valid path."""
        design, self.proposed = self.proposed, None
        self.version += 1
        if design is None:
            return True
        if self.faults:
            self._blend_to(self.design.curve)
            return False
        if design is not self.design:
            self._past = [*self._past[-DEPTH:], self.design]
            self._future.clear()
            self._keep(design)
        return True

    def commit(self, design: PathDesign) -> bool:
        """Apply a complete edit."""
        self.propose(design)
        return self.finish()

    def undo(self) -> bool:
        """Undo one edit; False if there is none."""
        return self._swap(self._past, self._future)

    def redo(self) -> bool:
        """Redo one edit; False if there is none."""
        return self._swap(self._future, self._past)

    def forget_edits(self) -> None:
        """Leave nothing to undo or redo."""
        self._past.clear()
        self._future.clear()

    def clear_faults(self) -> None:
        """Clear the marks of the last refused edit."""
        if self.faults:
            self.faults = []
            self.version += 1

    def advance(self, seconds: float) -> bool:
        """Advance the blend; True if the followed curve jumped between open and closed."""
        now = self.blend
        if now.before is None:
            return False
        progress = now.progress + seconds / BLEND
        ends = progress >= 1.0 or not now.mixes
        self._follow(Blend(now.target) if ends else replace(now, progress=progress))
        return not now.mixes

    def settle(self) -> None:
        """Follow the last valid path at once, without a blend."""
        self.proposed, self.faults = None, []
        self._follow(Blend(self.design.curve))

    def show(self, shown: PathDesign, followed: Blend, faults: list[Fault]) -> None:
        """Copy another editor: its points and marks, and the path followed there."""
        self.design, self.proposed, self.faults = shown, None, faults
        self._follow(followed)

    def points(self) -> np.ndarray:
        """Control points as shown, shape (k, 2), [m]."""
        return (self.proposed or self.design).points

    def _swap(self, source: list[PathDesign], sink: list[PathDesign]) -> bool:
        dragged, self.proposed, self.faults = self.proposed, None, []
        if not source:
            if dragged is not None:
                self._blend_to(self.design.curve)
            return False
        sink.append(self.design)
        self._keep(source.pop())
        self._blend_to(self.design.curve)
        return True

    def _keep(self, design: PathDesign) -> None:
        self.design = design
        if self.selected is not None and self.selected >= len(design.points):
            self.selected = None
        self.version += 1

    def _blend_to(self, target: Curve) -> None:
        self.blend = Blend(target, self.curve, 0.0)

    def _follow(self, followed: Blend) -> None:
        self.blend, self.curve = followed, followed.curve
        self.table = self.curve.table()
        self.version += 1
