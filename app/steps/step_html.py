"""A step of a lesson as HTML, readable without scripts; assets/web makes it answerable."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from msgspec.structs import replace

from onpath.app.common.templates import Markup, part_of_page
from onpath.lessons.adaptive.own_numbers import filled, marked
from onpath.lessons.derivation.judged import LineState
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Notes
from onpath.lessons.safe_html import safe
from onpath.lessons.schema import KINDS, Block, Choice, Lesson, Prediction, Quiz, Text
from onpath.lessons.symbols import marked_symbols
from onpath.lessons.words import Words


@dataclass(frozen=True, slots=True)
class StepPart:
    """A part of a step.

    Attributes:
        kind: see `onpath.lessons.schema.KINDS`.
        block_index: index among the step's blocks.
        here: whether a task can be done on the page; True for other parts.
        order: the order of a question's options, as indices; by default the author's.
        lettered: whether the options have letters, of which a class may speak.
        told: whether the page has the answers, which it may show at the right time.
        replies: the wrong options or numbers of which it has the answers, if not `told`.
        states: of a derivation's lines; None if the page's script judges them.
        hints: how many hints of a task are shown; None if the reader unfolds them.
        way: the way in which a task was passed; None if the page's script decides that.
        second: of a question, its second try, if the page has it.
        second_of: of a second try, the step and the block of its question; else empty.
        remark: what is said above a question; may be empty.
        aside: what the student has said beside an answer, if anything.
    """

    kind: str
    block_index: int
    block: Block
    here: bool = True
    order: tuple[int, ...] = ()
    lettered: bool = False
    told: bool = True
    replies: tuple[int, ...] = ()
    states: tuple[LineState, ...] | None = None
    hints: int | None = None
    way: int | None = None
    second: StepPart | None = None
    second_of: str = ""
    remark: str = ""
    aside: Markup | None = None


def part_of(
    lesson: Lesson, index: int, block_index: int, words: Words, here: bool = True
) -> StepPart:
    """A part of a step; the student's own numbers in a text have defaults, and are marked."""
    block = lesson.steps[index].blocks[block_index]
    if isinstance(block, Text):
        html = marked(block.html, lesson.steps, index)
        block = replace(block, html=filled(html, lesson.steps, index, Notes(), words))
    order = tuple(range(len(getattr(block, "options", ()))))
    second = second_part(index, block_index, block)
    return StepPart(KINDS[type(block)], block_index, block, here, order=order, second=second)


def second_part(index: int, block_index: int, block: Block) -> StepPart | None:
    """The second try at a question in a block of a step; None if it has none."""
    if not isinstance(block, Choice | Quiz) or block.second is None:
        return None
    asked = block.second.asked
    order = tuple(range(len(block.second.options)))
    return StepPart(
        kind=KINDS[type(asked)],
        block_index=block_index,
        block=asked,
        order=order,
        second_of=f"{index}.{block_index}",
    )


def predicted_second(lesson: Lesson, index: int) -> StepPart | None:
    """The second try at the prediction that a step's run shows; None if there is none."""
    if lesson.steps[index].kind == "run":
        for at in (index, index - 1)[: index + 1]:
            for block_index, block in enumerate(lesson.steps[at].blocks):
                if isinstance(block, Prediction):
                    return second_part(at, block_index, block)
    return None


def step_html(
    lesson: Lesson,
    index: int,
    parts: list[StepPart],
    words: Words,
    plays: bool = False,
    lacking: str = "",
) -> Markup:
    """The column of a step: its heading, texts, questions and tasks.

    Args:
        parts: its blocks, see `part_of`.
        plays: whether the page can play the step's script.
        lacking: what the page lacks here, in words; may be empty.
    """
    if lesson.steps[index].kind == "task":  # what is to be done is seen at once
        first = next(part for part in parts if part.kind == "task")
        parts = [first, *(part for part in parts if part is not first)]
    return part_of_page(
        "step/step.html",
        lesson=lesson,
        step=lesson.steps[index],
        index=index,
        parts=parts,
        plays=plays,
        lacking=lacking,
        words=words,
        letters=LETTERS,
        live=partial(live, lesson),
    )


def live(lesson: Lesson, text: str) -> Markup:
    """A text of a lesson with the places of its symbols, which a page can show."""
    return marked_symbols(safe(text), lesson.front.symbols)
