"""A check passes exactly when what it asks for holds over its whole window."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import accumulate

import msgspec
import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.lessons.checks import judge, verdict
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.record import Happening, Record
from onpath.lessons.task_schema import (
    Bound,
    Compare,
    During,
    Event,
    Once,
    Only,
    Setting,
    Stat,
    Task,
)
from onpath.lessons.words import Words
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.random_records import some_check, some_record

DT = 1e-3  # [s], a tick
NEED = re.compile(r"\(([\d.]+) of ([\d.]+) s\)")
WORDS = Words()


@dataclass(frozen=True)
class FrameSegment:
    """Some frames of the lab with the same inputs."""

    ticks: tuple[int, ...]
    held: bool
    value: float


@dataclass(frozen=True)
class Frames:
    """A run, frame after frame: its ticks are whole numbers, its times sums as the lab has them."""

    ticks: np.ndarray
    held: np.ndarray
    values: np.ndarray

    def record(self) -> Record:
        times = list(accumulate((int(n) * DT for n in self.ticks), initial=0.0))
        happenings, before = list[Happening](), False
        for time, held in zip(times, self.held.tolist(), strict=False):
            if held != before:
                happenings.append(Happening(0, time, "hold" if held else "let_go"))
            before = held
        values = {"distance": self.values}
        return Record(
            times=np.array(times[:-1]),
            values={"follower": values, "tracker": {"distance": 2.0 * self.values}},
            happenings=tuple(happenings),
            run=0,
            parameters=FIVE_BAR.parameters(),
            end=times[-1],
        )

    def window(self, during: During, last: int) -> tuple[np.ndarray, int]:
        """Which frames count, and how many ticks they last; exactly, by counting ticks.

        Args:
            last: ticks; 0 for all.
        """
        held = self.held
        first = int(held.argmax()) if held.any() else len(held)
        released = ~held & (np.arange(len(held)) > first)
        every = np.ones_like(held)
        chosen = {"always": every, "held": held, "free": ~held, "released": released}[during]
        ticks = np.where(chosen, self.ticks, 0)
        later = np.cumsum(ticks[::-1])[::-1] - ticks
        if last:
            chosen = chosen & (later < last)
        return chosen, int(self.ticks[chosen].sum())


def frames_of(segments: list[FrameSegment]) -> Frames:
    rows = [(ticks, s.held, s.value) for s in segments for ticks in s.ticks]
    ticks, held, values = zip(*rows, strict=True)
    return Frames(np.array(ticks), np.array(held, dtype=bool), np.array(values))


sixtieths = st.integers(1, 90).map(
    lambda n: tuple(np.diff([int(k / 60 / DT + 1e-9) for k in range(n + 1)]).tolist())
)
uneven = st.lists(st.integers(1, 68), min_size=1, max_size=90).map(tuple)
segments = st.builds(
    FrameSegment,
    st.one_of(sixtieths, uneven),
    st.booleans(),
    st.sampled_from([0.5, 0.603, 1.0, 1.004, 3.0]),
)
runs = st.lists(segments, min_size=1, max_size=8).map(frames_of)
seconds = st.sampled_from([0.0, 0.05, 0.3, 0.5, 0.95, 1.0, 2.0, 2.2, 3.0])
durings = st.sampled_from(["always", "held", "free", "released"])


def frames(*ticks: int) -> Frames:
    """A run all of which is held, and well."""
    return frames_of([FrameSegment(ticks, held=True, value=1.0)])


@given(runs, durings, seconds, seconds)
@example(frames(*200 * [17]), "always", 1.0, 1.0)
@example(frames(*20 * [16, 17, 17]), "held", 1.0, 1.0)
@example(frames(*58 * [17], 10), "held", 0.0, 1.0)  # four ticks too few
def test_a_bound_passes_exactly_when_it_holds_over_its_window(
    run: Frames, during: During, last: float, least: float
) -> None:
    chosen, ticks = run.window(during, round(last / DT))
    enough = ticks >= round(least / DT)
    holds = bool(chosen.any()) and bool((run.values[chosen] <= 1.0).all())
    check = Bound(during=during, last=last, least=least, quantity="distance", below=1.0)
    assert verdict(check, run.record(), WORDS).passed == (enough and holds)


@given(runs, durings, seconds)
def test_the_latest_seconds_are_enough_when_as_many_are_asked_for(
    run: Frames, during: During, last: float
) -> None:
    whole = run.window(during, 0)[1]
    if last:
        check = Bound(during=during, last=last, least=last, quantity="distance", below=9.0)
        assert verdict(check, run.record(), WORDS).passed == (whole >= round(last / DT))


@given(runs, durings, seconds, seconds, st.sampled_from([0.5, 0.6, 1.0, 1.001, 3.0]))
def test_the_numbers_that_are_shown_are_met_exactly_when_it_passes(
    run: Frames, during: During, last: float, least: float, below: float
) -> None:
    check = Bound(during=during, last=last, least=least, quantity="distance", below=below)
    found = verdict(check, run.record(), WORDS)
    shown = NEED.search(found.words)
    assert shown is not None
    have, need = map(float, shown.groups())
    value = re.search(r"([\d.e+-]+) mm", found.words)
    assert value is not None
    there = run.window(during, round(last / DT))[0].any()
    met = have >= need and bool(there) and float(value[1]) <= below
    assert found.passed == met, found.words


@given(runs, seconds, st.sampled_from([1.9, 2.0, 2.1]))
def test_a_comparison_looks_at_the_same_window(run: Frames, last: float, ratio: float) -> None:
    whole = run.window("always", 0)[1]
    check = Compare(last=last, least=last, quantity="distance", ratio=ratio)
    passed = verdict(check, run.record(), WORDS).passed
    assert passed == (whole >= round(last / DT) and ratio <= 2.0)


events = st.lists(st.sampled_from(["identify", "set", "reset"]), max_size=8)


@given(events)
def test_an_event_counts_only_after_the_latest_of_those_that_undo_it(names: list[str]) -> None:
    happenings = tuple(Happening(0, 0.1 * i, name, "K1") for i, name in enumerate(names))
    record = replace(frames(17).record(), happenings=happenings)
    since = [name for name in reversed(names) if name != "reset"][:1]
    check = Event(event="identify", since=("set:K1", "set:K2"))
    assert verdict(check, record, WORDS).passed == (since == ["identify"])
    assert verdict(Event(event="identify"), record, WORDS).passed == ("identify" in names)


NAMES = ("K1", "stiction", "path", "left", "start", "wall")
some_names = st.lists(st.sampled_from(NAMES), unique=True).map(tuple)


@given(some_names, some_names)
def test_only_what_is_named_may_be_changed(allowed: tuple[str, ...], done: tuple[str, ...]) -> None:
    record = replace(frames(16, 17).record(), changed=lambda: done)
    found = verdict(Only(allowed), record, WORDS)
    others = set(done) - set(allowed)
    assert found.passed == (not others) == (not found.words)
    assert ("Static friction" in found.words) == ("stiction" in others)


@dataclass(frozen=True)
class Run:
    """A run with one value of K1, and what undid the check before it began."""

    k1: float
    values: tuple[float, ...]
    undone: bool


runs = st.builds(
    Run,
    k1=st.sampled_from([400.0, 600.0]),
    values=st.lists(st.sampled_from([0.5, 2.0]), min_size=1, max_size=6).map(tuple),
    undone=st.booleans(),
)


@given(st.lists(runs, min_size=1, max_size=5))
def test_a_bound_was_kept_once_if_any_run_with_the_setting_kept_it(course: list[Run]) -> None:
    """Frame by frame, through resets, and only since the latest event that undoes it."""
    least = 3  # frames
    check = Once(
        quantity="distance", below=1.0, least=least * 0.01, name="K1", equals=600, since=("path",)
    )
    task, earlier, happenings, kept = Task("t", "", (check,)), EarlierRun(), (), False
    for number, run in enumerate(course):
        if run.undone:
            happenings, kept = (*happenings, Happening(number, 0.0, "path", "ellipse")), False
        for count in range(1, len(run.values) + 1):
            shown = run.values[:count]
            record = Record(
                times=np.array([0.01 * i for i in range(count)]),
                values={"tracker": {}, "follower": {"distance": np.array(shown)}},
                happenings=happenings,
                run=number,
                parameters=replace(FIVE_BAR.parameters(), K1=run.k1),
                end=count * 0.01,
                before=earlier.values,
            )
            earlier.follow(record, [task])
            kept |= run.k1 == 600.0 and count >= least and max(shown) <= 1.0
            found = verdict(check, record, WORDS)
            assert found.passed == kept, found.words
            assert "below 1 mm" in found.words and "600" in found.words


def test_an_edited_path_and_a_drawn_one_are_the_student_s_own() -> None:
    check = Setting(name="path", equals="own")
    record = frames(16, 17).record()
    for path in (*presets(), "edited", "drawn"):
        own = verdict(check, replace(record, path=path), WORDS)
        assert own.passed == (path in ("edited", "drawn")) and "your own" in own.words


def test_a_bound_is_missed_for_good_at_the_first_value_beyond_it() -> None:
    rng, missed = np.random.default_rng(32), 0
    while missed < 60:
        check = some_check(rng)
        if not isinstance(check, Bound):
            continue
        if rng.random() < 0.8:  # most others cannot be missed for good
            extreme: Stat = "max" if rng.random() < 0.5 else "min"
            check = msgspec.structs.replace(check, stat=extreme, last=0.0)
        record = some_record(rng)
        found = verdict(check, record, WORDS)
        assert found.share is None or 0 <= found.share <= 1
        if found.passed:
            assert found.share == 1 and found.broken is None
        if found.broken is None:
            continue
        missed += 1
        chosen = record.chosen(check.robot, check)
        values, times = record.values[check.robot][check.quantity], record.times
        bound = check.below if check.stat == "max" else check.above
        assert bound is not None
        beyond = values > bound if check.stat == "max" else values < bound
        assert beyond[chosen & (times == found.broken)].all()
        assert not beyond[chosen & (times < found.broken)].any()
        assert f"missed at {found.broken:.1f} s" in found.words


def test_a_task_is_begun_by_what_is_done_in_its_run() -> None:
    task = Task(id="one", text="", check=(Bound(quantity="distance", below=3.0),))
    frames = Frames(np.full(300, 10), np.zeros(300, dtype=bool), np.zeros(300))
    for held in (False, True):
        record = replace(frames, held=np.full(300, held)).record()
        (found,) = judge(task, record, WORDS)
        assert found.passed and found.begun is held
    (again,) = judge(task, replace(record, run=1), WORDS)
    assert not again.begun
