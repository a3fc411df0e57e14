"""Reads folders of lessons in all their languages, and reports everything that is wrong."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import msgspec
from msgspec.structs import replace

from onpath.lessons.action_schema import Script, StepSetup
from onpath.lessons.cheating import fair_faults
from onpath.lessons.concept_test.concept_test import (
    BEFORE,
    FOLDERS,
    both_sittings,
    name_of,
    questions,
    unlike_forms,
)
from onpath.lessons.lecture import LECTURE
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError, Problem, line_of, near
from onpath.lessons.routes import FOLDER as ROUTES
from onpath.lessons.routes import Route, read_routes
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    Quiz,
    Sketch,
    Step,
    Text,
)
from onpath.lessons.task_schema import Reference, Task
from onpath.lessons.text_files import FileError, load_toml, read_text, toml_fault
from onpath.lessons.toml_blocks import nearest
from onpath.lessons.vocabulary.setups import script_faults
from onpath.lessons.words import DEFAULT
from onpath.models.systems.catalogue import ROBOTS

BUILT_IN = Path(__file__).parent / "course"
REFERENCE = "reference.toml"
PLAYS = "plays"
"""The table of REFERENCE with the scripts that marks in the text name."""
NOTES = ("usual", "answer", "ask", "passed")
"""Texts that a block has either in all languages or in none."""
LANGUAGE = re.compile(r"[a-z]{2}")  # name of a language's file
NUMBER = re.compile(r"(\d+)([a-z]?)-")
"""The number of a lesson's folder; one with a letter, such as 01b-..., may be skipped."""


@dataclass(frozen=True, slots=True)
class Course:
    """Lessons in order, each in the languages in which it is written.

    Attributes:
        lessons: name -> language -> lesson.
        routes: name -> route.
        tests: name -> language -> lesson; the concept test before and after the course, if any,
            in each of its forms.
        lecture: language -> lesson, see `lessons.lecture`; empty if there is none.
    """

    lessons: dict[str, Mapping[str, Lesson]]
    routes: dict[str, Route] = field(default_factory=dict[str, Route])
    tests: dict[str, Mapping[str, Lesson]] = field(default_factory=dict[str, Mapping[str, Lesson]])
    lecture: Mapping[str, Lesson] = field(default_factory=dict[str, Lesson])

    @property
    def played(self) -> dict[str, Mapping[str, Lesson]]:
        """The lessons and the lecture by name: all that has scripts."""
        return self.lessons | ({LECTURE: self.lecture} if self.lecture else {})

    def has(self, name: str) -> bool:
        """Whether there is a lesson or a test of this name."""
        return name in self.lessons or name in self.tests

    def has_steps(self, name: str, first: int, last: int) -> bool:
        """Whether a lesson or a test has a range of steps, given by their indices."""
        return self.has(name) and 0 <= first <= last < len(self.lesson(name, DEFAULT).steps)

    def lesson(self, name: str, language: str) -> Lesson:
        """A lesson, test or lecture in a language, or in English, or else in any language.

        Raises:
            KeyError: there is no such lesson.
        """
        versions = (self.played | self.tests)[name]
        return versions.get(language) or versions.get(DEFAULT) or next(iter(versions.values()))

    def forms(self, language: str) -> list[Lesson]:
        """The concept test in each of its forms; empty if there is none."""
        names = (name_of(BEFORE, form) for form in range(len(FOLDERS)))
        return [self.lesson(name, language) for name in names if name in self.tests]

    def numbers(self) -> dict[str, str]:
        """Lesson -> its displayed number: "1", "2", ...

        An optional lesson, in a folder such as `01b-name`, has the number of the lesson before it
        and a letter, so that the other lessons keep their numbers, to which texts refer.
        """
        numbers, count = dict[str, str](), 0
        for name in self.lessons:
            number = NUMBER.match(name)
            letter = number[2] if number and count else ""
            count += not letter
            numbers[name] = f"{count}{letter}"
        return numbers

    def languages(self) -> list[str]:
        """The languages of all lessons and tests, sorted."""
        every = (self.lessons | self.tests).values()
        return sorted({language for versions in every for language in versions})


NO_LESSONS = Course({})


def read_course(
    folders: Iterable[Path], first: Course = NO_LESSONS
) -> tuple[Course, list[Problem]]:
    """All valid lessons in the folders, and the problems of the others.

    Args:
        first: a course to which these are added.
    """
    lessons, routes, tests = dict(first.lessons), first.routes, first.tests
    lecture = first.lecture
    homes, test_homes = dict[str, Path](), dict[str, Path]()
    problems = list[Problem]()
    for folder in folders:
        forms = dict[str, Mapping[str, Lesson]]()
        found = sorted(
            {file.parent for file in folder.glob("[!.]*/[!.]*.md") if file.stem != "README"}
        )
        if not found:
            text = "no lessons: a lesson is a folder in it with en.md"
            if not folder.exists():
                text = "there is no such folder"
            elif _is_lesson(folder):
                text = f"this is a lesson itself: name the folder that it is in, {folder.parent}"
            problems.append(Problem(str(folder), 0, text))
        for home in found:
            versions, wrong = read_versions(home)
            problems += wrong
            if home.name in FOLDERS:
                forms[home.name], test_homes[home.name] = versions, home
            elif home.name == LECTURE:
                lecture = versions or lecture
            elif versions and home.name in lessons:
                problems.append(Problem(str(home), 1, f"a second lesson {home.name!r}"))
            elif versions:
                lessons[home.name], homes[home.name] = versions, home
        read_forms = [forms[name] for name in FOLDERS if forms.get(name)]
        tests = both_sittings(dict(enumerate(read_forms))) or tests
        problems += [*_form_faults(folder, forms), *_folder_faults(folder, found)]
        read = read_routes(folder, lessons)
        routes, problems = {**read.routes, **routes}, problems + read.problems
    course = Course(lessons, routes, tests, lecture)
    problems += [*_warm_up_faults(course, homes), *_treated_faults(course, test_homes)]
    return course, sorted(problems)


def _warm_up_faults(course: Course, homes: Mapping[str, Path]) -> Iterator[Problem]:
    """Warm-up questions that are not drawn from a lesson at least two back.

    Args:
        homes: lesson -> its folder, of the lessons that are checked.
    """
    counts = {
        name: int(number.rstrip(ascii_lowercase)) for name, number in course.numbers().items()
    }
    for name, home in homes.items():
        for language, lesson in course.lessons[name].items():
            for step in lesson.steps:
                for quiz in (block for block in step.blocks if isinstance(block, Quiz)):
                    drawn = quiz.warm_up
                    if drawn and counts.get(drawn, counts[name]) > counts[name] - 2:
                        text = f"warm_up = {drawn!r}: no lesson at least two before this one"
                        file = str(home / f"{language}.md")
                        yield Problem(file, step.line, text + near(drawn, list(counts)))


def _treated_faults(course: Course, homes: Mapping[str, Path]) -> Iterator[Problem]:
    """Questions of the concept test that name a page which there is not.

    Args:
        homes: folders of the forms that are checked, by name.
    """
    for folder, home in homes.items():
        name = name_of(BEFORE, FOLDERS.index(folder))
        if name not in course.tests:
            continue
        test = course.lesson(name, DEFAULT)
        for step, quiz in zip(test.steps, questions(test).values(), strict=True):
            page = quiz.treated
            if page and not course.has_steps(page.lesson, page.step - 1, page.step - 1):
                text = f"treated: there is no step {page.step} of a lesson {page.lesson!r}"
                file = str(home / f"{test.language}.md")
                yield Problem(file, step.line, text + near(page.lesson, list(course.lessons)))


def _form_faults(folder: Path, forms: Mapping[str, Mapping[str, Lesson]]) -> Iterator[Problem]:
    """Problems of the concept test's second form beside the first one."""
    first, second = (forms.get(name, {}) for name in FOLDERS)
    if second and not first:
        yield Problem(str(folder / FOLDERS[1]), 1, f"there is no first form, {FOLDERS[0]}")
    if first and second and set(first) != set(second):
        yield Problem(str(folder / FOLDERS[1]), 1, "not the languages of the first form")
    for language in set(first) & set(second):
        for line, text in unlike_forms(first[language], second[language]):
            yield Problem(str(folder / FOLDERS[1] / f"{language}.md"), line, text)


def _folder_faults(folder: Path, lessons: Sequence[Path]) -> Iterator[Problem]:
    """Problems of the folders in a course: numbers used twice, and folders that are not read."""
    numbered: dict[str, str] = {}
    for home in lessons:
        if number := NUMBER.match(home.name):
            first = numbered.setdefault(number[0], home.name)
            if first != home.name:
                yield Problem(
                    str(home), 1, f"{first!r} has the number {number[0].removesuffix('-')}, too"
                )
    known = [ROUTES, *FOLDERS, LECTURE]
    for other in sorted(folder.iterdir()) if lessons else ():
        unread = other not in lessons and other.name not in known and other.name[0] not in "._"
        if unread and other.is_dir():
            text = f"it is no lesson, having no en.md, and not one of {', '.join(known)}"
            yield Problem(str(other), 1, text + near(other.name.lower(), known))


def read_folder(folder: Path) -> tuple[Course, list[Problem], Path]:
    """The lessons in a folder, or the lesson or form of the concept test whose folder it is; their
    problems; their folder."""
    if not _is_lesson(folder):
        return *read_course([folder]), folder
    home = folder.resolve()
    versions, problems = read_versions(home)
    course = Course({home.name: versions} if versions else {})
    if versions and home.name in FOLDERS:
        course = Course({}, tests=both_sittings({FOLDERS.index(home.name): versions}))
    return course, sorted(problems), home.parent


def _is_lesson(folder: Path) -> bool:
    """Whether this is the folder of a single lesson."""
    return any(folder.glob("??.md")) and not any(folder.glob("*/??.md"))


def read_versions(home: Path) -> tuple[dict[str, Lesson], list[Problem]]:
    """One lesson in all its languages, and its problems.

    Args:
        home: the folder of the lesson.
    """
    versions: dict[str, Lesson] = {}
    problems: list[Problem] = []
    for file in sorted(home.glob("[!.]*.md"), key=lambda f: (f.stem != DEFAULT, f.stem)):
        if file.stem == "README":
            continue
        if not LANGUAGE.fullmatch(file.stem):
            text = "the file of a language is named by two small letters, such as en.md"
            problems.append(Problem(str(file), 1, text))
            continue
        try:
            versions[file.stem] = read_lesson(file)
        except LessonError as error:
            problems += error.problems
    if versions:
        first, *others = versions.values()
        for other in others:
            problems += _differences(first, other, home / f"{other.language}.md")
            same = replace(other, keys=first.keys, version=first.version)
            versions[other.language] = same
        if home.name not in FOLDERS:
            problems += read_references(first, home / REFERENCE)[1]
    return versions, problems


def read_references(lesson: Lesson, file: Path) -> tuple[dict[str, Reference], list[Problem]]:
    """Task id -> reference solution and failure, and the problems of the file.

    Args:
        lesson: whose tasks need references.
        file: TOML.
    """

    def problem(text: str, line: int = 1) -> Problem:
        return Problem(str(file), line, text)

    if not file.exists():
        return {}, [problem("there must be one")]
    content = ""
    try:
        content = read_text(file)
        tables = load_toml(content)
    except FileError as error:
        return {}, [error.problem]
    except tomllib.TOMLDecodeError as error:
        below, fault = toml_fault(error, content)
        return {}, [problem(fault, 1 + below)]
    ids = [task.id for task in lesson.tasks()]
    problems = [problem(f"no solution of task {task!r}") for task in ids if task not in tables]
    read: dict[str, Reference] = {}
    lines = content.split("\n")
    begins = {
        name: next((i for i, each in enumerate(lines, 1) if f"[{name}" in each), 1)
        for name in tables
    }
    for name, table in tables.items():
        line = begins[name]
        if name == PLAYS:
            problems += (problem(fault, line) for fault in _play_faults(table, lesson.front.robot))
            continue
        if name not in ids:
            problems.append(problem(f"there is no task {name!r}{near(name, ids)}", line))
        try:
            read[name] = msgspec.convert(table, Reference)
        except msgspec.ValidationError as error:
            rest = "\n".join(lines[line - 1 :])
            message = f"{error}{nearest(str(error), Reference)}"
            problems.append(problem(f"task {name!r}: {message}", line_of(message, rest, line)))
    for name, reference in read.items():
        rest = "\n".join(lines[begins[name] - 1 :])
        for fault in _reference_faults(reference, lesson.front.robot):
            problems.append(problem(f"{name}: {fault}", line_of(fault, rest, begins[name])))
    return read, problems


def read_plays(file: Path) -> dict[str, Script]:
    """The scripts that marks in a lesson's text name, by name.

    Raises:
        ValueError: the file has a fault, which `read_references` reports.
    """
    return msgspec.convert(load_toml(read_text(file)).get(PLAYS, {}), dict[str, Script])


def _play_faults(table: Any, robot: str) -> Iterator[str]:
    try:
        for name, script in msgspec.convert(table, dict[str, Script]).items():
            yield from (f"{PLAYS}.{name}: {fault}" for fault in script_faults(script, robot))
    except msgspec.ValidationError as error:
        yield f"{PLAYS}: {error}"


def _reference_faults(reference: Reference, robot: str) -> Iterator[str]:
    if robot in ROBOTS:
        yield from fair_faults(reference, ROBOTS[robot])
    for script in (reference.solution, reference.failure, *reference.variant):
        yield from script_faults(script, robot)


def _differences(first: Lesson, other: Lesson, file: Path) -> Iterator[Problem]:
    """Differences between a translation and the lesson in more than the words."""
    for name in ("needs", "goals", "misconception", "picture"):
        if bool(getattr(first.front, name)) != bool(getattr(other.front, name)):
            yield Problem(str(file), 1, f"{name} is not given in both languages")
    if len(first.front.takeaway) != len(other.front.takeaway):
        yield Problem(str(file), 1, f"takeaway has not as many points as in {first.language}.md")
    if len(first.steps) != len(other.steps):
        text = f"{len(other.steps)} steps, {len(first.steps)} in {first.language}.md"
        yield Problem(str(file), 1, text)
    if first.front.robot != other.front.robot:
        robots = f"robot is {other.front.robot!r}, and {first.front.robot!r} in {first.language}.md"
        front = read_text(file).partition("\n+++")[0]
        yield Problem(str(file), line_of(robots, front, 1), robots)
    if first.front.symbols != other.front.symbols:
        yield Problem(str(file), 1, f"symbols are not those of {first.language}.md")
    for ours, theirs in zip(first.steps, other.steps, strict=False):
        parts, translated = _structure(ours), _structure(theirs)
        if differs := [what for what, part in parts.items() if translated[what] != part]:
            text = f"step {theirs.title!r} is not as in {first.language}.md, line {ours.line}"
            yield Problem(str(file), theirs.line, f"{text}: not the same {', '.join(differs)}")


def _without_words(setup: StepSetup | None) -> StepSetup | None:
    """A set-up without the texts of its marks."""
    if setup is None:
        return None
    return replace(setup, marks=tuple(replace(m, text=str(bool(m.text))) for m in setup.marks))


def _structure(step: Step) -> dict[str, object]:
    """The parts of a step that are the same in all languages, by their names in messages."""
    texts = [block for block in step.blocks if isinstance(block, Text)]
    return {
        "kind": step.kind,
        "block `step`": (step.optional, step.when),
        "scene": _without_words(step.setup),
        "script": step.script,
        "block `watch`": bool(step.watch),
        "block `notes`": bool(step.notes),
        "conditions of texts (`when`)": [text.when for text in texts if text.when],
        "number of folds": sum(text.html.count("<details>") for text in texts),
        "lab links": [link.actions for text in texts for link in text.links],
        "stated numbers": [replace(each, line=0, text="") for each in step.stated],
        "marked behaviour": [replace(each, line=0, text="") for each in step.behaviours],
        **_asked(step),
    }


def _asked(step: Step) -> dict[str, object]:
    """What a step asks, as in `_structure`."""
    blocks = [block for block in step.blocks if not isinstance(block, Text | Task)]
    return {
        "tasks": [
            (
                *(task.id, task.check, len(task.hints), task.best, task.exploratory),
                [way.when for way in task.way],
            )
            for task in step.tasks()
        ],
        "order of texts and questions": [type(block) for block in step.blocks],
        "right options": [
            [o.right for o in b.options] for b in blocks if isinstance(b, Choice | Quiz)
        ],
        "second tries": [
            b.second and b.second.without_words for b in blocks if isinstance(b, Choice | Quiz)
        ],
        "axes to draw on": [
            replace(
                b,
                question="",
                usual="",
                answer="",
                ask="",
                reasons=(),
                hidden=(),
                shapes=(),
                features=(),
            )
            for b in blocks
            if isinstance(b, Sketch)
        ],
        "shapes of curves": [
            [shape.without_words for shape in (*b.shapes, *b.features)]
            for b in blocks
            if isinstance(b, Sketch)
        ],
        "number of reasons or hidden words": [
            (b.why, len(b.reasons), len(b.hidden)) for b in step.predictions()
        ],
        "right or wrong numbers": [
            (b.number, b.tolerance, [each.number for each in b.wrong])
            for b in blocks
            if isinstance(b, NumberQuestion)
        ],
        "derived lines": [
            (b.names, [line.without_words for line in b.line])
            for b in blocks
            if isinstance(b, Derivation)
        ],
        "misconceptions": [
            (bool(b.misconception), b.treated, b.transfer) for b in blocks if isinstance(b, Quiz)
        ],
        "warm-up questions": [b.warm_up for b in blocks if isinstance(b, Quiz)],
        f"texts ({', '.join(NOTES)})": [
            tuple(bool(getattr(b, name, "")) for name in NOTES) for b in step.blocks
        ],
    }
