"""Parameters accept exactly the values that they declare."""

from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.control.settable import changed, specs, value_of
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.parameter_specs import NOTHING, Spec, checked

SPECS = specs(FiveBarParameters)
NUMBERS = {name: spec for name, spec in SPECS.items() if not spec.options}


@pytest.mark.parametrize("name", SPECS)
def test_default_is_allowed_and_explained(name: str) -> None:
    spec, default = SPECS[name], value_of(FiveBarParameters(), name)
    assert checked(spec, name, default) == default
    assert spec.help and spec.label and spec.group
    assert spec.options or 0 < spec.step <= spec.high - spec.low
    if spec.on is not None:  # 0 means off
        assert default in (0, spec.on) and checked(spec, name, spec.on) == spec.on != 0


@given(st.sampled_from(sorted(NUMBERS)), st.floats(allow_nan=True, allow_infinity=True))
def test_number_is_taken_exactly_in_its_range(name: str, value: float) -> None:
    spec = NUMBERS[name]
    if spec.low <= value <= spec.high:
        taken = value_of(changed(FiveBarParameters(), name, value), name)
        assert taken == (value if abs(value) > NOTHING else 0.0)
    else:
        with pytest.raises(ValueError, match=name):
            changed(FiveBarParameters(), name, value)


@pytest.mark.parametrize("name", NUMBERS)
def test_ends_of_a_range_belong_to_it(name: str) -> None:
    spec = NUMBERS[name]
    for value, beyond in ((spec.low, -math.inf), (spec.high, math.inf)):
        assert value_of(changed(FiveBarParameters(), name, value), name) == value
        with pytest.raises(ValueError, match=f"{name}.*not between"):
            changed(FiveBarParameters(), name, math.nextafter(value, beyond))


@pytest.mark.parametrize(
    "value", [math.nan, math.inf, "nan", "1e999", "", "x", None, [1, 2], 10**400]
)
def test_an_invalid_value_is_refused_by_name(value: object) -> None:
    for name in SPECS:
        with pytest.raises(ValueError, match=name):
            changed(FiveBarParameters(), name, value)


@pytest.mark.parametrize("name", [name for name, spec in SPECS.items() if spec.options])
def test_choices_are_taken_as_text_and_come_back_as_they_are(name: str) -> None:
    for option in SPECS[name].options:
        taken = value_of(changed(FiveBarParameters(), name, str(option)), name)
        assert taken == option and type(taken) is type(option)


@given(st.sampled_from(SPECS["control_rate"].options) | st.integers(-3000, 3000))
def test_a_choice_of_numbers_takes_them_with_a_point_and_none_between(value: int) -> None:
    name = "control_rate"
    if value in SPECS[name].options:
        taken = value_of(changed(FiveBarParameters(), name, float(value)), name)
        assert taken == value and type(taken) is int
    else:
        with pytest.raises(ValueError, match=name):
            changed(FiveBarParameters(), name, float(value))
    for between in (value + 0.5, math.nextafter(value, math.inf)):
        with pytest.raises(ValueError, match=name):
            changed(FiveBarParameters(), name, between)


def test_one_value_changes_and_the_old_record_stays() -> None:
    before = FiveBarParameters()
    after = changed(before, "K1", "100")
    assert (before.K1, after.K1) == (400.0, 100.0)
    assert dataclasses.replace(after, K1=400.0) == before


@pytest.mark.parametrize(
    ("wrong", "meant"),
    [("k1", "K1"), ("K6", "K5"), ("sped", "speed"), ("torquelimit", "torque_limit")],
)
def test_unknown_name_is_answered_with_the_nearest(wrong: str, meant: str) -> None:
    with pytest.raises(ValueError, match=f"{wrong}.*did you mean.*{meant}"):
        changed(FiveBarParameters(), wrong, 1.0)


def test_a_name_like_no_other_is_answered_with_all() -> None:
    with pytest.raises(ValueError, match=r"there are.*K1.*payload"):
        changed(FiveBarParameters(), "§§§§§§", 1.0)


def test_message_says_the_range_with_its_unit() -> None:
    spec = Spec("gains", "K", "1/s", 0.0, 5.0, 1.0, (), "help")
    with pytest.raises(ValueError, match="K: 6 is not between 0 and 5 1/s"):
        checked(spec, "K", 6)
