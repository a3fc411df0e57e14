"""A figure moves as in Python, whatever a reader does; its page runs in Node."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.exports.standalone.figure_choice import FigureChoice, chosen
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.lessons.words import ENGLISH
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.registry import LAWS as REGISTERED
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.drawings import letters, scrawl, star
from tests.support.figure_runs import Act, PythonFigure
from tests.support.node_page import NodePage, needs_node
from tests.support.robot_files import HEAVY, urdf
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.thorough, needs_node]
WAIT = 60.0  # [s]
LAWS = ("trajectory_tracking", "path_following")
PATHS = ("circle", "clover", "segment")
DRAWINGS = {"letters": letters(), "scrawl": scrawl(3), "star": star()}
OTHERS = ("waiting_clock", "set_point")
CLOSE = 1e-12
BENDS = 1e-10
"""On drawings, from the same state: sharp bends make other roundings of a sine larger."""
EDITED = 1e-10
"""After an edit: the curve itself is fitted with other roundings, to 1e-13."""
ACT = """([what, value]) => {
    const {simulation} = onpath
    if (what === "advance") onpath.advance(value)
    else if (what === "move") simulation.followed.move(...value)
    else if (what === "drop") simulation.followed.finish()
    else if (what === "change") simulation.sides[value[0]].change(value[1])
    else simulation[what](value)
}"""
LOGGED = "onpath.simulation.sides.map(side => [...side.logged()])"
STATES = "onpath.simulation.sides.map(side => [...side.keep().state])"
DISTANCES = "onpath.simulation.sides.map(side => side.distance)"
TEXT = "document.body.textContent"
CHOOSE = """([name, option]) => {
    const select = [...document.querySelectorAll("select")].find(each => each.ariaLabel === name)
    select.selectedIndex = [...select.options].findIndex(each => each.textContent === option)
    select.dispatchEvent(new Event("change"))
}"""
THROWN = """(() => {
    const {state, kernels} = onpath.simulation.sides[0], {q} = onpath.data.state
    kernels.numbers[state + q[0] + q[1]] = 1e4
})()"""
"""A joint is thrown."""
SPEEDS = """(() => {
    const [begin, size] = onpath.data.log.v
    return [...onpath.simulation.sides[0].logged().slice(begin, begin + size)]
})()"""
"""Speeds of the first robot's joints in the last row of its log, [rad/s]."""
TABLE = """(() => {
    const {table, data} = onpath.simulation.followed
    return [...onpath.simulation.kernels.numbers.subarray(table, table + data.table.length)]
})()"""


def choice(robot: str = "five_bar") -> FigureChoice:
    paths = {name: presets()[name].curve for name in PATHS}
    return chosen(robot, LAWS, paths, NEWCOMER, choices=OTHERS)


class Opened:
    """A figure's page; it stands still between what it is told to do."""

    def __init__(self, file: Path) -> None:
        self.page = NodePage()
        self.page.evaluate("(globalThis.requestAnimationFrame = () => 0)")
        self.page.goto(file.as_uri())
        wait_for(lambda: self.page.evaluate("'onpath' in window"), WAIT)
        self.page.evaluate("onpath.engine.act({do: 'run', on: false})")

    def number(self, what: str) -> Any:
        return self.page.evaluate(what)

    def do(self, *acts: Act) -> None:
        for act in acts:
            self.page.evaluate(ACT, list(act))

    @property
    def note(self) -> str:
        """What the page says below the robots, drawn anew."""
        self.page.evaluate("onpath.draw()")
        return self.number("document.querySelector('.note').textContent")


def written(folder: Path, robot: str = "five_bar") -> Path:
    file = folder / f"{robot}.html"
    file.write_text(figure_page(choice(robot), ENGLISH), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("figures"))


@pytest.fixture
def opened(file: Path) -> Iterator[Opened]:
    opened = Opened(file)
    yield opened
    opened.page.close()


BEGIN: list[Act] = [("choose", 0), ("set", {"speed": 2.0, "K1": 400.0})]
PULLED: list[Act] = [
    *BEGIN,
    *(("advance", 500), ("pull", [0.01, 0.02]), ("advance", 300), ("pull", [0.02, 0.0])),
    *(("advance", 300), ("hold", True), ("advance", 100), ("pull", None)),
]


DRAGGED: list[Act] = [
    *(("move", [1, [0.05, 0.05]]), ("advance", 100), ("move", [1, [0.09, 0.02]]), ("drop", None)),
    *(("advance", 200), ("move", [0, [0.2, 0.2]]), ("advance", 500), ("drop", None)),
]


def acts() -> st.SearchStrategy[list[Act]]:
    coordinate, place = st.floats(-0.03, 0.03), st.floats(-0.2, 0.2)
    each = (
        st.tuples(st.just("advance"), st.integers(1, 600)),
        st.tuples(st.just("hold"), st.booleans()),
        st.tuples(st.just("set"), st.fixed_dictionaries({"speed": st.floats(-4, 4)})),
        st.tuples(st.just("set"), st.fixed_dictionaries({"K1": st.floats(100, 900)})),
        st.tuples(st.just("choose"), st.integers(0, len(PATHS) - 1)),
        st.tuples(st.just("reset"), st.none()),
        st.tuples(st.just("pull"), st.one_of(st.none(), st.tuples(coordinate, coordinate))),
        st.tuples(st.just("change"), st.tuples(st.integers(0, 1), st.integers(0, 3))),
        st.tuples(st.just("move"), st.tuples(st.integers(0, 1), st.tuples(place, place))),
        st.tuples(st.just("drop"), st.none()),
    )
    return st.lists(st.one_of(each), min_size=3, max_size=12).map(lambda found: [*BEGIN, *found])


@settings(max_examples=12, deadline=None)
@given(acts())
@example(PULLED)
@example([*BEGIN, ("advance", 300), *DRAGGED, ("choose", 2), *DRAGGED, ("reset", None)])
@example([*BEGIN, ("change", [0, 2]), ("advance", 700), ("change", [0, 3]), ("advance", 9)])
def test_the_same_inputs_give_the_trajectory_of_python(file: Path, script: list[Act]) -> None:
    opened = Opened(file)  # its paths are as they were
    python = PythonFigure(choice())
    for act in (*script, ("advance", 1000)):
        opened.do(act)
        python.act(act)
        if act[0] == "advance":
            found = np.array(opened.number(LOGGED))
            edited = any(act[0] == "move" for act in script)
            close = EDITED if edited else CLOSE
            np.testing.assert_allclose(found, np.array(python.rows()), rtol=0, atol=close)
            assert max(abs(np.array(opened.number(TABLE)) - python.editor.table)) < 1e-11
            expected = [side.distance() for side in python.sides]
            np.testing.assert_allclose(opened.number(DISTANCES), expected, atol=1e-5)
    opened.page.close()


def drawings(robot: str = "five_bar") -> FigureChoice:
    paths = {**DRAWINGS, "circle": presets()["circle"].curve}
    return chosen(robot, LAWS, paths, NEWCOMER, choices=OTHERS)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("figures") / "drawings.html"
    file.write_text(figure_page(drawings(), ENGLISH), encoding="utf-8")
    return file


QUICK = [("set", {"speed": 6.0, "K1": 100.0})]
BENT = [
    *(("move", [2, [0.06, 0.01]]), ("advance", 100), ("move", [2, [0.03, 0.01]]), ("advance", 9)),
    *(
        ("advance", 400),
        ("drop", None),
        ("move", [3, [0.2, 0.2]]),
        ("advance", 900),
        ("drop", None),
    ),
]
TORN = [("advance", 700), ("hold", True), ("advance", 500), ("hold", False), ("advance", 900)]


@settings(max_examples=2, deadline=None)
@given(acts())
@example([("choose", 1), *QUICK, *TORN, ("change", [1, 2]), *TORN])
@example([("choose", 0), *QUICK, ("advance", 500), *BENT, ("choose", 2), *BENT, ("reset", None)])
def test_a_drawing_is_followed_as_in_python(drawn: Path, script: list[Act]) -> None:
    opened, python = Opened(drawn), PythonFigure(drawings())
    for act in (*script, ("advance", 1000)):
        opened.do(act)
        python.act(act)
        if act[0] == "move":
            faults = [f"fault.{each.check}" for each in python.editor.faults]
            assert opened.number("onpath.simulation.followed.fault?.reasons ?? []") == faults
        if act[0] == "drop":
            doubts = [each.reason.code for each in ambiguities(python.editor.curve)]
            assert opened.number("onpath.simulation.followed.doubts") == doubts
        if act[0] == "advance":
            table = opened.number(TABLE)
            assert table == python.editor.table[: len(table)].tolist()
            found = np.array(opened.number(LOGGED))
            np.testing.assert_allclose(found, np.array(python.rows()), rtol=0, atol=BENDS)
            seen = zip(python.sides, opened.number(DISTANCES), opened.number(STATES), strict=True)
            for side, distance, state in seen:
                assert side.distance() - 1e-5 <= distance <= side.gap() + 1e-12
                side.state = np.array(state[: len(side.state)])
    assert opened.number("complaints") == []
    opened.page.close()


@settings(max_examples=2, deadline=None)
@given(st.sampled_from(list(ROBOTS)), st.sampled_from(list(REGISTERED)))
@example("spatial_arm", "time_optimal_following")
def test_every_law_follows_a_drawing_on_every_robot_that_it_suits(
    drawn: Path, robot: str, law: str
) -> None:
    entry = ROBOTS[robot]
    assume(law_named(law).suits(entry.make(entry.parameters()).system))
    figure = chosen(robot, (law,), {"letters": letters(), "star": star()})
    file = drawn.with_name("law.html")
    file.write_text(figure_page(figure, ENGLISH), encoding="utf-8")
    opened, python = Opened(file), PythonFigure(figure)
    bent = [("move", [1, [0.0, 0.02]]), ("advance", 400)] if "drag" in figure.controls else []
    for act in (("choose", 1), *TORN, ("choose", 0), ("advance", 300), *bent):
        opened.do(act)
        python.act(act)
        if act[0] == "advance":
            rows = np.array(python.rows())
            np.testing.assert_allclose(opened.number(LOGGED), rows, rtol=0, atol=BENDS)
    assert opened.number("complaints") == []
    opened.page.close()


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, len(DRAWINGS) - 1))
def test_a_drawing_that_is_bent_crosses_itself_where_the_lab_says_so(
    drawn: Path, seed: int, number: int
) -> None:
    rng, opened, python = np.random.default_rng(seed), Opened(drawn), PythonFigure(drawings())
    for act in [("choose", number), *BEGIN[1:]]:
        opened.do(act)
        python.act(act)
    for _ in range(4):
        points = python.editor.design.points
        index = int(rng.integers(len(points)))
        target = points[index] + rng.normal(0, 0.012, 2)
        for act in (("move", (index, target.tolist())), ("drop", None)):
            opened.do(act)
            python.act(act)
        doubts = [each.reason.code for each in ambiguities(python.editor.design.curve)]
        assert opened.number("onpath.simulation.followed.doubts") == doubts
    opened.page.close()


@pytest.mark.parametrize("number", range(len(DRAWINGS)))
def test_a_drawing_is_drawn_within_a_tenth_of_a_millimetre(drawn: Path, number: int) -> None:
    opened, curve = Opened(drawn), [*DRAWINGS.values()][number]
    opened.do(("choose", number))
    parts = opened.number("onpath.simulation.followed.parts")
    assert [part["raised"] for part in parts] == [i % 2 == 1 for i in range(len(parts))]
    edges = np.array([-np.pi, *np.ravel(curve.raised), np.pi])
    assert len(parts) == len(edges) - 1
    robot = drawings().machine
    for part, begin, end in zip(parts, edges[:-1], edges[1:], strict=True):
        line = np.array(part["points"])
        theta = np.linspace(begin, end, 20 * len(line) + 1)
        there = (robot.seen @ robot.position(robot.frame.lift(curve.at(theta))).T).T
        np.testing.assert_allclose(line[[0, -1]], there[[0, -1]], atol=1e-9)
        share = np.linspace(0, 1, len(line))
        between = np.linspace(0, 1, len(theta))
        shown = np.column_stack([np.interp(between, share, line[:, k]) for k in (0, 1)])
        assert np.abs(shown - there).max() < 1e-4
    opened.page.close()


def test_it_is_the_run_of_simulate(opened: Opened) -> None:
    opened.do(("choose", 0), ("set", {"speed": 2.0, "K1": 400.0}), ("advance", 1000))
    opened.do(("hold", True), ("advance", 1000), ("hold", False), ("advance", 1000))
    found = np.array(opened.number(LOGGED))
    for law, row in zip(LAWS, found, strict=True):
        run = onpath.simulate(law=law, hold=(1, 2), duration=3, speed=2, ramp=4)
        end = np.concatenate([run.q[-1], run.v[-1], run.y[-1]])
        np.testing.assert_allclose(row[: len(end)], end, rtol=0, atol=CLOSE)


@pytest.mark.parametrize("robot", [name for name in ROBOTS if name != FIVE_BAR.name])
def test_every_robot_follows_also_a_path_whose_points_are_dragged(
    tmp_path: Path, robot: str
) -> None:
    opened = Opened(written(tmp_path, robot))
    opened.do(("reset", None), ("advance", 3000))
    python = PythonFigure(choice(robot))
    python.act(("advance", 3000))
    np.testing.assert_allclose(opened.number(LOGGED), python.rows(), rtol=0, atol=CLOSE)
    before = python.editor.table.copy()
    for act in (*DRAGGED, ("advance", 300), ("reset", None), ("advance", 3000)):
        opened.do(act)
        python.act(act)
    assert max(abs(python.editor.table - before)) > 1e-3
    assert max(abs(np.array(opened.number(TABLE)) - python.editor.table)) < 1e-11
    np.testing.assert_allclose(opened.number(LOGGED), python.rows(), rtol=0, atol=EDITED)
    assert max(opened.number(DISTANCES)) < 1e-3 and opened.number("complaints") == []
    opened.page.close()


@pytest.mark.parametrize("robot", onpath.robots())
@pytest.mark.parametrize("given", [{}, {"speed": 3.0}])
def test_it_moves_as_a_run_with_the_same_arguments(
    tmp_path: Path, robot: str, given: dict[str, Any]
) -> None:
    file = onpath.figure(robot, "ellipse", LAWS, sliders=(), **given).save(tmp_path / "a.html")
    opened = Opened(file)
    opened.do(("reset", None), ("advance", 300))
    begin, size = opened.number("onpath.data.log.y")
    there = [row[begin : begin + size] for row in opened.number(LOGGED)]
    own = given or onpath.NEWCOMER
    here = [onpath.simulate(robot, "ellipse", law, duration=0.3, **own).y[-1] for law in LAWS]
    assert np.array(there) == pytest.approx(np.array(here), abs=CLOSE)
    opened.page.close()


def test_a_heavy_arm_moves_as_in_python_and_says_that_it_exceeds_its_file(
    tmp_path: Path,
) -> None:
    source = tmp_path / "heavy.urdf"
    source.write_text(urdf("heavy", HEAVY), "utf-8")
    arm = onpath.robot(source)
    file = onpath.figure(arm, "circle 0.1", LAWS, sliders=(), speed=6.0).save(tmp_path / "a.html")
    opened = Opened(file)
    opened.do(("reset", None), ("advance", 300))
    begin, size = opened.number("onpath.data.log.u")
    there = [row[begin : begin + size] for row in opened.number(LOGGED)]
    with pytest.warns(UserWarning, match="more than the"):
        runs = [onpath.simulate(arm, "circle 0.1", law, duration=0.3, speed=6.0) for law in LAWS]
    assert all(np.abs(run.torque).max() > 3000 for run in runs)
    here = np.array([run.torque[-1] for run in runs])
    assert np.array(there) == pytest.approx(here, rel=1e-9, abs=1e-9 * np.abs(here).max())
    said = opened.note
    assert "joint2 gave" in said and "more than the 3000 N m" in said
    opened.do(("reset", None))
    assert "gave" not in opened.note
    opened.page.close()


def test_a_path_that_crosses_itself_is_followed_with_the_lab_s_warning(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="crosses itself"):
        file = onpath.figure(path="figure of eight", controls="drag").save(tmp_path / "a.html")
    opened, rng = Opened(file), np.random.default_rng(2)
    design = presets()["figure of eight"]
    assert "crosses itself" in opened.note
    seen = set[str]()
    for index in range(len(design.points)):
        target = design.points[index] + rng.normal(0, 0.006, 2)
        opened.do(("move", [index, target.tolist()]), ("drop", None))
        if opened.number("onpath.simulation.followed.fault") is None:
            design = design.moved(index, target)
            doubts = [each.reason.code for each in ambiguities(design.curve)]
            assert opened.number("onpath.simulation.followed.doubts") == doubts
            seen |= set(doubts)
        else:
            opened.do(("choose", 0))
            design = presets()["figure of eight"]
    assert seen and opened.number("complaints") == []
    opened.page.close()


def test_a_law_is_chosen_for_each_robot_and_its_poles_are_the_lab_s(opened: Opened) -> None:
    channels = channels_of("path_following", choice().parameters)
    assert not isinstance(channels, Message)
    for channel in channels:
        said = ENGLISH.sentence(channel.behaviour()).replace("-", "−")
        poles = channel.pole_words().replace("-", "−")
        assert f"{said}; poles {poles} 1/s" in opened.number(TEXT)
    opened.page.evaluate("onpath.form.host.set('K5', 0)")
    assert "not stable" in opened.number(TEXT)
    for side in ("left", "right"):
        opened.page.evaluate(CHOOSE, [f"Law, {side}", "Trajectory tracking"])
    names = opened.number(
        "[...document.querySelectorAll('.title > :first-child')].map(each => each.textContent)"
    )
    assert names == ["Trajectory tracking, left", "Trajectory tracking, right"]


def test_why_a_robot_has_stopped_is_said_as_in_the_lab(opened: Opened) -> None:
    opened.do(("reset", None))
    opened.page.evaluate(THROWN)
    opened.do(("advance", 50))
    said = opened.note
    assert said.startswith("Trajectory tracking stopped at 0.0 s: a joint turns faster than 100")
    assert opened.number("onpath.simulation.sides[1].stopped") == 0
    assert max(map(abs, opened.number(SPEEDS))) < 100  # it is seen as it was before that
    opened.do(("reset", None))
    assert opened.note == ""
