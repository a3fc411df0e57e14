"""A controller in C is that in Python, bit by bit, whatever it is given."""

from __future__ import annotations

import ctypes
import math
import re
import shutil
import subprocess
import time
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.notebook.controller import Controller
from onpath.models.arrays import Array
from onpath.models.paths.distance import path_distance
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab_log import lab_log
from tests.support.robot_files import PLANAR, urdf

COMPILERS = [found for name in ("gcc", "clang") if (found := shutil.which(name))]
pytestmark = pytest.mark.skipif(not COMPILERS, reason="there is no C compiler")
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Wshadow", "-Werror"]
CHECKED = ["-fsanitize=undefined", "-fno-sanitize-recover=all", "-g"]
EQUAL = "equal to the last bit"


def compiled(compiler: str, file: Path, *options: str) -> str:
    """What the replay of a controller prints, which must succeed."""
    replay, program = file.with_name(f"{file.stem}_replay.c"), file.with_suffix(".out")
    command = [compiler, *STRICT, *options, str(file), str(replay), "-lm", "-o", str(program)]
    subprocess.run(command, check=True, cwd=file.parent)
    done = subprocess.run([str(program)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.thorough
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize(
    ("robot", "given"),
    [
        ("five_bar", {}),
        ("two_link_arm", {"law": "trajectory_tracking", "control_rate": 250, "delay": 1.5}),
    ],
)
def test_a_replay_of_the_lab_is_equal_to_the_last_bit(
    tmp_path: Path, compiler: str, robot: str, given: dict[str, Any]
) -> None:
    file = onpath.controller(robot, **given).save(tmp_path / "law.c")
    printed = compiled(compiler, file, "-O2", *CHECKED)
    assert printed.count(EQUAL) == 2, printed


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["seven_axes", "flexible", "cart_pendulum", "spatial_arm"])
def test_replays_of_other_robots_are(tmp_path: Path, robot: str) -> None:
    """Seven axes, too, take less than a minute to compile."""
    file = onpath.controller(robot).save(tmp_path / "law.c")
    begin = time.monotonic()
    printed = compiled(COMPILERS[0], file, "-O2")
    assert time.monotonic() - begin < 60
    bends = ROBOTS[robot].flexible_link is not None
    assert printed.count(EQUAL) == (1 if bends else 2), printed


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "flexible", "cart_pendulum"])
def test_with_other_flags_they_are_within_the_stated_share(tmp_path: Path, robot: str) -> None:
    """The replay fails beyond 1e-9; with products and sums contracted, there are differences."""
    file = onpath.controller(robot).save(tmp_path / "law.c")
    compiled(COMPILERS[0], file, "-O3", "-march=native", "-ffp-contract=fast")


@pytest.mark.thorough
def test_drawings_and_laws_of_one_s_own_are_replayed(tmp_path: Path) -> None:
    pytest.importorskip("svgpathtools")
    from onpath.assets import asset_path

    text = "across = -K1*xi - K2*tanh(dxi); along = -K5*(dtheta - speed)"
    drawing = f"@{asset_path('examples/leaf.svg')} fit=0.08"
    for path, law in (("circle", text), (drawing, "path_following")):
        file = onpath.controller("two_link_arm", path, law).save(tmp_path / "law.c")
        assert compiled(COMPILERS[0], file, "-O1").count(EQUAL) == 2


class InC:
    """A controller in C, as a library."""

    def __init__(self, controller: Controller, folder: Path) -> None:
        file = controller.save(folder / "law.c")
        library = file.with_suffix(".so")
        command = [COMPILERS[0], *STRICT, "-O1", "-fPIC", "-shared", str(file), "-lm"]
        subprocess.run([*command, "-o", str(library)], check=True)
        self._library = ctypes.CDLL(str(library))
        self._library.law_closest.restype = ctypes.c_double
        functions = controller.design.functions
        self._settings, self._m = functions.settings, controller.design.robot.system.m
        size = functions.settings.size + functions.state.size + 2  # and two pointers
        self._memory = np.zeros(size)
        self._library.law_init(self._place(self._memory))

    @property
    def settings(self) -> dict[str, Array]:
        return self._settings.unpack(self._memory[: self._settings.size])

    def closest(self, q: Array) -> float:
        return self._library.law_closest(self._place(self._memory), self._place(q))

    @property
    def draws(self) -> bool:
        return bool(self._library.law_draws(self._place(self._memory)))

    def follow(self, path: int) -> None:
        self._library.law_follow(self._place(self._memory), ctypes.c_int(path))

    def stop(self) -> None:
        self._library.law_stop(self._place(self._memory))

    def start(self, t: float, q: Array, v: Array | None, theta: float) -> None:
        times = ctypes.c_double(t), self._place(q), self._place(v), ctypes.c_double(theta)
        self._library.law_start(self._place(self._memory), *times)

    def step(self, t: float, q: Array, v: Array | None) -> tuple[Array, int]:
        torque = np.full(self._m, np.nan)
        places = self._place(q), self._place(v), self._place(torque)
        memory = self._place(self._memory)
        code = self._library.law_step(memory, ctypes.c_double(t), *places)
        return torque, code

    @staticmethod
    def _place(array: Array | None) -> ctypes.c_void_p:
        return ctypes.c_void_p(None if array is None else array.ctypes.data)


@cache
def both(at_fault: str) -> tuple[InC, Any]:
    """The same controller in C and, made anew for each run, in Python; and a log."""
    import tempfile

    def made() -> Controller:
        paths = ["circle", onpath.ellipse(0.06, 0.04)]
        return onpath.controller("two_link_arm", paths, at_fault=at_fault, control_rate=500)

    return InC(made(), Path(tempfile.mkdtemp())), made


@cache
def log() -> Any:
    return lab_log("two_link_arm", "circle", "path_following", duration=0.2, control_rate=500)


NUMBERS = st.sampled_from([0.0, 1e-3, -0.3, math.nan, math.inf, -1e308, 60.0, 200.0])
EVENTS = st.one_of(
    st.tuples(st.just("bad q"), st.integers(0, 1), NUMBERS),
    st.tuples(st.just("bad v"), st.integers(0, 1), NUMBERS),
    st.tuples(st.just("gap"), st.integers(1, 8), st.just(0.0)),
    st.tuples(st.just("time"), st.just(0), st.sampled_from([-0.01, 0.0004, -0.0007, math.nan])),
    st.tuples(st.just("no v"), st.just(0), st.just(0.0)),
    st.tuples(st.just("start"), st.just(0), st.just(0.0)),
    st.tuples(st.just("speed"), st.just(0), st.integers(-5, 5)),
    st.tuples(st.just("K1"), st.just(0), st.integers(0, 2000)),
    st.tuples(st.just("follow"), st.integers(0, 1), st.just(0.0)),
    st.tuples(st.just("stop"), st.just(0), st.just(0.0)),
)


@pytest.mark.thorough
@pytest.mark.parametrize("at_fault", ["zero", "hold", "damp"])
@settings(max_examples=15)
@given(events=st.dictionaries(st.integers(0, 60), EVENTS, max_size=5))
def test_c_does_what_python_does_whatever_happens(
    at_fault: str, events: dict[int, tuple[str, int, float]]
) -> None:
    """Same torques, same codes: with numbers that are not finite, jumps, gaps, and changes."""
    in_c, made = both(at_fault)
    controller: Controller = made()
    known = log()
    in_c.follow(0)
    for name, value in controller.design.functions.settings.unpack(
        controller.design.settings(next(iter(controller.design.paths.values())))
    ).items():
        in_c.settings[name][:] = value
    names = [*controller.design.paths]
    measures, k = True, 0
    start_both(in_c, controller, 0.0, known.q[0])
    for count in range(60):
        kind, place, number = events.get(count, ("", 0, 0.0))
        t, q, v = float(known.t[k]), known.q[k].copy(), known.v[k].copy()
        if kind == "bad q":
            q[place] = number
        elif kind == "bad v":
            v[place] = number
        elif kind == "time":
            t += number
        elif kind == "no v":
            measures = not measures
        elif kind == "start":
            start_both(in_c, controller, t, q)
        elif kind in ("speed", "K1"):
            controller.set(**{kind: number})
            in_c.settings[kind][:] = number
        elif kind == "follow":
            theta = follow_both(in_c, controller, names, place)
            assert math.isfinite(theta)
            start_both(in_c, controller, t, q)  # at the same θ, to the last bit
        elif kind == "stop":
            controller.stop()
            in_c.stop()
        torque, code = in_c.step(t, q, v if measures else None)
        assert np.array_equal(controller.step(t, q, v if measures else None), torque)
        assert controller.code == code and np.isfinite(torque).all()
        k += 1 + (place if kind == "gap" else 0)


def start_both(in_c: InC, controller: Controller, t: float, q: Array) -> None:
    controller.start(t, q)
    in_c.start(t, q, None, controller.theta)


@settings(max_examples=30)
@given(place=st.tuples(st.floats(-0.07, 0.07), st.floats(-0.07, 0.07)), path=st.integers(0, 1))
def test_the_search_in_c_finds_the_closest_point(place: tuple[float, float], path: int) -> None:
    in_c, made = both("zero")
    design = made().design
    robot, curve = design.robot, list(design.paths.values())[path]
    q = robot.rest(np.array(place))
    in_c.follow(path)
    found = robot.frame.lift(curve.at(np.array(in_c.closest(q))))
    least = path_distance(robot.frame, curve, robot.endpoint(q)[None])[0]
    assert np.linalg.norm(found - robot.endpoint(q)) < least + 1e-9


def follow_both(in_c: InC, controller: Controller, names: list[str], path: int) -> float:
    controller.follow(names[path])
    in_c.follow(path)
    return controller.theta


@pytest.mark.thorough
def test_names_of_a_file_are_safe(tmp_path: Path) -> None:
    """A joint's name cannot end a comment, and a file may have any name."""
    text = urdf("planar", PLANAR).replace("joint1", "*/ int main(")
    robot = tmp_path / "arm.urdf"
    robot.write_text(text, "utf-8")
    file = onpath.controller(robot).save(tmp_path / "2nd law α.c")
    assert compiled(COMPILERS[0], file).count(EQUAL) == 2


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore:.*The pen is raised")
def test_the_pen_is_up_between_the_strokes_of_a_drawing(tmp_path: Path) -> None:
    """As the path says, in C and in Python, at places all along it."""
    pytest.importorskip("svgpathtools")
    lines = '<path d="M5 5 L35 5 L35 30"/><path d="M45 10 L75 50 L45 50"/>'
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 80 60">{lines}</svg>'
    (tmp_path / "strokes.svg").write_text(text, "utf-8")
    path = f"@{tmp_path / 'strokes.svg'} fit=0.08"
    controller = onpath.controller("two_link_arm", path)
    in_c, design = InC(controller, tmp_path), controller.design
    robot, curve = design.robot, next(iter(design.paths.values()))
    seen = set[bool]()
    for theta in np.linspace(-3, 3, 61):
        q = robot.rest(robot.frame.lift(curve.at(theta)))
        controller.start(0.0, q, theta=float(theta))
        in_c.start(0.0, q, None, float(theta))
        assert controller.draws == in_c.draws
        seen.add(controller.draws)
    assert seen == {True, False}


def test_what_is_guessed_about_the_robot_stands_in_the_header(tmp_path: Path) -> None:
    robot = tmp_path / "arm.urdf"
    text = re.sub("<inertial>.*?</inertial>", "", urdf("planar", PLANAR), flags=re.DOTALL)
    robot.write_text(text, "utf-8")
    with pytest.warns(UserWarning, match="states no masses"):
        file = onpath.controller(robot).save(tmp_path / "law.c")
    assert "states no masses" in file.with_suffix(".h").read_text("utf-8")


def test_the_file_needs_no_library_but_libm_and_no_heap(tmp_path: Path) -> None:
    file = onpath.controller().save(tmp_path / "law.c")
    made = tmp_path / "law.o"
    subprocess.run([COMPILERS[0], "-std=c99", "-c", str(file), "-o", str(made)], check=True)
    symbols = subprocess.run(["nm", str(made)], capture_output=True, text=True, check=True).stdout
    needed = {each.lstrip("_") for each in re.findall(r" U (\w+)", symbols)}
    libm, others = {"sin", "cos", "exp", "sqrt", "floor"}, {"memset", "memcpy", "stack_chk_fail"}
    assert needed <= libm | others | {"GLOBAL_OFFSET_TABLE_"}
    assert not re.search(r" [BbDd] ", symbols)  # no data that changes
