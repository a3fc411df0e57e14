"""A code survives what mail programs, word processors, chats and phones do to it."""

from __future__ import annotations

import random
import textwrap

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.classroom.admission import CODE_LENGTH, Admission, class_code_of
from onpath.app.common.access_codes import ALPHABET, as_meant, new_code, normalised, shown
from onpath.app.common.throttle import TRIES
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.share_code import decode, encode
from tests.support.some_setups import CALM, setups

DASHES = "-\u2010\u2011\u2012\u2013\u2014\u2015\u2212\ufe58\ufe63\uff0d\u30fc"
INVISIBLE = "\u00ad\u200b\u200c\u200d\u200e\u200f\u2060\ufeff\u202a\u202c"
AROUND = [
    *(("", ""), ("“", "”"), ("„", "“"), ("«", "»"), ("'", "'"), ("(", ")"), ("[", "]"), ("<", ">")),
    *(("> ", "\n"), ("Use: ", "."), ("Dear all,\n", "\nBest, Eve"), ("*", "*"), ("`", "`")),
]


def wide(text: str) -> str:
    """Full-width letters and digits, as East Asian keyboards type them."""
    return "".join(chr(ord(c) + 0xFEE0) if "!" <= c <= "~" else c for c in text)


@st.composite
def manglers(draw: st.DrawFn, wraps: bool) -> object:
    """What a program does to a text that passes through it.

    Args:
        wraps: whether it also breaks lines, and quotes them.
    """
    dash, (before, after) = draw(st.sampled_from(DASHES)), draw(st.sampled_from(AROUND))
    case = draw(st.sampled_from([str.upper, str.lower, str.capitalize, str, wide]))
    seed, invisible = draw(st.integers(0, 999)), draw(st.sampled_from(["", *INVISIBLE]))
    width = draw(st.integers(9, 72)) if wraps and draw(st.booleans()) else 0

    def mangle(code: str) -> str:
        text = case(code).replace("-", dash)
        chance = random.Random(seed)
        text = "".join(c + invisible * (chance.random() < 0.3) for c in text)
        if width:
            text = "\n> ".join(textwrap.wrap(text, width, break_on_hyphens=False))
        return before + text + after

    return mangle


@given(manglers(wraps=False))
def test_the_code_of_a_lab_is_read_as_it_was_sent(mangle: object) -> None:
    code = new_code()
    assert normalised(mangle(shown(code))) == code  # type: ignore[operator]


@CALM
@given(setups(), manglers(wraps=True))
def test_a_share_code_is_read_as_it_was_sent(setup: Setup, mangle: object) -> None:
    assert decode(mangle(encode(setup))) == setup  # type: ignore[operator]


@pytest.mark.thorough
@given(manglers(wraps=False))
def test_a_class_code_is_read_as_it_was_sent_and_is_no_wrong_guess(mangle: object) -> None:
    door, code = Admission(lambda: 0.0), class_code_of(new_code())
    for _ in range(2 * TRIES):
        assert door.check_code(mangle(code), [code], "tab") == code  # type: ignore[operator]


@pytest.mark.parametrize(
    "typed", ["M63 EYZ", "m63-eyz", "https://lab.example.org/c/m63eyz/", "Thanks, M63EYZ is it"]
)
def test_a_class_code_in_a_sentence_or_an_address(typed: str) -> None:
    assert Admission().check_code(typed, ["m63eyz"], "tab") == "m63eyz"


def test_several_words_are_one_guess_at_most() -> None:
    """Who pastes all codes that there are gains nothing by that."""
    codes = ["".join(random.choices(ALPHABET, k=CODE_LENGTH)) for _ in range(100)]
    with pytest.raises(ValueError, match="class code"):
        Admission().check_code(" ".join(codes), codes, "tab")
    with pytest.raises(ValueError, match="12"):
        normalised(" ".join(shown(new_code()) for _ in range(3)))


@given(st.text(max_size=200))
def test_any_text_is_a_code_or_refused(text: str) -> None:
    try:
        code = normalised(text)
    except ValueError:
        return
    assert normalised(shown(code)) == code


def test_a_letter_under_many_marks_costs_no_more_than_its_length() -> None:
    """Normalisation sorts marks: 10 s for so many, in which no other thread runs."""
    marks = "\u0301\u0327" * 25_000
    assert len(as_meant(f"a{marks}b{marks}")) < 10
