"""Labs that advance together do what each does alone, to the last bit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.lab import Lab
from onpath.app.lab.looking_back import forget_history
from onpath.models.closed_loop.loops import CompiledLoop
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import FOLLOWER, FRAME, do, finish, loop_cache, new_lab
from tests.support.waiting import wait_for

WILD = [("K1", 5000), ("K2", 0), ("control_rate", 50)]
"""Settings with which a robot diverges once it is held."""


def random_command(rng: np.random.Generator, lab: Lab) -> list[c.Command]:
    """What a user might do; drawn from `rng` alone, so that equal labs get equal commands."""
    target = rng.normal(0.0, 0.03, lab.simulation.robot.system.p)
    parameter = [("K1", rng.uniform(50, 1500)), ("K3", rng.uniform(0, 40))][rng.integers(2)]
    other = [("encoder_counts", 500), ("torque_limit", 1.0), ("across", "level_set")]
    choices: list[list[c.Command]] = [
        [c.Set(*parameter)],
        [c.Set(*other[rng.integers(len(other))])],
        [c.ChoosePath(str(rng.choice(list(presets()))))],
        [c.Hold(bool(rng.integers(2)))],
        [c.Grab(SIDES[rng.integers(2)], target)],
        [c.Release()],
        [c.Set("rate", float(rng.choice([0.5, 1.0, 2.0])))],
        [c.SetRunning(bool(rng.integers(3)))],
        [*(c.Set(*each) for each in WILD), c.Hold(True)],
        [c.Reset()],
    ]
    return choices[rng.integers(len(choices))]


def played(together: bool) -> Iterator[list[Lab]]:
    """Labs of all robots, two of the first, with random users, after each frame."""
    rng, entries = np.random.default_rng(1), [*ROBOTS.values()]
    labs = [Lab(loop_cache(), entry) for entry in (*entries, entries[0])]
    for _ in range(240):
        for lab in labs:
            if rng.random() < 0.04:
                do(lab, *random_command(rng, lab))
        if together:
            advance_together([lab.frame(lab.simulation.settings.rate * FRAME) for lab in labs])
        else:
            for lab in labs:
                lab.advance(lab.simulation.settings.rate * FRAME)
        yield labs


def now(lab: Lab) -> list[object]:
    """Everything that simulating changes, but for the history."""
    simulation = lab.simulation
    runs = [
        (run.state.tobytes(), run.row.tobytes(), run.distance, run.max_distance, run.diverged)
        for run in simulation.runs.values()
    ]
    return [simulation.time, lab.message, runs]


@pytest.mark.thorough
def test_advancing_together_equals_advancing_one_by_one() -> None:
    stopped, labs, others = set[str](), list[Lab](), list[Lab]()
    for labs, others in zip(played(True), played(False), strict=True):
        for lab, other in zip(labs, others, strict=True):
            assert now(lab) == now(other)
            stopped |= {
                run.diverged.reason.code for run in lab.simulation.runs.values() if run.diverged
            }
    assert stopped
    for lab, other in zip(labs, others, strict=True):
        columns, alone = (each.simulation.history.copy().columns for each in (lab, other))
        assert columns.keys() == alone.keys()
        for name in columns.keys() - {"inputs"}:
            assert columns[name].tobytes() == alone[name].tobytes()
        assert [vars_of(event) for event in lab.simulation.events] == [
            vars_of(event) for event in other.simulation.events
        ]


def vars_of(event: object) -> list[object]:
    return [getattr(event, name) for name in ("run", "time", "name", "detail", "sides")]


def compiled_labs(count: int) -> list[Lab]:
    """Equal labs whose loops are compiled."""
    wait_for(are_compiled, 60.0)
    return [new_lab(FRAME) for _ in range(count)]


def are_compiled() -> bool:
    """Whether the loops of a new lab are; what is no longer asked for is not compiled."""
    ticks = next(new_lab(FRAME).frame(FRAME))
    finish(loop_cache())
    return all(isinstance(loop, CompiledLoop) for _, loop in ticks.runs)


def test_a_frame_is_one_call_per_kind_of_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    calls, run_many = list[int](), CompiledLoop.run_many

    def counted(self: CompiledLoop, states: list[np.ndarray], *others: object) -> object:
        calls.append(len(states))
        return run_many(self, states, *others)  # pyright: ignore[reportArgumentType]

    labs = compiled_labs(7)
    for lab, gain in zip(labs, range(400, 1100, 100), strict=True):
        do(lab, c.Set("K1", gain))
    monkeypatch.setattr(CompiledLoop, "run_many", counted)
    advance_together([lab.frame(FRAME) for lab in labs])
    assert calls == [len(labs)] * len(SIDES)


def test_one_lab_s_error_leaves_the_others_alone() -> None:
    labs, alone, errors = compiled_labs(4), new_lab(FRAME), list[Exception]()
    labs[1].simulation.editor.table = np.zeros(3)
    labs[2].simulation.forces.pushes.clear()
    for _ in range(3):
        advance_together([lab.frame(FRAME) for lab in labs], errors.append)
        alone.advance(FRAME)
    assert [type(error) for error in errors] == [KeyError, ValueError] * 3
    for lab in (labs[0], labs[3]):
        assert now(lab) == now(alone) and len(lab.simulation.history) == len(
            alone.simulation.history
        )
    assert labs[1].simulation.time == new_lab(FRAME).simulation.time
    with pytest.raises(ValueError, match="reshape"):
        labs[1].advance(FRAME)


def test_no_lab_keeps_the_log_of_all_ticks() -> None:
    """A lab that stands still keeps one frame's records of all loops of its kind, and no more."""
    labs = compiled_labs(5)
    advance_together([lab.frame(FRAME) for lab in labs])
    for run in (run for lab in labs for run in lab.simulation.runs.values()):
        records = run.slot[0].records
        assert records.base is None and records.shape == (5, run.state.size + run.row.size + 2)
    do(labs[0], *(c.Set(*each) for each in WILD), c.Hold(True))
    while labs[0].simulation.runs[FOLLOWER].diverged is None:
        advance_together([lab.frame(FRAME) for lab in labs])
    assert len(labs[0].simulation.runs[FOLLOWER].slot[0].records) == 1
    assert all(run.diverged is None for lab in labs[1:] for run in lab.simulation.runs.values())


def test_a_lab_that_was_left_keeps_nothing_of_those_it_was_advanced_with() -> None:
    labs = [new_lab(0.0) for _ in range(3)]
    for _ in range(5):
        advance_together([lab.frame(FRAME) for lab in labs])
    simulation = labs[0].simulation
    together, before = simulation.runs[FOLLOWER].slot[0].records, simulation.instant()
    assert len(together) >= len(labs)
    forget_history(simulation)
    after = simulation.instant()
    assert not len(simulation.history)
    for old, new in zip(before.states, after.states, strict=True):
        assert np.array_equal(old, new) and not np.shares_memory(new, together)
