"""The curves of a class are counted by the shapes that the lesson names."""

from __future__ import annotations

import re
from html import unescape

from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.classroom.class_html import prediction_view
from onpath.app.classroom.results import Distribution
from onpath.app.classroom.sketches_html import Picks
from onpath.lessons.given import Answer
from onpath.lessons.measures.shapes import shape_of
from onpath.lessons.schema import Sketch, SketchShape
from onpath.lessons.words import ENGLISH

BLOCK = Sketch(
    question="Draw.",
    quantity="distance",
    seconds=4.0,
    top=10.0,
    shapes=(SketchShape("nothing", highest=(0.0, 1.0)), SketchShape("two peaks", peaks=(2, 2))),
)
curves = st.lists(st.tuples(*[st.sampled_from([0.0, 5.0, 10.0])] * 5), max_size=8)


@given(curves)
@settings(max_examples=30)
def test_each_curve_is_in_one_group_of_which_one_is_an_example(
    drawn: list[tuple[float, ...]],
) -> None:
    sketches = tuple(Answer(times=(0.0, 1.0, 2.0, 3.0, 4.0), values=each) for each in drawn)
    found = Distribution(counts=(), sketches=sketches, skipped=0, waiting=0)
    numbers = tuple(range(11, 11 + len(sketches)))
    view = unescape(
        prediction_view(BLOCK, found, None, False, ENGLISH, picks=Picks((), (numbers,)))
    )
    view = re.sub("[\u2068\u2069]", "", view)
    told = re.findall(r"(\d+) drew ([a-z ]+) \(such as (\d+)\)", view)
    names = [shape.name if (shape := shape_of(BLOCK, s)) else "something else" for s in sketches]
    assert {name: int(count) for count, name, _ in told} == {n: names.count(n) for n in names}
    assert all(names[int(example) - 11] == name for _, name, example in told)
