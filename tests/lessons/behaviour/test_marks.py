"""Marks of behaviour are read from a text, and leave plain words."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.behaviour.marks import read_behaviour, take_behaviours

WORDS = st.text(
    st.characters(exclude_characters="{}=", exclude_categories=("Cs", "Cc")), min_size=1
)
PLAYS = st.sampled_from(
    [
        *("refuses fault.bends after sharp", "says fault.crosses", "no says fault.crosses"),
        *("stops tracker", "stops follower stop.fast after late", "runs follower after pull"),
        *("follows figure of eight after crossing", "plot across", "no drawing rank"),
        *("control hold", "label stop.unstable", "max distance follower during held < 5"),
    ]
)


def no_complaint(line: int, text: str) -> None:
    raise AssertionError(f"{line}: {text}")


@given(st.lists(st.tuples(WORDS, WORDS, PLAYS), max_size=4))
def test_a_text_keeps_its_words_and_lines_and_loses_its_marks(
    parts: list[tuple[str, str, str]],
) -> None:
    marked = "\n".join(f"{before} {{{{{words} = {play}}}}}" for before, words, play in parts)
    plain, found = take_behaviours(marked, no_complaint)
    assert plain == "\n".join(f"{before} {words.strip()}" for before, words, _ in parts)
    assert [each.line for each in found] == list(range(1, len(parts) + 1))
    assert [each.text for each in found] == [words.strip() for _, words, _ in parts]


def test_a_mark_over_two_lines_keeps_the_numbers_of_the_lines_below() -> None:
    plain, (said,) = take_behaviours("It {{does\nstop = stops\ntracker}}\nor so", no_complaint)
    assert plain.split("\n")[-1] == "or so" and plain.count("\n") == 3
    assert (said.verb, said.name) == ("stops", "tracker")


@pytest.mark.parametrize(
    ("play", "says"),
    [
        ("", "is not understood"),
        ("refuse fault.bends", "did you mean refuses?"),
        ("stops", "follower or tracker"),
        ("control hodl", "did you mean hold?"),
        ("plot across after pull", "from the beginning"),
        ("no stops tracker", "is not understood"),
        ("max distance follower", "is not understood"),
        ("max distance folower < 5", "did you mean follower?"),
    ],
)
def test_a_mark_that_is_not_understood_says_what_is_expected(play: str, says: str) -> None:
    with pytest.raises(ValueError) as caught:
        read_behaviour(1, "words", play)
    assert says in str(caught.value)
