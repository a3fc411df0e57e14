"""What a figure draws besides its robots: the same as the scene of the lab, seen from the side.

What moves is computed on the page by CasADi functions, from the same expressions as in app/scene;
what stays is data.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from typing import Any

import casadi as ca
import numpy as np

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.scene.mass_nodes import LARGEST, OF_A_KILOGRAM, SIDES
from onpath.app.scene.rank_nodes import map_opacity, rank_picture
from onpath.app.scene.robot_labels import PAST, SUBSCRIPTS
from onpath.app.scene.stage import PlanePicture
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.scene.tube_nodes import ALONG, LINES, tube_sizes
from onpath.app.view.label_geometry import axes_of, label_function
from onpath.lessons.action_schema import SceneMark
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import lift_of, page_functions, placed, view_of
from onpath.models.closed_loop.simulation import raised
from onpath.models.control.effective_mass import mobility_of
from onpath.models.paths.curves import Curve
from onpath.models.systems.robots import Robot

SWITCHES = ("labels", "tube", "grid", "rank", "errors", "mass")
"""Drawings that a reader may switch."""


def drawing_functions(figure: FigureChoice, kind: Kind) -> dict[str, ca.Function]:
    """The functions of a figure's drawings on paths of a kind; points are those of the picture.

    labels: q -> places of the names, then both ends of all lines, (2, k + 2 m)
    ellipse: q -> points of the ellipse of the effective mass, (2, SIDES + 1)
    beside: (values, ξ) -> the point at a distance ξ to the left of the path, (2, 1)
    enlarged: (q, factor) -> `picture` of `page_functions` with a larger deflection
    """
    robot, drawn = figure.machine, {*figure.drawings}
    q, (seen, offset) = robot.system.q, view_of(robot)
    bars, _ = robot.skeleton(q, ca.SX(1))
    functions = dict[str, ca.Function]()
    if "labels" in drawn:
        labels = label_function(robot, bars.shape[1] // 2).function
        points = labels(bars, bars[:, -1])
        functions["labels"] = ca.Function("labels", [q], [ca.densify(seen @ points)])
    if "mass" in drawn:
        functions["ellipse"] = _ellipse(figure, kind)
    if drawn & {"tube", "grid"}:
        values, xi = ca.SX.sym("values", kind.value_rows), ca.SX.sym("xi")
        sigma, first, *_ = ca.vertsplit(values, kind.dimension)
        along = first / ca.norm_2(first)
        point = sigma + xi * ca.vertcat(-along[1], along[0])
        there = placed(robot, lift_of(robot, kind)(point, False), seen) + offset
        functions["beside"] = ca.Function("beside", [values, xi], [ca.densify(there)])
    if "larger" in drawn:
        factor = ca.SX.sym("factor")
        larger = [ca.densify(seen @ points) for points in robot.skeleton(q, factor)]
        functions["enlarged"] = ca.Function("enlarged", [q, factor], larger)
    return functions


def _ellipse(figure: FigureChoice, kind: Kind) -> ca.Function:
    """The function "ellipse" of a robot with rigid links; see `MassNodes`."""
    robot, q = figure.machine, figure.machine.system.q
    turn = np.linspace(0, 2 * np.pi, SIDES + 1)
    directions = np.column_stack([np.cos(turn), np.sin(turn)])
    lifted = (robot.frame.lift(directions) - robot.frame.lift(np.zeros(2))).T
    mobility = mobility_of(robot)(q, ca.SX(ca.DM(robot.plant(figure.parameters))))
    masses = 1 / ca.sum1(lifted * (mobility @ lifted))
    radii = ca.fmin(OF_A_KILOGRAM * ca.sqrt(masses), LARGEST)
    functions, (seen, _) = page_functions(robot, kind), view_of(robot)
    middle = functions["place"](functions["tip"](q))
    around = placed(robot, ca.SX(ca.DM(lifted)) * ca.repmat(radii, lifted.shape[0], 1), seen)
    points = ca.repmat(middle, 1, SIDES + 1) + around
    return ca.Function("ellipse", [q], [ca.densify(ca.cse(points))])


def drawings_data(
    figure: FigureChoice, shown: Iterable[str], marks: Sequence[SceneMark], words: Words
) -> dict[str, Any]:
    """What the page needs for the drawings of a figure.

    Args:
        shown: those that are shown at first.
        marks: texts and arrows.
    """
    robot, drawn = figure.machine, figure.drawings
    data: dict[str, Any] = {
        "switches": [
            {"name": name, "label": words(f"show.{name}"), "help": words(f"show.{name}_hint")}
            for name in SWITCHES
            if name in drawn
        ],
        "shown": [*shown],
        "marks": [_mark(robot, mark) for mark in marks],
    }
    if "labels" in drawn:
        data["labels"] = _labels(robot)
    if {"tube", "grid"} & {*drawn}:
        data["tubes"] = [_tube(figure, curve) for curve in figure.paths.values()]
    if "rank" in drawn:
        stage = stage_of(robot)
        picture = rank_picture(stage, robot, figure.parameters)
        data["rank"] = _image(robot, picture) | {"opacity": map_opacity(stage)}
    if "zone" in drawn:
        data["zone"] = _image(robot, stage_of(robot).zone())
    return data


def _labels(robot: Robot) -> dict[str, Any]:
    bars = robot.skeleton(robot.system.q, ca.SX(1))[0].shape[1] // 2
    axes, seen = axes_of(robot), robot.seen
    names = list[dict[str, Any]]()
    for number, (begin, end) in enumerate(axes, 1):
        direction = (end - begin) / np.linalg.norm(end - begin)
        place = seen @ (end + PAST * direction)
        names.append({"text": f"y{SUBSCRIPTS[number]}", "place": _flat(place)})
    labels = label_function(robot, bars)
    return {
        "names": labels.names,
        "points": labels.function.size2_out(0),
        "axes": [[_flat(seen @ begin), _flat(seen @ end)] for begin, end in axes],
        "axisNames": names,
    }


def _tube(figure: FigureChoice, curve: Curve) -> dict[str, Any]:
    sizes = tube_sizes(raised(curve, figure.parameters))
    return {
        "shown": sizes.shown,
        "across": [*sizes.across.tolist()],
        "along": ALONG,
        "lines": LINES,
    }


def _image(robot: Robot, picture: PlanePicture) -> dict[str, Any]:
    """A picture in the path's plane: its lower left corner, and the ways to the right and up."""
    (left, bottom), (right, top) = picture.low, picture.high
    corner, across, upward = (
        _seen(robot, np.array(z)) for z in ((left, bottom), (right, bottom), (left, top))
    )
    return {
        "src": f"data:image/png;base64,{b64encode(picture.png).decode()}",
        "corner": _flat(corner),
        "right": _flat(across - corner),
        "up": _flat(upward - corner),
    }


def _mark(robot: Robot, mark: SceneMark) -> dict[str, Any]:
    place = {"at": _flat(_seen(robot, 1e-3 * np.array(mark.at))), "text": mark.text}
    if mark.tail is not None:
        place["from"] = _flat(_seen(robot, 1e-3 * np.array(mark.tail)))
    return place


def _seen(robot: Robot, z: Array) -> Array:
    """A point of the path's plane in the picture, shape (2,), [m]."""
    return robot.seen @ robot.position(robot.frame.lift(z))


def _flat(point: Array) -> list[float]:
    return (np.round(point, 5) + 0.0).tolist()
