"""Routes through the lessons for an occasion: steps of lessons, and their times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec

from onpath.lessons.action_schema import Data
from onpath.lessons.problems import Problem, line_of
from onpath.lessons.schema import Lesson
from onpath.lessons.text_files import FileError, read_text
from onpath.lessons.toml_blocks import read_toml
from onpath.lessons.words import DEFAULT
from onpath.models.systems.parameter_specs import unknown_name

FOLDER = "routes"
"""The folder of the routes, next to the folders of the lessons."""
Lessons = Mapping[str, Mapping[str, Lesson]]
Texts = dict[str, str]  # language -> text


class Stop(Data, frozen=True):
    """Steps of one lesson, from the first to the last, by their numbers from 1, and minutes."""

    lesson: str
    steps: tuple[int, int]
    minutes: Annotated[float, msgspec.Meta(gt=0)]

    def holds(self, lesson: str, index: int) -> bool:
        """Whether a step, by its index from 0, is one of them."""
        return lesson == self.lesson and self.steps[0] <= index + 1 <= self.steps[1]


class Route(Data, frozen=True):
    """A route: its texts by language, and its stops in order, no step twice.

    Attributes:
        test: whether the concept test comes before and after it.
    """

    title: Texts
    summary: Texts
    stop: tuple[Stop, ...]
    test: bool = False

    @property
    def minutes(self) -> float:
        """Total of all stops."""
        return sum(stop.minutes for stop in self.stop)

    def text(self, texts: Texts, language: str) -> str:
        """A text in a language, in English if there is none."""
        return texts.get(language) or texts[DEFAULT]

    def stop_of(self, lesson: str, index: int) -> int | None:
        """Index of the stop to which a step belongs; None if it is not on the route."""
        held = (i for i, stop in enumerate(self.stop) if stop.holds(lesson, index))
        return next(held, None)

    def beside(self, lesson: str, index: int, by: int) -> tuple[str, int] | None:
        """Lesson and index of the step `by` steps away, at most in the next stop, or None.

        A step that is not on the route has its neighbours in its lesson.
        """
        at = self.stop_of(lesson, index)
        if at is None or self.stop[at].holds(lesson, index + by):
            return lesson, index + by
        beyond = at + (1 if by > 0 else -1)
        if not 0 <= beyond < len(self.stop):
            return None
        other = self.stop[beyond]
        return other.lesson, other.steps[0 if by > 0 else 1] - 1


@dataclass(frozen=True, slots=True)
class ReadRoutes:
    """Routes by the names of their files, and the problems of the others."""

    routes: dict[str, Route]
    problems: list[Problem]


def read_routes(folder: Path, lessons: Lessons | None = None) -> ReadRoutes:
    """The routes of a folder of lessons, in the order of their files' names.

    Args:
        lessons: those of the course; None if the routes are known to be valid and need no check.
    """
    read = ReadRoutes({}, [])
    for file in sorted((folder / FOLDER).glob("[!.]*.toml")):
        found: list[Problem] = []

        def complain(line: int, text: str, file: Path = file, found: list[Problem] = found) -> None:
            found.append(Problem(str(file), line, text))

        try:
            content = read_text(file)
        except FileError as error:
            read.problems.append(error.problem)
            continue
        route = read_toml(content, 1, Route, complain)
        if route is not None and lessons is not None:
            for fault in route_faults(route, lessons):
                complain(line_of(fault, content, 1), fault)
        if route is not None and not found:
            read.routes[file.stem] = route
        read.problems.extend(found)
    return read


def route_faults(route: Route, lessons: Lessons) -> Iterator[str]:
    """The faults of a route."""
    for name, texts in (("title", route.title), ("summary", route.summary)):
        if not texts.get(DEFAULT):
            yield f"{name}: there is none in English"
    if not route.stop:
        yield "stop: there is none"
    for i, stop in enumerate(route.stop):
        if stop.lesson not in lessons:
            yield str(unknown_name(stop.lesson, list(lessons), "lesson"))
            continue
        steps = next(iter(lessons[stop.lesson].values())).steps
        first, last = stop.steps
        if last < first:
            yield f"steps = [{first}, {last}]: it ends before it begins"
            continue
        if not 1 <= first <= last <= len(steps):
            yield f"steps = [{first}, {last}]: {stop.lesson!r} has 1 to {len(steps)}"
            continue
        if steps[last - 1].kind == "predict":
            yield f"steps = [{first}, {last}]: {last} is a prediction, and {last + 1} shows it"
        if first > 1 and steps[first - 2].kind == "predict":
            yield f"steps = [{first}, {last}]: {first} shows what {first - 1} predicts"
        if any(other.holds(stop.lesson, at - 1) for other in route.stop[:i] for at in stop.steps):
            yield f"steps = [{first}, {last}] of {stop.lesson!r}: on the route twice"
