"""Who may set what, and where it is kept: every setting against the table of its declaration."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.settings import SetByProcess
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.step_setup import setup_from
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.storage.lab_state import _now, _state, put_back
from onpath.lessons.action_schema import StepSetup
from onpath.models.closed_loop import lab_settings
from onpath.models.closed_loop.lab_settings import (
    SETTINGS,
    LabSettings,
    Role,
    lab_specs,
    step_specs,
)
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import NOTHING, Spec, checked
from tests.support.lab import do, new_lab

EXAMPLES = 12
ROBOT_NAMES = ("five_bar", "flexible")
ODD = st.sampled_from([None, True, "", "x", "on", 10**400, float("nan"), -1e300, 0, 1, 0.5])
MATTERS = ("across", "b", "d", "centre", "rise", "start_beside", "start_along", "start_across")
"""Settings of which a value in range may still be impossible on the present path."""


ORDERS: dict[Role, type[c.Set]] = {"lab": c.Set, "process": SetByProcess}


def good(spec: Spec) -> st.SearchStrategy[Any]:
    if spec.options:
        return st.sampled_from(spec.options)
    return st.sampled_from([spec.low, spec.high, spec.low + spec.step])


@st.composite
def orders(draw: st.DrawFn) -> tuple[str, Role, str, Any]:
    """A robot, a role, the name of a setting, and a value."""
    robot = draw(st.sampled_from(ROBOT_NAMES))
    name, spec = draw(st.sampled_from(list(lab_specs(ROBOTS[robot].parameters).items())))
    value = draw(st.one_of(good(spec), good(spec), good(spec), ODD))
    return robot, draw(st.sampled_from(list(ORDERS))), name, value


def is_good(spec: Spec, name: str, value: Any) -> bool:
    try:
        checked(spec, name, value)
    except ValueError:
        return spec.kind == "switch" and value is None
    return True


def shown(lab: Lab) -> dict[str, Any]:
    return take_page_snapshot(lab, 1.0).values


def stored(lab: Lab) -> dict[str, Any]:
    """What a lab shows that is restored from what is stored of another one."""
    other = new_lab()
    put_back(other, _state(*_now(lab)))
    return shown(other)


def shared(lab: Lab) -> dict[str, Any]:
    other = new_lab()
    do(other, c.UseShared(encode(capture(lab.simulation))))
    assert other.message == lab.words("say.set_up")
    return shown(other)


PLACES = {"code": shared, "lab": stored}
BOTH = {"code": ("code", "lab"), "lab": ("lab",), "nowhere": ()}
"""Where a setting is kept -> the places that have it."""


@settings(max_examples=EXAMPLES, deadline=None)
@given(orders())
def test_a_setting_is_set_by_whom_it_says_and_kept_where_it_says(
    order: tuple[str, Role, str, Any],
) -> None:
    robot, role, name, value = order
    lab, setting = new_lab(), SETTINGS.get(name)
    spec = lab_specs(ROBOTS[robot].parameters)[name]
    do(lab, c.ChooseRobot(robot))
    before = shown(lab)
    lab.show_message("")
    do(lab, ORDERS[role](name, value))
    after, refused = shown(lab), take_page_snapshot(lab, 1.0).refused
    allowed = setting is None or setting.by in ("lab", role)
    if not allowed or not is_good(spec, name, value) or (refused and name in MATTERS):
        assert refused.keys() == {name} and refused[name] and lab.message == refused[name]
        assert after == before
    else:
        wanted = (not before[name]) if value is None else checked(spec, name, value)
        assert refused == {} and after[name] == wanted
        others = {n for n in after if after[n] != before[n]} - {name}
        assert others <= ({"wall_z1", "wall_z2", "wall_angle"} if name == "wall" else set())
    kept = BOTH["code" if setting is None else setting.kept]
    for place, told in PLACES.items():
        here = after[name] if place in kept else before[name]  # where it is not kept: the default
        there = told(lab)[name]
        if isinstance(here, str):  # an option
            assert there == here, place
        else:
            assert there == pytest.approx(here, rel=1e-5, abs=NOTHING), place
    do(lab, c.Set(name, before[name]))  # set again, whatever was refused
    assert (setting is not None and setting.by != "lab") or name not in lab.refused


@pytest.mark.parametrize("name", SETTINGS)
def test_a_lesson_s_step_restores_what_a_set_up_has(name: str) -> None:
    lab, setting = new_lab(), SETTINGS[name]
    spec = setting.spec
    value = not setting.default if spec.kind == "switch" else (spec.options or (spec.step,))[-1]
    value = value if spec.options else spec.low + spec.step
    if name == "start_beside":
        value = 0.01
    do(lab, c.Set("wall", True), c.Set(name, value))
    assert shown(lab)[name] == value
    lab.set_up(setup_from(StepSetup(), "five_bar"))
    restored = setting.kept == "code"
    assert shown(lab)[name] == (setting.default if restored else value)
    if restored:
        assert name in step_specs(ROBOTS["five_bar"].parameters)
        setup = StepSetup(set={"wall": True, name: value} if "wall_" in name else {name: value})
        lab.set_up(setup_from(setup, "five_bar"))
        assert shown(lab)[name] == pytest.approx(value)


def test_only_those_who_may_set_something_do(monkeypatch: pytest.MonkeyPatch) -> None:
    """The table of roles: none of today's settings is kept from its lab, but one may be."""
    for by in ORDERS:
        only = {"rate": lab_settings.LabSetting(SETTINGS["rate"].spec, 1.0, by, "code", False)}
        monkeypatch.setattr("onpath.app.lab.commands.settings.SETTINGS", only)
        for role, order in ORDERS.items():
            lab = new_lab()
            do(lab, order("rate", 0.5))
            may = by in ("lab", role)
            assert lab.simulation.settings.rate == (0.5 if may else 1.0)
            assert lab.refused == ({} if may else {"rate": lab.words("error.set_by_process")})


def test_a_refusal_is_gone_once_its_setting_is_set_and_with_another_set_up() -> None:
    lab = new_lab()
    do(lab, c.Set("rate", 9.0), c.Set("K1", "much"), c.Set("nothing", 1))
    assert lab.refused.keys() == {"rate", "K1"}
    do(lab, c.Set("rate", 2.0))
    assert lab.refused.keys() == {"K1"}
    do(lab, c.UseShared(encode(capture(new_lab().simulation))))
    assert lab.refused == {}


def test_a_wall_that_is_switched_off_stands_where_it_was_when_it_comes_back() -> None:
    lab = new_lab()
    do(lab, c.Set("wall"), c.Set("wall_z1", 0.02), c.Set("wall"))
    assert lab.simulation.wall is None and not lab.simulation.forces.pushes["left"].wall
    do(lab, c.Set("wall", True))
    wall = lab.simulation.wall
    assert wall is not None and wall.z1 == 0.02 and wall.z2 > 0
    assert decode(encode(capture(lab.simulation))).robots["five_bar"].settings["wall"] is True


def test_names_are_unique() -> None:
    for entry in ROBOTS.values():
        assert not SETTINGS.keys() & entry.parameters.__dataclass_fields__.keys()
    assert LabSettings().values == {name: each.default for name, each in SETTINGS.items()}
