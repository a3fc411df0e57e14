"""`onpath` in Python: the numbers of the command line, arrays with units, clear complaints."""

from __future__ import annotations

import doctest
import importlib
import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import onpath
from onpath.app.cli.main import run_command
from onpath.models.control.settable import specs
from onpath.models.studies.experiments import experiments
from onpath.models.systems.catalogue import FLEXIBLE
from tests.support import stranger
from tests.support.checkout import ROOT
from tests.support.robot_files import PLANAR, urdf

LAWS = ("trajectory_tracking", "path_following")  # of onpath.laws()


ARGUMENTS: dict[str, dict[str, Any]] = {
    "obstruction": {
        "duration": 1.0,
        "hold": (0.3, 0.6),
        "hold_at": 1.0,
        "hold_direction": "both",
        "wall": (0.2, 0.9, (0.0, 0.03), -1.5),
    },
    "position": {"duration": 0.5, "task": "position", "velocity": (0.1, 0.05), "clock_offset": 0.4},
    "flexible": {"robot": "flexible", "output": "redefined", "duration": 0.5, "reverse_at": 0.3},
}
SET = {
    "obstruction": {
        "duration": 1.0,
        "hold_from": 0.3,
        "hold_to": 0.6,
        "hold_at": 1.0,
        "hold_direction": "both",
        "wall_from": 0.2,
        "wall_to": 0.9,
        "wall_z2": 0.03,
        "wall_angle": -1.5,
    },
    "position": {"duration": 0.5, "start_along": 0.1, "start_across": 0.05, "clock_offset": 0.4},
    "flexible": {"duration": 0.5, "reverse_at": 0.3},
}
PUSH = {"push_from": 0.1, "push_to": 0.2, "push_z1": 0.06, "push_z2": 0.01}


@pytest.mark.filterwarnings("ignore:no effect under path following. clock_offset")
@pytest.mark.parametrize("name", ARGUMENTS)
def test_bytes_are_those_of_the_command_line(name: str, tmp_path: Path) -> None:
    assignments = {**SET[name], **PUSH, "K1": 500, "control_rate": 500}
    told = [f"--set={key}={value}" for key, value in assignments.items()]
    expected, file = tmp_path / "expected.csv", tmp_path / "run.csv"
    assert run_command(["experiment", name, *told, "--csv", str(expected)]) == 0
    values = {**ARGUMENTS[name], "push": (0.1, 0.2, (0.06, 0.01)), "K1": 500, "control_rate": 500}
    start = experiments()[name].begin()
    first, *others = [onpath.simulate(law=law, start=start, **values) for law in LAWS]
    first.to_csv(file, *others)
    assert file.read_bytes() == expected.read_bytes()


def test_a_run_has_a_row_per_millisecond_of_everything() -> None:
    run = onpath.simulate("flexible", duration=0.1, modes=2)
    shapes = {
        **dict.fromkeys(("t", "theta", "theta_rate", "theta_ref"), ()),
        **dict.fromkeys(("distance", "speed", "held"), ()),
        **dict.fromkeys(("q", "v"), (5,)),
        **dict.fromkeys(("y", "torque", "force"), (3,)),
        **dict.fromkeys(("xi", "xi_rate"), (2,)),
    }
    for name, shape in shapes.items():
        assert getattr(run, name).shape == (100, *shape), name
        assert "shape (n" in getattr(onpath.Run, name).__doc__
    assert run.t == pytest.approx(np.arange(100) * 1e-3)


def test_arrays_agree_with_each_other() -> None:
    run = onpath.simulate(path=onpath.ellipse(0.06, 0.04), duration=1.5, start=(0.05, 0.0))
    away = np.linalg.norm(run.y - run.experiment.curve().at(run.theta), axis=1)
    assert away[5:] == pytest.approx(run.distance[5:], abs=1e-5)
    assert np.abs(run.xi[:, 0]) == pytest.approx(run.distance, abs=1e-5)
    assert run.distance[0] == pytest.approx(0.01) and run.distance[-1] < 1e-3
    for values, rate in ((run.q, run.v), (run.xi, run.xi_rate)):
        middle = (values[2:] - values[:-2]) / 2e-3
        half_a_tick = 0.5e-3 * np.abs(np.diff(rate, axis=0)).max() / 1e-3  # the law looks ahead
        assert middle == pytest.approx(rate[1:-1], abs=1.1 * half_a_tick)


def test_a_hand_pulls_towards_its_place_while_it_does() -> None:
    place = np.array([0.0, 0.07])
    run = onpath.simulate(duration=0.5, push=(0.2, 0.4, place), speed=0)
    pulls = (run.t > 0.1995) & (run.t < 0.3995)
    assert np.array_equal(np.any(run.force != 0, axis=1), pulls) and not run.held.any()
    begun = int(pulls.argmax())
    towards = place - run.y[begun]
    assert run.force[begun] / np.linalg.norm(run.force[begun]) == pytest.approx(
        towards / np.linalg.norm(towards), abs=1e-3
    )
    assert np.linalg.norm(run.force, axis=1).max() <= 15 + 1e-9


def test_output_of_the_flexible_robot_can_be_chosen() -> None:
    run = onpath.simulate("flexible", output="composite", duration=0.05)
    assert getattr(run.experiment.parameters, "output", None) == "composite"


@pytest.mark.parametrize("robot", onpath.robots())
def test_every_parameter_is_listed_with_its_range_and_can_be_set(robot: str) -> None:
    listed = onpath.parameters(robot)
    assert listed["K1"].startswith("400, 0 to 2500 1/s²: ")
    assert len(listed) == len(
        specs(type(onpath.simulate(robot, duration=0.01).experiment.parameters))
    )
    for name, text in listed.items():
        wrong: Any = {name: "no such value"}
        with pytest.raises(ValueError, match=re.escape(name)):
            onpath.simulate(robot, **wrong)
        assert re.match(r"\S+, (one of|\S+ to \S+)", text)
    assert "output" in onpath.parameters(FLEXIBLE.name)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"robot": "fivebar"}, "did you mean five_bar"),
        ({"robot": ["five_bar"]}, "robot: expected one, got several, which onpath.sweep takes"),
        ({"path": ["circle", "clover"]}, "path: expected one, got several, which onpath.sweep"),
        ({"K1": [400, 900]}, "K1: expected one, got several, which onpath.sweep takes"),
        ({"path": "elipse"}, "did you mean ellipse"),
        ({"path": onpath.circle(0.3)}, "leaves the workspace"),
        ({"path": onpath.circle(0.005)}, "bends too sharply"),
        ({"law": "folowing"}, "path_following"),
        ({"law": LAWS}, "law: expected one, got several, which onpath.sweep takes"),
        ({"law": 3}, "a law is a name of onpath.laws()"),
        ({"law": "zzz"}, "(onpath.laws() lists all)"),
        ({"path": "zzz"}, "(onpath.paths() lists all)"),
        ({"robot": "zzz"}, "(onpath.robots() lists all)"),
        ({"zzz": 1}, "(onpath.parameters('five_bar') lists all)"),
        ({"path": "my logo.svg fit=0.1"}, "a file is given as '@my logo.svg fit=0.1'"),
        ({"law": "my_law.py"}, "expected FILE.py:NAME"),
        ({"path": "circle 50"}, "50 m: did you mean 0.05?"),
        ({"start": (50, 0)}, "50 m: did you mean 0.05?"),
        ({"duration": "8"}, "duration: '8' is not a number"),
        ({"K1": "900"}, "K1: '900' is not a number"),
        ({"k1": 3}, "did you mean K1"),
        ({"durations": 3}, "did you mean duration"),
        ({"r": 0.03}, "unknown parameter 'r'"),
        ({"K1": 9999}, "between 0 and 2500 1/s²"),
        ({"K1": "much"}, "'much' is not a number"),
        ({"task": "dance"}, "speed, position"),
        ({"duration": -1}, "between 0.01 and 600 s"),
        ({"reverse_at": None}, "None is not a number"),
        ({"hold": 3}, "hold: expected (from, to), [s]"),
        ({"hold": (5, 3)}, "hold_to (3 s) lies before hold_from (5 s)"),
        ({"hold": (0, float("nan"))}, "hold: expected (from, to), [s]"),
        ({"push": (1, 2)}, "push: expected (from, to, (z1, z2)), [s] and [m]"),
        ({"push": (1, 2, 3)}, "push: expected (from, to, (z1, z2)), [s] and [m]"),
        ({"push": (1, 2, (3, 3))}, "push_z1: 3.0 is not between -0.4 and 0.4 m"),
        ({"velocity": 1}, "velocity: expected (along, across), [m/s]"),
        ({"wall": (1, 2, (0, 0))}, "wall: expected (from, to, (z1, z2), angle)"),
        ({"hold_at": 9}, "hold_at: 9.0 is not between"),
        ({"hold_direction": "up"}, "along, across, both"),
        ({"profile": 3}, "profile: expected times and speeds"),
        ({"start": "here"}, "start: expected a point, shape (2,), [m]"),
        ({"start": (1, 1)}, "out of reach"),
        ({"robot": "flexible", "start": 0.1}, "shape (2,) or (3,), [m]"),
    ],
)
def test_complaint_names_what_was_expected(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=re.escape(words)):
        onpath.simulate(**values)


@given(
    st.floats(0.02, 0.12), st.sampled_from([onpath.circle, lambda r: onpath.ellipse(r, 0.9 * r)])
)
def test_a_path_in_millimetres_is_asked_about(radius: float, made: Callable[[float], Any]) -> None:
    with pytest.warns(UserWarning, match=r"\d m: did you mean 0\.\d+\?"):
        path = made(1000 * radius)
    with pytest.raises(ValueError, match="did you mean"):
        onpath.simulate(path=path)


@pytest.mark.parametrize(
    "read",
    [
        lambda: onpath.robot("no.urdf"),
        lambda: onpath.simulate("no.urdf"),
        lambda: onpath.simulate(path="@no.svg"),
        lambda: onpath.simulate(path=Path("no.svg")),
        lambda: onpath.simulate(law="no.py:Law"),
        lambda: onpath.check_path("no.urdf"),
        lambda: onpath.path_from("no.csv"),
        lambda: onpath.identify("five_bar", "no.csv"),
    ],
)
def test_a_missing_file_is_one_kind_of_error(read: Callable[[], Any]) -> None:
    with pytest.raises(FileNotFoundError, match=r"no\.\w+: there is no such file"):
        read()


@pytest.mark.thorough
def test_files_are_read_wherever_a_robot_a_path_or_a_law_is_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "arm.urdf").write_text(urdf("own", PLANAR), "utf-8")
    (tmp_path / "way.csv").write_text("50,0\n0,40\n-50,0\n0,-40\n", "utf-8")
    (tmp_path / "law.py").write_text("def same(now):\n    return 0, -400 * now.xi[0]\n", "utf-8")
    way = "@~/way.csv unit=mm"
    run = onpath.simulate("~/arm.urdf", way, "~/law.py:same", duration=0.02)
    assert run.law == "same" and len(run.q[0]) == 3
    run.to_csv("~/run.csv")
    run.plot("~/run.png")
    assert {"run.csv", "run.png"} < {each.name for each in tmp_path.iterdir()}
    assert onpath.check_path("five_bar", way).ok
    assert "K1" in onpath.parameters("~/arm.urdf")


WAY_FIRST = onpath.circle(0.05), "five_bar"


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (
            lambda: cast("Any", onpath.check_path)(onpath.circle(0.05), "five_bar"),
            "robot comes first",
        ),
        (lambda: onpath.check_path("clover"), "robot comes first"),
        (lambda: onpath.identify("arm.csv"), "identify(robot, file)"),
        (lambda: onpath.identify("arm.csv", "five_bar"), "identify(robot, file)"),
    ],
)
def test_the_former_order_is_answered_with_the_right_one(
    call: Callable[[], Any], told: str
) -> None:
    with pytest.raises(TypeError, match=re.escape(told)):
        call()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("start", [(1e300, 0.0), (0.0, 1e160), (-1e308, 1e308), (1e154, 1e154)])
@pytest.mark.parametrize("robot", onpath.robots())
def test_a_start_beyond_the_range_of_numbers_is_out_of_reach(
    robot: str, start: tuple[float, float]
) -> None:
    with pytest.raises(ValueError, match="out of reach"):
        onpath.simulate(robot, start=start)


def test_a_path_and_a_profile_may_be_text() -> None:
    told = onpath.simulate(path="ellipse 0.06 0.04", profile="0:0, 0.1:2", duration=0.2)
    made = onpath.simulate(
        path=onpath.ellipse(0.06, 0.04), profile=[(0, 0), (0.1, 2)], duration=0.2
    )
    assert np.array_equal(told.y, made.y) and told.distance.max() < 1e-5


def test_an_invalid_path_is_refused() -> None:
    for make, words in (
        (lambda: onpath.ellipse(0, 1), "half axes: expected positive"),
        (lambda: onpath.circle(float("nan")), "radius: expected positive"),
        (lambda: onpath.circle(0.05, (1,)), "centre: expected a point"),  # type: ignore[arg-type]
        (lambda: onpath.segment((0, 0), (0, 0)), "at least 2 points"),
        (lambda: onpath.through([[0, 0], [1]]), "points: expected"),  # type: ignore[list-item]
        (lambda: onpath.simulate(path=np.eye(2)), "path: onpath.through(points) makes"),  # type: ignore[arg-type]
        (lambda: onpath.simulate(path=[(0, 1)]), "path: onpath.through(points) makes"),  # type: ignore[arg-type]
        (lambda: onpath.figure(path=[[(0, 1)]]), "path: onpath.through"),  # type: ignore[list-item]
        (lambda: onpath.simulate(law=3), "but nothing of type int"),
    ):
        with pytest.raises(ValueError, match=re.escape(words)):
            make()


def test_a_path_that_leaves_its_polygon_warns(recwarn: pytest.WarningsRecorder) -> None:
    square = 0.05 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    with pytest.warns(UserWarning, match="18.7 mm away from the lines") as told:
        assert onpath.through(square).deviation == pytest.approx(18.74e-3, abs=5e-5)
    assert told[0].filename == __file__
    angle = np.linspace(0, 2 * np.pi, 5000, endpoint=False)
    assert onpath.through(0.05 * np.column_stack([np.cos(angle), np.sin(angle)])).deviation < 1e-4
    assert not recwarn.list


def test_a_path_goes_through_its_points() -> None:
    points = np.array([[0.05, 0.0], [0.0, 0.04], [-0.05, 0.0], [0.0, -0.04]])
    for closed in (True, False):
        with pytest.warns(UserWarning, match="between the given points"):  # they are far apart
            curve = onpath.through(points, closed)
        assert curve.nearest(points)[1].max() < 1e-3 and curve.closed is closed
    end = onpath.segment((0.0, 0.01), (0.03, 0.02)).at(np.array(np.pi))
    assert end == pytest.approx([0.03, 0.02])


@pytest.mark.thorough
def test_pictures_and_files_are_whole_or_refused(tmp_path: Path) -> None:
    run, other = (onpath.simulate(law=law, duration=0.05) for law in LAWS)
    figure: Any = run.plot(other, file=tmp_path / "run.svg")
    assert (tmp_path / "run.svg").read_text().startswith("<?xml")
    assert figure._repr_png_().startswith(b"\x89PNG")
    elsewhere = onpath.simulate(path="ellipse", duration=0.05)
    for fail, words in (
        (lambda: run.plot(file=tmp_path / "run.doc"), "expected a name ending in .png"),
        (lambda: run.to_csv(tmp_path / "no" / "run.csv"), "no folder"),
        (lambda: run.plot(elsewhere), "one robot on one path"),
        (lambda: run.to_csv(tmp_path / "two.csv", elsewhere), "one robot on one path"),
    ):
        with pytest.raises(ValueError, match=words):
            fail()
    assert [file.name for file in tmp_path.iterdir()] == ["run.svg"]


def test_a_run_tells_what_happened() -> None:
    run = onpath.simulate(duration=0.3, K1=2500, K2=0, control_rate=50, start=(0.03, 0))
    assert run.stopped_at is not None and run.t[-1] < run.stopped_at
    assert run.reason in repr(run) and "max distance" in repr(run) and "path following" in repr(run)
    assert run.summary()["stopped_at_s"] == pytest.approx(run.stopped_at)


def test_a_law_that_fails_at_once_is_not_the_best_one() -> None:
    laws = ("across = -K1*sqrt(xi); along = 0", "trajectory_tracking", "path_following")
    runs = {law: onpath.simulate(law=law, duration=4.0, hold=(3, 3.5)) for law in laws}
    assert min(runs, key=lambda law: runs[law].max_distance) == "path_following"
    stopped = runs[laws[0]]
    assert stopped.stopped_at is not None and stopped.max_distance == np.inf
    assert np.isfinite(stopped.distance).all()  # what was recorded stays data
    told = stopped.summary()
    assert told["max_distance_m"] == told["max_distance_while_held_m"] == np.inf
    assert "stopped" in repr(stopped) and "0.00 mm" not in repr(stopped)
    for law in laws[1:]:
        assert runs[law].max_distance == runs[law].distance.max()


DOCUMENTED = ("simulate", "figure", "identify", "path_files")


@pytest.mark.thorough
@pytest.mark.parametrize("module", ["", *(f".app.notebook.{name}" for name in DOCUMENTED)])
def test_examples_in_docstrings_do_what_they_show(module: str) -> None:
    failed, tried = doctest.testmod(importlib.import_module(f"onpath{module}"))
    assert tried > 2 and failed == 0


def test_the_example_of_the_readme_with_a_drawing_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("svgpathtools")
    text = (ROOT / "README.md").read_text("utf-8")
    (example,) = re.findall(r"```python\n([^`]*path_from.*?)```", text, re.DOTALL)
    drawing = (ROOT / "assets" / "examples" / "leaf.svg").read_text("utf-8")
    (tmp_path / "logo.svg").write_text(drawing, "utf-8")
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exec(compile(example, "README.md", "exec"), {"onpath": onpath})


def test_the_example_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    (example,) = re.findall(r"## From Python\n.*?```python\n(.*?)```", text, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    exec(compile(example, "README.md", "exec"), {})
    assert {file.suffix for file in tmp_path.iterdir()} == {".csv", ".png", ".html"}


def test_the_package_alone_imports_next_to_nothing(tmp_path: Path) -> None:
    code = "import sys, onpath; print(*sys.modules, *dir(onpath), sep='\\n')"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=stranger.environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    names = done.stdout.split()
    assert not {"numpy", "casadi", "viser", "onpath.app"} & set(names)
    assert set(onpath.__all__) <= set(names)
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        _ = onpath.simulat  # type: ignore[attr-defined]


def test_the_list_of_paths_says_which_are_refused_and_the_refusal_names_the_path() -> None:
    for name, text in onpath.paths().items():
        if ", refused: " not in text:
            assert len(onpath.simulate(path=name, duration=0.02).t) == 20
            continue
        with pytest.raises(ValueError, match=name) as refusal:
            onpath.simulate(path=name, duration=0.02)
        assert text.split("refused: ")[1] in str(refusal.value)


def test_a_hold_that_never_happens_is_told() -> None:
    with pytest.warns(UserWarning, match="did not pass"):
        run = onpath.simulate(hold=(0.1, 0.2), hold_at=-2.0, duration=0.3)
    assert "did not pass" in repr(run) and not run.held.any()
