"""A figure's page as a file: what is in it, and what is refused. Browser tests see it move."""

from __future__ import annotations

import hashlib
import html
import re
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.site.step_figures import step_figure
from onpath.app.exports.standalone.figure_choice import CONTROLS, chosen
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.exports.standalone.figure_module import figure_module
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.assets import asset_path
from onpath.lessons.words import ENGLISH, Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.page_functions import page_functions, stop_reasons
from onpath.models.closed_loop.simulation import brake_at, kind_of, raised
from onpath.models.control.laws.registry import law_named
from onpath.models.paths.path_design import presets
from onpath.models.standalone.curve_scans import curve_scans
from onpath.models.systems.catalogue import ROBOTS
from tests.support.built_in import built_in_course
from tests.support.cases import drawn, some
from tests.support.drawings import random_drawing, scrawl
from tests.support.page_scans import steps_along

CURVES = {name: presets()[name].curve for name in ("circle", "clover", "segment")}
DRAWINGS = {name: random_drawing(2, 60, 0.02, name == "ring") for name in ("ring", "scrawl")}
LARGEST = 1_500_000  # [B]


def numbers(function: Any, *arguments: Any) -> Array:
    return np.array(function(*arguments)).ravel(order="F")


@pytest.mark.parametrize("name", [*CURVES, *DRAWINGS])
@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_what_a_page_computes_is_what_the_lab_computes(robot: str, name: str) -> None:
    entry, rng = ROBOTS[robot], np.random.default_rng(1)
    machine = entry.make(entry.parameters())
    curve = raised({**CURVES, **DRAWINGS}[name], entry.parameters())
    kind = kind_of("path_following", entry.parameters(), curve)
    functions = page_functions(machine, kind)
    scan, begin, step = curve_scans(machine, kind)["curve"], -4.0, float(rng.uniform(0.1, 0.3))
    _, rows = steps_along(scan, kind, curve, np.array([0, begin, step, 3.9]), 30)
    theta = np.minimum(begin + np.arange(30) * step, 3.9)
    every = np.concatenate(curve.all_orders(theta), axis=1)
    np.testing.assert_allclose(rows, every, rtol=1e-11, atol=1e-11 * np.abs(every).max())
    found = [numbers(functions["at"], each) for each in rows]
    np.testing.assert_allclose(found, machine.frame.lift(curve.at(theta)), atol=1e-14)
    q = machine.rest(machine.frame.lift(curve.at(np.array(0.4))))
    tip, end = numbers(functions["tip"], q), machine.endpoint(q)
    np.testing.assert_allclose(tip, end, atol=1e-15)
    seen = numbers(functions["place"], end)
    np.testing.assert_allclose(np.array(functions["picture"](q)[0])[:, -1], seen, atol=1e-15)
    _, (there,) = steps_along(scan, kind, curve, np.array([0, 0.4, 0, 0.4]), 1)
    brake = numbers(functions["brake"], there)
    np.testing.assert_allclose(brake, brake_at(machine, curve, end, 0.4)[1], atol=1e-14)
    moved = numbers(functions["hand"], end, seen, seen + [0.01, -0.02])
    np.testing.assert_allclose(numbers(functions["place"], moved), seen + [0.01, -0.02], atol=1e-15)


@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_a_page_stops_a_robot_where_the_lab_does(robot: str) -> None:
    entry, rng = ROBOTS[robot], np.random.default_rng(2)
    machine = entry.make(entry.parameters())
    n = machine.system.n
    kind = kind_of("path_following", entry.parameters(), CURVES["circle"])
    fault = page_functions(machine, kind)["fault"]
    home = machine.rest(machine.frame.lift(np.zeros(2)))
    size = np.where(
        np.arange(n) < machine.system.joints, 1.0, 0.02
    )  # joints, and what a link bends
    size[[name.endswith("_m") for name in machine.system.coordinate_names]] = 0.1  # slides, [m]
    near = home + size * rng.normal(0, 0.3, (100, n)), size * rng.normal(0, 100, (100, n))
    near[1][:50] /= 100
    q = np.concatenate([near[0], size * rng.uniform(-4, 4, (200, n)), [home, home + np.nan, home]])
    v = np.concatenate([near[1], np.zeros((202, n)), np.full((1, n), np.nan)])
    found = [int(numbers(fault, *each, 0.0)[0]) for each in zip(q, v, strict=True)]
    for one, rate, code in zip(q, v, found, strict=True):
        here = one if np.isfinite(one).all() else home
        reasons = stop_reasons(machine, entry.parameters(), here, "path_following")
        reasons = [each.arguments.get("reason", each) for each in reasons]  # without a forecast
        expected = machine.fault(one[None], rate[None], entry.parameters())
        assert (expected and expected[1]) == (reasons[code - 1] if code else None)
    assert 20 < sum(map(bool, found)) < len(found) - 20
    assert len(set(found)) >= 4
    typed = stop_reasons(machine, entry.parameters(), home, "across = 1; along = 1")
    code = int(numbers(fault, home, 0 * home, np.nan)[0])
    assert typed[code - 1].code == "stop.typed_law"


@pytest.mark.thorough
def test_a_page_is_small_the_same_every_time_and_names_no_other_place(tmp_path: Path) -> None:
    page = figure_page(chosen("five_bar", paths=CURVES), ENGLISH)
    assert page == figure_page(chosen("five_bar", paths=CURVES), ENGLISH)
    assert len(page.encode()) < 400_000
    assert "default-src 'none'" in html.unescape(page)
    around = page.replace(asset_path("web/figure.js").read_text("utf-8"), "")
    assert not re.findall(r"(?:src|href|url)\s*[=(]|https?:|import\(", around)


@pytest.mark.thorough
@settings(max_examples=3)
@given(st.integers(0, 2**32), st.integers(20, 200))
def test_all_drawings_have_the_same_module(seed: int, pieces: int) -> None:
    figure = chosen("five_bar", paths={"one": scrawl(3)})
    other = replace(figure, paths={"other": random_drawing(seed, pieces, 0.02)})
    assert figure.controls == CONTROLS
    assert figure_module(other) == figure_module(figure)


LARGEST_PAGE = "flexible"


@pytest.mark.thorough
@pytest.mark.parametrize(
    "robot",
    some(
        [LARGEST_PAGE, *drawn([name for name in ROBOTS if name != LARGEST_PAGE], 2)],
        quick=[LARGEST_PAGE],
    ),
)
def test_a_page_with_all_laws_has_at_most_a_megabyte_and_a_half(robot: str, tmp_path: Path) -> None:
    """Whatever laws the author includes."""
    system = ROBOTS[robot].make(ROBOTS[robot].parameters()).system
    laws = [name for name in onpath.laws() if law_named(name).suits(system)]
    assert len(laws) > 4
    file = onpath.figure(robot, choices=laws).save(tmp_path / "a.html")
    assert file.stat().st_size < LARGEST


def test_texts_of_the_author_are_texts(tmp_path: Path) -> None:
    title = "</script><script>alert(1)</script>{{ x }}"
    page = figure_page(chosen("five_bar", paths=CURVES), Words("de"), title)
    assert page.count("<script") == 2 and page.count("</script>") == 2
    shown = re.findall(r"<(?:title|h1)>(.*?)</(?:title|h1)>", page)
    assert [*map(unescape, shown)] == [title, title]


@pytest.mark.thorough
def test_a_page_has_one_heading_and_says_what_it_is() -> None:
    """Whether its author gives a title or not."""
    for title in ("", "Mine"):
        page = figure_page(chosen("five_bar", paths=CURVES), ENGLISH, title)
        (heading,) = re.findall(r"<main>\s*<h1.*?>(.*?)</h1>", page)
        assert heading == (title or "OnPath: Trajectory tracking / Path following")
        assert re.search(r'<meta name="description" content="[^"]{20,}">', page)


LEVEL_SET = ["--set", "across=level_set"]


def test_what_cannot_be_a_figure_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = str(tmp_path / "a.html")
    wrong = [
        (["--robot", "five"], "five_bar"),
        (["--law", "path_folowing"], "path_following"),
        (["--law", "set_point"] * 3, "one or two"),
        (["--path", "circle", "--path", "circle 0.3"], "path 'circle 0.3': "),
        (["--path", "circle 0,05"], "write 0.05 instead of 0,05"),
        (["--path", "@missing.txt"], "missing.txt: there is no such file"),
        (["--set", "K1=nothing"], "K1"),
        (["--slider", "torque_limit"], "cannot be changed in a figure"),
        (["--slider", "task"], "cannot be changed in a figure"),
        (["--set", "speed_profile=sine"], "constant speed"),
        (["--language", "xx"], "en"),
        (["--control", "brake"], "control"),
        (["--path", "circle", *LEVEL_SET, "--control", "drag"], "adapted to the path"),
        (["--law", "contouring", "--control", "poles"], "poles"),
        (["--choice", "path_folowing"], "path_following"),
    ]
    for arguments, hint in wrong:
        assert run_command(["figure", target, *arguments]) == 2, arguments
        said = capsys.readouterr().err
        assert said.count("\n") == 1 and hint in said and not list(tmp_path.iterdir())
    assert run_command(["figure", str(tmp_path / "no" / "a.html")]) == 2


@pytest.mark.thorough
def test_paths_may_be_read_from_files(tmp_path: Path) -> None:
    oval, file = tmp_path / "My oval.txt", tmp_path / "a.html"
    oval.write_text("ellipse 0.06 0.03", "utf-8-sig")
    arguments = ["figure", str(file), "--path", f"@{oval}", "--path", "circle"]
    assert run_command(arguments) == 0
    named = {"My oval": onpath.ellipse(0.06, 0.03), "circle": "circle"}
    assert file.read_bytes() == onpath.figure(path=named).save(tmp_path / "b.html").read_bytes()


@pytest.mark.thorough
def test_one_law_and_paths_of_one_s_own() -> None:
    paths = {"my oval": onpath.ellipse(0.06, 0.03), "line": "segment"}
    law = "across = -K1*xi - K2*dxi; along = 9*(5 - dtheta)"
    page = onpath.figure(law=law, path=paths, title="Mine").html
    assert "my oval" in page and "<title>Mine</title>" in page


@pytest.mark.parametrize("name", ["figure", "lab", "site"])
def test_what_runs_was_built_from_these_sources(name: str) -> None:
    """After a change: cd assets/web; npm ci; npm run build."""
    sources = sorted(asset_path("web").glob("*/*.ts"))
    text = b"".join(file.read_bytes() for file in sources)
    built = asset_path(f"web/{name}.js").read_text("utf-8")
    assert built.splitlines()[0] == f"// sources: {hashlib.sha256(text).hexdigest()}"


@pytest.mark.parametrize(
    "laws, task, expected",
    [
        (("trajectory_tracking", "set_point"), "speed", ["speed", "K1", "K2", "K3"]),
        (("waiting_clock",), "speed", ["speed", "K1", "K2", "K3", "clock_gain"]),
        (("path_following",), "position", ["target", "K1", "K2", "K3", "K4", "K5"]),
    ],
)
def test_sliders_are_those_of_what_acts(
    laws: tuple[str, ...], task: str, expected: list[str]
) -> None:
    assert list(chosen("five_bar", laws, CURVES, {"task": task}).sliders) == expected


def test_a_figure_has_the_plan_of_its_laws_and_lets_nothing_change_it() -> None:
    laws, curve = ("trajectory_tracking", "time_optimal_following"), CURVES["circle"]
    values = {"torque_limit": 0.5}
    figure = chosen("five_bar", laws, {"circle": curve}, values)
    assert "drag" not in figure.controls and not {"speed", "torque_limit"} & {*figure.sliders}
    shown = np.array(figure_data(figure, ENGLISH)["paths"][0]["settings"])
    assert np.array_equal(shown, figure.settings("time_optimal_following", curve))
    assert not np.array_equal(shown, figure.settings("trajectory_tracking", curve))
    for unwanted in ({"controls": ["drag"]}, {"sliders": ["torque_limit"]}, {"sliders": ["speed"]}):
        with pytest.raises(ValueError, match=r"drag|cannot be changed"):
            chosen("five_bar", laws, {"circle": curve}, values, **unwanted)  # type: ignore[arg-type]


def test_no_step_offers_a_choice_of_one_option() -> None:
    """A parameter that makes another robot is offered where a page has several of them."""
    lesson = built_in_course()[0].lesson("07b-where-the-theorem-decides", "en")
    for index in range(len(lesson.steps)):
        offered = step_figure(lesson, index).choice.remade
        assert all(len(values) > 1 for values in offered.values()), (index, offered)
