"""A law with an operation that no compiler translates is interpreted; it disturbs no other law."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import casadi as ca
import pytest

from onpath.app.cli.main import run_command
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops import loop_cache as module
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.control.laws.law import ControlAction, View
from onpath.models.control.laws.path_following import LAW as PATH_FOLLOWING
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import LEFT
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.support.lab import FRAME, do, finish, run

OPERATIONS = {"inverse": ca.OP_ERFINV}


@pytest.fixture(params=OPERATIONS)
def law(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """A law of the registry that cannot be compiled."""

    def command(view: View) -> ControlAction:
        action = PATH_FOLLOWING.command(view)
        assert action.acceleration is not None and action.error is not None
        added = 1e-3 * ca.SX.unary(OPERATIONS[request.param], action.error[0])
        return replace(action, acceleration=action.acceleration + added)

    own = replace(PATH_FOLLOWING, name=request.param, label="Of the test", command=command)
    monkeypatch.setitem(LAWS, request.param, own)
    return request.param


@pytest.fixture
def loop_cache() -> Iterator[LoopCache]:
    made = LoopCache()
    yield made
    made.close()


def test_others_are_still_compiled(
    loop_cache: LoopCache, law: str, caplog: pytest.LogCaptureFixture
) -> None:
    robot = RIGID_FIVE_BAR
    with caplog.at_level(logging.WARNING, module.__name__):
        for _ in range(3):
            loop_cache.prepare(robot, Kind(law))
            finish(loop_cache)
    assert isinstance(loop_cache.find(robot, Kind(law)), InterpretedLoop)
    (warning,) = caplog.records
    assert law in warning.getMessage() and "OP_" in warning.getMessage()
    loop_cache.prepare(robot, Kind("waiting_clock"))
    finish(loop_cache)
    assert isinstance(loop_cache.find(robot, Kind("waiting_clock")), CompiledLoop)


def test_a_lab_uses_it_and_another_lab_notices_nothing(loop_cache: LoopCache, law: str) -> None:
    labs = Lab(loop_cache), Lab(loop_cache)
    for lab, name in zip(labs, (law, "waiting_clock"), strict=True):
        do(lab, c.ChooseLaw(LEFT, name))
        for _ in range(4):
            run(lab, FRAME)
            finish(loop_cache)
        assert lab.simulation.laws[LEFT] == name
    made = [loop_cache.find(r.robot, r.kind) for r in (lab.simulation.runs[LEFT] for lab in labs)]
    assert [type(loop) for loop in made] == [InterpretedLoop, CompiledLoop]


@pytest.mark.thorough
@pytest.mark.parametrize("language", ["en", "de"])
def test_the_page_says_once_that_it_is_interpreted_and_why(
    loop_cache: LoopCache, law: str, language: str
) -> None:
    lab = Lab(loop_cache)
    do(lab, c.SetLanguage(language))
    reason = lab.words("error.no_translation", owner=law, operation="OP_ERFINV", target="LLVM")
    shown = list[str]()
    do(lab, c.ChooseLaw(LEFT, law))
    for command in (None, None, None, c.ChooseRobot("two_link_arm"), c.Reset(), c.Reset()):
        lab.show_message("")
        if command is not None:
            do(lab, command)
        for _ in range(3):
            run(lab, FRAME)
            finish(loop_cache)
        shown += [lab.message] * (reason in lab.message)
    assert shown == [lab.words("say.law_interpreted", reason=reason)]


def test_nothing_is_said_while_a_law_is_being_compiled(loop_cache: LoopCache) -> None:
    lab = Lab(loop_cache)
    do(lab, c.ChooseLaw(LEFT, "waiting_clock"))
    for _ in range(4):
        run(lab, FRAME)
        assert not lab.message
        finish(loop_cache)


def test_an_exported_figure_is_refused_in_one_line(
    tmp_path: Path, law: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "a.html"
    assert run_command(["figure", str(file), "--law", law]) == 2
    error = capsys.readouterr().err
    assert law in error and "OP_" in error and "WebAssembly" in error
    assert error.count("\n") == 1 and not list(tmp_path.iterdir())


def test_it_is_compared_with_others(law: str, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--law", law, "--law", "path_following", "--obstruction", "wall", "--json"]
    assert run_command(["compare", *arguments]) == 0
    assert law in capsys.readouterr().out
