"""Numbers that rest on a guess are marked, and no others."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.exports.figures import PANELS
from onpath.app.exports.summary_text import ROWS as SUMMARY
from onpath.models.closed_loop.trajectory import header, without_mark
from onpath.models.control.settable import specs
from onpath.models.robot_files.guesses import Guess
from onpath.models.studies.comparison import MEASURES
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.guessed_numbers import (
    RESTS_ON,
    SETTINGS,
    TOLD,
    guess_mark,
    guessed_kinds,
    quantities_of,
    setting_with_mark,
    told_guesses,
    with_mark,
)
from tests.support.guessed_robot import KINDS, guess, guessed_robot

guesses = st.lists(st.sampled_from(KINDS)).map(lambda kinds: tuple(map(guess, kinds)))


@given(guesses, st.sampled_from(sorted(TOLD)), st.sampled_from(["en", "de"]))
def test_a_number_is_marked_exactly_if_it_rests_on_a_guess(
    some: tuple[Guess, ...], name: str, language: str
) -> None:
    decisive = {kind for each in quantities_of(name) for kind in RESTS_ON[each]}
    found = guessed_kinds(some, quantities_of(name))
    assert set(found) == decisive & {each.kind for each in some} and len(set(found)) == len(found)
    marked = with_mark("12.3 N m", some, name, language)
    assert (marked == "12.3 N m") == (not found)
    mark = guess_mark(some, quantities_of(name))
    assert (mark is None) == (not found)
    if mark is not None:
        assert marked == f"12.3 N m ({mark.text(language)})"


def test_every_number_of_a_summary_comparison_or_picture_tells_something() -> None:
    """None is left out under a name that nobody knows."""
    names = {*MEASURES, *(name for name, *_ in SUMMARY), *PANELS.values()}
    assert {name for name in names if not quantities_of(name)} == {"stopped_at_s"}


def test_a_setting_is_marked_by_its_own_name_and_not_by_that_of_a_number() -> None:
    known = {name for each in ROBOTS.values() for name in specs(each.parameters())}
    assert {*SETTINGS} - known == {"start_along", "start_across"}
    some = tuple(map(guess, KINDS))
    marked = {name for name in known if setting_with_mark(name, some, name) != name}
    assert marked == {*SETTINGS} & known
    assert quantities_of("speed") and quantities_of("delay_s")
    assert not {"speed", "delay"} & marked


@given(guesses)
def test_each_guess_is_told_with_the_line_that_settles_it(some: tuple[Guess, ...]) -> None:
    for language in ("en", "de"):
        for each, text in zip(some, told_guesses(some, language), strict=True):
            assert each.message.text(language) in text and each.line in text


@settings(deadline=None)
@given(
    st.sampled_from(sorted(ROBOTS)),
    st.booleans(),
    st.booleans(),
    st.booleans(),
    guesses,
)
def test_columns_keep_their_names_beside_their_marks(
    robot: str, level_set: bool, sides: bool, measured: bool, some: tuple[Guess, ...]
) -> None:
    made = ROBOTS[robot].make(ROBOTS[robot].parameters())
    plain = header(made, level_set, sides, measured)
    marked = header(made, level_set, sides, measured, some)
    assert [without_mark(name) for name in marked] == plain
    kinds = {each.kind for each in some}
    for name, shown in zip(plain, marked, strict=True):
        if name.startswith("tau"):
            assert (shown != name) == bool(kinds & {"mass", "inertia"})
        if name in ("t_s", "law", "held", *made.system.coordinate_names):
            assert shown == name
        if name in ("y1_m", "theta_rad", "xi1_rate_m_s", "xi1_m2", "distance_m"):
            assert (shown != name) == ("tip" in kinds)
        assert not set(shown) & set(",;\t\"'=@")


@pytest.mark.parametrize("kinds", [(), KINDS])
def test_a_robot_says_what_is_guessed(kinds: tuple[str, ...]) -> None:
    entry = guessed_robot(kinds)
    assert [each.kind for each in entry.guesses] == list(kinds)
    for shown in (repr(entry), entry._repr_html_()):
        for each in entry.guesses:
            assert str(each.message)[1:] in shown and each.line in shown
