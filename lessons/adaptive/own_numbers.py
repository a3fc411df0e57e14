"""The student's own numbers in a text: `{{your sketch max or 47}}`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import itemgetter

from markupsafe import Markup

from onpath.lessons.progress import Notes
from onpath.lessons.safe_html import safe
from onpath.lessons.schema import Block, Choice, NumberQuestion, Sketch, Step, Text
from onpath.lessons.task_schema import Task
from onpath.lessons.words import Words

OWN = re.compile(r"\{\{\s*your\s+([^{}]*?)\s*\}\}")
SKETCH: dict[str, Callable[[Sequence[float]], float]] = {
    "max": max,
    "min": min,
    "final": itemgetter(-1),
}
KINDS = (*(f"sketch {stat}" for stat in SKETCH), "number", "choice", "best")
WANTED = {
    "sketch": "no prediction by a sketch",
    "number": "no question with a number",
    "choice": "no prediction by choice",
    "best": "no task with `best = …`",
}
"""Kind -> what is missing if nothing asks for it, for messages."""
SINGLE = re.compile(r"\{\s*(your\s|[−+-]?\d+([.,]\d+)?\s*(±[^{}=]*)?=)[^{}]*\}")
NOTHING = "–"


def own_faults(text: str) -> Iterator[str]:
    """Faults in the placeholders of the student's numbers, and all other double braces."""
    for match in OWN.finditer(text):
        if _parts(match[1])[0] not in KINDS:
            yield f"{match[0]}: it is {{{{your …}}}} with one of {', '.join(KINDS)}, and `or …`"
    if "{{" in OWN.sub("", text):
        yield "{{ is not understood: a number is {{47 = max distance tracker}} or {{your number}}"
    elif single := SINGLE.search(OWN.sub("", text)):
        yield f"{single[0]}: a number stands between two braces, {{{{…}}}}"
    elif "{{{" in text or "}}}" in text:
        yield "three braces: a number stands between two, {{…}}"


def unanswered(steps: Sequence[Step]) -> Iterator[tuple[int, str, str]]:
    """Placeholders of answers that no question asks for: line of the step, first words, fault."""
    asked = set[str]()
    for step in steps:
        for block in step.blocks:
            asked |= set(_answered(block))
        for block in step.blocks:
            for place in OWN.finditer(block.html if isinstance(block, Text) else ""):
                kind = _parts(place[1])[0]
                if kind in KINDS and kind not in asked:
                    words = f"{{{{your {kind}"
                    yield step.line, words, f"{words}}}}}: {WANTED[kind.split()[0]]} is above it"


def _answered(block: Block) -> Iterable[str]:
    """The kinds of own numbers that a block asks for."""
    if isinstance(block, Sketch):
        return KINDS[: len(SKETCH)]
    if isinstance(block, Task):
        return ("best",) if block.best else ()
    kinds: dict[type[Block], str] = {NumberQuestion: "number", Choice: "choice"}
    return [kinds[type(block)]] if type(block) in kinds else ()


def filled(html: Markup, steps: Sequence[Step], index: int, notes: Notes, words: Words) -> Markup:
    """A text of a step with the student's numbers, or with their substitutes after `or`.

    Args:
        notes: the student's answers in this lesson.
    """
    if "{{" not in html:
        return html

    def replacement(match: re.Match[str]) -> str:
        kind, other = _parts(match[1])
        return _value(kind, steps, index, notes, words) or other

    return safe(OWN.sub(replacement, str(html)))


def marked(html: Markup, steps: Sequence[Step], index: int) -> Markup:
    """A text in which the numbers of a sketched curve are elements for JavaScript to fill.

    Their attributes are `data-own`, the statistic, and `data-step`, the index of the sketch's step.
    """
    sketched = [
        i for i, step in enumerate(steps) if any(isinstance(b, Sketch) for b in step.blocks)
    ]
    before = [i for i in sketched if i <= index]

    def replacement(match: re.Match[str]) -> str:
        kind, other = _parts(match[1])
        if not kind.startswith("sketch") or not before:
            return match[0]
        stat = kind.removeprefix("sketch ")
        return f'<span data-own="{stat}" data-step="{before[-1]}">{other}</span>'

    return safe(OWN.sub(replacement, str(html)))


def _parts(place: str) -> tuple[str, str]:
    """The kind of number, and its substitute, which is part of a safe text."""
    kind, _, other = place.partition(" or ")
    return " ".join(kind.split()), other.strip() or NOTHING


def _value(kind: str, steps: Sequence[Step], index: int, notes: Notes, words: Words) -> str:
    """The latest answer of a kind up to a step, as HTML; empty if there is none."""
    for at in range(index, -1, -1):
        for block_index, block in enumerate(steps[at].blocks):
            answer = (notes.second if str(at) in notes.asked_again else notes.answers).get(str(at))
            if isinstance(block, NumberQuestion) and kind == "number":
                given = notes.numbers.get(f"{at}.{block_index}")
                return "" if given is None else words.number(given)
            if isinstance(block, Sketch) and kind.startswith("sketch"):
                values = () if answer is None else answer.values
                return words.number(SKETCH[kind[7:]](values), 3) if values else ""
            if isinstance(block, Choice) and kind == "choice":
                chosen = None if answer is None or str(at) in notes.unknown else answer.option
                known = chosen is not None and chosen in range(len(block.options))
                return str(block.options[chosen or 0].text) if known else ""
        for task in steps[at].tasks():
            if task.best and kind == "best":
                best = notes.tasks.get(task.id)
                return "" if best is None else words.number(best, 3)
    return ""
