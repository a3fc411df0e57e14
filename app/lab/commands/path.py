"""Commands that choose, edit and draw the path. Points are coordinates of its plane, [m]."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands.checks import finite, point
from onpath.app.lab.commands.time import StepOnce
from onpath.app.lab.lab import Await, Command, Lab
from onpath.app.lab.plant_state import PlantState
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_faults import Fault, ambiguities
from onpath.models.paths.curve_fit import deviation_of
from onpath.models.paths.curves import Curve
from onpath.models.paths.drawing_design import drawn, from_curve
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.parameter_specs import unknown_name

MOST_STROKE_POINTS = 5000
_fits = ThreadPoolExecutor(1, "strokes")
"""Fits the strokes of all labs, one at a time: a fit takes tenths of a second."""


@dataclass(frozen=True, slots=True)
class ChoosePath(Command):
    """Follow a preset path."""

    name: str

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        if self.name not in lab.simulation.presets:
            raise unknown_name(self.name, list(lab.simulation.presets), "path")
        commit(lab, lab.simulation.presets[self.name])


@dataclass(frozen=True, slots=True)
class SelectPoint(Command):
    """Select a control point; None selects none."""

    index: int | None

    @override
    def apply(self, lab: Lab) -> None:
        editor = lab.simulation.editor
        if self.index is not None:
            editor.design.check_index(self.index)
        editor.select(self.index)


@dataclass(frozen=True, slots=True)
class SelectNext(Command):
    """Select the control point after the selected one, or the first."""

    @override
    def apply(self, lab: Lab) -> None:
        editor = lab.simulation.editor
        editor.select((-1 if editor.selected is None else editor.selected) + 1)
        if editor.selected is None:
            editor.select(0)


@dataclass(frozen=True, slots=True, eq=False)
class MovePoint(Command):
    """Drag a control point towards a target, as far as the path remains valid.

    Attributes:
        index: of the control point.
        target: new position, shape (2,), [m].
        finished: whether the drag ends here; a drag is undone as one edit.
    """

    index: int
    target: Array
    finished: bool = True

    @override
    def apply(self, lab: Lab) -> None:
        editor, target = lab.simulation.editor, point(self.target, 2)
        if editor.proposed is None or editor.selected != self.index:
            editor.finish()  # the drag of another point
            editor.select(self.index)
        editor.drag(self.index, target)
        if self.finished:
            finish(lab)


@dataclass(frozen=True, slots=True)
class EndMove(Command):
    """End the drag of a control point at its current position."""

    @override
    def apply(self, lab: Lab) -> None:
        finish(lab)


@dataclass(frozen=True, slots=True)
class NudgePoint(Command):
    """Move the selected control point by a step, [m]; with none, a step right advances time."""

    right: float
    up: float

    @override
    def apply(self, lab: Lab) -> None:
        index = lab.simulation.editor.selected
        if index is None:
            if self.right > 0:
                StepOnce().apply(lab)
            return
        design = lab.simulation.editor.design
        step = np.array([finite(self.right), finite(self.up)])
        MovePoint(index, design.points[index] + step).apply(lab)


@dataclass(frozen=True, slots=True)
class PlacePoint(Command):
    """Move the selected control point to coordinates, [m]; None leaves one unchanged."""

    first: float | None = None
    second: float | None = None

    @override
    def apply(self, lab: Lab) -> None:
        index, design = _selected(lab), lab.simulation.editor.design
        old = design.points[index]
        wanted = zip(old, (self.first, self.second), strict=True)
        new = [o if n is None else finite(n) for o, n in wanted]
        if not np.allclose(old, new, atol=1e-6):
            MovePoint(index, np.array(new)).apply(lab)


@dataclass(frozen=True, slots=True)
class AddPoint(Command):
    """Add a control point after the selected one."""

    @override
    def apply(self, lab: Lab) -> None:
        editor = lab.simulation.editor
        index = 0 if editor.selected is None else editor.selected
        commit(lab, editor.design.added(index))
        editor.select(min(index + 1, len(editor.design.points) - 1))


@dataclass(frozen=True, slots=True)
class RemovePoint(Command):
    """Remove the selected control point."""

    @override
    def apply(self, lab: Lab) -> None:
        commit(lab, lab.simulation.editor.design.removed(_selected(lab)))


@dataclass(frozen=True, slots=True, eq=False)
class DrawPath(Command):
    """Follow a freehand stroke.

    Attributes:
        stroke: shape (n, 2), [m].
    """

    stroke: Array

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def parts(self, lab: Lab) -> Iterator[Command]:
        stroke = np.asarray(self.stroke, dtype=float)
        if stroke.ndim != 2 or stroke.shape[1] != 2 or len(stroke) > MOST_STROKE_POINTS:
            raise CodedError("error.stroke_without_points")
        fit = _fits.submit(drawn, stroke)
        while not fit.done():
            yield Await(fit)
        yield FollowDesign(fit)


@dataclass(frozen=True, slots=True, eq=False)
class FollowDesign(Command):
    """Follow a stroke that has been fitted; no page sends it."""

    fit: Future[PathDesign]

    @override
    def apply(self, lab: Lab) -> None:
        design = self.fit.result()
        _draw(lab, design, lab.words.sentence(deviation_of(design.curve)))


@dataclass(frozen=True, slots=True, eq=False)
class FollowCurve(Command):
    """Follow a plane curve from a file; no page sends it.

    Attributes:
        curve: the path.
        remarks: what the user should know, in the page's language.
    """

    curve: Curve
    remarks: str = ""

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        _draw(lab, from_curve(self.curve), self.remarks)


@dataclass(frozen=True, slots=True)
class Undo(Command):
    """Undo the last edit of the path."""

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        words = lab.words
        lab.show_message("" if lab.simulation.editor.undo() else words("say.nothing_to_undo"))


@dataclass(frozen=True, slots=True)
class Redo(Command):
    """Redo the last undone edit of the path."""

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        words = lab.words
        lab.show_message("" if lab.simulation.editor.redo() else words("say.nothing_to_redo"))


def commit(lab: Lab, design: PathDesign) -> None:
    """Apply a complete edit; if it is refused, show why."""
    lab.simulation.editor.propose(design)
    _end(lab, "say.refused")


def _draw(lab: Lab, design: PathDesign, remark: str) -> None:
    """Let both robots draw a path from its beginning, and say what the user should know of it."""
    simulation = lab.simulation
    lab.lessons.judge(simulation)
    commit(lab, design)
    if simulation.editor.design is not design:
        return
    told, level = " ".join(filter(None, [remark, lab.message])), lab.message_level
    if lab.plant is None:
        simulation.editor.settle()
        simulation.restart()
    lab.show_message(told, level)


def finish(lab: Lab) -> None:
    """End the drag of a control point; if it went less far than wanted, show why.

    The invalid parts of the path are marked only during the drag.
    """
    _end(lab, "say.no_further")
    lab.simulation.editor.clear_faults()


def _end(lab: Lab, key: str) -> None:
    """Keep an edit. If it has faults, show the message of a key; else warn of ambiguities."""
    editor, words = lab.simulation.editor, lab.words
    before = editor.design
    editor.finish()
    if editor.design is not before:
        lab.simulation.note("path", editor.design.name)
    lab.clear_message()
    lab.return_to_present()
    if editor.faults:
        lab.show_message(words(key, reasons=_reasons(words, editor.faults)), "warning")
    elif editor.design is not before and (found := ambiguities(editor.blend.target)):
        lab.show_message(words("say.ambiguous", reasons=_reasons(words, found)), "warning")


def _reasons(words: Words, faults: Iterable[Fault]) -> str:
    return "; ".join(words.sentence(fault.reason) for fault in faults)


def _selected(lab: Lab) -> int:
    if lab.simulation.editor.selected is None:
        raise CodedError("say.select_first")
    return lab.simulation.editor.selected
