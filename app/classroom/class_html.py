"""Pieces of the teacher's page as HTML, from the templates in assets/templates/class."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Literal

from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import Asked, Distribution, tasks_passed
from onpath.app.classroom.sketches_html import ALL, Picks, SketchRound, sketches_view
from onpath.app.common.palette import AMBER, AZURE, GREEN, GREY, VIOLET, Colour
from onpath.app.common.qr_code import qr_code
from onpath.app.common.templates import render
from onpath.app.viser_adapter.addresses import REMOTE, WALL
from onpath.lessons.concept_test.concept_test import sitting_of
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.schema import Choice, NumberQuestion, Prediction, Quiz, Sketch
from onpath.lessons.sides import robot_names
from onpath.lessons.votes import Vote
from onpath.lessons.words import Words
from onpath.models.control.sides import DEFAULT_LAWS

MOST_NUMBERS = 8  # different numbers that are shown one by one
IDLE = 60.0  # [s] without a command after which a student counts as idle


def class_code(
    address: str,
    is_local: bool,
    code: str,
    count: int | None,
    words: Words,
    large: bool = False,
    screens: str = "",
) -> str:
    """The address of the class, as a QR code, too, and its code, in large type for the projector.

    Args:
        is_local: whether only this machine can open the address.
        count: number of students; None: it is not told.
        screens: address below which wall and remote control are; empty: it is not told.
    """
    return render(
        "class/code.html",
        address=address,
        qr=None if is_local else qr_code(address),
        code=code,
        count=count,
        words=words,
        large=large,
        wall=WALL if screens else "",
        remote=f"{screens}{REMOTE}" if screens else "",
        remote_qr=qr_code(f"{screens}{REMOTE}") if screens and not is_local else None,
    )


@dataclass(frozen=True, slots=True)
class MemberLine:
    """A student's row in the table."""

    name: str
    lesson: str
    step: str
    tasks: str
    colour: str
    state: str


def table(members: Iterable[Member], course: Course, now: float, words: Words) -> str:
    """The table of members and their progress.

    Args:
        now: time on the class's clock, [s].
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
    lesson, step, tasks = _position(member.progress, course, words)
    return MemberLine(
        name=member.name, lesson=lesson, step=step, tasks=tasks, colour=colour, state=state
    )


def _position(progress: Progress, course: Course, words: Words) -> tuple[str, str, str]:
    """A student's lesson, step and tasks, as displayed."""
    name = progress.lesson
    if not course.has(name):
        return words("class.free"), "", ""
    if name in course.tests:
        return titles_of_tests(course, words)[sitting_of(name)], "", ""
    lesson = course.lesson(name, words.language)
    step = progress.notes[name].step if name in progress.notes else 0
    index = min(step, len(lesson.steps) - 1)
    done, wanted = tasks_passed(progress, lesson)
    number = course.numbers()[name]
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
    picks: Picks = ALL,
) -> str:
    """The answers of the class without names, and the truth once revealed.

    Args:
        large: whether to use large type for a projector.
        laws: control laws of the run that tests the prediction.
        second: the answers after a discussion, shown beside the first; None if it was asked once.
        picks: the sketches to show.
    """
    rounds = [("", found)]
    if second is not None:
        rounds = [(words("class.first"), found), (words("class.second"), second)]
    if isinstance(block, Choice):
        return choices_view(block, rounds, revealed, words, large)
    return sketches_view(
        block=block,
        rounds=[SketchRound(title, each, given_line(each, words)) for title, each in rounds],
        truth=truth if revealed else None,
        robots=robot_names(laws, words),
        words=words,
        large=large,
        picks=picks,
    )


def choices_view(
    block: Choice | Quiz,
    rounds: Sequence[tuple[str, Distribution]],
    revealed: bool,
    words: Words,
    large: bool = False,
    facts: str = "",
) -> str:
    """The options and how many students chose each, without names; rounds stand side by side.

    Args:
        rounds: title and answers of each time the question was asked; none hides the answers.
        facts: what is said below, unless there is one round, which has its own line.
    """
    titled = [(title, found.counts, given_line(found, words)) for title, found in rounds]
    return render(
        "class/choices.html",
        block=block,
        options=list(zip(LETTERS, block.options, strict=False)),
        rounds=titled,
        most=max([1, *(count for _, found in rounds for count in found.counts)]),
        revealed=revealed,
        facts=titled[0][2] if len(titled) == 1 else facts,
        large=large,
    )


@dataclass(frozen=True, slots=True)
class NumberLine:
    """A number that students have given, in place of an option."""

    text: str
    right: bool


def numbers_view(
    block: NumberQuestion, found: Distribution, revealed: bool, words: Words, large: bool = False
) -> str:
    """How many students gave each number, without names; of many, the most frequent ones."""
    times = Counter(found.numbers)
    shown = sorted(number for number, _ in times.most_common(MOST_NUMBERS))
    lines = [
        (NumberLine(_with_unit(number, block, words), block.accepts(number)), times[number])
        for number in shown
    ]
    if (others := len(found.numbers) - sum(count for _, count in lines)) > 0:
        lines.append((NumberLine(words("class.other_numbers"), False), others))
    if revealed and not any(line.right for line, _ in lines):
        lines.append((NumberLine(_with_unit(block.number, block, words), True), 0))
    return render(
        "class/choices.html",
        block=block,
        options=[("", line) for line, _ in lines],
        rounds=[("", tuple(count for _, count in lines), "")],
        most=max([1, *(count for _, count in lines)]),
        revealed=revealed,
        facts=given_line(found, words),
        large=large,
    )


def _with_unit(number: float, block: NumberQuestion, words: Words) -> str:
    return f"{words.number(number, 4)} {block.unit}".rstrip()


def hidden_view(block: Asked, found: Distribution | None, words: Words, large: bool = False) -> str:
    """The question, its options and, if it is to be told, how many students have answered it."""
    facts = "" if found is None else given_line(found, words)
    if isinstance(block, Sketch | NumberQuestion):
        return render("class/prediction.html", block=block, facts=facts, large=large)
    return choices_view(block, (), revealed=False, words=words, large=large, facts=facts)


State = Literal["here", "answered", "right", "changed"]
"""What a student who is here has done with what the class is asked."""
DOTS: dict[State, tuple[Colour, str, str, str]] = {
    "here": (GREY, "○", "class.dots_here", "class.cell_here"),
    "answered": (AZURE, "●", "class.dots_answered", "class.cell_answered"),
    "right": (GREEN, "✓", "class.dots_right", "class.cell_right"),
    "changed": (VIOLET, "↻", "class.dots_changed", "class.cell_changed"),
}
"""Colour and sign of each state, and the messages that say how many are in it, or that one is."""


def dots_view(states: Sequence[State], words: Words) -> str:
    """A dot for each student who is here, and how many are in each state."""
    order = list(DOTS)
    shown = [(state, DOTS[state][0].hex) for state in sorted(states, key=order.index, reverse=True)]
    counts, more = list[tuple[str, str]](), {"here": len(states) - states.count("here")}
    more["answered"] = states.count("right")
    for state, (colour, _, many, _) in DOTS.items():
        if count := states.count(state):
            counts.append((colour.hex, words(many, count=count, more=more.get(state, 0))))
    return render("class/dots.html", dots=shown, counts=counts)


def grid_view(here: Sequence[tuple[Member, State]], words: Words) -> str:
    """A cell with number and name for each student who is here; pressed, it sets who is followed.

    On a phone, a cell is as large as a thumb needs.
    """
    cells = [
        (each.number, each.name, colour.hex, sign, words(one))
        for each, state in here
        for colour, sign, _, one in (DOTS[state],)
    ]
    return render("class/grid.html", cells=cells) if cells else ""


def moves_view(
    block: Prediction, moves: Mapping[tuple[int, int], int], words: Words, large: bool = False
) -> str:
    """From which answers students went to which by a discussion; empty if nobody answered twice.

    Args:
        moves: see `app.classroom.results.moves`.
    """
    if isinstance(block, Choice):
        names = list(LETTERS[: len(block.options)])
    else:
        names = [*(shape.name for shape in block.shapes), words("class.other_shape")]
    groups = sorted({group for pair in moves for group in pair})
    rows = [
        (names[before], [moves.get((before, after), 0) for after in groups]) for before in groups
    ]
    heads = [names[group] for group in groups]
    title = words("class.moves")
    return render("class/moves.html", heads=heads, rows=rows, title=title, large=large)


def step_view(title: str, remark: str, large: bool = False) -> str:
    """A step that asks nothing."""
    return render("class/step.html", title=title, remark=remark, large=large)


def remark(text: str) -> str:
    """A sentence below the answers."""
    return render("class/remark.html", text=text)


def given_line(found: Distribution, words: Words) -> str:
    """How many students who are here have answered, and what does not count."""
    lines = [words("class.given", given=found.answered, here=found.here, away=found.away)]
    if found.skipped:
        lines.append(words("class.skipped", count=found.skipped))
    if found.late:
        lines.append(words("class.late", count=found.late))
    if found.unknown:
        lines.append(words("class.unknown", count=found.unknown))
    return " ".join(lines)


def vote_line(vote: Vote, now: float, words: Words) -> str:
    """How long a vote is still open, or that it is closed; empty while it is open."""
    if vote.closes is None:
        return ""
    left = vote.closes - now
    return words("class.closes", seconds=ceil(left)) if left > 0 else words("class.closed")
