"""A figure as plain data: what its page shows, and which widget sets which number."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

import casadi as ca
import numpy as np

from onpath.app.common import palette
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.scene.captions import OFF
from onpath.lessons.benches import bench_titles, law_text
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import (
    GRID,
    grid_of,
    measurements,
    page_functions,
)
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.wasm_loop import wasm_of
from onpath.models.control.benches import BENCHES, RIGHT
from onpath.models.control.laws.registry import law_named
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import specs, time_step

OUTLINE = 241  # points of a path as it is drawn
WORDS = (
    *("run.hold_both", "run.hold", "run.let_both_go", "run.let_go", "run.hold_hint"),
    *("run.run", "run.pause", "run.run_hint", "run.step", "run.reset", "key.reset", "key.right"),
    *("standalone.path", "standalone.plot"),
)
_CAPTIONS = ("torn_off", "held", "waits", "pulled", "chases", "off", "stopped")


def figure_data(figure: FigureChoice, words: Words, title: str = "") -> dict[str, Any]:
    """The data of a figure for JSON: numbers, texts, and the module as Base64.

    Args:
        title: above the figure; may be empty.
    """
    robot, curves = figure.machine, figure.paths
    first = next(iter(curves.values()))
    kernel = figure.kernel(figure.laws[0], first)
    return {
        "language": words.language,
        "title": title,
        "words": _words(words),
        "dt": time_step(figure.parameters),
        "sizes": _sizes(figure, kernel),
        "state": _places(kernel.state, ("q", "theta")),
        "settings": _places(kernel.settings, _SET),
        "log": _places(kernel.log, ("q", "v", "y", "theta", "theta_ref", "force")),
        "benches": _benches(figure, words),
        "paths": [_path(figure, name, curve, words) for name, curve in curves.items()],
        "sliders": [slider_data(figure, name, words) for name in figure.sliders],
        "controls": figure.controls,
        "box": _box(figure),
        "off": OFF,
        "strip": robot.drawing.strip,
        "colours": {n.lower(): getattr(palette, n).hex for n in ("PATH", "FORCE", "STEEL", "INK")},
        "module": b64encode(_module(figure)).decode(),
    }


_SET = (
    *("hold_active", "hold_anchor", "hold_tangent", "hold_normal"),
    *("hand_active", "hand_target"),
)


def _words(words: Words) -> dict[str, str]:
    said = {key: words(key) for key in WORDS}
    said |= {f"caption.{kind}": words(f"caption.{kind}", mm="{mm}") for kind in _CAPTIONS}
    said["caption.spoken"] = words("caption.spoken", robot="{robot}", caption="{caption}")
    said["standalone.scene"] = words("standalone.scene", law="{law}")
    said["point"] = words("report.point")
    return said


def _places(layout: Any, names: tuple[str, ...]) -> dict[str, list[int]]:
    """Name -> (place of the first number, how many) in a flat vector."""
    return {name: [(s := layout.slices[name]).start, s.stop - s.start] for name in names}


def _sizes(figure: FigureChoice, kernel: Kernel) -> dict[str, int]:
    system = figure.machine.system
    bars, joints = figure.machine.skeleton(system.q, ca.SX(1))
    return {
        "p": system.p,
        "n": system.n,
        "log": kernel.log.size,
        "bars": bars.shape[1] // 2,
        "joints": joints.shape[1],
    }


def _benches(figure: FigureChoice, words: Words) -> list[dict[str, Any]]:
    names = BENCHES if len(figure.laws) > 1 else (RIGHT,)
    laws: dict[str, str] = dict(zip(names, figure.laws, strict=True))
    titles = bench_titles(laws, words)
    return [
        {
            "title": titles[name],
            "text": law_text(law, words),
            "colour": palette.OF_BENCH[name].hex,
            "dark": palette.OF_BENCH[name].toward(palette.INK, 0.45).hex,
            "pale": palette.OF_BENCH[name].toward(palette.WHITE, 0.6).hex,
            "aim": law_named(law).aim,
            "byClock": law_named(law).by_clock,
        }
        for name, law in laws.items()
    ]


def _path(figure: FigureChoice, name: str, curve: Curve, words: Words) -> dict[str, Any]:
    robot, path = figure.machine, raised(curve, figure.parameters)
    theta = np.linspace(-np.pi, np.pi, OUTLINE)
    place = page_functions(robot, figure.kind(figure.laws[0], curve))["place"]
    outline = place(robot.frame.lift(path.at(theta)).T).full()
    return {
        "label": words.get(f"path.{name}", name),
        "kind": _kind_name(figure, curve),
        "table": path.table().tolist(),
        "grid": grid_of(robot, path.at(path.sample(GRID))).ravel().tolist(),
        "outline": _rounded(outline.T),
        "states": [figure.start(law, curve).tolist() for law in figure.laws],
        "settings": [figure.settings(law, curve).tolist() for law in figure.laws],
    }


def slider_data(figure: FigureChoice, name: str, words: Words) -> dict[str, Any]:
    """A slider: its words, its range, and the place of its number in the settings."""
    spec = specs(type(figure.parameters))[name]
    kernel = figure.kernel(figure.laws[0], next(iter(figure.paths.values())))
    unit = words.get(f"parameter.{name}.unit", spec.unit)
    place = kernel.settings.slices.get(name)
    return {
        "label": words.get(f"parameter.{name}.label", spec.label),
        "unit": unit,
        "help": words.get(f"parameter.{name}.help", spec.help),
        "low": spec.low,
        "high": spec.high,
        "step": spec.step,
        "value": getattr(figure.parameters, name),
        "place": place.start if place else -1,
    }


def _box(figure: FigureChoice) -> list[float]:
    """What the picture shows: left, right, bottom, top, [m]; robots may be off a path."""
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


def _kinds(figure: FigureChoice) -> dict[tuple[Kind, ...], Curve]:
    """The kinds of the benches' loops, with a path that needs them."""
    return {
        tuple(figure.kind(law, curve) for law in figure.laws): curve
        for curve in figure.paths.values()
    }


def _kind_name(figure: FigureChoice, curve: Curve) -> str:
    own = tuple(figure.kind(law, curve) for law in figure.laws)
    return str(list(_kinds(figure)).index(own))


def _module(figure: FigureChoice) -> bytes:
    """Loops and functions, named as the page calls them: "loop0.0", "distance.0"."""
    functions, loops = dict[str, ca.Function](), dict[str, Kernel]()
    for curve in _kinds(figure).values():
        name = _kind_name(figure, curve)
        for number, law in enumerate(figure.laws):
            loops[f"loop{number}.{name}"] = figure.kernel(law, curve)
        own = page_functions(figure.machine, figure.kind(figure.laws[0], curve))
        own |= measurements(figure.machine, figure.parameters)
        functions |= {f"{each}.{name}": function for each, function in own.items()}
    return wasm_of(functions, loops)


def _rounded(points: Array) -> list[float]:
    """Flat, to a hundredth of a millimetre."""
    return (np.round(points.ravel(), 5) + 0.0).tolist()
