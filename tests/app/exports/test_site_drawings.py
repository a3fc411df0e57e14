"""What a site draws besides the robots is what the scene of the lab draws, to 0.1 mm."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from onpath.app.exports.site.step_figures import figure_of, step_figure
from onpath.app.exports.standalone.drawings import SWITCHES, drawings_data
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.scene.mass_nodes import SIDES, ellipse
from onpath.app.scene.tube_nodes import tube_shape
from onpath.app.view.label_geometry import label_function
from onpath.lessons.words import ENGLISH
from onpath.models.arrays import Array
from onpath.models.control.bend_limit import speed_on
from onpath.models.paths.path_design import presets
from onpath.models.systems.robots import Robot
from tests.support.built_in import built_in_course
from tests.support.cases import drawn
from tests.support.drawings import letters
from tests.support.node_page import judging_page
from tests.support.site_scripts import answer_of, needs_node

pytestmark = needs_node

TENTH = 1e-4  # [m]
PAGE = """
import { Drawings } from "./parts/drawings"
import { Kernels } from "./simulation/kernels"
import { Simulation } from "./simulation/simulation"
import { readFileSync } from "node:fs"

const { figure, pull, larger } = JSON.parse(readFileSync(0, "utf8"))
const simulation = new Simulation(figure, await Kernels.from(figure.module))
simulation.pull(pull)
simulation.advance(700)
const side = simulation.sides[1], { followed } = simulation
const row = side.logged(), { q } = figure.log
const drawn = { q: [...row.slice(q[0], q[0] + q[1])] }
const { drawings } = figure
if (larger) drawn.larger = [...side.picture(larger)]
else {
    drawn.labels = side.drawn("labels", drawings.labels.points)
    drawn.ellipse = side.drawn("ellipse", 49)
    const { edges, across, along } = new Drawings(drawings, () => {}).lines(followed, 0)
    drawn.tube = { edges, across, along }
}
console.log(JSON.stringify(drawn))
"""

SHAPES = "([name, seen]) => shapesOf(name, seen)"


def drawn_on_page(robot: str, path: str, drawings: tuple[str, ...], **more: Any) -> Any:
    """The robot that is pulled, and what a page draws of it and its path."""
    figure = chosen(robot, paths={path: presets()[path].curve}, sliders=(), controls=())
    figure = replace(figure, drawings=drawings)
    data = figure_data(figure, ENGLISH)
    data["drawings"] = drawings_data(figure, drawings, (), ENGLISH)
    return figure, answer_of(PAGE, {"figure": data, "pull": [0.03, -0.02], **more})


def seen(robot: Robot, points: Array) -> Array:
    """Points of the robot's frame, (..., 3), in the picture, (..., 2)."""
    return points @ np.array(robot.seen).T


def test_labels_and_the_ellipse_of_the_mass_are_those_of_the_scene() -> None:
    figure, page = drawn_on_page("five_bar", "ellipse", SWITCHES)
    robot, q = figure.machine, np.array(page["q"])
    bars = np.array(ca.Function("b", [robot.system.q], [robot.skeleton(robot.system.q, 1)[0]])(q))
    tip = robot.position(robot.endpoint(q))
    labels = np.array(label_function(robot, bars.shape[1] // 2).function(bars, tip)).T
    np.testing.assert_allclose(page["labels"], seen(robot, labels), rtol=0, atol=TENTH)
    turn = np.linspace(0, 2 * np.pi, SIDES + 1)
    directions = np.column_stack([np.cos(turn), np.sin(turn)])
    points = ellipse(robot, tip, figure.parameters, directions)
    np.testing.assert_allclose(page["ellipse"], seen(robot, points), rtol=0, atol=TENTH)
    assert np.ptp(points, axis=0).max() > 0.03


@pytest.mark.parametrize("path", ["circle", "ellipse", "clover", "segment"])
def test_the_tube_and_its_grid_are_those_of_the_scene(path: str) -> None:
    figure, page = drawn_on_page("five_bar", path, SWITCHES)
    robot, curve = figure.machine, presets()[path].curve
    snapshot: Any = SimpleNamespace(curve=curve)
    shape = tube_shape(robot, snapshot)
    edges = seen(robot, shape.fill.vertices).reshape(-1, 2, 2)
    found = np.array(page["tube"]["edges"]).transpose(1, 0, 2)
    np.testing.assert_allclose(found, edges, rtol=0, atol=TENTH)
    spokes = np.array(page["tube"]["across"])
    np.testing.assert_allclose(spokes, seen(robot, shape.normals), rtol=0, atol=TENTH)
    lines = {tuple(np.round(line[0], 3)) for line in page["tube"]["along"]}
    starts = seen(robot, shape.offsets)[:, 0]
    for line in lines:
        assert np.abs(starts - line).max(axis=1).min() < 1e-3


def test_a_bending_is_drawn_larger_as_in_the_scene() -> None:
    figure, page = drawn_on_page("flexible", "circle", ("larger",), larger=20.0)
    robot, q = figure.machine, np.array(page["q"])
    parts = robot.skeleton(robot.system.q, 20.0)
    function = ca.Function("larger", [robot.system.q], list(parts))
    wanted = np.concatenate([seen(robot, np.array(part).T) for part in function(q)])
    np.testing.assert_allclose(np.reshape(page["larger"], (-1, 2)), wanted, rtol=0, atol=TENTH)


PACE = """
import { LocalSettings } from "./pages/settings"
import { Kernels } from "./simulation/kernels"
import { Simulation } from "./simulation/simulation"
import { readFileSync } from "node:fs"

const { figure, settings } = JSON.parse(readFileSync(0, "utf8"))
const simulation = new Simulation(figure, await Kernels.from(figure.module))
const shown = new LocalSettings(simulation, () => {})
simulation.choose(1)
const answers = [shown.value("pace")]
simulation.choose(0)
const side = simulation.sides[0], { log } = figure
for (const values of settings) {
    simulation.set(values)
    simulation.advance(1500)
    let fastest = 0
    for (let before = null, i = 0; i < 1500; i++) {
        simulation.advance(4)
        const row = side.logged(), tip = row.slice(log.y[0], log.y[0] + log.y[1])
        const way = before ? Math.hypot(...tip.map((each, k) => each - before[k])) : 0
        before = tip
        if (!simulation.followed.draws(row[log.theta[0]])) continue
        fastest = Math.max(fastest, way / (4 * figure.dt))
    }
    answers.push([shown.value("pace"), fastest])
}
console.log(JSON.stringify(answers))
"""


def test_the_speed_that_is_told_is_the_one_at_which_a_drawing_is_drawn() -> None:
    """Also where it is limited by bends and K1."""
    paths = {"letters": letters(), "circle": presets()["circle"].curve}
    figure = chosen(
        "five_bar", ("path_following",), paths, sliders=("speed", "K1"), controls=("path",)
    )
    settings = [
        {"speed": 3.0},
        {"speed": -9.0, "K1": 100.0},
        {"speed": 20.0, "K1": 100.0},
    ]
    data = figure_data(figure, ENGLISH)
    names = [field["name"] for group in data["form"]["groups"] for field in group["fields"]]
    assert names[names.index("speed") + 1] == "pace"
    none, *answers = answer_of(PACE, {"figure": data, "settings": settings})
    assert none == ""
    for values, (told, measured) in zip(settings, answers, strict=True):
        parameters = replace(figure.parameters, **values)
        theta = letters().sample(4000)
        slopes = np.linalg.norm(letters().at(theta[letters().draws(theta)], 1), axis=1)
        speed = 1e3 * abs(speed_on(parameters, letters())) * slopes.max()
        number = float(re.findall(r"\d+", told)[0])
        assert number == pytest.approx(speed, abs=1.0)
        assert 1e3 * measured == pytest.approx(speed, rel=0.05)


@pytest.mark.thorough
def test_a_step_has_the_drawings_that_it_shows_and_switches_for_all() -> None:
    course = built_in_course()[0]
    lessons = [course.lesson(name, "en") for name in course.lessons]
    steps = [(lesson, index) for lesson in lessons for index in range(len(lesson.steps))]
    setups = [(*step, step[0].setup_at(step[1])) for step in steps]
    drawing = [each for each in setups if each[2].show or "show" in each[2].controls]
    for lesson, index, setup in drawn(drawing, 8):
        data = figure_of(step_figure(lesson, index), ENGLISH)["drawings"]
        switches = [each["name"] for each in data["switches"]]
        assert data["shown"] == [*setup.show] and {*setup.show} <= {*switches}
        assert ("show" in setup.controls) == (switches == [*SWITCHES])


def test_what_a_symbol_means_is_shapes_to_scale() -> None:
    """On a circle, wherever the robot is."""
    page = judging_page()
    random = np.random.default_rng(41)
    angles = np.linspace(-np.pi, np.pi, 241)
    for _ in range(30):
        radius, theta = random.uniform(0.02, 0.2), random.choice(angles[1:-1])
        middle, away = random.uniform(-0.2, 0.2, 2), random.uniform(-0.01, 0.01)

        def at(angle: Any, r: float, middle: Any = middle) -> Any:
            return middle + r * np.array([np.cos(angle), np.sin(angle)])

        closest, tip = at(theta, radius), at(theta, radius - away)
        reference = at(random.choice(angles), radius)
        seen = {
            "tip": tip.tolist(),
            "closest": closest.tolist(),
            "reference": reference.tolist(),
            "pushed": (tip + [0.01, 0]).tolist(),
            "outline": [at(each, radius).tolist() for each in angles],
            "closed": True,
            "joints": {},
        }
        shapes = {
            name: [np.array(each["points"]) for each in page.evaluate(SHAPES, [name, seen])]
            for name in ("lambda", "e", "N", "T", "theta", "K_1", "q_1")
        }
        np.testing.assert_allclose(shapes["lambda"], [[closest, tip]])
        np.testing.assert_allclose(shapes["e"], [[reference, tip]])
        np.testing.assert_allclose(shapes["K_1"], [[reference, tip]])
        (normal,), (tangent,) = shapes["N"], shapes["T"]
        inwards = (middle - closest) / radius  # where λ > 0
        np.testing.assert_allclose((normal[1] - normal[0]) / 0.03, inwards, atol=0.02)
        assert abs((tangent[1] - tangent[0]) @ inwards) < 1e-3
        (arc,) = shapes["theta"]
        length = np.linalg.norm(np.diff(arc, axis=0), axis=1).sum()
        np.testing.assert_allclose(length, radius * abs(theta), rtol=0.01, atol=1e-3)
        np.testing.assert_allclose(arc[-1], closest, atol=1e-9)
        assert shapes["q_1"] == []  # it has no such joint
    page.close()
