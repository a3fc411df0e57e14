"""A law whose code has an error is refused in one line, and what runs goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.path_following import LAW as PATH_FOLLOWING
from onpath.models.control.laws.registry import LAWS, found_laws
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, SIDES
from onpath.models.errors import CodedError
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import FRAME, assert_sound, do, finish, run

HEAD = """
from onpath.models.control.laws.law import ControlAction, Law
from onpath.models.control.laws.path_following import followed, tangential

def command(view):
    """
TAIL = """

LAW = Law(name="wrong", label="Wrong", text="", source="", command=command, gains=("K4", "K5"))
"""
LINE = 6
ERRORS = {
    "a name": ("return followed(view, tangential(view), -K1 * view.output.xi)", "NameError"),
    "a gain": ("return view.own_gains['reach']", "KeyError"),
    "sizes": ("return followed(view, view.y + view.output.theta_rate[1:], 0)", "RuntimeError"),
    "no action": ("pass", "AttributeError"),
    "no command": ("return ControlAction()", "has 0 numbers as acceleration"),
    "refused": ("raise ValueError('only\\n on Sundays')", "ValueError: only on Sundays"),
}
COMMANDS = [
    ["experiment", "obstruction"],
    ["compare", "--obstruction", "none"],
    ["figure", "page.html"],
]


@pytest.fixture
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
@pytest.mark.parametrize("name", ERRORS)
def test_the_command_line_says_it_in_one_line_with_the_place(
    name: str,
    command: list[str],
    in_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    body, error = ERRORS[name]
    file = in_folder / "wrong.py"
    file.write_text(HEAD + body + TAIL)
    own = dict[str, Law]()
    exec(compile(file.read_text(), str(file), "exec"), own)
    monkeypatch.setitem(LAWS, "wrong", own["LAW"])
    assert run_command([*command, "--law", "wrong"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("onpath: wrong cannot be used here: ") and error in line
    first = LINE if name not in ("no action", "no command") else LINE - 1  # where it begins
    assert line.endswith(f"(wrong.py, line {first})")
    assert [*in_folder.iterdir()] == [file]


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("def command(view:\n    pass", "SyntaxError"),
        ("\nLAW = Lav()", "NameError"),
    ],
)
def test_so_is_a_module_that_cannot_be_imported(
    text: str, error: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from onpath.models.control import laws

    (tmp_path / "wrong_module.py").write_text(text)
    monkeypatch.setattr(laws, "__path__", [*laws.__path__, str(tmp_path)])
    with pytest.raises(CodedError, match=f"wrong_module .* {error}: .*wrong_module.py, line [12]"):
        found_laws()


def test_the_poles_of_such_a_law_are_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    def channels(*_: object) -> None:
        raise ZeroDivisionError

    wrong = replace(PATH_FOLLOWING, name="wrong", linear=False, channels=channels)
    monkeypatch.setitem(LAWS, "wrong", wrong)
    found = channels_of("wrong", ROBOTS["five_bar"].parameters(), place=object())  # type: ignore
    assert "ZeroDivisionError" in str(found) and Path(__file__).name in str(found)


# In the lab

Fails = Callable[[View], bool]
FAILS: dict[str, Fails] = {
    "on_two_links": lambda view: view.system.name == "two_link_arm",
    "in_space": lambda view: view.frame.p == 3,
    "with_encoders": lambda view: "floor" in str(view.measured[0]),
    "everywhere": lambda view: True,
}


@pytest.fixture
def laws(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Laws that raise under some condition, two of them with a memory."""
    for name, fails in FAILS.items():
        memory = (("kept", 3),) if len(name) % 2 else ()

        def command(
            view: View, fails: Fails = fails, memory: tuple[tuple[str, int], ...] = memory
        ) -> ControlAction:
            if fails(view):
                raise TypeError("an error in the law")
            kept = {name: ca.SX.ones(size) for name, size in memory}
            return replace(PATH_FOLLOWING.command(view), memory=kept)

        own = replace(PATH_FOLLOWING, name=name, label=name, command=command, memory=memory)
        monkeypatch.setitem(LAWS, name, own)
    return [*FAILS]


@pytest.fixture
def loop_cache() -> Iterator[LoopCache]:
    made = LoopCache()
    yield made
    made.close()


def frames(lab: Lab, loop_cache: LoopCache, count: int = 3) -> None:
    for _ in range(count):
        run(lab, FRAME)
        finish(loop_cache)


def test_it_is_not_chosen(loop_cache: LoopCache, laws: list[str]) -> None:
    lab = Lab(loop_cache)
    before, began = dict(lab.simulation.laws), lab.simulation.time
    do(lab, c.ChooseLaw(LEFT, "everywhere"))
    frames(lab, loop_cache)
    assert "everywhere cannot be used here: TypeError: an error in the law" in lab.message
    assert Path(__file__).name in lab.message
    assert lab.simulation.laws == before and lab.simulation.time > began
    do(lab, c.ChooseLaw(LEFT, "waiting_clock"))
    frames(lab, loop_cache)
    assert lab.simulation.laws[LEFT] == "waiting_clock"


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("law", "command"),
    [
        ("on_two_links", c.ChooseRobot("two_link_arm")),
        ("in_space", c.ChooseRobot("spatial_arm")),
        ("with_encoders", c.Set("encoder_counts", 2000.0)),
    ],
)
def test_where_it_fails_the_usual_law_takes_its_place(
    loop_cache: LoopCache, laws: list[str], law: str, command: c.Command
) -> None:
    lab = Lab(loop_cache)
    do(lab, c.ChooseLaw(LEFT, law))
    frames(lab, loop_cache)
    assert lab.simulation.laws[LEFT] == law
    do(lab, command)
    frames(lab, loop_cache)
    assert lab.simulation.laws == DEFAULT_LAWS
    assert f"{law} cannot be used here: TypeError" in lab.message
    assert lab.message_level == "warning"
    began = lab.simulation.time
    frames(lab, loop_cache)
    assert lab.simulation.time > began
    assert_sound(lab)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(6))
def test_whatever_is_changed_the_lab_goes_on(
    loop_cache: LoopCache, laws: list[str], seed: int
) -> None:
    """The law of a side is the one that was chosen, or where that fails the usual one."""
    rng = np.random.default_rng(seed)
    robots = ["five_bar", "two_link_arm", "spatial_arm", "flexible"]
    lab, wanted = Lab(loop_cache), dict(DEFAULT_LAWS)

    def possible(law: str) -> bool:
        simulation = lab.simulation
        fails = {
            "everywhere": True,
            "on_two_links": simulation.entry.name == "two_link_arm",
            "in_space": simulation.robot.system.p == 3,
            "with_encoders": simulation.parameters.encoder_counts > 0,
        }
        return not fails.get(law, False)

    for _ in range(25):
        draw = rng.integers(6)
        if draw < 2:
            do(lab, c.ChooseRobot(str(rng.choice(robots))))
        elif draw < 4:
            side, law = str(rng.choice(SIDES)), str(rng.choice([*laws, "waiting_clock"]))
            do(lab, c.ChooseLaw(side, law))
            if possible(law):
                wanted[side] = law
        elif draw == 4:
            counts = float(rng.choice([0.0, 2000.0]))
            do(lab, c.Set("encoder_counts", counts))
        else:
            do(lab, c.Reset(), c.Undo())
        frames(lab, loop_cache)
        wanted = {
            side: law if possible(law) else DEFAULT_LAWS[side] for side, law in wanted.items()
        }
        assert lab.simulation.laws == wanted
        began = lab.simulation.time
        frames(lab, loop_cache, 1)
        assert lab.simulation.time > began
        assert_sound(lab)


def test_python_keeps_the_cause(laws: list[str]) -> None:
    with pytest.raises(CodedError, match="everywhere cannot be used here") as caught:
        onpath.simulate(law="everywhere", duration=0.1)
    assert isinstance(caught.value.__cause__, TypeError)
