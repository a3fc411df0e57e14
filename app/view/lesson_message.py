"""The open step of a lesson, or its end, as the page's data channel tells it: HTML and data.

assets/web/parts/column.ts shows it beside the robots.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec

from onpath.app.channel.lesson_messages import LessonMessage, MeasuredMessage
from onpath.app.common.templates import part_of_page
from onpath.app.steps.block_data import answer_data, block_data, curves_data, script_data
from onpath.app.steps.step_html import StepPart, part_of, predicted_second, step_html
from onpath.app.view.lesson_end import lesson_end
from onpath.app.view.lesson_view import LessonView
from onpath.app.view.lessons import route_line
from onpath.app.view.step_navigation import pager_of
from onpath.app.view.symbol_geometry import has_meaning
from onpath.lessons.derivation.judged import judged
from onpath.lessons.given import Answer, Given
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import given_to
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    Prediction,
    Quiz,
    Sketch,
    Step,
    Text,
)
from onpath.lessons.second_try import SECOND_TRY, second_item
from onpath.lessons.task_schema import Task
from onpath.models.systems.robots import Robot

END = "end"
TOLD = ("attempt", "answer", "number", "text", "way")
"""What a page is told of an answer."""
"""Name of the section that stands for the end of a lesson."""


def lesson_message(run: LessonView, robot: Robot) -> LessonMessage:
    """The message; without a lesson, it says so.

    Args:
        robot: that the lab shows; a symbol is told only if it means something on it.
    """
    lesson = run.lesson
    if lesson is None:
        return LessonMessage(lesson="", version=run.version)
    message = LessonMessage(
        lesson=lesson.name,
        version=run.version,
        index=run.index,
        ended=run.ended,
        test=run.is_test,
        playing=run.playing,
        symbols={
            name: run.words(f"symbol.{name}")
            for name in lesson.front.symbols
            if has_meaning(name, robot)
        },
        head=_head(lesson, run),
        pager=part_of_page("lesson/pager.html", pager=pager_of(run), words=run.words),
    )
    if run.ended:
        html, charts = lesson_end(run)
        return msgspec.structs.replace(message, sections={END: html}, charts=charts)
    return _with_steps(message, lesson, run)


def measured(run: LessonView) -> MeasuredMessage:
    """The verdicts on the open step's tasks, and the curves so far of a script."""
    truth = curves_data(run.truth) if run.playing and run.truth is not None else None
    return MeasuredMessage(run.verdicts, truth)


def _head(lesson: Lesson, run: LessonView) -> str:
    number = run.course.numbers().get(lesson.name, "")
    title = f"{number}. {lesson.front.title}" if number else lesson.front.title
    return part_of_page(
        "lesson/head.html",
        title=title,
        route=route_line(run),
        run=run,
        lesson=lesson,
        words=run.words,
    )


def _with_steps(message: LessonMessage, lesson: Lesson, run: LessonView) -> LessonMessage:
    """The message with the open step and, before it, the one whose prediction it shows."""
    found, index = run.prediction(), run.index
    shown = {index: _parts(lesson, run)}
    if found is not None and int(found[0]) != index:
        shown = {int(found[0]): [_asked(lesson, int(found[0]), run)]} | shown
    sections = {
        str(at): step_html(lesson, at, parts, run.words, plays=lesson.steps[at].script is not None)
        for at, parts in shown.items()
    }
    steps = [_step(step, lesson, i, shown.get(i, []), run) for i, step in enumerate(lesson.steps)]
    return msgspec.structs.replace(message, sections=sections, steps=steps, notes=_notes(run))


def _parts(lesson: Lesson, run: LessonView) -> list[StepPart]:
    """The parts of the open step that are meant for the student's answers."""
    second = predicted_second(lesson, run.index)
    happened = run.truth is not None and not run.playing
    tried = None if second is None or not happened else _tried(lesson, second, run)
    parts = [] if tried is None else [tried]
    return parts + [
        part
        for block_index in range(len(lesson.steps[run.index].blocks))
        if (part := _part(lesson, block_index, run)) is not None
    ]


def _part(lesson: Lesson, block_index: int, run: LessonView) -> StepPart | None:
    block = lesson.steps[run.index].blocks[block_index]
    if isinstance(block, Prediction):
        return _asked(lesson, run.index, run)
    part, notes = part_of(lesson, run.index, block_index, run.words), run.notes
    key = f"{run.index}.{block_index}"
    if isinstance(block, Text):
        html = run.text(block_index, block)
        shown = None if html is None else msgspec.structs.replace(block, html=html)
        return None if shown is None else replace(part, block=shown)
    if isinstance(block, Task):
        way = notes.ways.get(block.id, 0)
        return replace(
            part,
            hints=notes.hints.get(block.id, 0),
            way=way if way in block.explanations else 0,
            told=block.id in notes.tasks,
        )
    if isinstance(block, Quiz):
        unknown = run.is_unknown(key)
        hidden = unknown or run.is_test or run.is_voted_on(key)
        chosen = None if hidden else notes.quiz.get(key)
        second = None if part.second is None or hidden else _tried(lesson, part.second, run)
        told = chosen is not None and (key in notes.twice or block.options[chosen].right)
        if block.second is not None:
            told = chosen is not None and (second is None or second.told)
        return replace(
            part,
            second=second,
            order=run.order(block, key),
            lettered=True,
            told=told,
            replies=() if chosen is None or told else (chosen,),
            remark=run.words("lesson.unknown") if unknown else "",
        )
    if isinstance(block, Derivation):
        states = tuple(judged(block, notes.written.get(key, "")))
        return replace(part, told=all(each.closed for each in states), states=states)
    if not isinstance(block, NumberQuestion):
        return replace(part, told=key in notes.written)
    given = None if run.is_voted_on(key) else notes.numbers.get(key)
    known = None if given is None else block.known(given)
    told = given is not None and (key in notes.twice or block.accepts(given))
    return replace(part, told=told, replies=() if known is None or told else (known,))


def _tried(lesson: Lesson, part: StepPart, run: LessonView) -> StepPart | None:
    """A second try, once it has begun; what is right is told after its answer."""
    at, block_index = map(int, part.second_of.split("."))
    if not run.is_second_tried(lesson, at, block_index):
        return None
    item = second_item(at, block_index)
    order = run.order(part.block, item) if isinstance(part.block, Quiz) else ()
    given = given_to(run.notes, item)
    return replace(part, order=order, told=any(not each.lost for each in given))


def _asked(lesson: Lesson, index: int, run: LessonView) -> StepPart:
    """A prediction; what is right is told by the step that shows it."""
    blocks = lesson.steps[index].blocks
    block_index = next(i for i, block in enumerate(blocks) if isinstance(block, Prediction))
    block, answer = blocks[block_index], run.answer()
    assert isinstance(block, Prediction)
    happened = run.step_is("run") and run.truth is not None and not run.playing
    aside = part_of_page("lesson/beside.html", block=block, answer=answer, words=run.words)
    part = part_of(lesson, index, block_index, run.words)
    judged = happened and answer is not None and not run.is_voting
    second = None if part.second is None or not judged else _tried(lesson, part.second, run)
    told = judged and (second is None or second.told)
    option = None if answer is None or told or not judged else answer.option
    return replace(
        part,
        order=run.order(block) if isinstance(block, Choice) else (),
        lettered=True,
        told=told,
        replies=() if option is None else (option,),
        second=second,
        remark=_remark(block, run),
        aside=aside if aside.strip() else None,
    )


def _remark(block: Prediction, run: LessonView) -> str:
    """That a prediction is asked again, or that its answer is not known any more."""
    first = run.first_answer()
    if run.answer() is None and first is not None:
        return _discuss(block, first, run)
    return run.words("lesson.unknown") if run.is_unknown() else ""


def _discuss(block: Prediction, first: Answer, run: LessonView) -> str:
    if isinstance(block, Sketch):
        return run.words("lesson.discuss_curve" if first.times else "lesson.discuss")
    if first.option not in range(len(block.options)):
        return run.words("lesson.discuss")
    letter = LETTERS[run.order(block).index(first.option)]
    return run.words("lesson.discuss_letter", letter=letter)


def _step(
    step: Step, lesson: Lesson, index: int, parts: list[StepPart], run: LessonView
) -> dict[str, Any]:
    """A step; a closed one has no blocks."""
    own = [part for part in parts if not part.second_of]
    known = {part.block_index: _block(part, lesson, index, run) for part in own}
    count = len(step.blocks) if parts else 0
    return {
        "kind": step.kind,
        "optional": step.optional,
        "script": None if step.script is None else script_data(step.script),
        "blocks": [known.get(block_index, {"kind": "hidden"}) for block_index in range(count)],
        "figure": -1,
        "plots": lesson.setup_at(index).plots if parts else (),
    }


def _block(part: StepPart, lesson: Lesson, index: int, run: LessonView) -> dict[str, Any]:
    data, block = block_data(part, lesson, index, run.words), part.block
    if isinstance(block, Text):
        data["links"] = [[msgspec.to_builtins(act) for act in link.actions] for link in block.links]
    elif isinstance(block, Task):
        data |= {"id": block.id, "best": block.best}
    elif run.is_voted_on(f"{index}.{part.block_index}"):
        data["voted"] = True
    elif isinstance(block, Sketch) and (first := run.first_answer()) is not None and first.times:
        data["before"] = answer_data(first)
    return data


def _notes(run: LessonView) -> dict[str, Any]:
    """The notes that the open step needs."""
    notes, found, answer, key = run.notes, run.prediction(), run.answer(), f"{run.index}."
    asked = "" if found is None else found[0]
    known = answer is not None and not run.is_unknown()
    tried = [each for each in notes.given if each.item.endswith(SECOND_TRY)]
    here = [each for each in notes.given if each.way is not None or each.item.startswith(key)]
    here += [each for each in tried if f"{asked}." != key and each.item.startswith(f"{asked}.")]
    if answer is not None:
        here.append(Given(asked, answer=answer if known else Answer()))
    truth = None if run.playing or run.is_voting else run.truth
    return {
        "step": run.index,
        "seen": notes.seen,
        "truths": {} if truth is None else {asked: curves_data(truth)},
        "played": dict.fromkeys(notes.played, True),
        "hints": notes.hints,
        "given": [_told(each) for each in here if not each.lost],
    }


def _told(given: Given) -> dict[str, Any]:
    """An answer without what is right, which a block tells when it is time to."""
    told = {name: getattr(given, name) for name in TOLD}
    return msgspec.to_builtins(Given(item=given.item, **told))
