"""Who has changed an answer by a discussion is counted by the groups before and after it."""

from __future__ import annotations

import re

from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.classroom.class_html import moves_view
from onpath.app.classroom.results import moves
from onpath.lessons.given import Answer
from onpath.lessons.progress import Progress
from onpath.lessons.schema import Choice, Option, Sketch, SketchShape
from onpath.lessons.words import ENGLISH
from tests.support.given import notes_with

CHOICE = Choice("?", tuple(Option(text, text) for text in ("a", "b", "c")))
SHAPES = (SketchShape("nothing", highest=(0.0, 1.0)), SketchShape("a lot", highest=(8.0, 10.0)))
SKETCH = Sketch("?", "distance", 1.0, 10.0, shapes=SHAPES)
HEIGHTS = (0.0, 9.0, 5.0)  # of each shape, and of none
OPEN, SKIPPED = 3, 4
pairs = st.lists(st.tuples(st.integers(0, SKIPPED), st.integers(0, SKIPPED)), max_size=12)


def answer(group: int, curve: bool) -> Answer:
    if group == SKIPPED:
        return Answer()
    if curve:
        return Answer(times=(0.0, 1.0), values=(0.0, HEIGHTS[group]))
    return Answer(option=group)


@given(pairs, st.booleans())
@settings(max_examples=40)
def test_all_who_answered_twice_are_in_the_table(both: list[tuple[int, int]], curve: bool) -> None:
    students = list[Progress]()
    for before, after in both:
        first = {} if before == OPEN else {"1": answer(before, curve)}
        second = {} if after == OPEN else {"1": answer(after, curve)}
        notes = notes_with(answers=first, second=second)
        students.append(Progress(notes={"a": notes}))
    block = SKETCH if curve else CHOICE
    found = moves(block, "a", "1", students, (None, None))
    twice = [pair for pair in both if max(pair) < OPEN]
    assert found == {pair: twice.count(pair) for pair in twice}
    cells = re.findall(r"<td style[^>]*>(\d*)</td>", moves_view(block, found, ENGLISH))
    assert sorted(int(each) for each in cells if each) == sorted(found.values())
