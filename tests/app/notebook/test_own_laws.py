"""Custom laws in Python do what other laws do, and what is wrong with one is its own."""

from __future__ import annotations

import dataclasses
import random
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any
from uuid import uuid4

import casadi as ca
import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.common.own_laws import compiled_law, law_given
from onpath.app.lab.commands.laws import ChooseLaw
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.new_lab import new_lab
from onpath.models.control.laws.law import ControlAction, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential
from onpath.models.control.laws.python_law import Now
from onpath.models.control.laws.registry import law_named
from onpath.models.systems.catalogue import ROBOTS
from tests.support.checkout import ROOT

EXAMPLE = f"{ROOT / 'assets' / 'examples' / 'own_law.py'}:SlidingMode"
HELD = {"hold": (0.5, 1.0), "duration": 1.5}


def by_function(now: Now) -> tuple[float, float]:
    """Path following without its integral."""
    return -now.K5 * (now.theta_rate - now.speed), -now.K1 * now.xi[0] - now.K2 * now.xi_rate[0]


class Summed:
    """Path following with an integral in Python's memory."""

    def __init__(self) -> None:
        self.sum = 0.0

    def __call__(self, now: Now) -> tuple[float, float]:
        along, across = by_function(now)
        across -= 500 * self.sum
        self.sum += now.interval * now.xi[0]
        return along, across


class SummedHere:
    """The same, compiled."""

    memory = (("summed", 1),)

    def command(self, view: View) -> ControlAction:
        gains, output, before = view.gains, view.output, view.clock.memory["summed"]
        along = -gains.k5 * (output.theta_rate - view.task.speed)
        across = -gains.k1 * output.xi - gains.k2 * output.xi_rate - 500 * before
        action = followed(view, along, across, output.acceleration_per_along)
        later = before + view.clock.interval * output.xi
        return dataclasses.replace(action, memory={"summed": later})


@pytest.mark.parametrize("rate", [1000, 100, 2000])
@pytest.mark.parametrize("robot", ["five_bar", "spatial_arm"])
def test_a_function_moves_the_robot_as_the_same_formula_does(robot: str, rate: int) -> None:
    def both(now: Now) -> tuple[float, ...]:
        along, _ = by_function(now)
        return along, *(-now.K1 * now.xi - now.K2 * now.xi_rate)

    in_space = ROBOTS[robot].make(ROBOTS[robot].parameters()).system.p == 3
    law = both if in_space else by_function
    text = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"
    text += "; across2 = -K1*xi2 - K2*dxi2" if in_space else ""
    values = {**HELD, "control_rate": rate, "hold_at": 1.0}
    runs = [onpath.simulate(robot, law=each, **values) for each in (law, text)]
    assert runs[0].held.any()
    np.testing.assert_allclose(runs[0].y, runs[1].y, atol=1e-9)


def test_python_keeps_its_memory_as_a_compiled_law_does_also_where_a_run_looks_ahead() -> None:
    """A hold at a place is found by running ahead and going back."""
    values = {**HELD, "hold_at": 1.0, "torque_limit": 0.2}
    runs = [onpath.simulate(law=law, **values) for law in (Summed, SummedHere, Summed)]
    np.testing.assert_allclose(runs[0].y, runs[1].y, atol=1e-9)
    assert np.array_equal(runs[0].y, runs[2].y)  # each run has a memory of its own


@pytest.mark.thorough
def test_an_object_begins_each_run_as_it_was_given() -> None:
    law, fresh = Summed(), onpath.simulate(law=Summed, **HELD)
    runs = [onpath.simulate(law=law, **HELD) for _ in range(3)]
    assert all(np.array_equal(run.y, fresh.y) for run in runs) and law.sum == 0.0
    bound = [onpath.simulate(law=law.__call__, **HELD) for _ in range(2)]
    assert all(np.array_equal(run.y, fresh.y) for run in bound) and law.sum == 0.0
    law.sum = 1e-4  # as the user has it now
    other = onpath.simulate(law=law, **HELD)
    assert not np.array_equal(other.y, fresh.y) and law.sum == 1e-4


def test_a_compiled_object_acts_as_it_is_now() -> None:
    class Pulling:
        factor = 1.0

        def command(self, view: View) -> ControlAction:
            across = -self.factor * view.gains.k1 * view.output.xi - 40 * view.output.xi_rate
            return followed(view, tangential(view), across)

    law = Pulling()
    before = [onpath.simulate(law=law, **HELD) for _ in range(2)]
    law.factor = 3.0
    after = onpath.simulate(law=law, **HELD)
    assert before[0].law == before[1].law != after.law
    assert after.max_distance < 0.7 * before[0].max_distance


def test_what_cannot_be_copied_is_named() -> None:
    class Logging(Summed):
        def __init__(self) -> None:
            super().__init__()
            self.log = open(__file__, encoding="utf-8")  # noqa: SIM115

    law = Logging()
    try:
        with pytest.raises(ValueError, match=r"copy of it, but its log, of type TextIOWrapper"):
            onpath.simulate(law=law)
    finally:
        law.log.close()


@pytest.mark.parametrize(
    "returned",
    [("0", "0"), (1j, 0), (0, 1 + 0j), (np.zeros(1), 0), (np.zeros(1), np.zeros(1)), (1, 2, 3)]
    + [0.0, None, "ab", b"ab", (True, False), (0, float("nan")), [[0, 0]], {0: 1, 1: 2}, (0, None)],
    ids=repr,
)
def test_what_a_law_returns_is_checked_before_the_first_run(returned: object) -> None:
    calls = list[float]()

    def odd(now: Now) -> object:
        calls.append(now.t)
        return returned

    with pytest.raises(ValueError, match=r"odd.* it returned .* \(test_own_laws.py, line \d+\)"):
        onpath.simulate(law=odd, duration=0.1)
    assert calls == [0.0]


@pytest.mark.parametrize(
    "call",
    [
        lambda law: onpath.simulate(law=law),
        lambda law: onpath.sweep(law=[law, "path_following"], duration=[0.1, 0.2]),
        lambda law: onpath.arena("five_bar", law, only=True, rounds=1),
    ],
    ids=["simulate", "sweep", "arena"],
)
def test_an_error_in_a_compiled_law_is_told_at_once_with_what_there_is(
    call: Callable[[Any], Any],
) -> None:
    class Odd:
        def command(self, view: Any) -> ControlAction:
            return followed(view, tangential(view), -view.gains.K1 * view.output.xi)

    with pytest.raises(ValueError, match=r"Odd.* it has k1, k2, .* \(test_own_laws.py, line \d+\)"):
        call(Odd)


@pytest.mark.parametrize("kind", [tuple, list, np.array, np.float32])
def test_any_two_real_numbers_are_a_command(kind: Any) -> None:
    def fine(now: Now) -> object:
        return kind([-now.K5 * (now.theta_rate - now.speed), 0])

    assert onpath.simulate(law=fine, duration=0.1).stopped_at is None


@pytest.mark.parametrize("limit", [0.0, 0.7])
def test_a_function_knows_the_torque_limits_which_are_infinite_if_there_are_none(
    limit: float,
) -> None:
    seen = list[np.ndarray]()

    def looking(now: Now) -> tuple[float, ...]:
        seen.append(now.torque_limit)
        return by_function(now)

    onpath.simulate(law=looking, duration=0.1, torque_limit=limit)
    assert np.array_equal(np.unique(seen), [limit or np.inf])


def broken(choice: random.Random) -> tuple[str, int]:
    """A file with a law `Law` that is broken in some way, and the line in which it is."""
    blank = ["# a remark"] * choice.randrange(8)
    junk = choice.choice(
        ["None", "1.0", "(1, 2, 3)", "'ab'", "(0, float('nan'))", "(float('inf'), 0)", "(1e300, 0)"]
        + ["[[0, 0]]", "{}", "(0, 'x')", "object()", "(1j, 0)", "print"]
    )
    wrong = choice.choice(
        [
            "1 / 0",
            "[][3]",
            "now.nothing",
            "{}['a']",
            "raise_it()",
            "int('x')",
            "now.xi[9]",
            "exit()",
        ]
    )
    tick = choice.randrange(300)
    called = ["def Law(now):", f"    if now.t > {tick}e-3:"]
    late = [*called, f"        return {junk}", "    return 0, 0"]
    raising = [*called, f"        {wrong}", "    return 0, 0"]
    endless = [*called, "        while True:", "            pass", "    return 0, 0"]
    made = ["class Law:", "    def __init__(self):", f"        {wrong.replace('now', 'self')}"]
    made += ["    def __call__(self, now):", "        return 0, 0"]
    odd = choice.choice(["view.nothing", "None", "3", "ca.SX(3)", "view", "ControlAction()"])
    imports = ["import casadi as ca", "from onpath.models.control.laws.law import ControlAction"]
    imports += ["from onpath.models.control.laws.path_following import followed, tangential"]
    symbolic = [*imports, "class Law:", "    def command(self, view):", f"        return {odd}"]
    root = ["        across = ca.sqrt(view.output.xi - 1e-6)"]
    root += ["        return followed(view, tangential(view), across)"]
    rooted = [*imports, "class Law:", "    def command(self, view):", *root]
    memory = [*imports, "class Law:", "    memory = (('kept', 2),)", "    def command(self, view):"]
    memory += ["        return followed(view, tangential(view), view.output.xi)"]
    lines, line = choice.choice(
        [(late, 1), (raising, 3), (endless, 4), (rooted, 5), (memory, 6)]
        + [(made, 3), (symbolic, 6 if odd == "view.nothing" else 5)]
    )
    return "\n".join([*blank, *lines]) + "\n", len(blank) + line


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(12))
def test_a_broken_law_stops_its_own_run_with_file_and_line(seed: int, tmp_path: Path) -> None:
    file = tmp_path / f"broken{seed}.py"
    text, line = broken(random.Random(seed))
    file.write_text(text)
    before = onpath.simulate(duration=0.2)
    told = ""
    try:
        run = onpath.simulate(law=f"{file}:Law", duration=0.5)
        assert run.stopped_at is not None and run.max_distance == np.inf
        told = run.reason
    except ValueError as error:
        told = str(error)
    near = [f"({file.name}, line {at})" for at in (line, line - 1)]  # the last line of a loop
    assert any(each in told for each in near), (told, text)
    assert sys.gettrace() is None
    assert np.array_equal(onpath.simulate(duration=0.2).y, before.y)


def test_the_same_class_is_the_same_law_and_a_changed_one_another() -> None:
    def fresh(factor: float) -> type:
        class Repeated:
            own_gains = (own_gain("factor_here", factor, "", (0, 9, 0.1), "times", label="F"),)

            def command(self, view: View) -> ControlAction:
                across = -view.own_gains["factor_here"] * view.gains.k1 * view.output.xi
                return followed(view, tangential(view), across - 40 * view.output.xi_rate)

        return Repeated

    first, second = fresh(1.0), fresh(4.0)
    names = [onpath.simulate(law=law, duration=0.1).law for law in (first, first, second, first)]
    assert names == ["Repeated", "Repeated", "Repeated_2", "Repeated"]
    assert onpath.simulate(law=second, duration=0.1, factor_here=2.0).law == "Repeated_2"
    assert onpath.simulate(duration=0.1).stopped_at is None  # a loop built before has no such gain


def test_a_file_is_read_again_after_a_change(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("def mine(now):\n    return 0, 0\n")
    assert law_given(f"{file}:mine") == law_given(f"{file}:mine") == "mine"
    file.write_text("def mine(now):\n    return 10 - now.theta_rate, 0\n")
    assert law_given(f"{file}:mine") == "mine_2"


def test_laws_of_a_file_that_runs_them_itself_keep_their_names(tmp_path: Path) -> None:
    file = tmp_path / "used_here.py"
    readme = (ROOT / "README.md").read_text("utf-8")
    codes = re.findall(r"```python\n(.*?)```", readme, re.S)
    [code] = [each for each in codes if "class SlidingMode" in each]
    alone = uuid4().hex  # a name is another law's as long as the process lasts
    law, simple = f"Law_{alone}", f"simple_{alone}"
    file.write_text(code.replace("SlidingMode", law).replace("plain", simple))
    for name in (law, simple, law):
        assert law_given(f"{file}:{name}") == name
        assert law_named(name).source == file.name


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("no_such.py:Law", "there is no such file"),
        (f"{EXAMPLE}Typo", "did you mean SlidingMode"),
        (3, "of type int"),
        (ModuleType("m"), "of type module"),
    ],
)
def test_what_is_no_law_is_refused(law: object, words: str) -> None:
    with pytest.raises((ValueError, FileNotFoundError), match=words):
        onpath.simulate(law=law)


def test_no_law_takes_the_name_of_one_of_ours() -> None:
    class Taken:
        name = "path_following"

        def command(self, view: View) -> ControlAction:
            return followed(view, tangential(view), ca.SX(0))

    with pytest.raises(ValueError, match="choose another name"):
        law_given(Taken)


def test_a_file_is_never_run_for_a_browser(tmp_path: Path) -> None:
    file = tmp_path / "hostile.py"
    file.write_text(f"open({str(tmp_path / 'trace')!r}, 'w')\ndef law(now):\n    return 0, 0\n")
    lab = new_lab(LoopCache(at_once=True), built_in_course())
    with pytest.raises(ValueError, match="unknown law"):
        ChooseLaw("right", f"{file}:law").apply(lab)
    assert not (tmp_path / "trace").exists()


def test_a_lab_begins_with_the_law_and_a_fault_in_it_stops_its_own_robot() -> None:
    class Roots:
        def command(self, view: View) -> ControlAction:
            across = -40 * view.output.xi_rate + ca.sqrt(1e-3 - view.clock.memory["age"])
            action = followed(view, tangential(view), across)
            later = view.clock.memory["age"] + 1e-3 * view.clock.interval / 0.3
            return dataclasses.replace(action, memory={"age": later})

        memory = (("age", 1),)

    lab = new_lab(LoopCache(at_once=True), built_in_course(), law=compiled_law(Roots))
    assert lab.simulation.laws == {"left": "trajectory_tracking", "right": "Roots"}
    lab.simulation.simulate(600)
    assert lab.simulation.faults == ["right"]
    stop = lab.simulation.runs["right"].diverged
    assert stop is not None and "(test_own_laws.py, line" in str(stop.reason)


@pytest.mark.thorough
def test_the_command_line_takes_a_law_of_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "own.html"
    assert run_command(["experiment", "obstruction", "--law", f"path_following,{EXAMPLE}"]) == 0
    assert "SlidingMode" in capsys.readouterr().out
    assert run_command(["figure", str(page), "--law", EXAMPLE, "--path", "circle"]) == 0
    assert page.stat().st_size > 1e5
    compared = ["compare", "--law", EXAMPLE, "--obstruction", "brake"]
    assert run_command(compared) == 0 and "SlidingMode" in capsys.readouterr().out
    function = EXAMPLE.replace("own_law.py:SlidingMode", "own_function.py:Patient")
    assert run_command(["compare", "--law", function]) == 2
    assert "called in every control interval" in capsys.readouterr().err
    assert run_command(["--classroom", "--law", EXAMPLE]) == 2
    assert "a class has the laws of OnPath only" in capsys.readouterr().err
