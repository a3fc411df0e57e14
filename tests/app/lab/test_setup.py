"""A set-up is captured, restored, and rejected as a whole."""

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
    Set,
    Undo,
)
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture, capture_path, kept
from onpath.app.lab.setups.former import DEFAULTS
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.models.closed_loop.simulation import has_level_set
from onpath.models.control.settable import specs
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.drawing_design import from_curve
from onpath.models.paths.path_design import PathDesign
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameter_specs import NOTHING
from tests.support.lab import FOLLOWER, do, new_lab, run
from tests.support.some_setups import CALM, FOLLOWABLE, PRESETS, designs, setups

SLOW = settings(CALM, max_examples=25)
RIGID, FLEXIBLE = "five_bar", "flexible"


def own(**path: Any) -> Setup:
    return Setup(robots={RIGID: RobotSetup(path=Path(**path))})


def followable(setup: Setup) -> bool:
    """Whether a new lab takes it."""
    try:
        restore(new_lab().simulation, setup)
    except ValueError as error:
        assert "cannot follow this path" in str(error)
        return False
    return True


def everything(lab: Lab) -> list[Any]:
    """What restoring touches, and what it must not."""
    editor = lab.simulation.editor
    kept = [
        lab.simulation.entry,
        lab.simulation.parameters,
        lab.simulation.robot,
        editor,
        editor.design,
        editor.curve,
    ]
    kept += [
        editor.version,
        lab.simulation.settings,
        lab.simulation.time,
    ]
    kept += [id(run) for run in lab.simulation.runs.values()] + [
        len(lab.simulation.history),
        lab.simulation.running,
    ]
    return [*kept, dict(lab.simulation.earlier), lab.simulation.forces.held.copy(), lab.message]


def test_a_new_lab_has_nothing_to_tell() -> None:
    assert capture(new_lab().simulation) == Setup()
    assert to_data(Setup()) == {"defaults": DEFAULTS}


@pytest.mark.thorough
@SLOW
@given(setups())
def test_what_is_restored_is_captured_again(setup: Setup) -> None:
    lab = new_lab(0.1)
    if followable(setup):
        restore(lab.simulation, setup)
        run(lab, 0.1)
        assert lab.simulation.time > 0
        asked = setup.robots.get(setup.robot, RobotSetup()).parameters
        if asked.get("across") == LEVEL_SET and not has_level_set(lab.simulation.editor.curve):
            assert lab.simulation.parameters.across == "distance"
        else:
            assert capture(lab.simulation) == setup


def test_what_a_parameter_takes_for_nothing_is_kept_as_nothing() -> None:
    for gain in (NOTHING, NOTHING / 2, 2 * NOTHING):
        lab = new_lab()
        restore(lab.simulation, Setup(robots={"five_bar": RobotSetup({"K1": gain})}))
        value = lab.simulation.parameters.K1
        assert (
            value == kept(specs(lab.simulation.parameters)["K1"], gain) == (gain > NOTHING) * gain
        )


@CALM
@given(setups())
def test_data_round_trip(setup: Setup) -> None:
    assert from_data(msgspec.json.decode(msgspec.json.encode(to_data(setup)))) == setup


@pytest.mark.thorough
@SLOW
@given(designs)
def test_a_path_comes_back_where_it_was(design: PathDesign) -> None:
    lab = new_lab()
    if lab.simulation.editor.commit(design):
        other = new_lab()
        restore(other.simulation, capture(lab.simulation))
        back, theta = other.simulation.editor.design, design.curve.sample()
        assert back.curve.closed == design.curve.closed
        assert np.abs(back.curve.at(theta) - design.curve.at(theta)).max() < 2e-5
        placed_anew = isinstance(design.curve, SplineCurve)
        handles = from_curve(design.curve).points if placed_anew else design.points
        assert np.abs(back.points - handles).max() < 2e-5
        if isinstance(design.curve, SplineCurve):
            given = {**design.curve.data(), "given": None, "deviation": 0.0}
            assert repr(back.curve.data()) == repr(given)  # to the last bit
            assert np.array_equal(back.curve.coefficients, design.curve.coefficients)
        np.testing.assert_array_equal(
            other.simulation.editor.curve.coefficients, back.curve.coefficients
        )


def test_robots_start_on_the_new_path_and_undo_brings_the_old() -> None:
    lab = new_lab(0.5)
    restore(lab.simulation, own(name="ellipse"))
    assert (
        lab.simulation.time == 0 and lab.simulation.editor.curve is PRESETS["ellipse"].curve
    ) or (lab.simulation.editor.curve is lab.simulation.presets["ellipse"].curve)
    run(lab, 1.0)
    assert lab.simulation.runs[FOLLOWER].max_distance < 1e-4
    do(lab, Undo())
    assert lab.simulation.editor.design.name == "circle"


def test_every_side_is_kept_and_those_not_named_are_as_new() -> None:
    lab = new_lab()
    do(lab, Set("K3", 100.0), ChooseRobot(FLEXIBLE), Set("alpha", 0.25))
    do(lab, ChoosePath("segment"))
    kept = capture(lab.simulation)
    assert kept.robot == FLEXIBLE and set(kept.robots) == {RIGID, FLEXIBLE}
    restore(lab.simulation, Setup())
    assert capture(lab.simulation) == Setup()
    restore(lab.simulation, kept)
    assert lab.simulation.entry.name == FLEXIBLE and lab.simulation.parameters.K3 == 0.0
    do(lab, ChooseRobot(RIGID))
    assert lab.simulation.parameters.K3 == 100.0
    assert capture(lab.simulation).robots == kept.robots


def test_numbers_with_a_tail_are_rounded_within_their_range() -> None:
    lab = new_lab()
    do(lab, Set("target", math.pi), Set("K1", 0.1 + 0.2))
    do(lab, Set("payload", 1e-300))
    kept = capture(lab.simulation)
    assert kept.robots[RIGID].parameters == {"K1": 0.3, "target": 3.14159}
    restore(lab.simulation, kept)
    assert capture(lab.simulation) == kept


def drawing(numbers: tuple[int, ...], closed: bool = False, **given: Any) -> Path:
    return Path("drawing", closed, numbers, **{"duration": 10_000, **given})


BAD: dict[str, tuple[Setup, str]] = {
    "robot": (Setup(robot="six_bar"), "unknown robot"),
    "side": (Setup(robots={"six_bar": RobotSetup()}), "unknown robot"),
    "parameter": (Setup(robots={RIGID: RobotSetup({"K9": 1.0})}), "unknown parameter"),
    "another robot's parameter": (
        Setup(robots={RIGID: RobotSetup({"alpha": 1.0})}),
        "unknown param",
    ),
    "range": (Setup(robots={RIGID: RobotSetup({"K1": 1e9})}), "not between"),
    "not a number": (Setup(robots={RIGID: RobotSetup({"K1": math.nan})}), "not between"),
    "infinity": (Setup(robots={RIGID: RobotSetup({"K1": -math.inf})}), "not between"),
    "huge": (Setup(robots={RIGID: RobotSetup({"K1": 10**400})}), "not a number"),
    "word": (Setup(robots={RIGID: RobotSetup({"K1": "much"})}), "not a number"),
    "option": (Setup(robots={RIGID: RobotSetup({"control_rate": 3})}), "not one of"),
    "script": (Setup(robots={RIGID: RobotSetup({"<script>": 3})}), "matching"),
    "list": (Setup(robots={RIGID: RobotSetup({"K1": [1.0]})}), "Expected"),  # pyright: ignore[reportArgumentType]
    "rate": (Setup(settings={"rate": 9.0}), "rate: 9"),
    "no rate": (Setup(settings={"rate": math.nan}), "rate: nan"),
    "exaggeration": (Setup(settings={"larger": 0.0}), "larger: 0"),
    "path": (own(name="spiral"), "unknown path"),
    "preset with numbers": (own(name="circle", numbers=(1, 2)), "no numbers"),
    "no points": (own(name="edited"), "2 to 24 points"),
    "half a point": (own(name="edited", numbers=(1, 2, 3)), "a point is incomplete"),
    "points in one place": (own(name="edited", numbers=(1, 2) * 5), "at least 3 points"),
    "far away": (own(name="edited", numbers=(0, 0, 900_000, 0, 0, 900_000)), "within 0.2 m"),
    "farther": (own(name="edited", numbers=(0, 0, 10**9, 0, 0, 10**9)), "Expected"),
    "too many points": (own(name="edited", numbers=tuple(range(50))), "2 to 24"),
    "coefficients": (own(name="drawn", numbers=(1, 2)), "25 coefficients"),
    "drawn in a point": (own(name="drawn", numbers=(0,) * 50), "cusp"),
    "not reached": (own(name="drawn", closed=False, numbers=(500_000,) * 26), "workspace"),
    "drawing of no pieces": (
        Setup(robots={RIGID: RobotSetup(path=drawing((1,) * 8))}),
        "512 pieces",
    ),
    "drawing in no time": (
        Setup(robots={RIGID: RobotSetup(path=drawing((1,) * 20, duration=0))}),
        "not those of a drawing",
    ),
    "drawing far away": (
        Setup(robots={RIGID: RobotSetup(path=drawing((900_000,) * 20))}),
        "not those of a drawing",
    ),
    "drawing that is raised and not lowered": (
        Setup(robots={RIGID: RobotSetup(path=drawing((1,) * 20, raised=(5,)))}),
        "not those of a drawing",
    ),
    "drawing that is raised backwards": (
        Setup(robots={RIGID: RobotSetup(path=drawing((1,) * 20, raised=(5, 4)))}),
        "not those of a drawing",
    ),
    "drawing that does not close": (
        Setup(robots={RIGID: RobotSetup(path=drawing(tuple(range(20)), closed=True))}),
        "first five",
    ),
    "the other robot's path": (
        Setup(robots={FLEXIBLE: RobotSetup(path=Path("drawn", False, (500_000,) * 26))}),
        "flexible link cannot follow",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_setup_is_refused_in_words_and_changes_nothing(case: str) -> None:
    setup, words = BAD[case]
    if setup.robots:  # what else is in it is good, and must not be applied either
        good = {"settings": {"rate": 2.0, "copy": False, "larger": 3.0}, "robot": FLEXIBLE}
        setup = msgspec.structs.replace(setup, **good)
    lab = new_lab(0.2)
    do(lab, ChooseRobot(FLEXIBLE), ChooseRobot(RIGID), SelectPoint(2), AddPoint())
    before = everything(lab)
    with pytest.raises(ValueError, match=words):
        restore(lab.simulation, setup)
    assert everything(lab) == before


@pytest.mark.parametrize("data", [None, 3, "x", [], {"robots": 1}, {"benches": {RIGID: {"x": 1}}}])
def test_strange_data_is_refused(data: Any) -> None:
    with pytest.raises(ValueError):
        from_data(data)


def test_presets_that_are_offered_can_be_restored() -> None:
    lab = new_lab()
    for name in FOLLOWABLE:
        assert not curve_faults(lab.simulation.robot.margin, PRESETS[name].curve)
        assert capture_path(PRESETS[name], PRESETS) == Path(name)
        restore(lab.simulation, own(name=name))
        assert lab.simulation.editor.design is lab.simulation.presets[name]


def test_no_point_is_selected_after_a_set_up() -> None:
    """Else the ball that was taken in one step of a lesson would still be marked in the next."""
    lab = new_lab()
    do(lab, SelectPoint(2))
    assert lab.simulation.editor.selected == 2
    restore(lab.simulation, capture(lab.simulation))
    assert lab.simulation.editor.selected is None
