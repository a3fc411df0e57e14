"""The lessons and routes to choose from, and how far the student is."""

from __future__ import annotations

from onpath.app.channel.sheet_messages import LessonCard, LessonSheet, RouteCard
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, sitting_of, taken
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.progress import Notes
from onpath.lessons.routes import Route
from onpath.lessons.schema import Lesson
from onpath.lessons.words import Words


def lesson_sheet(run: LessonState) -> LessonSheet:
    """The lessons in the course's order, then the tests, and the routes."""
    language, numbers = run.words.language, run.course.numbers()
    lessons = [lesson_card(run.course.lesson(n, language), run, numbers[n]) for n in numbers]
    before, after = (_test_cards(name, run) for name in (BEFORE, AFTER))
    routes = [_route_card(name, route, run) for name, route in run.course.routes.items()]
    return LessonSheet(
        open=sitting_of(run.progress.lesson), lessons=[*lessons, *before, *after], routes=routes
    )


def lesson_card(lesson: Lesson, run: LessonState, number: str) -> LessonCard:
    """A lesson with its times, and how much of it is done."""
    words, notes = run.words, run.progress.notes.get(lesson.name)
    tasks = lesson.required_tasks()
    seen = 0 if notes is None else min(notes.seen, lesson.required_steps())
    done = 0 if notes is None else sum(task.id in notes.tasks for task in tasks)
    steps = lesson.required_steps()
    facts = [words("lesson.minutes", minutes=lesson_minutes(lesson))]
    if lesson.language != words.language:
        facts.append(words("lesson.english"))
    return LessonCard(
        name=lesson.name,
        number=number,
        picture=lesson.front.picture,
        title=lesson.front.title,
        summary=lesson.front.summary,
        facts=facts,
        done=round((seen + done) / max(steps + len(tasks), 1), 2),
        begun=notes is not None,
        finished=notes is not None and seen == steps and done == len(tasks),
    )


def _test_cards(name: str, run: LessonState) -> list[LessonCard]:
    """The concept test before or after the course, if there is one."""
    if name not in run.course.tests:
        return []
    words, lesson = run.words, run.course.lesson(name, run.words.language)
    notes = run.progress.notes.get(taken(run.progress, name))
    handed_in = (notes or Notes()).handed_in
    minutes = words("lesson.minutes", minutes=lesson_minutes(lesson))
    card = LessonCard(
        name=name,
        number="",
        picture=lesson.front.picture,
        title=titles_of_tests(run.course, words)[name],
        summary=lesson.front.summary,
        facts=[minutes, *([words("test.handed_in")] if handed_in else [])],
        done=float(handed_in),
        begun=notes is not None,
        finished=handed_in,
    )
    return [card]


def _route_card(name: str, route: Route, run: LessonState) -> RouteCard:
    language = run.words.language
    return RouteCard(
        name=name,
        title=route.text(route.title, language),
        summary=route.text(route.summary, language),
        minutes=run.words("lesson.minutes", minutes=f"{route.minutes:g}"),
        stops=route_stops(route, run.course, run.words),
    )


def route_stops(route: Route, course: Course, words: Words) -> list[str]:
    """The stops of a route with their times, between the tests if it has them."""
    numbers = course.numbers()
    stops = list[str]()
    for stop in route.stop:
        title = course.lesson(stop.lesson, words.language).front.title
        first, last = stop.steps
        lesson = f"{numbers[stop.lesson]}. {title}"
        minutes = f"{stop.minutes:g}"
        stops.append(words("route.stop", lesson=lesson, first=first, last=last, minutes=minutes))
    if not (route.test and course.tests):
        return stops
    titles = titles_of_tests(course, words).items()
    before, after = (_test_stop(name, title, course, words) for name, title in titles)
    return [before, *stops, after]


def _test_stop(name: str, title: str, course: Course, words: Words) -> str:
    minutes = lesson_minutes(course.lesson(name, words.language))
    return f"{title}, {words('lesson.minutes', minutes=minutes)}"


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
