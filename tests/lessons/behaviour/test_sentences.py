"""Sentences about the lab are found in prose, and those that say nothing of it are not."""

from __future__ import annotations

import re

import pytest

from onpath.lessons.behaviour.sentences import (
    Sentence,
    found_sentences,
    list_faults,
    named_controls,
    read_sentences,
)
from onpath.lessons.course import BUILT_IN
from tests.support.checkout import ROOT


@pytest.mark.parametrize(
    ("language", "sentence"),
    [
        ("en", "For this reason the lab refuses a path with a sharp bend."),
        ("en", "The follower is stopped after a second."),
        ("en", "The page shows the curve."),
        ("en", "Paths that cross are allowed."),
        ("en", "A button hides the map."),
        ("en", "Held back, the tracker is torn off its path."),
        ("en", "Meanwhile the follower waits."),
        ("en", "Both arms come back."),
        ("en", "In the way of a wall jumps the arm."),
        ("de", "Festgehalten wird der Nachläufer von der Bahn gerissen."),
        ("de", "Der Bahnfolger wartet."),
        ("de", "Danach kommt der Arm zur Ruhe."),
        ("de", "Deshalb lehnt das Labor eine solche Bahn ab."),
        ("de", "Nach einer Sekunde hält das Labor ihn an."),
        ("de", "Der Verlauf zeigt ξ₁."),
        ("de", "Eine Bahn, die sich kreuzt, wird abgelehnt."),
    ],
)
def test_a_sentence_on_the_lab_is_found_wherever_it_stands(language: str, sentence: str) -> None:
    verb = sentence.split()[-1].rstrip(".")
    question = f'```quiz\nquestion = "Which?"\nanswer = "{sentence}"\n```'
    for text in (
        sentence,
        f"First.\n\n{sentence}\nThen.",
        f"```fold Why\n{sentence}\n```",
        f'```task\nhints = [\n  "{sentence}",\n]\n```',
        question,
    ):
        found = list(found_sentences(text, language))
        line = next(n for n, each in enumerate(text.split("\n"), 1) if sentence in each)
        assert [(n, sentence.rstrip(".") in each) for n, each in found] == [(line, True)]
    assert not list(
        found_sentences(sentence.replace(verb, f"{{{{{verb} = plot across}}}}"), language)
    )


@pytest.mark.parametrize(
    "text",
    [
        "What does the lab say?",
        "**When does the lab stop the arm, and what is said?**",
        "The sun shows itself.",
        "**Does the follower wait, or what shows the page?**,",
        "While the robots are pulled, watch the button.",
        '```quiz\n  { text = "The lab stops it", answer = "No." },\n```',
        "```scene\n# the lab stops it\n```",
        'goals = "say what the lab does."',
    ],
)
def test_questions_and_wrong_options_say_nothing(text: str) -> None:
    assert not list(found_sentences(text, "en"))


def test_a_right_option_says_what_is_so() -> None:
    option = '{ text = "The lab stops it", right = true, answer = "Yes." },'
    assert len(list(found_sentences(f"```quiz\n{option}\n```", "en"))) == 1


def test_the_text_of_a_law_need_not_name_it() -> None:
    text = "Held back, it waits on the curve."
    assert list(found_sentences(text, "en", of_law=True)) == [(1, text)]
    assert not list(found_sentences(text, "en"))


def test_a_sentence_is_played_or_listed_and_an_entry_occurs() -> None:
    text = "The lab stops it. {{The page shows it = plot across}}."
    stops = Sentence(where="a", en="The lab stops it", reason="somebody's words")
    gone = Sentence(where="a", en="The lab shows it", reason="a definition")
    played = Sentence(where="a", en="The page", plays="plot across")
    assert not list(list_faults([stops, played], "a", "en", text))
    ((line, fault),) = list_faults([], "a", "en", text)
    assert line == 1 and "nobody plays 'The lab stops it.'" in fault
    ((_, fault),) = list_faults([stops, gone], "a", "en", text)
    assert "'The lab shows it' of a, which says so no longer" in fault


def test_names_of_controls_are_found() -> None:
    text = "Press **Reset**, then set\n**Speed** to 2, and **see**."
    assert list(named_controls(text, "en")) == [(1, "Reset"), (2, "Speed")]
    assert list(named_controls("Drücke **Pause**.", "de")) == [(1, "Pause")]


def test_tests_that_the_list_names_exist() -> None:
    listed, problems = read_sentences(BUILT_IN)
    assert listed and not problems
    named = {path for each in listed for path in re.findall(r"tests/[\w/.]+\w", each.reason)}
    assert named and not [path for path in named if not (ROOT / path).exists()]
