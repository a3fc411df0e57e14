"""The last minute: kept, looked at, gone on from, and computed again exactly."""

from __future__ import annotations

import threading
import tracemalloc
from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.history import COARSE, LONGEST, MOST, RECENT, SECONDS, History
from onpath.app.lab.lab import Lab
from onpath.app.lab.loop_states import single
from onpath.app.lab.segments import FEW, HistoryFrame, Input, Inputs, Segment
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.control.sides import DEFAULT_LAWS, RIGHT, SIDES
from onpath.models.paths.curves import Curve, circle
from tests.support.lab import FOLLOWER, FRAME, TRACKER, do, new_lab, run, states, y

KIND = Kind(DEFAULT_LAWS[RIGHT])
CURVE, SETTINGS = circle(0.05), np.zeros(3)


def add(
    history: History,
    time: float,
    ticks: int = 17,
    settings: np.ndarray = SETTINGS,
    frozen: bool = False,
    curve: Curve = CURVE,
    dt: float = 1e-3,
) -> None:
    """A segment of one robot, whose state and sample are the time."""
    state, inputs = np.array([time]), inputs_of(curve, dt, id(settings), frozen)
    history.append(HistoryFrame(time, ticks, inputs, [single(state, state, 0.0, 0.0)]))


@lru_cache
def inputs_of(curve: Curve, dt: float, settings: int, frozen: bool) -> Inputs:
    """The same object for the same inputs."""
    return Inputs(curve, dt, (Input(FOLLOWER, KIND, np.full(3, float(settings)), frozen, 1),))


def new_history() -> History:
    return History(lambda rows, _: rows)


def contiguous(history: History) -> bool:
    kept = history.all()
    ends = [s.time + s.ticks * s.dt for s in kept]
    return np.allclose(ends[:-1], [s.time for s in kept[1:]], atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(1, 40), min_size=1, max_size=60), st.data())
def test_nothing_is_lost_whatever_the_frames_were(ticks: list[int], data: st.DataObject) -> None:
    history, time, kept = new_history(), 0.0, list[np.ndarray]()
    for count in ticks:
        changed = np.zeros(3) if data.draw(st.booleans()) else SETTINGS
        kept.append(changed)  # alive, so that ids differ
        add(history, time, count, changed)
        time += count * 1e-3
    assert contiguous(history) and history.span() == pytest.approx(time)
    assert all(s.ticks <= max(LONGEST, max(ticks)) for s in history.all())
    for instant in np.linspace(0, time - 1e-6, 7):
        found = history.at(instant)
        assert found is not None
        assert found.time <= instant < found.time + found.ticks * found.dt + 1e-9
        assert found.drives[FOLLOWER].state[0] == found.time  # the state at its beginning


def test_only_stretches_with_the_same_inputs_are_joined() -> None:
    other_settings, other_curve = np.zeros(3), circle(0.05)
    cases: list[tuple[dict[str, Any], bool]] = [
        ({"ticks": 5}, True),
        ({"ticks": 13}, False),  # too long together
        ({"ticks": 5, "settings": other_settings}, False),
        ({"ticks": 5, "frozen": True}, False),
        ({"ticks": 5, "curve": other_curve}, False),
        ({"ticks": 5, "dt": 5e-4}, False),
    ]
    for changes, joined in cases:
        history = new_history()
        add(history, 0.0, 5)
        add(history, 0.005, **changes)
        assert (len(history) == 1) is joined
        assert sum(s.ticks for s in history.all()) == 5 + changes["ticks"]


def test_a_minute_is_kept_and_no_more() -> None:
    history = new_history()
    for k in range(5000):
        add(history, k * 0.017)
    assert SECONDS <= history.span() < SECONDS + 0.1
    assert history.all()[-1].time == pytest.approx(4999 * 0.017)


def test_short_stretches_do_not_pile_up() -> None:
    history = new_history()
    for k in range(3 * MOST):
        add(history, k * 1e-3, 1, dt=1e-3 if k % 2 else 5e-4)
    assert len(history) == MOST and history.all()[-1].time == pytest.approx(3 * MOST * 1e-3 - 1e-3)
    assert [s.sample[0, 0] for s in history.all()] == pytest.approx(
        [s.time for s in history.all()], abs=1e-6
    )


@pytest.mark.thorough
def test_a_minute_takes_little_memory() -> None:
    """At 60 Hz, both robots, after a long time: less than 1 MB."""
    lab = new_lab(0.5)
    lab.simulation.simulate(17)
    one = lab.simulation.history.at(lab.simulation.time)
    assert one is not None
    taken = [memory_of_a_minute(lab, one) for _ in range(3)]
    used, peak = (min(each) for each in zip(*taken, strict=True))  # other threads take some, too
    assert used < 1e6 and peak < 2e6


def memory_of_a_minute(lab: Lab, one: Segment) -> tuple[int, int]:
    """What a history has in the end, and what all threads had meanwhile at most, [B]."""
    names, rows = list(lab.simulation.runs), list(one.sample)
    inputs = Inputs(one.curve, one.dt, tuple(lab.simulation.runs[name].input() for name in names))
    states = [lab.simulation.runs[name].state for name in names]
    places = [single(state, row, 0.0, 0.0) for state, row in zip(states, rows, strict=True)]
    tracemalloc.start()
    history = new_history()
    for k in range(8000):
        history.append(HistoryFrame(k * 0.017, 17, inputs, places))
    assert history.span() > 59
    _, peak = tracemalloc.get_traced_memory()
    snapshot = tracemalloc.take_snapshot()
    tracemalloc.stop()
    ours = [tracemalloc.Filter(True, file) for file in ("*/history.py", __file__)]
    return sum(trace.size for trace in snapshot.filter_traces(ours).traces), peak


@pytest.mark.thorough
def test_older_stretches_are_fewer_and_as_exact() -> None:
    """Each goes on where the one before ends, to the last bit; a change of input parts them."""
    lab = new_lab()
    for k in range(2400):
        if k % 37 == 0:
            do(lab, c.Set("K2", 20.0 + k % 5))
        lab.simulation.simulate(17)
    segments, name = lab.simulation.history.all(), FOLLOWER
    assert sum(s.ticks for s in segments) == 2400 * 17
    recent = [s.ticks for s in segments if s.time > lab.simulation.time - RECENT]
    assert set(recent) == {17} and max(s.ticks for s in segments) == COARSE
    assert len(segments) < 2400 * 0.8
    for segment, later in pairwise(segments):
        drive, ends = segment.drives[name], segment.time + segment.ticks * segment.dt
        assert later.time == pytest.approx(ends, abs=1e-9)
        loop = lab.simulation._loop_cache.find(lab.simulation.robot, drive.kind)
        assert loop is not None
        state, _ = loop.run(drive.state, drive.settings, segment.curve.table(), segment.ticks)
        assert np.array_equal(state, later.drives[name].state)


def test_reading_from_another_thread_changes_nothing() -> None:
    """A page is built in a thread of its own."""
    history, done = new_history(), threading.Event()

    def look() -> None:
        while not done.is_set():
            history.samples(0.0, 100.0, 10)

    looking = threading.Thread(target=look)
    looking.start()
    for k in range(3000):
        add(history, k * 5e-3, 5)
    done.set()
    looking.join()
    assert contiguous(history) and sum(s.ticks for s in history.all()) == 15_000


def test_a_copy_of_what_came_before_is_independent() -> None:
    history = new_history()
    for k in range(10):
        add(history, k * 0.017)
    found = history.at(0.1)
    assert found is not None
    before = history.before(found)
    assert [s.time for s in before.all()] == pytest.approx([k * 0.017 for k in range(5)])
    add(before, 0.085)
    assert [s.time for s in history.all()] == pytest.approx([k * 0.017 for k in range(10)])
    history.clear()
    assert len(history) == 0 and history.at(1.0) is None and history.span() == 0.0


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 300), st.integers(1, 120), st.floats(-1, 5), st.floats(0, 4))
def test_samples_are_few_in_order_and_within(
    count: int, most: int, begin: float, span: float
) -> None:
    history = new_history()
    for k in range(count):
        add(history, k * 0.017)
    times, samples = history.samples(begin, begin + span, most)
    assert len(times) == len(samples) <= most
    assert np.all(np.diff(times) > 0) and np.all((begin <= times) & (times <= begin + span))
    if len(times):
        assert np.array_equal(samples[:, 0, 0], times.astype(np.float32))
    inside = sum(begin <= k * 0.017 <= begin + span for k in range(count))
    assert inside == len(times) if inside <= most else len(times) > most / 4


# In a simulation


def busy(seconds: float = 1.0) -> Lab:
    """A lab with a past in which everything happened."""
    lab = new_lab(0.3)
    do(lab, c.Hold(True))
    run(lab, seconds / 3)
    do(lab, c.Hold(False), c.Set("K3", 200))
    do(
        lab,
        c.Grab(TRACKER, y(lab.simulation, TRACKER) + np.array([0.02, 0.0])),
    )
    run(lab, seconds / 3)
    do(lab, c.Release(), c.ChoosePath("ellipse"))
    run(lab, seconds / 3 + 0.35)
    return lab


def test_past_is_shown_as_it_was() -> None:
    lab, seen = new_lab(), []
    for _ in range(60):
        lab.advance(FRAME)
        seen.append((lab.simulation.time, take_snapshot(lab, 1.0)))
    for ago in (0.1, 0.4, 0.9):
        do(lab, c.LookAt(ago))
        assert not lab.simulation.running and lab.simulation.viewing == pytest.approx(
            lab.simulation.time - ago
        )
        now = take_snapshot(lab, 1.0)
        at = lab.simulation.history.at(lab.simulation.viewing or 0.0)
        assert at is not None
        begin = at.time
        then = min(seen, key=lambda pair: abs(pair[0] - begin))[1]
        for name in SIDES:
            was, shown = then.robots[name], now.robots[name]
            assert shown.joints == pytest.approx(was.joints, abs=1e-3)
            assert shown.tip == pytest.approx(was.tip, abs=1e-6)
            assert shown.distance == pytest.approx(was.distance, abs=1e-7)
            assert shown.max_distance == was.max_distance
            assert shown.speed == pytest.approx(was.speed, rel=1e-5)
    do(lab, c.LookAt(0.0))
    assert lab.simulation.viewing is None
    assert take_snapshot(lab, 1.0).robots[TRACKER].tip == pytest.approx(
        seen[-1][1].robots[TRACKER].tip
    )


def test_looking_back_by_keys_stops_at_both_ends() -> None:
    lab = new_lab(1.0)
    do(lab, c.LookBack(0.2), c.LookBack(0.2))
    assert lab.simulation.viewing == pytest.approx(lab.simulation.time - 0.4)
    do(lab, c.LookBack(-0.3))
    assert lab.simulation.viewing == pytest.approx(lab.simulation.time - 0.1)
    do(lab, c.LookBack(100.0))
    assert lab.simulation.viewing == pytest.approx(
        lab.simulation.time - lab.simulation.history.span()
    )
    do(lab, c.LookBack(-100.0))
    assert lab.simulation.viewing is None


@pytest.mark.parametrize("values", [{}, {"K3": 300, "encoder_counts": 4000}, {"control_rate": 50}])
def test_going_on_gives_the_same_future_to_the_last_bit(values: dict[str, float]) -> None:
    lab = new_lab()
    do(lab, *[c.Set(name, value) for name, value in values.items()])
    run(lab, 1.0)
    passed: dict[int, dict[str, np.ndarray]] = {}
    for _ in range(40):
        lab.advance(FRAME)
        passed[round(lab.simulation.time * 1e3)] = states(lab.simulation)
    do(lab, c.LookAt(0.4), c.GoOn())
    begin = lab.simulation.time
    assert lab.simulation.viewing is None and lab.simulation.running
    assert begin == pytest.approx(1.667 - 0.4, abs=0.035)
    compared = 0
    while lab.simulation.time < 1.6:
        lab.simulation.simulate(1)
        then = passed.get(round(lab.simulation.time * 1e3))
        if then is not None:
            compared += 1
            for name, state in states(lab.simulation).items():
                assert np.array_equal(state, then[name])
    assert compared > 10


def test_going_on_forgets_what_came_after() -> None:
    lab = busy()
    most = lab.simulation.runs[TRACKER].max_distance
    do(lab, c.LookAt(lab.simulation.time - 0.2), c.GoOn())
    assert lab.simulation.time < 0.21 and lab.simulation.history.span() < 0.21
    assert not lab.simulation.forces.held and not lab.simulation.forces.hands
    assert lab.simulation.runs[TRACKER].max_distance < most / 3
    run(lab, 0.5)
    assert contiguous(lab.simulation.history)
    for run_ in lab.simulation.runs.values():
        assert run_.diverged is None and run_.distance < 3e-3


def test_going_on_from_a_time_with_another_path_finds_the_new_one() -> None:
    lab = new_lab(0.5)
    do(lab, c.ChoosePath("segment"))
    run(lab, 0.5)
    do(lab, c.LookAt(0.8), c.GoOn())
    run(lab, 2.0)
    for run_ in lab.simulation.runs.values():
        assert run_.diverged is None and run_.distance < 1e-3
        assert not lab.simulation.editor.curve.closed


def test_acting_on_the_lab_ends_looking_back() -> None:
    for command in (c.Hold(True), c.MoveHand(0.01, 0.0), c.StepOnce(), c.ChoosePath("ellipse")):
        lab = new_lab(0.5)
        time = lab.simulation.time
        do(lab, c.LookAt(0.3), command)
        assert lab.simulation.viewing is None and lab.simulation.time >= time


def test_reset_forgets_the_past() -> None:
    lab = new_lab(0.5)
    do(lab, c.LookAt(0.3), c.Reset())
    assert (
        lab.simulation.viewing is None
        and len(lab.simulation.history) == 0
        and lab.simulation.time == 0.0
    )
    do(lab, c.LookAt(0.3))
    assert lab.simulation.viewing is None


def test_a_robot_that_had_diverged_stands_still_again_and_one_that_had_not_runs() -> None:
    lab = new_lab(0.5)
    lab.simulation.runs[FOLLOWER].fields()["v"][:] = 500.0
    run(lab, 0.5)
    assert lab.simulation.runs[FOLLOWER].diverged
    do(lab, c.LookAt(0.2), c.GoOn())
    assert lab.simulation.runs[FOLLOWER].diverged and "Path following stopped" in lab.message
    do(lab, c.LookAt(lab.simulation.time - 0.3), c.GoOn())
    assert lab.simulation.runs[FOLLOWER].diverged is None and lab.message_level == "info"
    run(lab, 0.3)
    assert (
        lab.simulation.runs[FOLLOWER].diverged is None
        and lab.simulation.runs[FOLLOWER].distance < 1e-3
    )


@pytest.mark.parametrize("robot", ["flexible", "two_link_arm"])
def test_a_page_may_be_built_while_the_robot_is_changed(
    robot: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another thread reads the samples when the new robot is there and its run has not begun."""
    lab = new_lab(0.1)
    restart, seen = Simulation._restart, list[np.ndarray]()

    def read_first(simulation: Simulation) -> None:
        seen.append(simulation.history.samples(0.0, 1.0, 100)[1])
        restart(simulation)

    monkeypatch.setattr(Simulation, "_restart", read_first)
    size = lab.simulation.sample_layout.size
    do(lab, c.ChooseRobot(robot))
    assert [samples.shape[2] for samples in seen] == [size] and len(seen[0])


@given(
    st.lists(st.floats(allow_nan=False), min_size=12, max_size=12),
    st.lists(st.dictionaries(st.integers(0, 11), st.floats(allow_nan=False)), max_size=5),
)
def test_an_input_stores_its_settings_exactly(
    before: list[float], changes: list[dict[int, float]]
) -> None:
    """To the last bit, also the sign of zero, whether many of them have changed or few."""
    settings, changed = np.array(before), set[int]()
    first = made = Input(FOLLOWER, KIND, settings.copy(), False, 1)
    for change in changes:
        settings[list(change)] = list(change.values())
        earlier, made = made, Input(FOLLOWER, KIND, settings.copy(), False, 1).like(made)
        assert made.settings(settings[made.varying]).tobytes() == settings.tobytes()
        assert made is earlier or not change.keys() <= set(earlier.varying.tolist())
        changed |= change.keys()
        assert made.base is first.base or len(changed) > FEW


@pytest.mark.parametrize(
    "change",
    [
        lambda k: c.Grab(FOLLOWER, np.array([0.01 * k, 0.15])),
        lambda k: c.Set("K1", 400.0 + k),
    ],
    ids=["pull", "slider"],
)
def test_inputs_that_differ_in_few_settings_share_the_others(
    change: Callable[[int], c.Command],
) -> None:
    lab = new_lab(0.1)
    follower = lab.simulation.runs[FOLLOWER]
    for k in range(5):
        do(lab, change(k))
        lab.simulation.simulate(17)
        made = follower.input()
        assert np.array_equal(made.settings(np.frombuffer(follower.values)), follower.settings)
    drives = [s.drives[FOLLOWER] for s in lab.simulation.history.all()[-4:]]
    assert len({d.settings.tobytes() for d in drives}) == 4
    inputs = lab.simulation.history.copy().columns["inputs"][-4:]
    assert len(set(map(id, inputs))) == 1
