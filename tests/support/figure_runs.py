"""What a figure's page does, done by Python's own loops: the oracle of assets/web."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.figure_module import design_of
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.loop_states import single
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.path_editor import PathEditor
from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.page_functions import view_of
from onpath.models.closed_loop.simulation import FREE, brake_at, raised, settings_vector
from onpath.models.control.laws.registry import law_named
from onpath.models.control.settable import changed
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import path_distance
from onpath.models.systems.parameters import time_step

Act = tuple[str, Any]
"""("advance", ticks), ("hold", on), ("set", {name: value}), ("choose", path), ("reset", None),
("pull", metres to the right and up in the picture, or None), ("move", (point, its new place)),
("drop", None), ("change", (side, law))."""


LOOPS = LoopCache()
LOOPS.close()  # nothing is compiled


class PythonSide:
    """One robot of a figure."""

    def __init__(self, figure: FigureChoice, law: str, curve: Curve) -> None:
        self.figure, self.law = figure, law
        self.robot, self.parameters = figure.machine, figure.parameters
        self.begin(curve)

    def begin(self, curve: Curve, edited: bool = False) -> None:
        """Begin anew on a path; on an edited one at `Curve.begin`, to the last bit."""
        self.given, self.curve = curve, raised(curve, self.figure.parameters)
        self.kernel = self.figure.kernel(self.law, curve)
        self.loop = InterpretedLoop(self.kernel)
        self.state, self.push = self.figure.start(self.law, curve), FREE
        if edited:
            for name in ("theta", "theta_ref"):
                self.state[self.kernel.state.slices[name]] = curve.begin
        self.row = np.zeros(self.kernel.log.size)
        self.y = self.robot.endpoint(self.kernel.state.unpack(self.state)["q"])
        self.grabbed = self.y

    def advance(self, ticks: int) -> None:
        """Simulate."""
        settings = settings_vector(self.robot, self.kernel, self.parameters, self.curve, self.push)
        self.state, rows = self.loop.run(self.state, settings, self.curve.table(), ticks)
        self.row = rows[-1]
        self.y = self.kernel.log.unpack(self.row)["y"]

    def change(self, law: str) -> None:
        """Go on under another law, as `ClosedLoopRun.change_law`."""
        given = self.robot, "right", self.law, self.parameters, self.curve
        run = ClosedLoopRun(LOOPS, *given)
        run.slot = single(self.state, run.row, 0.0, 0.0)
        run.change_law(law, self.parameters, self.curve, self.push)
        self.law, self.state = law, run.state
        self.kernel = self.figure.kernel(law, self.given)
        self.loop = InterpretedLoop(self.kernel)

    def hold(self, on: bool) -> None:
        """Hold it where it is, along its path."""
        fields = self.kernel.state.unpack(self.state)
        y, theta = self.robot.endpoint(fields["q"]), float(fields["theta"][0])
        brake = brake_at(self.robot, self.curve, y, theta) if on else None
        self.push = replace(self.push, hold=brake)

    def pull(self, by: tuple[float, float] | None) -> None:
        """Pull its tip by a way in the picture of a robot in the vertical plane."""
        assert np.array(view_of(self.robot)[0]).tolist() == [[1, 0, 0], [0, 0, 1]]
        if by is None or self.push.hand is None:
            self.grabbed = self.y
        self.push = replace(self.push, hand=None if by is None else self.grabbed + np.array(by))

    def distance(self) -> float:
        """From the end-point of the last row to the path, by global search, [m]."""
        return float(path_distance(self.robot.frame, self.curve, self.y[None])[0])

    def gap(self) -> float:
        """From the end-point of the last row to the point of the path that its law knows, [m]."""
        aim = law_named(self.law).aim
        theta = self.kernel.log.unpack(self.row)[aim]
        return float(np.linalg.norm(self.robot.frame.lift(self.curve.at(theta)) - self.y))


class PythonFigure:
    """All robots of a figure, which starts on its first path."""

    def __init__(self, figure: FigureChoice) -> None:
        self.figure, self.held = figure, False
        self.editors = [
            PathEditor(figure.machine, design_of(*path)) for path in figure.paths.items()
        ]
        self.editor, self.curve = self.editors[0], next(iter(figure.paths.values()))
        self.sides = [PythonSide(figure, law, self.curve) for law in figure.laws]

    def act(self, act: Act) -> None:
        """Do what a reader does."""
        what, value = act
        if what == "advance":
            self.editor.advance(value * time_step(self.figure.parameters))
        if what in ("advance", "hold", "set", "pull", "change"):
            for index, side in enumerate(self.sides):
                self._act_on(side, index, what, value)
        elif what == "move":
            with suppress(CodedError):  # there is no such curve
                self.editor.drag(value[0], np.array(value[1]))
        elif what == "drop":
            self.editor.finish()
        else:
            self.editor = self.editors[value] if what == "choose" else self.editor
            self._begin()
        self.held = value if what == "hold" else self.held

    def _act_on(self, side: PythonSide, index: int, what: str, value: Any) -> None:
        if what == "advance":
            side.curve = self.editor.curve
            side.advance(value)
        elif what == "hold" and value != self.held:
            side.hold(value)
        elif what == "set":
            for name, number in value.items():
                side.parameters = changed(side.parameters, name, number)
        elif what == "pull":
            side.pull(value)
        elif what == "change" and index == value[0]:
            side.change(self.figure.every_law[value[1]])

    def _begin(self) -> None:
        self.editor.finish()
        self.editor.settle()
        self.held = False
        for side in self.sides:
            side.begin(self.editor.curve, self.editor.design.name == "edited")

    def rows(self) -> list[Array]:
        """The last row of each log."""
        return [side.row for side in self.sides]
