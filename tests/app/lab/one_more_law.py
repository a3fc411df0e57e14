"""What a law that is one more file can do; run by test_one_more_law.py."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_form import setting_of
from onpath.app.exports.standalone.setting_numbers import setting_numbers
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.share_code import decode, encode
from onpath.lessons.words import Words
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.closed_loop.wasm_loop import wasm_of
from onpath.models.control.settable import value_of, with_values
from onpath.models.control.sides import LEFT
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.lab import FRAME, do, finish, loop_cache, run

LAW = "sliding_mode"


@pytest.mark.parametrize("name", ROBOTS)
def test_both_loops_have_the_same_bits(name: str) -> None:
    entry = ROBOTS[name]
    parameters = with_values(entry.parameters(), {"reach": 3.0})
    if entry.flexible_link:
        parameters = replace(parameters, output="redefined")  # type: ignore[call-arg]
    robot, curve = entry.make(parameters), circle(0.05)
    kernel = kernel_of(robot, kind_of(LAW, parameters, curve))
    start = robot.rest(robot.frame.lift(curve.at(np.array(0.3))) * 1.002)
    state = first_state(robot, kernel, curve, start)
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    first, second = (
        loop.run(state, settings, curve.table(), 200)[1]
        for loop in (InterpretedLoop(kernel), translate_loop(kernel))
    )
    assert np.array_equal(first, second) and np.isfinite(first).all()
    assert wasm_of({}, {LAW: kernel})


def test_it_runs_compiled_in_the_lab_with_its_gain_in_the_share_code() -> None:
    loops = loop_cache()
    lab = Lab(loops)
    do(lab, c.ChooseLaw(LEFT, LAW), c.Set("reach", 4.5))
    for _ in range(3):
        run(lab, FRAME)
        finish(loops)
    own = lab.simulation.runs[LEFT]
    assert isinstance(loops.find(own.robot, own.kind), CompiledLoop)
    setup = decode(encode(capture(lab.simulation)))
    assert setup.robots[FIVE_BAR.name].parameters == {"reach": 4.5}
    other = Lab(loops)
    other.set_up(setup)
    assert value_of(other.simulation.parameters, "reach") == 4.5
    assert other.simulation.parameters == lab.simulation.parameters
    assert other.simulation.laws[LEFT] == LAW


def test_it_holds_against_a_force_below_its_reach() -> None:
    free, weak = (onpath.simulate(law=LAW, duration=2, reach=reach) for reach in (2.0, 0.5))
    assert np.abs(free.distance[-500:]).max() < 1e-3
    assert not np.array_equal(free.distance, weak.distance)
    assert onpath.parameters()["reach"] == "2, 0 to 20 m/s²: how hard it pulls"


def test_it_runs_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["experiment", "obstruction", "--law", LAW, "--set", "reach=3", "--json"]
    assert run_command(given) == 0
    assert LAW in json.dumps(json.loads(capsys.readouterr().out))
    assert run_command(["lessons", "names"]) == 0
    assert "`reach`" in capsys.readouterr().out


def test_it_is_exported_with_sliders_for_its_gains(tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    assert run_command(["figure", str(file), "--law", LAW, "--set", "reach=3"]) == 0
    assert "Sliding mode" in file.read_text("utf-8")
    figure = chosen("five_bar", (LAW,), {"circle": circle(0.05)}, {"reach": 3.0})
    assert {"boundary", "reach"} <= {*figure.sliders}
    german = setting_of(figure, "reach", Words("de"))
    assert (german.label, german.default) == ("Reach", 3.0)
    assert setting_numbers(figure, {}).indices["reach"] > 0
