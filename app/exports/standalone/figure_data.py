"""A figure as plain data: what its page shows, and the number that each field sets."""

from __future__ import annotations

import gzip
import math
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import casadi as ca
import msgspec
import numpy as np

from onpath.app.exports.standalone.drawings import drawings_data
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.figure_form import figure_form
from onpath.app.exports.standalone.figure_module import (
    design_of,
    figure_module,
    kind_name,
)
from onpath.app.exports.standalone.figure_words import figure_words
from onpath.app.exports.standalone.loop_variants import variants_of
from onpath.app.exports.standalone.setting_numbers import SettingNumbers, setting_numbers
from onpath.app.lab.path_editor import BLEND, HALVINGS
from onpath.app.lab.plot_rows import row_data
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.view.captions import FULL, OFF, RETURNS
from onpath.app.view.log_curves import fields_of_efforts, fields_on_path, times_of
from onpath.app.view.notes import NEVER, alpha_note
from onpath.lessons.labels import path_label
from onpath.lessons.sides import law_text, law_titles
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.page_functions import (
    front_of,
    page_functions,
    stop_reasons,
)
from onpath.models.closed_loop.simulation import raised
from onpath.models.control.bend_limit import PER_PIECE
from onpath.models.control.laws.own import short_name
from onpath.models.control.laws.registry import law_named
from onpath.models.control.settable import specs, value_of
from onpath.models.control.sides import RIGHT, SIDES
from onpath.models.paths import curve_fit
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.curves import HARMONICS, Curve
from onpath.models.paths.drawing_design import DrawingDesign
from onpath.models.paths.path_checks import DRAWING_CHECKS, FINER, POINT_CHECKS, SAMPLES
from onpath.models.paths.path_design import PathDesign
from onpath.models.paths.spline_curves import GRAIN, SplineCurve
from onpath.models.robot_files.xml_elements import shown
from onpath.models.standalone.curve_scans import GRID, REFINEMENTS
from onpath.models.standalone.edit import ROW
from onpath.models.systems.efforts import efforts
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameters import look_ahead_time, time_step
from onpath.models.systems.robots import Robot


def figure_numbers(figure: FigureChoice) -> dict[str, Any]:
    """What takes long to compute, and is the same in all languages."""
    return {
        "paths": [_path(figure, name, curve) for name, curve in figure.paths.items()],
        "critical": _critical(figure),
        "logged": _logged(figure),
        "box": _box(figure),
        "poles": {
            "interval": 1 / figure.parameters.control_rate,
            "ahead": look_ahead_time(figure.parameters),
            "delay": figure.parameters.delay,
            "position": figure.parameters.task == "position",
        },
        "module": b64encode(gzip.compress(figure_module(figure), mtime=0)).decode(),
    }


def figure_data(
    figure: FigureChoice, words: Words, numbers: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """The data of a figure for JSON: numbers, texts, and the module as Base64.

    Args:
        numbers: what `figure_numbers` gives, if it has been called before.
    """
    return {
        **common_data(figure, words, numbers or figure_numbers(figure)),
        "form": figure_form(figure, words),
        "changes": changes_data(figure, setting_numbers(figure, {})),
        "drawings": drawings_data(figure, (), (), words),
        "controls": figure.controls,
    }


def common_data(figure: FigureChoice, words: Words, numbers: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a figure without what its reader may do."""
    robot, curves = figure.machine, figure.paths
    first = next(iter(curves.values()))
    kernel = figure.kernel(figure.laws[0], first)
    return {
        "language": words.language,
        "words": figure_words(words),
        "dt": time_step(figure.parameters),
        "sizes": _sizes(figure, kernel),
        "state": _places(kernel.state, ("q", "theta", "theta_ref")),
        "settings": _places(kernel.settings, _SET),
        "log": _places(
            kernel.log, ("q", "v", "y", "theta", "theta_ref", "far", "integral_used", *PLOTTED)
        ),
        "sides": _sides(figure),
        "laws": _laws(figure, words),
        "loops": loops_data(figure),
        "paths": [
            {"label": path_label(name, words), **path}
            for name, path in zip(curves, numbers["paths"], strict=True)
        ],
        "front": front_of(robot).tolist(),
        "box": numbers["box"],
        "off": OFF,
        "returns": RETURNS,
        "full": FULL,
        "strip": robot.drawing.strip,
        "rows": msgspec.to_builtins(
            row_data(
                sample_layout(robot).fields,
                figure.parameters.across == LEVEL_SET,
                words,
                guesses=figure.entry.guesses,
                motors=robot.system.motor_units,
            )
        ),
        "logged": numbers["logged"],
        "efforts": _efforts(robot),
        "poles": numbers["poles"]
        | {"gains": [kernel.settings.slices[f"K{i}"].start for i in range(1, 6)]},
        "critical": _limits(figure, numbers["critical"], words),
        "fit": FIT,
        "edit": _EDIT,
        "module": numbers["module"],
    }


OUTLINE = 241
"""Points of the outline of a series."""
POSES = 13
"""Places on a path, from -π to π, at which the critical α is looked for; it varies slowly."""
PLOTTED = ("speed", "theta_rate", "xi", "xi_rate", "u", "force")
"""Fields of a log row that are plotted, besides those that are drawn."""
NUDGE = 0.001  # [m], as app/view/keys.py has it
FIT = {
    "samples": curve_fit.SAMPLES,
    "fine": curve_fit.FINE,
    "harmonics": HARMONICS,
    "closest": curve_fit.APART,
    "shortest": curve_fit.SHORTEST,
}
_EDIT = {
    "row": ROW,
    "refinements": REFINEMENTS,
    "turns": PER_PIECE,
    "grain": GRAIN,
    "halvings": HALVINGS,
    "blend": BLEND,
    "nudge": NUDGE,
}
"""Sizes of vectors and numbers of steps in models/standalone; and as in the lab, the halvings of a
refused move, the duration of a blend, [s], and the step of a key, [m]."""
_SET = (
    *("hold_active", "hold_anchor", "hold_tangent", "hold_normal"),
    *("hand_active", "hand_target"),
)


def _places(layout: Any, names: tuple[str, ...]) -> dict[str, list[int]]:
    """Name -> [index of the first number in a flat vector, how many there are]."""
    return {name: [(s := layout.slices[name]).start, s.stop - s.start] for name in names}


def _sizes(figure: FigureChoice, kernel: Kernel) -> dict[str, int]:
    system = figure.machine.system
    bars, joints = figure.machine.skeleton(system.q, ca.SX(1))
    modes = figure.machine.extras.get("modes", ca.SX(0, 1)).numel()
    return {
        "p": system.p,
        "n": system.n,
        "rigid": system.n - modes,
        "log": kernel.log.size,
        "bars": bars.shape[1] // 2,
        "joints": joints.shape[1],
    }


def _efforts(robot: Robot) -> list[dict[str, Any]]:
    """The torque limits that the robot's file states, with the numbers of their motors."""
    limits = efforts(robot)
    if limits is None or robot.chain is None:
        return []
    return [
        {"motor": i, "joint": shown(joint.name), "most": joint.effort, "unit": joint.unit}
        for i, joint in enumerate(robot.chain.joints)
        if math.isfinite(joint.effort)
    ]


def _critical(figure: FigureChoice) -> list[float]:
    """The least critical α of a robot with a flexible link on each path, if α changes."""
    link, robot, own = figure.entry.flexible_link, figure.machine, figure.parameters
    if link is None or not figure.flexes:
        return []
    theta = np.linspace(-np.pi, np.pi, POSES)
    rest = [
        robot.rest(robot.frame.lift(raised(curve, own).at(theta)))[:, : link.joints]
        for curve in figure.paths.values()
    ]
    return [min(link.critical_alpha(own, joints) for joints in poses) for poses in rest]


def _logged(figure: FigureChoice) -> dict[str, Any] | None:
    """The log of a real arm: what does not depend on a path, and what does, for each path."""
    log, own = figure.logged, figure.parameters
    if log is None:
        return None
    frame, is_level_set = figure.machine.frame, own.across == LEVEL_SET
    return {
        "name": log.file,
        "times": times_of(log.motion),
        "fields": fields_of_efforts(log.motion),
        "paths": [
            fields_on_path(log.motion, frame, raised(curve, own), is_level_set=is_level_set)
            for curve in figure.paths.values()
        ],
    }


def _limits(figure: FigureChoice, critical: Sequence[float], words: Words) -> list[dict[str, Any]]:
    """For each path the critical α, and what is said below it and beyond it."""
    if not critical:
        return []
    values = value_of(figure.parameters, "modes"), value_of(figure.parameters, "zeta")
    return [
        {
            "limit": min(limit, NEVER),
            "notes": [
                alpha_note(alpha, limit, *values, words, key="flexible.critical_on_path")
                for alpha in (-NEVER, NEVER)
            ],
        }
        for limit in critical
    ]


def _sides(figure: FigureChoice) -> list[dict[str, Any]]:
    names = SIDES if len(figure.laws) > 1 else (RIGHT,)
    return [
        {
            "law": figure.every_law.index(law),
            "side": SIDES.index(name),
        }
        for name, law in zip(names, figure.laws, strict=True)
    ]


def _laws(figure: FigureChoice, words: Words) -> list[dict[str, Any]]:
    titles, curve = law_titles(figure.every_law, words), next(iter(figure.paths.values()))
    return [
        {
            "key": short_name(law),
            "title": titles[law],
            "text": law_text(law, words),
            "aim": law_named(law).aim,
            "byClock": law_named(law).by_clock,
            "linear": law_named(law).linear,
            "stops": stop_texts(figure, law, curve, "alpha" in figure.sliders, words),
        }
        for law in figure.every_law
    ]


def stop_texts(
    figure: FigureChoice, law: str, curve: Curve, any_output: bool, words: Words
) -> list[str]:
    """The reasons why a robot under a law may stop, in the order of the page's `fault`.

    Args:
        any_output: whether the output may change; the reasons then hold for every output.
    """
    kernel, start = figure.kernel(law, curve), figure.start(law, curve)
    q = None if any_output else kernel.state.unpack(start)["q"]
    return [*map(words.sentence, stop_reasons(figure.machine, figure.parameters, q, law))]


def _path(figure: FigureChoice, name: str, curve: Curve) -> dict[str, Any]:
    path, design = raised(curve, figure.parameters), design_of(name, curve)
    kernel = figure.kernel(figure.laws[0], curve)
    drawn = path if isinstance(path, SplineCurve) else None
    return {
        "kind": kind_name(figure, curve),
        "closed": curve.closed,
        "dimension": path.dimension,
        "doubts": [each.reason.code for each in ambiguities(path)],
        "begin": path.begin,
        "pieces": drawn.pieces if drawn else 0,
        "grid": path.grid if drawn else GRID,
        "raised": drawn.raised if drawn else (),
        "table": (drawn.points.ravel() if drawn else path.table()).tolist(),
        "checks": tuple(DRAWING_CHECKS if drawn else POINT_CHECKS),
        "samples": FINER * path.grid if drawn else SAMPLES,
        "turning": kernel.settings.slices["turning"].start if drawn else None,
        "outline": [] if drawn else _outline(figure, curve, path),
        "states": [figure.start(law, curve).tolist() for law in figure.every_law],
        "settings": figure.settings(figure.planned, curve).tolist(),
        "points": design.points.tolist() if figure.edits else [],
        "handles": _handles(design) if figure.edits else [],
    }


def _handles(design: PathDesign) -> list[dict[str, Any]]:
    """θ of a drawing's handles, and how far each control point moves with one; none of a series."""
    if not isinstance(design, DrawingDesign):
        return []
    return [
        {"theta": at, "weights": design.weights(index).tolist()}
        for index, at in enumerate(design.theta.tolist())
    ]


def _outline(figure: FigureChoice, curve: Curve, path: Curve) -> list[float]:
    """Points of a series in the picture, from which also a page without loops tells a circle."""
    robot, theta = figure.machine, np.linspace(-np.pi, np.pi, OUTLINE)
    place = page_functions(robot, figure.kind(figure.laws[0], curve))["place"]
    return _rounded(place(robot.frame.lift(path.at(theta)).T).full().T)


def changes_data(figure: FigureChoice, numbers: SettingNumbers) -> dict[str, Any]:
    """What may change on the page: first values, and where they act."""
    values = {name: value_of(figure.parameters, name) for name in sorted(numbers.names)}
    tables = [asdict(table) for table in numbers.tables]
    return {"values": values, "indices": numbers.indices, "tables": tables}


def loops_data(figure: FigureChoice) -> dict[str, Any]:
    """The parameters that decide which variant of a loop runs."""
    variants, known = variants_of(figure), specs(figure.parameters)
    classes = {name: list(known[name].options) for name in variants.names}
    return {"classes": classes, "keys": dict(variants.keys)}


def _box(figure: FigureChoice) -> list[float]:
    """Bounds of the picture: left, right, bottom, top, [m], with a margin around the robots."""
    robot, corners = figure.machine, list[Array]()
    functions = page_functions(
        robot, figure.kind(figure.laws[0], next(iter(figure.paths.values())))
    )
    for curve in figure.paths.values():
        for theta in np.linspace(-np.pi, np.pi, 24):
            y = robot.frame.lift(raised(curve, figure.parameters).at(np.array(theta)))
            corners += [np.array(part) for part in functions["picture"](robot.rest(y))]
    points = np.concatenate(corners, axis=1)
    low, high = points.min(axis=1) - 0.04, points.max(axis=1) + 0.04
    return [float(low[0]), float(high[0]), float(low[1]), float(high[1])]


def _rounded(points: Array) -> list[float]:
    """The points as a flat list, rounded to a hundredth of a millimetre."""
    return (np.round(points.ravel(), 5) + 0.0).tolist()
