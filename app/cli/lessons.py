"""`onpath lessons`: lists, checks, plays and prints lessons."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

if TYPE_CHECKING:
    from onpath.lessons.course import Course
    from onpath.lessons.problems import Problem


@dataclass(frozen=True)
class ListLessons:
    """List the lessons and how many minutes each is estimated to take."""

    folder: Annotated[Path | None, tyro.conf.Positional] = None
    """Folder of lessons; by default the built-in ones."""
    steps: bool = False
    """List the steps of each lesson, too."""

    def run(self) -> int:
        """Print the list; return exit code 1 if there are problems."""
        from onpath.lessons.course import BUILT_IN, read_course

        course, problems = read_course([self.folder or BUILT_IN])
        print(minutes_table(course, self.steps))
        return _reported(problems)


@dataclass(frozen=True)
class CheckLessons:
    """Read lessons and play their scripts, solutions and failures."""

    folder: Annotated[Path | None, tyro.conf.Positional] = None
    """Folder of lessons, or of one lesson; by default the built-in ones."""
    cheat: bool = False
    """Try to pass every task without what it asks, and say how many random students pass it. This
    takes minutes."""

    def run(self) -> int:
        """Print what is wrong; return exit code 1 if anything is."""
        from onpath.app.lab.dry_runs.cheat_check import (
            asked_tasks,
            attempts,
            cheat_faults,
            passes_of,
        )
        from onpath.app.lab.dry_runs.course_check import play_course
        from onpath.app.lab.dry_runs.sentence_check import unplayed
        from onpath.app.lab.loops.loop_cache import LoopCache
        from onpath.lessons.course import BUILT_IN, read_folder

        course, problems, folder = read_folder(self.folder or BUILT_IN)
        print(rates_table(course) + long_pages_list(course), end="")
        if not problems:
            loop_cache = LoopCache(at_once=True)
            problems = list(play_course(course, folder, loop_cache))
            if self.cheat:
                problems += cheat_faults(attempts(course, folder), loop_cache)
                for asked in asked_tasks(course, folder):
                    print(found := passes_of(asked, loop_cache), flush=True)
                    problems += found.problems()
        if not problems and (count := unplayed(course, folder)):
            says = _count(count, "sentence")
            print(f"note: {says} about the lab that no mark plays; see lessons/README.md")
        if not problems:
            lessons = list(course.lessons.values())
            tasks = sum(len(next(iter(versions.values())).tasks()) for versions in lessons)
            counts = [_count(len(lessons), "lesson"), _count(tasks, "solution")]
            print(f"{', '.join(counts)} and {_count(tasks, 'failure')} played, nothing wrong")
        return _reported(problems)


@dataclass(frozen=True)
class ListNames:
    """List all names that a lesson may use: robots, parameters, paths, laws, plots, quantities…"""

    def run(self) -> int:
        """Print the lists."""
        from onpath.lessons.vocabulary.lists import names_markdown

        print(names_markdown(), end="")
        return 0


def minutes_table(course: Course, steps: bool) -> str:
    """One line per lesson and, if wanted, per step, with its minutes by activity.

    A lesson's minutes do not include optional steps, which have a column of their own.
    """
    from onpath.lessons.minutes import Minutes, optional_minutes, required_minutes, step_minutes

    def row(name: str, spent: Minutes, *rest: str) -> str:
        parts = (spent.total, spent.reading, spent.runs, spent.predictions, spent.tasks)
        return " ".join([f"{name:32.32s}", *(f"{part:7.1f}" for part in parts), *rest])

    heads = "minutes", "reading", "runs", "predict", "do", "optional"
    lines = [" ".join([f"{'':32s}", *(f"{head:>7s}" for head in heads)])]
    for name, versions in course.lessons.items():
        lesson = course.lesson(name, "en")
        minutes, languages = optional_minutes(lesson).total, ",".join(versions)
        optional = f"{minutes:8.1f}" if minutes else f"{'':8s}"
        rest = f"{optional} {languages:8s} {lesson.front.title}"
        lines.append(row(name, required_minutes(lesson), rest))
        for number, step in enumerate(lesson.steps if steps else (), 1):
            labels = [" optional"] if step.optional else []
            lines.append(row(f"  {number} {step.kind}: {step.title}", step_minutes(step), *labels))
    for name, route in course.routes.items():
        lines.append(f"{name:32.32s} {route.minutes:7.1f} route: {route.text(route.title, 'en')}")
    return "\n".join(lines)


def rates_table(course: Course) -> str:
    """How often strategies that read no physics are right; empty if too little is asked.

    One line per strategy, one column per kind of question and language. An exclamation mark is
    behind a rate that is not by chance.
    """
    from onpath.lessons.strategies import ALLOWED, FEWEST, rates

    found = [each for each in rates(course) if each.count >= FEWEST]
    groups = list(dict.fromkeys(each.group for each in found))
    cells = {(each.strategy, each.group): str(each) for each in found}
    if not found:
        return ""
    title = f"right by form alone (by chance ± {ALLOWED} standard deviations; ! is not by chance)"
    lines = [title, " ".join([f"{'':14s}", *(f"{group:>17s}" for group in groups)])]
    for strategy in dict.fromkeys(each.strategy for each in found):
        row = (f"{cells.get((strategy, group), ''):>17s}" for group in groups)
        lines.append(" ".join([f"{strategy:14s}", *row]))
    return "\n".join(lines) + "\n"


def long_pages_list(course: Course) -> str:
    """One line for each page with more words than are read in one go."""
    from onpath.lessons.minutes import PAGE, long_pages

    return "".join(
        f"note: {name}/{language}.md:{step.line}: {step.title!r} has {words} words; more than"
        f" {PAGE} want a page of their own or a fold\n"
        for name, versions in course.lessons.items()
        for language, lesson in versions.items()
        for step, words in long_pages(lesson)
    )


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' if number != 1 else ''}"


def _reported(problems: list[Problem]) -> int:
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0
