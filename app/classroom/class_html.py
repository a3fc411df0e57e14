"""Pieces of the teacher's page as HTML. What students have typed is escaped here."""

from __future__ import annotations

import html
from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import LETTERS, Distribution, tasks_passed
from onpath.app.common.palette import AMBER, FOLLOWER, GREEN, GREY, TRACKER
from onpath.lessons.course import Course
from onpath.lessons.progress import MOST_POINTS as MOST_OF_TRUTH
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Choice, Prediction, Sketch
from onpath.lessons.thinning import peaks
from onpath.lessons.words import Words

IDLE = 60.0  # [s] without a command
INK = "#3f4a5a"
WIDTH, HEIGHT, LEFT, BELOW = 640, 380, 50, 36  # of a plot, [px]
MOST_POINTS = 40  # of a sketch on it


def class_code(code: str, count: int, words: Words) -> str:
    """Large, for the projector."""
    said = words("class.code_for_all")
    return (
        f'<div class="op-class-code" style="padding:0.6em 1em;color:{GREY}">{said}'
        f'<div style="font-size:2.6em;font-weight:700;letter-spacing:0.18em;color:#111">'
        f"{html.escape(code.upper())}</div>{words('class.count', count=count)}</div>"
    )


def table(members: Iterable[Member], course: Course, now: float, words: Words) -> str:
    """Who is where.

    Args:
        now: by the class's clock, [s].
    """
    rows = "".join(_row(member, course, now, words) for member in members)
    heads = (
        *(words("class.name"), words("class.lesson"), words("class.step_head")),
        *(words("class.tasks"), words("class.state")),
    )
    head = "".join(f'<th align="left" style="padding:0.25em 0.5em">{h}</th>' for h in heads)
    if not rows:
        rows = f'<tr><td colspan="5" style="padding:0.5em">{words("class.nobody")}</td></tr>'
    return (
        '<div style="padding:0 0.6em;font-size:0.9em"><table style="width:100%;'
        f'border-collapse:collapse"><tr style="color:{GREY}">{head}</tr>{rows}</table></div>'
    )


def _row(member: Member, course: Course, now: float, words: Words) -> str:
    way = member.progress
    cells = (f"<bdi>{html.escape(member.name)}</bdi>", *_place(way, course, words))
    colour, state = GREEN, words("class.here")
    if not member.connected:
        colour, state = GREY, words("class.away")
    elif now - member.active > IDLE:
        minutes = int((now - member.active) / 60)
        colour, state = AMBER, words("class.idle", minutes=minutes)
    inner = "".join(f'<td style="padding:0.25em 0.5em">{cell}</td>' for cell in cells)
    return (
        f'<tr style="border-top:1px solid #d5dae1">{inner}'
        f'<td style="padding:0.25em 0.5em;white-space:nowrap;color:{colour}">● {state}</td></tr>'
    )


def _place(way: Progress, course: Course, words: Words) -> tuple[str, str, str]:
    """Lesson, step, tasks."""
    if way.lesson not in course.lessons:
        return words("class.free"), "", ""
    lesson = course.lesson(way.lesson, words.language)
    index = min(way.notes[way.lesson].step if way.lesson in way.notes else 0, len(lesson.steps) - 1)
    done, wanted = tasks_passed(way, lesson)
    number = list(course.lessons).index(way.lesson) + 1
    return (
        f"{number}. {html.escape(lesson.front.title)}",
        f"{index + 1}/{len(lesson.steps)} {html.escape(lesson.steps[index].title)}",
        f"{done}/{wanted}",
    )


def prediction_view(
    block: Prediction,
    found: Distribution,
    truth: Truth | None,
    revealed: bool,
    words: Words,
    large: bool = False,
) -> str:
    """How the class has answered, without names; the truth too, when it is revealed.

    Args:
        large: for a projector.
    """
    given = sum(found.counts) + len(found.sketches)
    facts = words("class.given", given=given, skipped=found.skipped, waiting=found.waiting)
    body = (
        _bars(block, found, revealed)
        if isinstance(block, Choice)
        else _sketches(block, found, truth if revealed else None, words)
    )
    return (
        f'<div class="op-class" style="padding:0.4em 1em;'
        f'font-size:{1.7 if large else 1.15}em;line-height:1.4">'
        f"<p><b>{block.question}</b></p>{body}"
        f'<p style="color:{GREY};font-size:0.85em">{facts}</p></div>'
    )


def _bars(block: Choice, found: Distribution, revealed: bool) -> str:
    most = max(1, *found.counts)
    bars = ""
    for letter, option, count in zip(LETTERS, block.options, found.counts, strict=False):
        right = revealed and option.right
        colour = GREEN if right else FOLLOWER.hex if not revealed else "#aab4c0"
        bars += (
            f'<div style="margin:0.6em 0"><div><b>{letter}</b> {option.text}'
            f"{' ✓' if right else ''}</div>"
            '<div style="display:flex;align-items:center;gap:0.5em">'
            f'<div style="background:{colour};height:1.3em;width:{85 * count / most:.1f}%;'
            f'min-width:2px"></div><b>{count}</b></div></div>'
        )
    return bars


def _sketches(block: Sketch, found: Distribution, truth: Truth | None, words: Words) -> str:
    """All curves on one plot."""
    lines = "".join(
        _line(block, sketch.times, sketch.values, INK, 2, 0.5, MOST_POINTS)
        for sketch in found.sketches
    )
    names = [(INK, words("class.predicted"))]
    if truth is not None:
        lines += _line(block, truth.times, truth.tracker, TRACKER.hex, 4, 1.0)
        lines += _line(block, truth.times, truth.follower, FOLLOWER.hex, 4, 1.0)
        names += [(TRACKER.hex, words("robot.tracker")), (FOLLOWER.hex, words("robot.follower"))]
    legend = " ".join(f'<span style="color:{colour}">■ {name}</span>' for colour, name in names)
    title = f"{words(f'quantity.{block.quantity}')} [{QUANTITIES[block.quantity]}]"
    return (
        f'<div style="font-size:0.85em">{title}</div>'
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="100%" role="img">{_axes(block)}{lines}</svg>'
        f'<div style="font-size:0.85em">{legend}</div>'
    )


def _axes(block: Sketch) -> str:
    marks = ""
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        time, value = part * block.seconds, block.bottom + part * (block.top - block.bottom)
        x, y = _at(block, time, value)
        _, floor = _at(block, 0.0, block.bottom)
        left, _ = _at(block, 0.0, block.bottom)
        marks += (
            f'<line x1="{left}" y1="{y:.0f}" x2="{WIDTH - 8}" y2="{y:.0f}" stroke="#dde2e8"/>'
            f'<text x="{left - 6}" y="{y + 5:.0f}" text-anchor="end" font-size="15">'
            f"{value:g}</text>"
            f'<text x="{x:.0f}" y="{floor + 22:.0f}" text-anchor="middle" font-size="15">'
            f"{time:g} s</text>"
        )
    return marks


@lru_cache(maxsize=1024)  # a class looks at the same curves again every second
def _line(
    block: Sketch,
    times: tuple[float, ...],
    values: tuple[float, ...],
    colour: str,
    width: int,
    opacity: float,
    most: int = MOST_OF_TRUTH,
) -> str:
    kept = peaks([np.array(values)], most)
    places = [_at(block, times[i], values[i]) for i in kept]
    points = " ".join(f"{x:.0f},{y:.0f}" for x, y in places)
    return (
        f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" '
        f'stroke-opacity="{opacity}"/>'
    )


def _at(block: Sketch, time: float, value: float) -> tuple[float, float]:
    """Where on the plot, [px]; what is outside the axes is drawn at their edge."""
    across = min(max(time / block.seconds, 0.0), 1.0)
    up = min(max((value - block.bottom) / (block.top - block.bottom), 0.0), 1.0)
    return LEFT + across * (WIDTH - LEFT - 20), 10 + (1.0 - up) * (HEIGHT - BELOW - 20)
