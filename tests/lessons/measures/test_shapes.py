"""The shapes by which the curves of a class are grouped."""

from __future__ import annotations

from functools import cache
from typing import Any

import msgspec
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.given import Answer
from onpath.lessons.measures.shapes import has, peaks_of, shape_of
from onpath.lessons.schema import Sketch, SketchShape
from tests.support.built_in import built_in_course
from tests.support.node_page import NodePage, needs_node

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


@needs_node
def test_the_page_sees_in_a_curve_what_python_sees() -> None:
    rng, page, seen = np.random.default_rng(3), NodePage(), list[bool]()
    sketch = Sketch(question="?", quantity="distance", seconds=8.0, bottom=-6.0, top=6.0)
    script = "([axes, feature, curve]) => hasFeature(axes, feature, curve)"
    for _ in range(300):
        count = int(rng.integers(2, 9))
        times = np.sort(rng.choice(np.arange(17), count, replace=False)) / 2
        curve = {
            "times": times.tolist(),
            "values": rng.integers(-6, 7, count).astype(float).tolist(),
        }
        low, high = sorted(rng.integers(-7, 8, 2).astype(float).tolist())
        start, end = sorted((rng.integers(0, 17, 2) / 2).tolist())
        kinds: list[dict[str, Any]] = [
            {"peaks": (int(rng.integers(2)), int(rng.integers(1, 4)))},
            {"highest": (low, high)},
            {"lowest": (low, high)},
            {"at": ((start, low, high),)},
            {"level": ((start, end, low, high),)},
            {"lowest": (low, high), "at": ((end, low, high),)},
        ]
        feature = SketchShape("it", **kinds[int(rng.integers(len(kinds)))])
        seen.append(has(sketch, feature, curve["times"], curve["values"]))
        given_to_it = [{"top": 6.0, "bottom": -6.0}, msgspec.to_builtins(feature), curve]
        assert page.evaluate(script, given_to_it) == seen[-1], (feature, curve)
    page.close()
    assert 60 < sum(seen) < 240


def test_the_run_of_lesson_5_has_the_features_that_a_stop_at_the_path_lacks() -> None:
    lesson = built_in_course()[0].lesson("05-invariance", "en")
    (index,) = [i for i, step in enumerate(lesson.steps) if sketches_in(step.blocks)]
    (sketch,) = sketches_in(lesson.steps[index].blocks)
    truth = computed_truth(lesson, index)
    assert truth is not None
    usual = (0.0, 0.4, 1.0, 1.05, 2.0), (0.0, 21.0, 21.0, 0.0, 0.0)
    told = [
        (has(sketch, f, truth.times, truth.follower), has(sketch, f, *usual))
        for f in sketch.features
    ]
    assert told == [(True, False), (True, True)]


def sketches_in(blocks: Any) -> list[Sketch]:
    """The sketches among some blocks."""
    return [block for block in blocks if isinstance(block, Sketch)]
