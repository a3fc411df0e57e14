"""Reads a lesson file into a `Lesson`, or reports all problems with file and line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from markdown_it.token import Token
from markupsafe import Markup
from msgspec.structs import replace

from onpath.lessons.action_schema import Script, StepSetup
from onpath.lessons.adaptive.branches import faults_of_when
from onpath.lessons.adaptive.own_numbers import unanswered
from onpath.lessons.behaviour.marks import Behaviour, take_behaviours
from onpath.lessons.completeness import NEEDED, first_page_faults, lacks, order_faults
from onpath.lessons.concept_test.concept_test import FOLDERS, lacks_of_test
from onpath.lessons.equations import FILE, Part, equations_table, read_equations
from onpath.lessons.formulas import TextError, reader
from onpath.lessons.kept.option_keys import fingerprint, keys_of
from onpath.lessons.lecture import LECTURE
from onpath.lessons.measures.stated import Stated, take_stated
from onpath.lessons.problems import LessonError, Problem, line_of
from onpath.lessons.prose import data_faults, own_picture, read_prose, text_faults
from onpath.lessons.rendered import rendered
from onpath.lessons.schema import (
    Block,
    Derivation,
    Front,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Step,
    StepKind,
    StepMark,
    Text,
)
from onpath.lessons.symbols import symbol_faults
from onpath.lessons.task_schema import Task
from onpath.lessons.text_files import FileError, load_toml, read_text
from onpath.lessons.toml_blocks import read_checked, read_toml
from onpath.lessons.vocabulary.blocks import (
    choice_faults,
    derivation_faults,
    number_faults,
    prediction_faults,
    task_faults,
)
from onpath.lessons.vocabulary.fences import FENCES
from onpath.lessons.vocabulary.setups import release_faults, script_faults, setup_faults

NO_MARK, NO_WORDS = StepMark(), Markup()
KINDS: tuple[str, ...] = get_args(StepKind)
HEADING = re.compile(r"(\w+):\s*(.+)")
FOLD = re.compile(r"fold(?:\s+(.*))?")
BRANCH = re.compile(r"when(?:\s+(.*))?")


@dataclass(slots=True)
class _Draft:
    """A step that is being read."""

    kind: str
    title: str
    line: int
    blocks: list[Block]
    setup: StepSetup | None = None
    script: Script | None = None
    mark: StepMark = NO_MARK
    watch: Markup = NO_WORDS
    notes: Markup = NO_WORDS
    fences: set[str] = field(default_factory=set[str])  # names of its blocks of TOML
    broken: bool = False  # whether one of its blocks could not be read

    def step(self, stated: Iterable[Stated], behaviours: Iterable[Behaviour]) -> Step:
        kind: Any = self.kind
        blocks, when = tuple(self.blocks), self.mark.when
        return Step(
            kind=kind,
            title=self.title,
            line=self.line,
            blocks=blocks,
            setup=self.setup,
            script=self.script,
            optional=self.mark.optional or bool(when),
            when=when,
            stated=tuple(stated),
            behaviours=tuple(behaviours),
            watch=self.watch,
            notes=self.notes,
        )


def read_lesson(path: Path) -> Lesson:
    """Read the lesson in a file.

    Raises:
        LessonError: with file, line and text of every problem.
    """
    try:
        text = read_text(path)
    except FileError as error:
        raise LessonError([error.problem]) from None
    return _Reader(path, text).lesson()


class _Reader:
    """Reads one lesson file and collects its problems."""

    def __init__(self, path: Path, text: str) -> None:
        self._path, self._folder = path, path.parent.name
        self._problems: list[Problem] = []
        text, self._stated = take_stated(text, self._complain)
        self._text, self._behaviours = take_behaviours(text, self._complain)
        self._markdown = reader()
        self._robot = self._home = "five_bar"
        self._setup = StepSetup()
        self._ids: set[str] = set()  # of tasks
        self._branches: dict[tuple[int, str], int] = {}  # step's line, condition -> its line

    def lesson(self) -> Lesson:
        """Read the whole file.

        Raises:
            LessonError: there is any problem.
        """
        front, first = self._front()
        body = self._text.split("\n", first)[first] if first else self._text
        steps = self._steps(body, first)
        if front is not None:
            for fault in first_page_faults(front, self._made(steps)):
                self._complain(line_of(fault, self._text, 1), fault)
        if not self._problems and front is not None:
            name, language = self._path.parent.name, self._path.stem
            made = self._made(steps)
            return Lesson(
                name=name,
                language=language,
                front=front,
                steps=made,
                keys=keys_of(made),
                version=fingerprint(self._text),
            )
        raise LessonError(self._problems)

    def _made(self, drafts: list[_Draft]) -> tuple[Step, ...]:
        """The steps, each with what its text states."""
        ends = [*(draft.line for draft in drafts[1:]), float("inf")]
        return tuple(
            draft.step(
                (each for each in self._stated if draft.line <= each.line < end),
                (each for each in self._behaviours if draft.line <= each.line < end),
            )
            for draft, end in zip(drafts, ends, strict=False)
        )

    def _front(self) -> tuple[Front | None, int]:
        """The front matter, and its number of lines."""
        lines = self._text.split("\n")
        ends = [i for i, line in enumerate(lines) if line.rstrip() == "+++"]
        if len(ends) < 2 or ends[0] != 0:
            self._complain(1, "a lesson begins with facts between two lines +++")
            return None, 0
        content = "\n".join(lines[1 : ends[1]])
        for mark in (*self._stated, *self._behaviours):
            if mark.line <= ends[1]:
                self._complain(
                    mark.line, f"{mark.text!r}: a mark stands in a step, whose run it is of"
                )
        front = read_toml(content, 2, Front, self._complain)
        self._complain_all(2, _words_faults(content))
        if front is not None:
            self._complain_all(1, setup_faults(StepSetup(robot=front.robot), front.robot))
            self._complain_all(1, symbol_faults(front.symbols))
            self._robot = self._home = front.robot
            try:
                front = rendered(front)
                if front.picture:
                    front = replace(front, picture=own_picture(front.picture, self._path.parent))
            except ValueError as error:
                self._complain(2, str(error))
        return front, ends[1] + 1

    def _steps(self, body: str, first: int) -> list[_Draft]:
        drafts: list[_Draft] = []
        for tokens in _sections(self._markdown.parse(body)):
            head = tokens[0]
            line = first + (head.map[0] if head.map else 0) + 1
            if head.type == "heading_open" and head.tag == "h1":
                drafts.append(self._begin(tokens[1].content, line))
            elif not drafts:
                self._complain(line, "before the first step: a step begins with `# kind: Title`")
            elif head.type == "fence" and head.info.strip() in FENCES:
                self._fence(drafts[-1], head.info.strip(), head.content, line + 1)
            elif head.type == "fence" and (fold := FOLD.fullmatch(head.info.strip())):
                self._fold(drafts[-1], fold[1] or "", head.content, line + 1)
            elif head.type == "fence" and (branch := BRANCH.fullmatch(head.info.strip())):
                self._branch(drafts[-1], branch[1] or "", head.content, line + 1)
            elif head.type == "fence" and head.info.strip() in ("watch", "notes"):
                read = self._watch if head.info.strip() == "watch" else self._notes
                read(drafts[-1], head.content, line + 1)
            else:
                self._prose(drafts[-1], tokens, line)
        broken = {draft.line for draft in drafts if draft.broken}
        steps = self._made(drafts)
        for line, fault in [*self._lacks(steps, broken), *order_faults(steps, broken)]:
            self._complain(line, fault)
        for line, when, fault in faults_of_when(steps):
            self._complain(self._branches.get((line, when), line), fault)
        for line, words, fault in unanswered(steps):
            self._complain(self._line_of(words, line), fault)
        return drafts

    def _lacks(self, steps: Sequence[Step], broken: set[int]) -> Iterable[tuple[int, str]]:
        """What a lesson lacks as a whole; of the test and of a lecture, less is asked."""
        if self._folder in FOLDERS:
            return ((1, fault) for fault in lacks_of_test(steps))
        return lacks(steps, broken, () if self._folder == LECTURE else NEEDED)

    def _line_of(self, words: str, first: int) -> int:
        """The first line from `first` on that contains some words; `first` if there is none."""
        lines = enumerate(self._text.split("\n")[first - 1 :], first)
        return next((number for number, line in lines if words in line), first)

    def _begin(self, heading: str, line: int) -> _Draft:
        match = HEADING.fullmatch(heading.strip())
        if match is None or match[1] not in KINDS:
            self._complain(
                line, f"heading {heading!r}: `# kind: Title`, kind one of {', '.join(KINDS)}"
            )
            return _Draft("play", heading, line, [])
        self._complain_all(line, text_faults(match[2]))
        return _Draft(match[1], match[2], line, [])

    def _fence(self, draft: _Draft, what: str, content: str, line: int) -> None:
        """Read a fenced block of TOML."""
        before = len(self._problems)
        if what in draft.fences and what in ("step", "scene", "script"):
            self._complain(line - 1, f"a second {what} in step {draft.title!r}: only one is used")
        draft.fences.add(what)
        self._complain_all(line, _words_faults(content))
        if what == "step":
            draft.mark = self._checked(content, line, StepMark, lambda _: ()) or draft.mark
        elif what == "scene":
            draft.setup = self._checked(content, line, StepSetup, self._setup_faults)
        elif what == "script":
            draft.script = self._checked(content, line, Script, self._script_faults)
        elif what == "equations":
            self._equations(draft, self._checked(content, line, Part, lambda _: ()), line)
        else:
            kinds: dict[str, tuple[Any, Callable[[Any], Iterable[str]]]] = {
                "predict": (Prediction, prediction_faults),
                "task": (Task, self._task_faults),
                "quiz": (Quiz, self._quiz_faults),
                "number": (NumberQuestion, number_faults),
                "open": (OpenQuestion, lambda _: ()),
                "derivation": (Derivation, derivation_faults),
            }
            self._add(draft, self._checked(content, line, *kinds[what]), line)
        draft.broken |= len(self._problems) > before

    def _add(self, draft: _Draft, block: Block | None, line: int) -> None:
        if block is None:
            return
        try:
            draft.blocks.append(rendered(block))
        except TextError as error:
            self._complain(line, str(error))

    def _setup_faults(self, setup: StepSetup) -> Iterator[str]:
        self._setup = setup.after(self._setup)
        self._robot = self._setup.robot or self._home
        return setup_faults(self._setup, self._robot)

    def _script_faults(self, script: Script) -> Iterator[str]:
        yield from script_faults(script, self._robot)
        yield from release_faults(script)

    def _task_faults(self, task: Task) -> Iterator[str]:
        yield from task_faults(task, self._robot)
        if task.id in self._ids:
            yield f"id {task.id!r}: another task has it"
        self._ids.add(task.id)

    def _quiz_faults(self, quiz: Quiz) -> Iterator[str]:
        yield from choice_faults(quiz)
        if quiz.second is not None and self._folder in FOLDERS:
            yield "second: the concept test asks everything once"

    def _fold(self, draft: _Draft, title: str, content: str, line: int) -> None:
        """Read a fenced block of Markdown that is shown when its title is pressed."""
        if not title:
            self._complain(line, "a fold needs a title: ```fold I cannot play: tell me")
        self._complain_all(line - 1, text_faults(title))
        self._prose(draft, self._markdown.parse(content), line, title)

    def _equations(self, draft: _Draft, part: Part | None, line: int) -> None:
        """Put a part of the paper's equations into a fold."""
        file = self._path.parent.parent / FILE
        try:
            known = read_equations(file)
        except (FileError, ValueError, KeyError) as error:
            self._complain(line, f"{file}: {error}")
            return
        found = [each for each in known if part and part.first <= each.number <= part.last]
        if not found:
            self._complain(line, f"{FILE} has no equation with such a number")
            return
        title, table = equations_table(found, self._path.stem)
        self._fold(draft, title, table, line)

    def _branch(self, draft: _Draft, when: str, content: str, line: int) -> None:
        """Read a fenced block of Markdown that is shown only after certain answers."""
        if not when:
            self._complain(line, "a branch needs an answer: ```when wrong")
        self._branches[draft.line, when] = line - 1
        self._prose(draft, self._markdown.parse(content), line, when=when)

    def _watch(self, draft: _Draft, content: str, line: int) -> None:
        """Read a fenced block of Markdown that says what to look at during the run."""
        if draft.watch:
            self._complain(line - 1, f"a second watch in step {draft.title!r}: only one is used")
        if draft.kind != "run":
            self._complain(
                line - 1, f"a watch stands in a `run` step, and this is a {draft.kind!r} step"
            )
        if "{{" in content:
            self._complain(line, "a watch has no numbers of the student")
        read = read_prose(
            self._markdown, self._markdown.parse(content), self._path.parent, self._robot
        )
        if not read.html or read.links:
            self._complain(line - 1, "a watch is a sentence or two, without lab links")
        self._complain_all(line, (fault for _, fault in read.faults))
        draft.watch = read.html

    def _notes(self, draft: _Draft, content: str, line: int) -> None:
        """Read a fenced block of Markdown for the lecturer."""
        if self._folder != LECTURE:
            self._complain(line - 1, "notes stand in a lecture: students read a lesson")
        read = read_prose(
            self._markdown, self._markdown.parse(content), self._path.parent, self._robot
        )
        if draft.notes or not read.html or read.links:
            self._complain(line - 1, "a slide has one block of notes, with words and no lab links")
        self._complain_all(line, (fault for _, fault in read.faults))
        draft.notes = read.html

    def _prose(
        self, draft: _Draft, tokens: list[Token], line: int, fold: str = "", when: str = ""
    ) -> None:
        """Read a part of a text; a lab link or a condition ends the block of text."""
        read = read_prose(self._markdown, tokens, self._path.parent, self._robot, fold)
        for below, fault in read.faults:
            self._complain(line + below, fault)
            draft.broken |= tokens[0].type == "fence"
        last = draft.blocks[-1] if draft.blocks else None
        if isinstance(last, Text) and not last.links and last.when == when:
            draft.blocks[-1] = Text(last.html + read.html, tuple(read.links), when)
        else:
            draft.blocks.append(read.text(when))

    def _checked(
        self, content: str, line: int, kind: Any, faults: Callable[[Any], Iterable[str]]
    ) -> Any:
        return read_checked(content, line, kind, faults, self._complain)

    def _complain(self, line: int, text: str) -> None:
        self._problems.append(Problem(str(self._path), line, text))

    def _complain_all(self, line: int, texts: Iterable[str]) -> None:
        for text in texts:
            self._complain(line, text)


def _sections(tokens: list[Token]) -> Iterator[list[Token]]:
    """Splits tokens into top-level blocks."""
    section: list[Token] = []
    depth = 0
    for token in tokens:
        section.append(token)
        depth += token.nesting
        if depth == 0:
            yield section
            section = []


def _words_faults(content: str) -> Iterator[str]:
    """The faults of the texts in a block of TOML; none if it cannot be read: that is reported."""
    try:
        yield from data_faults(load_toml(content))
    except tomllib.TOMLDecodeError:
        return
