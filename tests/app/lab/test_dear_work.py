"""No command takes long at a time, whatever a page asks for; its parts take turns with others."""

from __future__ import annotations

import gc
import random
from collections.abc import Iterator
from contextlib import suppress
from time import thread_time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import NoCommand, command_from
from onpath.app.lab.commands.lessons import MOST_ACTIONS
from onpath.app.lab.lab import PATIENCE, Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.warm_up import warm_up
from onpath.lessons.action_schema import Action
from onpath.lessons.schema import Text
from tests.bench.dear_commands import dear_message
from tests.support.lab import FRAME, assert_sound, do, new_lab, run, states

LONGEST = 2 * 0.05  # [s] of processor time; twice what is promised, for busy processors
ACTIONS = (
    *(Action(robot=name) for name in ("flexible", "two_link_arm", "five_bar")),
    *(Action(reset=True), Action(path="clover"), Action(set={"K1": 700.0, "K2": 60.0})),
    *(Action(hold=True), Action(run=True)),
)


@pytest.fixture(scope="module")
def loop_cache() -> Iterator[LoopCache]:
    """Of a server that has been running for a while."""
    made = LoopCache()
    warm_up(made, built_in_course(), rest=0.0).join()
    yield made
    made.close()


@pytest.mark.thorough
@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**32), st.integers(1, 12))
def test_nothing_that_a_page_sends_takes_long_at_a_time(
    loop_cache: LoopCache, seed: int, count: int
) -> None:
    """Messages of one page are decoded, and their commands applied, each in frames of its own."""
    draw, lab = random.Random(seed), Lab(loop_cache, course=built_in_course())
    gc.disable()  # a collection takes its time whenever it likes
    try:
        for _ in range(count):
            message, begun = dear_message(draw), thread_time()
            with suppress(NoCommand):
                lab.post(command_from(message))
            assert thread_time() - begun < LONGEST
            for _ in range(3):
                begun = thread_time()
                lab.drain(1e-4)  # hardly more than one command, or one part of one
                lab.advance(FRAME)
                assert thread_time() - begun < LONGEST, message[:200]
                begun = thread_time()
                take_page_snapshot(lab, 1.0)
                assert thread_time() - begun < LONGEST, message[:200]
    finally:
        gc.enable()


@given(st.lists(st.sampled_from(ACTIONS), max_size=8), st.floats(1e-4, 0.02))
@settings(deadline=None, max_examples=25)
def test_a_link_does_the_same_whether_at_once_or_in_parts(
    actions: list[Action], most: float
) -> None:
    whole, parts = new_lab(0.1), new_lab(0.1)
    for lab in (whole, parts):
        lab.post(c.Act(tuple(actions)))
    whole.drain()
    while parts.has_commands:
        parts.drain(most)
        before = parts.simulation.time
        if parts.has_commands:
            parts.advance(FRAME)
        assert parts.simulation.time == before or parts.simulation.time == before + 0.016
    for name, state in states(whole.simulation).items():
        assert (state == states(parts.simulation)[name]).all()
    assert whole.simulation.parameters == parts.simulation.parameters
    assert (
        whole.simulation.laws == parts.simulation.laws
        and whole.simulation.settings.rate == parts.simulation.settings.rate
    )


def test_a_lab_says_that_it_waits_for_its_commands() -> None:
    lab = new_lab(0.1)
    lab.post(c.Act((Action(robot="flexible"), Action(robot="five_bar")) * 20))
    for _ in range(PATIENCE + 2):
        lab.drain(1e-4)
        time = lab.simulation.time
        lab.advance(FRAME)
        assert lab.simulation.time == time
    assert lab.waits
    run(lab, 2 * FRAME)
    assert not lab.waits
    assert_sound(lab)


def test_a_link_has_a_bounded_number_of_actions() -> None:
    lab = new_lab()
    do(lab, c.Act((Action(robot="flexible"),) * (MOST_ACTIONS + 1)))
    assert "at most 100 actions" in lab.message and lab.simulation.entry.name == "five_bar"


def test_no_lesson_has_a_link_of_so_many_actions() -> None:
    for versions in built_in_course().lessons.values():
        for lesson in versions.values():
            for step in lesson.steps:
                texts = [block for block in step.blocks if isinstance(block, Text)]
                for link in (link for text in texts for link in text.links):
                    assert len(link.actions) < MOST_ACTIONS / 10
