"""Editing the path of a simulation: selection, validity, undo, and the blend from old to new."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_blend import blend, mixes
from onpath.models.paths.curve_faults import Fault, curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import PathDesign
from onpath.models.paths.space_curves import saddle
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import Robot

BLEND = 0.3  # [s] that the change to another path takes
DEPTH = 100
HALVINGS = 6  # of a drag that leads to an invalid path: it ends within 1/64 of its length


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
        """The followed curve; curves of different kinds are not blended, see `mixes`."""
        if self.before is None:
            return self.target
        return blend(self.before, self.target, self.progress) if self.mixes else self.before

    @property
    def mixes(self) -> bool:
        """Whether the two curves can be blended."""
        return self.before is not None and mixes(self.before, self.target)


class PathEditor:
    """The path as edited, and as followed while an edit blends in.

    Attributes:
        robot: must be able to follow the path.
        rise: of the path above the plane in which it is edited, see `saddle`, [m].
        design: the last valid design.
        proposed: the valid design to which an unfinished edit has led; None if there is none.
        faults: why the last edit was refused, or went no further.
        selected: index of the selected control point.
        version: changes whenever the drawing does.
        blend: the followed path and its blend.
        curve: the curve that the robots follow now.
        table: its coefficients for the loop.
    """

    def __init__(self, robot: Robot, design: PathDesign, rise: float = 0.0) -> None:
        self.robot, self.rise = robot, rise
        self._past: list[PathDesign] = []
        self._future: list[PathDesign] = []
        self.design = design
        self.proposed: PathDesign | None = None
        self.faults: list[Fault] = []
        self.selected: int | None = None
        self.version = 0
        self._follow(Blend(self._raised(design)))

    def raise_to(self, rise: float, design: PathDesign | None = None) -> None:
        """Set the rise of the path, and another design with it.

        Raises:
            ValueError: the robot could not follow the path; nothing has changed.
        """
        before, self.rise = self.rise, rise
        if faults := self._faults(design or self.design):
            self.rise = before
            reasons = tuple(fault.reason for fault in faults)
            label = ROBOTS[self.robot.name].label
            raise CodedError("error.cannot_follow", robot=label, reasons=reasons)
        if design is not None:
            self.commit(design)
        self._blend_to(self.proposed or self.design)
        self.version += 1

    def select(self, index: int | None) -> None:
        """Select a control point; an invalid index selects none."""
        valid = index is not None and 0 <= index < len(self.design.points)
        self.selected = index if valid else None
        self.version += 1

    def propose(self, design: PathDesign) -> bool:
        """Show and follow an unfinished edit if it is valid. Returns whether it is."""
        self.faults = self._faults(design)
        self.version += 1
        if not self.faults:
            self.proposed = design
            self._blend_to(design)
        return not self.faults

    def drag(self, index: int, target: Array) -> bool:
        """Move a control point from its position in `design` towards a target, as far as is valid.

        If the path would become invalid on the way, the last valid position is found by bisection
        of the straight line to the target, and `faults` says what is wrong beyond it.

        Args:
            index: of the control point.
            target: shape (2,), [m].

        Returns:
            Whether it has reached the target.

        Raises:
            ValueError: there is no such point, or no curve through the target.
        """
        if self.propose(self.design.moved(index, target)):
            return True
        start, faults = self.design.points[index], self.faults
        reached, low, high = self.design, 0.0, 1.0
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            try:
                design = self.design.moved(index, start + middle * (target - start))
            except CodedError:  # two points coincide
                high = middle
                continue
            if found := self._faults(design):
                faults, high = found, middle
            else:
                reached, low = design, middle
        self.proposed, self.faults = reached, faults
        self._blend_to(reached)
        return False

    def finish(self) -> None:
        """End an edit, and keep the proposed design."""
        design, self.proposed = self.proposed, None
        self.version += 1
        if design is not None and design is not self.design:
            self._past = [*self._past[-DEPTH:], self.design]
            self._future.clear()
            self._keep(design)

    def commit(self, design: PathDesign) -> bool:
        """Apply a complete edit; False if it is not valid, and the path is as before."""
        valid = self.propose(design)
        self.finish()
        return valid

    def _raised(self, design: PathDesign) -> Curve:
        """The path of a design, with the rise."""
        return saddle(design.curve, self.rise)

    def _faults(self, design: PathDesign) -> list[Fault]:
        return curve_faults(self.robot.margin, self._raised(design))

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone edit to make again."""
        return bool(self._future)

    def undo(self) -> bool:
        """Undo one edit; False if there is none."""
        return self._swap(self._past, self._future)

    def redo(self) -> bool:
        """Redo one edit; False if there is none."""
        return self._swap(self._future, self._past)

    def forget_edits(self) -> None:
        """Clear the undo and redo histories."""
        self._past.clear()
        self._future.clear()

    def mark(self, faults: list[Fault]) -> None:
        """Mark the faults of a path in whose place another one is followed."""
        self.faults = faults
        self.version += 1

    def clear_faults(self) -> None:
        """Clear the marks of the last refused edit."""
        if self.faults:
            self.faults = []
            self.version += 1

    def advance(self, seconds: float) -> bool:
        """Advance the blend; True if the followed curve jumped to one of another kind."""
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
        self._follow(Blend(self._raised(self.design)))

    def points(self) -> np.ndarray:
        """Control points as shown, shape (k, 2), [m]."""
        return (self.proposed or self.design).points

    def _swap(self, source: list[PathDesign], sink: list[PathDesign]) -> bool:
        dragged, self.proposed, self.faults = self.proposed, None, []
        if source and self.rise:  # the design may date from when the path was flat
            self.faults = self._faults(source[-1])
        if not source or self.faults:
            if dragged is not None:
                self._blend_to(self.design)
            return False
        sink.append(self.design)
        self._keep(source.pop())
        self._blend_to(self.design)
        return True

    def _keep(self, design: PathDesign) -> None:
        self.design = design
        if self.selected is not None and self.selected >= len(design.points):
            self.selected = None
        self.version += 1

    def _blend_to(self, design: PathDesign) -> None:
        self.blend = Blend(self._raised(design), self.curve, 0.0)

    def _follow(self, followed: Blend) -> None:
        self.blend, self.curve = followed, followed.curve
        self.table = self.curve.table()
        self.version += 1
