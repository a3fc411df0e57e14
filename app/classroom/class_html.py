"""Pieces of the teacher's page as HTML, from the templates in assets/templates/class."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import Distribution, tasks_passed
from onpath.app.common.palette import AMBER, GREEN, GREY, OF_BENCH, SLATE
from onpath.app.common.templates import render
from onpath.lessons.action_schema import RobotName
from onpath.lessons.benches import ROLES, robot_names
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import MOST_POINTS as MOST_OF_TRUTH
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Choice, Prediction, Quiz, Sketch
from onpath.lessons.thinning import peaks
from onpath.lessons.words import Words
from onpath.models.control.benches import DEFAULT_LAWS

IDLE = 60.0  # [s] without a command after which a student counts as idle
WIDTH, HEIGHT, LEFT, BELOW = 640, 380, 50, 36  # size of a plot, [px]
FLOOR = HEIGHT - BELOW - 10  # y of its lowest value, [px]
MOST_POINTS = 40  # of a sketch on it


def class_code(code: str, count: int, words: Words) -> str:
    """The class code in large type for the projector."""
    return render("class/code.html", code=code, count=count, words=words)


@dataclass(frozen=True, slots=True)
class MemberLine:
    """A student's line in the table."""

    name: str
    lesson: str
    step: str
    tasks: str
    colour: str
    state: str


def table(members: Iterable[Member], course: Course, now: float, words: Words) -> str:
    """Table of the members and their progress.

    Args:
        now: time by the class's clock, [s].
    """
    rows = [_row(member, course, now, words) for member in members]
    return render("class/table.html", rows=rows, words=words)


def _row(member: Member, course: Course, now: float, words: Words) -> MemberLine:
    colour, state = GREEN.hex, words("class.here")
    if not member.connected:
        colour, state = GREY.hex, words("class.away")
    elif now - member.active > IDLE:
        minutes = int((now - member.active) / 60)
        colour, state = AMBER.hex, words("class.idle", minutes=minutes)
    return MemberLine(member.name, *_place(member.progress, course, words), colour, state)


def _place(way: Progress, course: Course, words: Words) -> tuple[str, str, str]:
    """A student's lesson, step and tasks."""
    if not course.has(way.lesson):
        return words("class.free"), "", ""
    lesson = course.lesson(way.lesson, words.language)
    index = min(way.notes[way.lesson].step if way.lesson in way.notes else 0, len(lesson.steps) - 1)
    done, wanted = tasks_passed(way, lesson)
    if way.lesson in course.tests:
        return titles_of_tests(course, words)[way.lesson], "", ""
    number = course.numbers()[way.lesson]
    return (
        f"{number}. {lesson.front.title}",
        f"{index + 1}/{len(lesson.steps)} {lesson.steps[index].title}",
        f"{done}/{wanted}",
    )


def prediction_view(
    block: Prediction,
    found: Distribution,
    truth: Truth | None,
    revealed: bool,
    words: Words,
    large: bool = False,
    laws: Mapping[str, str] = DEFAULT_LAWS,
    second: Distribution | None = None,
) -> str:
    """The answers of the class without names, and the truth once revealed.

    Args:
        large: whether to use large type for a projector.
        laws: control laws under which the prediction is put to the test.
        second: the answers after a discussion, beside the others; None if it was asked once.
    """
    rounds = [("", found)]
    if second is not None:
        rounds = [(words("class.first"), found), (words("class.second"), second)]
    if isinstance(block, Choice):
        return choices_view(block, rounds, revealed, words, large)
    robots, seen = robot_names(laws, words), truth if revealed else None
    drawn = [_sketches(block, each, seen, words, robots) for _, each in rounds]
    told = [(title, given_line(each, words)) for title, each in rounds]
    return render(
        "class/sketches.html",
        block=block,
        title=f"{words(f'quantity.{block.quantity}')} [{QUANTITIES[block.quantity]}]",
        width=WIDTH,
        height=HEIGHT,
        left=LEFT,
        floor=FLOOR,
        marks=_marks(block),
        plots=[(title, lines, said) for (title, said), (lines, _) in zip(told, drawn, strict=True)],
        names=drawn[0][1],
        facts=told[0][1] if len(told) == 1 else "",
        large=large,
    )


def choices_view(
    block: Choice | Quiz,
    rounds: Sequence[tuple[str, Distribution]],
    revealed: bool,
    words: Words,
    large: bool = False,
) -> str:
    """The options with how many have chosen them, without names; several rounds side by side.

    Args:
        rounds: title and answers of each round in which the question was asked.
    """
    said = [(title, found.counts, given_line(found, words)) for title, found in rounds]
    return render(
        "class/choices.html",
        block=block,
        options=list(zip(LETTERS, block.options, strict=False)),
        rounds=said,
        most=max(1, *(count for _, found in rounds for count in found.counts)),
        revealed=revealed,
        facts=said[0][2] if len(said) == 1 else "",
        large=large,
    )


def hidden_view(block: Prediction, found: Distribution, words: Words, large: bool = False) -> str:
    """The question, and how many have answered it."""
    facts = given_line(found, words)
    return render("class/prediction.html", block=block, facts=facts, large=large)


def given_line(found: Distribution, words: Words) -> str:
    """How many have answered, skipped, and not answered yet, and how many answers are lost."""
    given = sum(found.counts) + len(found.sketches)
    said = words("class.given", given=given, skipped=found.skipped, waiting=found.waiting)
    return f"{said} {words('class.unknown', count=found.unknown)}" if found.unknown else said


@dataclass(frozen=True, slots=True)
class PlottedLine:
    """A curve on the plot.

    Attributes:
        points: the `points` attribute of an SVG polyline, [px].
        width: [px].
    """

    points: str
    colour: str
    width: int
    opacity: float


@dataclass(frozen=True, slots=True)
class AxisMark:
    """Labels of a time at x and a value at y, [px], beside the axes."""

    x: int
    y: int
    time: str
    value: str


def _sketches(
    block: Sketch,
    found: Distribution,
    truth: Truth | None,
    words: Words,
    robots: Mapping[RobotName, str],
) -> tuple[list[PlottedLine], list[tuple[str, str]]]:
    """All curves with a colour legend."""
    lines = [
        PlottedLine(_points(block, sketch.times, sketch.values, MOST_POINTS), SLATE.hex, 2, 0.5)
        for sketch in found.sketches
    ]
    names = [(SLATE.hex, words("class.predicted"))]
    if truth is not None:
        for bench, role in ROLES.items():
            points, colour = getattr(truth, role), OF_BENCH[bench].hex
            line = _points(block, truth.times, points, MOST_OF_TRUTH)
            lines.append(PlottedLine(line, colour, 4, 1.0))
            names.append((colour, robots[role]))
    return lines, names


def _marks(block: Sketch) -> list[AxisMark]:
    marks: list[AxisMark] = []
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        time, value = part * block.seconds, block.bottom + part * (block.top - block.bottom)
        x, y = _at(block, time, value)
        marks.append(AxisMark(round(x), round(y), f"{time:g}", f"{value:g}"))
    return marks


@lru_cache(maxsize=1024)  # the same curves are redrawn every second
def _points(block: Sketch, times: tuple[float, ...], values: tuple[float, ...], most: int) -> str:
    kept = peaks([np.array(values)], most)
    places = [_at(block, times[i], values[i]) for i in kept]
    return " ".join(f"{x:.0f},{y:.0f}" for x, y in places)


def _at(block: Sketch, time: float, value: float) -> tuple[float, float]:
    """Position on the plot, [px]; points outside the axes are clamped to their edge."""
    across = min(max(time / block.seconds, 0.0), 1.0)
    up = min(max((value - block.bottom) / (block.top - block.bottom), 0.0), 1.0)
    return LEFT + across * (WIDTH - LEFT - 20), 10 + (1.0 - up) * (HEIGHT - BELOW - 20)
