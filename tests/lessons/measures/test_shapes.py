"""The shapes by which the curves of a class are grouped."""

from __future__ import annotations

from functools import cache

from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.given import Answer
from onpath.lessons.measures.shapes import peaks_of, shape_of
from onpath.lessons.schema import Sketch
from tests.support.built_in import built_in_course

values = st.lists(st.integers(0, 6).map(float), max_size=12)


def most_turns(curve: list[float], height: float) -> int:
    """By trying all: the most peaks with a valley before and after each, `height` below it."""

    @cache
    def climbs(at: int, low: float) -> int:
        """The most peaks after a valley `low` that has been chosen, from index `at` on."""
        tops = (i for i in range(at, len(curve)) if curve[i] >= low + height)
        return max((falls(i + 1, curve[i]) for i in tops), default=0)

    @cache
    def falls(at: int, high: float) -> int:
        valleys = (i for i in range(at, len(curve)) if curve[i] <= high - height)
        return max((1 + climbs(i + 1, curve[i]) for i in valleys), default=0)

    return max((climbs(i + 1, low) for i, low in enumerate(curve)), default=0)


@given(values, st.integers(1, 5).map(float))
def test_peaks_are_as_many_as_there_are_climbs_and_falls(curve: list[float], height: float) -> None:
    assert peaks_of(curve, height) == most_turns(curve, height)


def test_the_curves_that_students_draw_in_lesson_1_have_their_shapes() -> None:
    course, _ = built_in_course()
    for language in course.languages():
        steps = course.lesson("01-path-or-timetable", language).steps
        (block,) = [b for step in steps for b in step.blocks if isinstance(b, Sketch)]
        nothing, arches, plateau, bump = block.shapes
        drawn = {
            nothing: (0, 0, 2, 2, 0, 0, 0),
            arches: (0, 0, 40, 5, 40, 0, 0),
            plateau: (0, 0, 40, 40, 40, 0, 0),
            bump: (0, 0, 50, 8, 2, 0, 0),
            None: (50, 50, 50, 8, 2, 0, 0),
        }
        times = (0.0, 3.0, 3.7, 4.3, 4.9, 5.0, 8.0)
        for shape, heights in drawn.items():
            answer = Answer(times=times, values=tuple(map(float, heights)))
            assert shape_of(block, answer) == shape
