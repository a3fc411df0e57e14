"""A set-up is captured, put back, and refused as a whole."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings

from onpath.app.lab.commands import (
    AddPoint,
    ChoosePath,
    ChooseRobot,
    SelectPoint,
    SetParameter,
    Undo,
)
from onpath.app.lab.session import Session
from onpath.app.lab.setup import (
    DRAWN_POINTS,
    Path,
    RobotSetup,
    Setup,
    capture,
    capture_path,
    from_data,
    kept,
    restore,
    to_data,
)
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.parameters import NOTHING, specs
from tests.support.lab import FOLLOWER, do, new_session, run
from tests.support.some_setups import CALM, FOLLOWABLE, PRESETS, designs, setups, wave

SLOW = settings(CALM, max_examples=25)
RIGID, FLEXIBLE = "five_bar", "flexible"


def own(**path: Any) -> Setup:
    return Setup(benches={RIGID: RobotSetup(path=Path(**path))})


def followable(setup: Setup) -> bool:
    """Whether a new lab takes it."""
    try:
        restore(new_session(), setup)
    except ValueError as error:
        assert "cannot follow this path" in str(error)
        return False
    return True


def everything(session: Session) -> list[Any]:
    """What restoring touches, and what it must not."""
    editor = session.editor
    kept = [session.entry, session.parameters, session.robot, editor, editor.design, editor.curve]
    kept += [editor.version, session.rate, session.copy, session.exaggeration, session.time]
    kept += [id(run) for run in session.runs.values()] + [len(session.history), session.running]
    return [*kept, dict(session._benches), session.grips.held.copy(), session.message]


def test_a_new_lab_has_nothing_to_tell() -> None:
    assert capture(new_session()) == Setup()
    assert to_data(Setup()) == {}


@SLOW
@given(setups())
def test_what_is_restored_is_captured_again(setup: Setup) -> None:
    session = new_session(0.1)
    if followable(setup):
        restore(session, setup)
        run(session, 0.1)
        assert capture(session) == setup
        assert session.time > 0


def test_what_a_parameter_takes_for_nothing_is_kept_as_nothing() -> None:
    for gain in (NOTHING, NOTHING / 2, 2 * NOTHING):
        session = new_session()
        restore(session, Setup(benches={"five_bar": RobotSetup({"K1": gain})}))
        value = session.parameters.K1
        assert value == kept(specs(session.parameters)["K1"], gain) == (gain > NOTHING) * gain


@CALM
@given(setups())
def test_data_round_trip(setup: Setup) -> None:
    assert from_data(msgspec.json.decode(msgspec.json.encode(to_data(setup)))) == setup


@SLOW
@given(designs)
def test_a_path_comes_back_where_it_was(design: PathDesign) -> None:
    session = new_session()
    if session.editor.commit(design):
        other = new_session()
        restore(other, capture(session))
        back, theta = other.editor.design, design.curve.sample()
        assert back.curve.closed == design.curve.closed
        assert np.abs(back.curve.at(theta) - design.curve.at(theta)).max() < 2e-5
        assert np.abs(back.points - design.points).max() < 2e-5
        np.testing.assert_array_equal(other.editor.curve.series, back.curve.series)


@pytest.mark.parametrize("closed", [True, False])
def test_a_stroke_keeps_its_number_of_control_points(closed: bool) -> None:
    assert len(wave(0.5, 0.0, closed).points) == DRAWN_POINTS[closed]


def test_robots_start_on_the_new_path_and_undo_brings_the_old() -> None:
    session = new_session(0.5)
    restore(session, own(name="ellipse"))
    assert (session.time == 0 and session.editor.curve is PRESETS["ellipse"].curve) or (
        session.editor.curve is session.presets["ellipse"].curve
    )
    run(session, 1.0)
    assert session.runs[FOLLOWER].max_distance < 1e-4
    do(session, Undo())
    assert session.editor.design.name == "circle"


def test_every_bench_is_kept_and_those_not_named_are_as_new() -> None:
    session = new_session()
    do(session, SetParameter("K3", 100.0), ChooseRobot(FLEXIBLE), SetParameter("alpha", 0.25))
    do(session, ChoosePath("segment"))
    kept = capture(session)
    assert kept.robot == FLEXIBLE and set(kept.benches) == {RIGID, FLEXIBLE}
    restore(session, Setup())
    assert capture(session) == Setup()
    restore(session, kept)
    assert session.entry.name == FLEXIBLE and session.parameters.K3 == 0.0
    do(session, ChooseRobot(RIGID))
    assert session.parameters.K3 == 100.0
    assert capture(session).benches == kept.benches


def test_numbers_with_a_tail_are_rounded_within_their_range() -> None:
    session = new_session()
    do(session, SetParameter("target", math.pi), SetParameter("K1", 0.1 + 0.2))
    do(session, SetParameter("payload", 1e-300))
    kept = capture(session)
    assert kept.benches[RIGID].parameters == {"K1": 0.3, "target": 3.14159}
    restore(session, kept)
    assert capture(session) == kept


BAD: dict[str, tuple[Setup, str]] = {
    "robot": (Setup(robot="six_bar"), "unknown robot"),
    "bench": (Setup(benches={"six_bar": RobotSetup()}), "unknown robot"),
    "parameter": (Setup(benches={RIGID: RobotSetup({"K9": 1.0})}), "unknown parameter"),
    "another robot's parameter": (
        Setup(benches={RIGID: RobotSetup({"alpha": 1.0})}),
        "unknown param",
    ),
    "range": (Setup(benches={RIGID: RobotSetup({"K1": 1e9})}), "not between"),
    "not a number": (Setup(benches={RIGID: RobotSetup({"K1": math.nan})}), "not between"),
    "infinity": (Setup(benches={RIGID: RobotSetup({"K1": -math.inf})}), "not between"),
    "huge": (Setup(benches={RIGID: RobotSetup({"K1": 10**400})}), "not a number"),
    "word": (Setup(benches={RIGID: RobotSetup({"K1": "much"})}), "not a number"),
    "option": (Setup(benches={RIGID: RobotSetup({"control_rate": 3})}), "not one of"),
    "script": (Setup(benches={RIGID: RobotSetup({"<script>": 3})}), "matching"),
    "list": (Setup(benches={RIGID: RobotSetup({"K1": [1.0]})}), "Expected"),  # pyright: ignore[reportArgumentType]
    "rate": (Setup(rate=9.0), "speed: 9"),
    "no rate": (Setup(rate=math.nan), "speed: nan"),
    "exaggeration": (Setup(exaggeration=0.0), "exaggeration: 0"),
    "path": (own(name="spiral"), "unknown path"),
    "preset with numbers": (own(name="circle", numbers=(1, 2)), "no numbers"),
    "no points": (own(name="edited"), "2 to 24 points"),
    "half a point": (own(name="edited", numbers=(1, 2, 3)), "half a point"),
    "points in one place": (own(name="edited", numbers=(1, 2) * 5), "at least 3 points"),
    "far away": (own(name="edited", numbers=(0, 0, 900_000, 0, 0, 900_000)), "within 0.2 m"),
    "farther": (own(name="edited", numbers=(0, 0, 10**9, 0, 0, 10**9)), "Expected"),
    "too many points": (own(name="edited", numbers=tuple(range(50))), "2 to 24"),
    "coefficients": (own(name="drawn", numbers=(1, 2)), "25 coefficients"),
    "drawn in a point": (own(name="drawn", numbers=(0,) * 50), "cusp"),
    "crossing": (own(name="figure of eight"), "crosses itself"),
    "not reached": (own(name="drawn", closed=False, numbers=(500_000,) * 26), "workspace"),
    "the other robot's path": (
        Setup(benches={FLEXIBLE: RobotSetup(path=Path("figure of eight"))}),
        "flexible link cannot follow",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_setup_is_refused_in_words_and_changes_nothing(case: str) -> None:
    setup, words = BAD[case]
    if setup.benches:  # what else is in it is good, and must not be applied either
        good = {"rate": 2.0, "copy": False, "exaggeration": 3.0, "robot": FLEXIBLE}
        setup = msgspec.structs.replace(setup, **good)
    session = new_session(0.2)
    do(session, ChooseRobot(FLEXIBLE), ChooseRobot(RIGID), SelectPoint(2), AddPoint())
    before = everything(session)
    with pytest.raises(ValueError, match=words):
        restore(session, setup)
    assert everything(session) == before


@pytest.mark.parametrize("data", [None, 3, "x", [], {"robots": 1}, {"benches": {RIGID: {"x": 1}}}])
def test_strange_data_is_refused(data: Any) -> None:
    with pytest.raises(ValueError):
        from_data(data)


def test_presets_that_are_offered_can_be_restored() -> None:
    session = new_session()
    for name in FOLLOWABLE:
        assert not curve_faults(session.robot.margin, PRESETS[name].curve)
        assert capture_path(PRESETS[name], PRESETS) == Path(name)
        restore(session, own(name=name))
        assert session.editor.design is session.presets[name]
