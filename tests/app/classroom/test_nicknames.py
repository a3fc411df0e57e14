"""Every nickname can be seen and told apart, in any script."""

from __future__ import annotations

import unicodedata
from itertools import groupby

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.app.classroom.admission import LONGEST_NAME, cleaned, not_among
from onpath.app.common.visible_text import (
    JOINERS,
    MOST_MARKS,
    SELECTOR,
    clusters,
    comparison_key,
    is_visible,
    readable,
)

INVISIBLE = (
    "\u3164\u2800\u115f\u1160\uffa0\u034f\u17b4\u17b5\u180b\ufe0f\u200b\u00ad\u2060\U000e0100"
)
names = st.text(
    st.characters(categories=["L", "N", "P", "S", "Z", "C"]) | st.sampled_from(INVISIBLE)
)
marked = st.text(st.characters(categories=["M"]) | st.sampled_from("ae \u1100\u3164"))


def is_mark(character: str) -> bool:
    return unicodedata.category(character)[0] == "M"


@pytest.mark.parametrize("character", INVISIBLE)
def test_what_cannot_be_seen_is_no_nickname(character: str) -> None:
    for name in (character, character * 30, f" {character} {character}"):
        with pytest.raises(ValueError, match="nickname"):
            cleaned(name)
    assert cleaned(f"A{character}\u0308da").replace(" ", "") in ("Äda", "Ada")


def test_marks_that_stand_alone_are_no_nickname() -> None:
    with pytest.raises(ValueError, match="nickname"):
        cleaned("\u0301\u0302 \u0303")


@given(names | marked | st.text())
@example("Z" + "\u0334" * 24 + "algo")
@example("\u3164Ada")
@example("\u1100\u034f\u1161")
@example("a\u0301\u034f\u0301\u0301\u0301")
def test_a_nickname_is_seen_and_stable(text: str) -> None:
    try:
        name = cleaned(text)
    except ValueError:
        return
    assert 0 < len(clusters(name)) <= LONGEST_NAME and cleaned(name) == name
    assert len(name) <= 4 * LONGEST_NAME and unicodedata.is_normalized("NFC", name)
    assert all(c in (" ", SELECTOR, *JOINERS) or is_visible(c) for c in name)
    assert is_visible(name[0]) and not is_mark(name[0])
    assert not any(c in JOINERS for c in comparison_key(name))
    runs = [len(list(run)) for marks, run in groupby(name, is_mark) if marks]
    assert max(runs, default=0) <= MOST_MARKS


@pytest.mark.parametrize(
    "name",
    [
        *("Zoë", "Nguyễn Thị Hậu", "दिव्या", "สุกัญญา", "مُحَمَّد", "김민준", "👩 Ada"),
        *("ශ්\u200dරී ලංකා", "ප්\u200dරියා", "علی\u200cرضا", "پوریا\u200cنژاد", "लक्ष्मी", "शर्\u200dमा"),
        *(
            "രാജന്\u200d",
            "ജോര്\u200dജ്",
            "👩🏽\u200d🔬",
            "👨\u200d👩\u200d👧",
            "❤\ufe0f",
            "1\ufe0f\u20e3",
            "🇩🇪 Ada",
        ),
    ],
)
def test_names_of_many_languages_stay_as_they_are(name: str) -> None:
    assert cleaned(name) == unicodedata.normalize("NFC", name)


@given(names | marked | st.text())
def test_a_long_name_is_cut_between_what_readers_see_as_characters(text: str) -> None:
    try:
        short = cleaned(text * 40)
    except ValueError:
        return
    whole = clusters(readable((text * 40)[:200], lambda _: " "))
    assert set(clusters(short)) <= {each for each in whole} | {" "}


@pytest.mark.parametrize("name", ["👩🏽\u200d🔬" * 30, "ශ්\u200dරී" * 30, "क्षि" * 30, "e\u0301" * 90])
def test_24_characters_that_are_seen_count_however_they_are_spelt(name: str) -> None:
    assert len(clusters(cleaned(name))) <= LONGEST_NAME
    assert clusters(cleaned(name))[-1] == clusters(cleaned(name))[0]


@pytest.mark.parametrize("joiner", [*JOINERS, SELECTOR])
def test_a_joiner_makes_no_second_name_that_looks_the_same(joiner: str) -> None:
    assert cleaned(f"A{joiner}da") == cleaned(f"Ada{joiner}") == "Ada"
    assert not_among({comparison_key("علیرضا")}, f"علی{joiner}رضا").endswith(" 2")
    with pytest.raises(ValueError, match="nickname"):
        cleaned(joiner * 5)


def test_no_control_and_no_change_of_direction_gets_through() -> None:
    for character in "\u202e\u202a\u2066\u2069\u200e\u200f\u061c\n\t\x00\x1b":
        assert character not in cleaned(f"علی{character}رضا {character}Ada")


def test_names_that_differ_in_width_alone_are_told_apart() -> None:
    assert not_among({comparison_key("Ada")}, cleaned("Ａｄａ")) == "Ａｄａ 2"
