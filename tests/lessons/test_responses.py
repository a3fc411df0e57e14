"""Settling time, overshoot and the path's length, as a task checks them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.lessons.action_schema import Action, Script
from onpath.lessons.checks import verdict
from onpath.lessons.course import read_course
from onpath.lessons.measures.responses import latest_stretch, overshoot, settling_time
from onpath.lessons.task_schema import Bound, Setting
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import LESSON, write_lesson

STEP = 1 / 60


def swinging(damping: float, frequency: float = 10.0) -> tuple[np.ndarray, np.ndarray]:
    """A second-order system that is let go at 1: instants and values."""
    times = np.arange(0.0, 8.0, 1e-3)
    own = frequency * np.sqrt(1 - damping**2)
    decay = np.exp(-damping * frequency * times)
    values = np.cos(own * times) + damping * frequency / own * np.sin(own * times)
    return times, decay * values


@given(st.floats(0.1, 0.9))
def test_of_a_second_order_system_they_are_those_of_the_textbook(damping: float) -> None:
    times, values = swinging(damping)
    ideal = 100 * np.exp(-np.pi * damping / np.sqrt(1 - damping**2))
    assert overshoot(values) == pytest.approx(ideal, rel=1e-3)
    settled = settling_time(times, values)
    assert settled is not None
    assert np.abs(values[times >= settled]).max() <= 0.05
    assert abs(values[times < settled][-1]) > 0.05


@given(st.lists(st.integers(-10, 10), min_size=1, max_size=30), st.floats(0.1, 10))
def test_neither_depends_on_the_unit_or_the_side(numbers: list[int], factor: float) -> None:
    values = np.array(numbers, dtype=float)
    times = STEP * np.arange(float(len(values)))
    assert settling_time(times, -values) == settling_time(times, values)
    peak = np.abs(values).max()
    if np.sum(np.abs(values) == peak) == 1:
        for other in (factor * values, -values):
            assert overshoot(other) == pytest.approx(overshoot(values))
    assert 0 <= overshoot(values) <= 100


def test_what_has_not_settled_has_no_settling_time() -> None:
    assert settling_time(STEP * np.arange(3.0), np.array([0.0, 1.0, 0.5])) is None
    assert settling_time(STEP * np.arange(3.0), np.zeros(3)) == 0.0 and overshoot(np.zeros(3)) == 0


@given(st.lists(st.booleans(), max_size=20))
def test_the_latest_stretch_is_the_last_run_of_chosen_instants(chosen: list[bool]) -> None:
    text = "".join("x" if each else "." for each in chosen).rstrip(".")
    length = len(text.rpartition(".")[2])
    found = np.flatnonzero(latest_stretch(np.array(chosen, dtype=bool)))
    assert found.tolist() == list(range(len(text) - length, len(text)))


def let_go(k2: float) -> Lab:
    """A lab at rest that has been pulled across, and let go for three seconds."""
    lab = Lab(loop_cache(), FIVE_BAR)
    for name, value in {"K1": 400, "K2": k2, "K3": 0, "speed": 0}.items():
        do(lab, c.Set(name, value))
    do(lab, c.Reset(), c.SetRunning(True))
    pull = Action(at=0.5, pull=(30.0, 0.0)), Action(at=2.5, release=True)
    lab.script = player_of(Script(pull, 5.5))
    run(lab, 5.4)
    return lab


@pytest.mark.parametrize("k2", [8.0, 20.0])
def test_a_task_measures_them_in_the_lab(k2: float) -> None:
    record = record_of(let_go(k2).simulation, Beginning(0, 0.0))
    ratio = k2 / (2 * 20)
    ideal = 100 * np.exp(-np.pi * ratio / np.sqrt(1 - ratio**2))
    near = Bound("free", quantity="across", stat="overshoot", below=ideal + 4, above=ideal - 4)
    said = verdict(near, record, ENGLISH)
    assert said.passed, said.words
    assert "%" in said.words and "overshoot" in said.words
    slow = verdict(Bound("free", quantity="across", stat="settling", below=0.1), record, ENGLISH)
    fast = verdict(Bound("free", quantity="across", stat="settling", below=2.0), record, ENGLISH)
    assert fast.passed and not slow.passed and " s;" in fast.words


def test_the_length_of_the_path_is_a_setting() -> None:
    lab = Lab(loop_cache(), FIVE_BAR)
    circle = 100 * np.pi
    for path, holds in (("circle", True), ("clover", False)):
        do(lab, c.ChoosePath(path))
        run(lab, 1.0)
        record = record_of(lab.simulation, Beginning(0, 0.0))
        check = Setting("length", above=circle - 1, below=circle + 1)
        said = verdict(check, record, ENGLISH)
        assert said.passed == holds and "mm" in said.words


def test_a_lesson_may_use_them_and_a_quantity_without_sign_has_no_overshoot(tmp_path: Path) -> None:
    check = '[[check]]\nkind = "bound"\nquantity = "{}"\nstat = "overshoot"\nbelow = 5\n'
    length = '[[check]]\nkind = "setting"\nname = "length"\nabove = 300\n'
    for quantity, wrong in (("across", 0), ("distance", 1)):
        more = f'hints = ["H", "The key H."]\n{check.format(quantity)}{length}'
        write_lesson(tmp_path, LESSON.replace('hints = ["H", "The key H."]\n', more))
        problems = read_course([tmp_path])[1]
        assert len(problems) == wrong and all("sign" in problem.text for problem in problems)
