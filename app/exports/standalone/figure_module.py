"""The WebAssembly module of a figure: its loops, and everything else that its page computes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import casadi as ca

from onpath.app.exports.standalone.drawings import drawing_functions
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.loop_variants import loops_of
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import measurements, page_functions
from onpath.models.closed_loop.reference_speed import speed_function
from onpath.models.closed_loop.wasm_loop import Scan, wasm_of
from onpath.models.paths.curve_fit import control_points
from onpath.models.paths.curves import Curve
from onpath.models.paths.drawing_design import from_curve
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.standalone.curve_scans import beyond_function, curve_scans
from onpath.models.standalone.edit import edit_functions, edit_scans
from onpath.models.standalone.states import begin_function, change_function

Parts = tuple[dict[str, ca.Function], dict[str, Scan]]


def design_of(name: str, curve: Curve) -> PathDesign:
    """A path of a figure, with the control points that it would have in a lab."""
    known = presets()
    if name in known and known[name].curve is curve:
        return known[name]
    if isinstance(curve, SplineCurve):
        return from_curve(curve)
    return PathDesign(name, curve, control_points(curve, 10 if curve.closed else 6))


def kind_name(figure: FigureChoice, curve: Curve) -> str:
    """The name of a path's kind, a suffix of the functions for such paths, as in "distance.0"."""
    kinds = tuple(figure.kind(law, curve) for law in figure.every_law)
    return str(list(_kinds(figure)).index(kinds))


def figure_module(figure: FigureChoice) -> bytes:
    """Loops, functions and scans, named as the page calls them: "loop0.0" is the first law's."""
    functions, scans, loops = dict[str, ca.Function](), dict[str, Scan](), dict[str, Kernel]()
    for curve in _kinds(figure).values():
        name, kind = kind_name(figure, curve), figure.kind(figure.laws[0], curve)
        kernels = [figure.kernel(law, curve) for law in figure.every_law]
        shown = {**page_functions(figure.machine, kind), **_changes(figure, kernels)}
        shown |= measurements(figure.machine, figure.parameters)
        shown |= drawing_functions(figure, kind)
        if kind.spline:
            shown["pace"] = speed_function(kernels[0])
        if not kind.closed:
            shown["beyond"] = beyond_function(figure.machine, kind)
        edited, steps = _editing(figure, kind, kernels)
        steps |= curve_scans(figure.machine, kind)
        loops |= {f"{each}.{name}": kernel for each, kernel in loops_of(figure, curve).items()}
        functions |= {f"{each}.{name}": function for each, function in (shown | edited).items()}
        scans |= {f"{each}.{name}": scan for each, scan in steps.items()}
    return wasm_of(functions, loops, scans)


def _changes(figure: FigureChoice, kernels: Sequence[Kernel]) -> dict[str, ca.Function]:
    """Functions that change each law to each other one, if readers or scripts choose laws."""
    return {
        f"change{i}to{j}": change_function(before, after, figure.every_law[j])
        for (i, before), (j, after) in permutations(enumerate(kernels), 2)
        if figure.choices or figure.scripted
    }


def _editing(figure: FigureChoice, kind: Kind, kernels: Sequence[Kernel]) -> Parts:
    """Functions and scans that edit paths of a kind, if readers may drag their points."""
    robot = figure.machine
    if not figure.edits:
        return {}, {}
    functions, scans = edit_functions(robot, kind), edit_scans(robot, kind)
    for i, kernel in enumerate(kernels):
        functions[f"begin{i}"] = begin_function(robot, kind, kernel)
    return functions, scans


def _kinds(figure: FigureChoice) -> dict[tuple[Kind, ...], Curve]:
    """The kinds of the laws' loops on a path -> such a path."""
    return {
        tuple(figure.kind(law, curve) for law in figure.every_law): curve
        for curve in figure.paths.values()
    }
