"""Same arguments, same motion: in Python, on the command line, in a figure and in the lab."""

from __future__ import annotations

import csv
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.cli.main import run_command
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import Path as SetupPath
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.app.server.new_lab import new_lab as newcomers_lab
from onpath.lessons.course import NO_LESSONS
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import changed, specs
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.systems.catalogue import ROBOTS
from tests.support.cases import some
from tests.support.figure_runs import PythonFigure
from tests.support.lab import do, loop_cache, new_lab
from tests.support.some_setups import CALM

SECONDS = 0.2
QUICK = ("five_bar", "flexible", "cart_pendulum")
FEW = settings(CALM, max_examples=3)
PATHS = ("circle", "ellipse", "clover")
NUMBERS = (
    *("K1", "K2", "K3", "K5", "speed", "ramp"),
    *("payload", "control_rate", "rise", "tip_damping"),
)


@pytest.fixture(autouse=True)
def quiet() -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # random arguments may have no effect
        yield


@st.composite
def arguments(draw: st.DrawFn, robot: str) -> tuple[str, str, dict[str, Any]]:
    """A path, a law and some parameters, by their declared names."""
    known = specs(ROBOTS[robot].parameters)
    own = dict[str, Any]()
    for name in draw(st.lists(st.sampled_from(NUMBERS), unique=True, max_size=4)):
        if name not in known:
            continue
        spec = known[name]
        low, high = spec.low, 0.7 * spec.high if name != "rise" else 0.02
        value = st.sampled_from(spec.options) if spec.options else st.floats(low, high)
        drawn = draw(value)
        own[name] = drawn if spec.options else float(f"{drawn:.4g}")
    if "output" in known:
        own |= draw(st.sampled_from([{}, {"output": "redefined"}]))
    parameters = ROBOTS[robot].parameters(**own)
    system = ROBOTS[robot].make(parameters).system
    composite = getattr(parameters, "output", "") == "composite"
    laws = [
        name
        for name in LAWS
        if (law := law_named(name)).suits(system) and (law.commands_acceleration or not composite)
    ]
    return draw(st.sampled_from(PATHS)), draw(st.sampled_from(laws)), own


def in_python(robot: str, path: str, law: str, own: dict[str, Any]) -> np.ndarray:
    """End-points at the ends of ticks, a row each."""
    run = onpath.simulate(robot, path, law, duration=SECONDS, **own)
    assume(run.stopped_at is None)  # some gains are unstable
    return run.y


def on_the_command_line(
    robot: str, path: str, law: str, own: dict[str, Any], folder: Path
) -> np.ndarray:
    told = [f"--set={n}={v}" for n, v in {**own, "duration": SECONDS}.items()]
    file = folder / "run.csv"
    command = ["experiment", "obstruction", f"--robot={robot}", f"--law={law}", f"--path={path}"]
    assert run_command([*command, "--csv", str(file), *told]) == 0
    with file.open() as opened:
        rows = list(csv.DictReader(opened))
    names = [name for name in rows[0] if re.fullmatch(r"y\d_m", name)]
    return np.array([[float(row[name]) for name in names] for row in rows])


def ticks(own: dict[str, Any]) -> int:
    """Until the last row of a run, which has a row per millisecond."""
    return round(SECONDS / 5e-4) - 1 if own.get("control_rate") == 2000 else round(SECONDS / 1e-3)


def in_the_lab(robot: str, path: str, law: str, own: dict[str, Any]) -> np.ndarray:
    """The last end-point."""
    lab = new_lab()
    laws = {LEFT: law, RIGHT: law}
    restore(lab.simulation, Setup(robot, {robot: RobotSetup(own, SetupPath(path))}, laws=laws))
    return last_in_the_lab(lab, own)


def last_in_the_lab(lab: Any, own: dict[str, Any]) -> np.ndarray:
    lab.simulation.simulate(ticks(own))
    both = [run.shown()["y"] for run in lab.simulation.runs.values()]
    return both[1]


def figure_of(robot: str, path: Any, law: str, **given: Any) -> FigureChoice:
    """What `onpath.figure` shows with these arguments; its loops are not compiled."""
    choice = onpath.figure(robot, path, law, sliders=(), **given).choice
    assert choice is not None
    return choice


def in_a_figure(choice: FigureChoice, own: dict[str, Any]) -> np.ndarray:
    page = PythonFigure(choice)
    page.act(("advance", ticks(own)))
    return page.sides[0].y


@pytest.mark.parametrize("robot", some(ROBOTS, QUICK))
def test_same_arguments_same_motion(robot: str, tmp_path: Path) -> None:
    @FEW
    @given(arguments(robot))
    def check(drawn: tuple[str, str, dict[str, Any]]) -> None:
        path, law, own = drawn
        here = in_python(robot, path, law, own)
        there = on_the_command_line(robot, path, law, own, tmp_path)
        assert here == pytest.approx(there, abs=1e-9)  # digits of the file
        assert np.array_equal(here[-1], in_the_lab(robot, path, law, own))
        named = own if own.keys() & NEWCOMER.keys() else {**own, "speed": 3.0}
        given = figure_of(robot, path, law, **named)
        expected = in_python(robot, path, law, named)[-1]
        assert np.array_equal(in_a_figure(given, own), expected)

    check()


@pytest.mark.parametrize("robot", some(ROBOTS, QUICK))
def test_the_newcomers_motion_has_a_name(robot: str) -> None:
    from onpath.app.lab import commands as c

    assert dict(onpath.NEWCOMER) == {"speed": 2.0, "ramp": 4.0}
    run = onpath.simulate(robot, duration=SECONDS, **onpath.NEWCOMER)
    lab = newcomers_lab(loop_cache(), NO_LESSONS)
    do(lab, c.ChooseRobot(robot))
    assert np.array_equal(last_in_the_lab(lab, {}), run.y[-1])
    choice = figure_of(robot, "circle", "path_following")
    assert np.array_equal(in_a_figure(choice, {}), run.y[-1])
    assert choice.parameters == lab.simulation.parameters == run.experiment.parameters


@pytest.mark.parametrize("robot", some(ROBOTS, QUICK))
def test_a_robot_has_one_set_of_defaults(robot: str) -> None:
    usual = ROBOTS[robot].parameters()
    lab = new_lab()
    restore(lab.simulation, Setup(robot))
    assert lab.simulation.parameters == usual
    assert onpath.simulate(robot, duration=0.01).experiment.parameters == usual
    own = {"speed": usual.speed}
    shown = figure_of(robot, "circle", "path_following", **own)
    assert shown.parameters == usual


def test_the_flexible_robot_holds_its_path_with_its_defaults() -> None:
    run = onpath.simulate("flexible", hold=(3, 5))
    assert run.stopped_at is None and run.distance.max() < 0.006


def test_the_rise_of_a_path_is_followed() -> None:
    run = onpath.simulate("spatial_arm", rise=0.03, duration=2.0)
    heights = run.y[:, 2]
    assert heights.max() == pytest.approx(0.03, abs=1e-4)
    assert heights.min() == pytest.approx(-0.03, abs=1e-4)
    assert run.distance.max() < 1e-4
    other = onpath.simulate("spatial_arm", "ellipse", rise=0.02, duration=2.0)
    assert np.ptp(other.y[:, 2]) == pytest.approx(0.04, abs=2e-4)


def test_a_space_curve_has_no_rise_besides() -> None:
    from onpath.models.paths.space_curves import saddle

    curve = saddle(onpath.circle(0.05), 0.01)
    with pytest.raises(ValueError, match="rise: the path is a space curve"):
        onpath.simulate("spatial_arm", curve, rise=0.03)
    assert changed(ROBOTS["spatial_arm"].parameters(), "rise", 0.03)
