"""Pieces of a lesson's page as HTML, from the templates in assets/templates/lesson."""

from __future__ import annotations

from functools import lru_cache

from onpath.app.common.palette import AZURE, BORDER, GREEN
from onpath.app.common.templates import render
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.checks import Verdict
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Answer
from onpath.lessons.record import QUANTITIES
from onpath.lessons.routes import Route
from onpath.lessons.schema import (
    Choice,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
    Step,
)
from onpath.lessons.task_schema import Task
from onpath.lessons.words import Words


def heading(lesson: Lesson, step: Step, run: LessonState) -> str:
    """Header of a step: lesson, progress bar, kind and title."""
    return render(
        "lesson/heading.html",
        lesson=lesson,
        step=step,
        index=run.index,
        seen=run.notes.seen,
        waits=run.locked is not None,
        large=run.progress.presenting,
        route=route_line(run),
        words=run.words,
    )


def aims(lesson: Lesson, words: Words) -> str:
    """Prerequisites and goals for the first page; empty if the lesson states none."""
    front = lesson.front
    if not front.needs and not front.goals:
        return ""
    return render("lesson/aims.html", needs=front.needs, goals=front.goals, words=words)


def text(content: str) -> str:
    """Prose: markup from a lesson, or plain text."""
    return render("lesson/text.html", content=content)


def remark(sentence: str, italic: bool = False) -> str:
    """A sentence of the interface."""
    return render("lesson/remark.html", sentence=sentence, italic=italic)


def watch(told: str) -> str:
    """What to look at during a run."""
    return render("lesson/watch.html", told=told)


def next_act(words: Words) -> str:
    """The remark after a prediction; the page brings the button that follows it into view."""
    return render("lesson/next_act.html", message=words("lesson.committed"))


def asked(block: Sketch) -> str:
    """A question answered by a sketch."""
    return render("lesson/box.html", title=block.question, colour=BORDER.hex)


def question(
    block: Choice | Quiz,
    order: tuple[int, ...],
    chosen: int | None,
    revealed: bool,
    words: Words,
    unknown: bool = False,
    pressable: bool = False,
) -> str:
    """A question with lettered options and, once revealed, the correct one and the explanation.

    Args:
        order: the options' indices in the order in which they are shown; see `option_order`.
        chosen: index of the student's answer, or None.
        unknown: whether the answer cannot be known, since the options have changed.
        pressable: whether the options press the buttons with their letters, which come next.
    """
    return render(
        "lesson/question.html",
        title=block.question,
        colour=AZURE.hex,
        options=[(LETTERS[place], block.options[i]) for place, i in enumerate(order)],
        own=None if chosen is None else block.options[chosen],
        revealed=revealed,
        unknown=unknown,
        pressable=pressable,
        words=words,
    )


def number_question(block: NumberQuestion, given: float | None, words: Words) -> str:
    """A question whose answer is a number and, once it is given, whether it is right, and why."""
    return render(
        "lesson/number.html",
        title=block.question,
        colour=AZURE.hex,
        block=block,
        given=given,
        words=words,
    )


def open_question(block: OpenQuestion, text: str, words: Words) -> str:
    """A question to be answered in the student's own words and, once it is, a model answer."""
    return render(
        "lesson/open.html",
        title=block.question,
        colour=AZURE.hex,
        block=block,
        text=text,
        words=words,
    )


def confidence(
    block: Prediction, answer: Answer | None, words: Words, unknown: bool = False
) -> str:
    """How sure the student is of a prediction, and why; empty if neither is given.

    Args:
        unknown: whether the answer cannot be known, since the question has changed.
    """
    html = render("lesson/beside.html", block=block, answer=answer, unknown=unknown, words=words)
    return html.strip()


def task(block: Task, verdicts: list[Verdict], run: LessonState) -> str:
    """A task: instructions, progress, and the hints shown so far."""
    words, best = run.words, run.notes.tasks.get(block.id)
    passed = ""
    if best is not None and block.best:
        unit = QUANTITIES.get(block.best, "")
        passed = words("lesson.passed_best", best=f"{best:.2f}", unit=unit)
    elif best is not None:
        passed = words("lesson.passed")
    hints = block.hints[: run.notes.hints.get(block.id, 0)]
    why = block.passed if passed else ""
    return _task(block.text, tuple(verdicts), hints, passed, why)


@lru_cache(maxsize=256)  # called by every page at 10 Hz
def _task(
    title: str, verdicts: tuple[Verdict, ...], hints: tuple[str, ...], passed: str, why: str
) -> str:
    return render(
        "lesson/task.html",
        title=title,
        colour=(GREEN if passed else AZURE).hex,
        verdicts=verdicts,
        hints=hints,
        passed=passed,
        why=why,
    )


def route_entry(route: Route, run: LessonState) -> str:
    """A route in the lesson overview, with its stops and their times."""
    words, numbers = run.words, run.course.numbers()
    stops = list[str]()
    for stop in route.stop:
        lesson = run.course.lesson(stop.lesson, words.language).front.title
        first, last = stop.steps
        stops.append(
            words(
                "route.stop",
                lesson=f"{numbers[stop.lesson]}. {lesson}",
                first=first,
                last=last,
                minutes=f"{stop.minutes:g}",
            )
        )
    if route.test and run.course.tests:
        before, after = titles_of_tests(run.course, words).items()
        tests = [_test_stop(name, title, run) for name, title in (before, after)]
        stops = [tests[0], *stops, tests[1]]
    title = route.text(route.title, words.language)
    return render(
        "lesson/route.html",
        title=title,
        name=words("route.follow_name", title=title),
        summary=route.text(route.summary, words.language),
        minutes=words("lesson.minutes", minutes=f"{route.minutes:g}"),
        stops=stops,
    )


def _test_stop(name: str, title: str, run: LessonState) -> str:
    minutes, _ = lesson_minutes(run.course.lesson(name, run.words.language))
    return f"{title}, {run.words('lesson.minutes', minutes=minutes)}"


def route_line(run: LessonState) -> str:
    """The student's position on the route; empty if the open step is not on one."""
    lesson, route = run.lesson, run.route
    at = None if lesson is None or route is None else route.stop_of(lesson.name, run.index)
    if at is None or route is None:
        return ""
    return run.words(
        "route.here",
        route=route.text(route.title, run.words.language),
        stop=at + 1,
        stops=len(route.stop),
        last=route.stop[at].steps[1],
        minutes=f"{route.stop[at].minutes:g}",
    )


def entry(lesson: Lesson, run: LessonState, number: str) -> str:
    """One line of the lesson overview, with the name of the button that follows."""
    notes = run.progress.notes.get(lesson.name)
    tasks, (minutes, optional) = lesson.required_tasks(), lesson_minutes(lesson)
    done = sum(task.id in notes.tasks for task in tasks) if notes else 0
    finished = notes is not None and notes.seen >= lesson.required_steps() and done == len(tasks)
    facts = [
        run.words("lesson.minutes", minutes=minutes),
        *([run.words("lesson.minutes_optional", minutes=optional)] if optional else []),
        run.words("lesson.tasks", done=done, all=len(tasks)),
    ]
    if lesson.language != run.words.language:
        facts.append(run.words("lesson.english"))
    return render(
        "lesson/entry.html",
        front=lesson.front,
        number=number,
        facts=facts,
        finished=finished,
        name=run.words(
            "lesson.open_name" if notes is None else "lesson.continue_name",
            number=number,
            title=lesson.front.title,
        ),
    )
