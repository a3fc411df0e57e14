"""The lessons and routes in the overview, as HTML."""

from __future__ import annotations

from onpath.app.common.templates import render
from onpath.app.lab.lesson_state import LessonState
from onpath.app.view.lessons import route_stops
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.routes import Route
from onpath.lessons.schema import Lesson


def route_entry(route: Route, run: LessonState) -> str:
    """A route in the lesson overview, with its stops and their times."""
    words = run.words
    title = route.text(route.title, words.language)
    return render(
        "lesson/route.html",
        title=title,
        name=words("route.follow_name", title=title),
        summary=route.text(route.summary, words.language),
        minutes=words("lesson.minutes", minutes=f"{route.minutes:g}"),
        stops=route_stops(route, run),
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
