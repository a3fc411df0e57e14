"""Reads a lesson file into a `Lesson`, or reports all problems with file and line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, get_args

from markdown_it.token import Token
from markupsafe import Markup

from onpath.lessons import vocabulary
from onpath.lessons.action_schema import Script, StepSetup
from onpath.lessons.completeness import lacks
from onpath.lessons.concept_test.concept_test import FOLDER, lacks_of_test
from onpath.lessons.formulas import FormulaError, embedded, folded, reader, render
from onpath.lessons.kept.option_keys import keys_of
from onpath.lessons.links import read_link
from onpath.lessons.problems import LessonError, Problem
from onpath.lessons.rendered import rendered
from onpath.lessons.schema import (
    Block,
    Front,
    LabLink,
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
from onpath.lessons.task_schema import Task
from onpath.lessons.toml_blocks import read_checked, read_toml

LARGEST = 1_000_000
"""Largest size of a lesson file, [B]."""
KINDS: tuple[str, ...] = get_args(StepKind)
FENCES = ("step", "scene", "script", "predict", "task", "quiz", "number", "open")
KNOWN = (*FENCES, "fold")
HEADING = re.compile(r"(\w+):\s*(.+)")
FOLD = re.compile(r"fold\b\s*(.*)")


@dataclass(slots=True)
class _Draft:
    """A step that is being read."""

    kind: str
    title: str
    line: int
    blocks: list[Block]
    scene: StepSetup | None = None
    script: Script | None = None
    optional: bool = False
    broken: bool = False  # whether one of its blocks could not be read

    def step(self) -> Step:
        kind: Any = self.kind
        blocks = tuple(self.blocks)
        parts = self.scene, self.script, self.optional
        return Step(kind, self.title, self.line, blocks, *parts)


def read_lesson(path: Path) -> Lesson:
    """Read the lesson in a file.

    Raises:
        LessonError: with file, line and text of every problem.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise LessonError([Problem(str(path), 1, f"larger than {LARGEST // 1000} kB")])
        text = path.read_text("utf-8-sig")  # Windows Notepad writes a byte-order mark
    except OSError as error:
        raise LessonError([Problem(str(path), 1, error.strerror or "cannot be read")]) from None
    except UnicodeDecodeError as error:
        raise LessonError([Problem(str(path), 1, f"not UTF-8 text: {error.reason}")]) from None
    return _Reader(path, text).lesson()


class _Reader:
    """Reads one lesson file and collects its problems."""

    def __init__(self, path: Path, text: str) -> None:
        self._path = path
        self._text = text
        self._problems: list[Problem] = []
        self._markdown = reader()
        self._robot = self._home = "five_bar"
        self._scene = StepSetup()

    def lesson(self) -> Lesson:
        """Read the whole file.

        Raises:
            LessonError: there is any problem.
        """
        front, first = self._front()
        body = self._text.split("\n", first)[first] if first else self._text
        steps = self._steps(body, first)
        if not self._problems and front is not None:
            name, language = self._path.parent.name, self._path.stem
            made = tuple(draft.step() for draft in steps)
            return Lesson(name, language, front, made, keys_of(made))
        raise LessonError(self._problems)

    def _front(self) -> tuple[Front | None, int]:
        """The front matter and the number of lines it takes."""
        lines = self._text.split("\n")
        ends = [i for i, line in enumerate(lines) if line.rstrip() == "+++"]
        if len(ends) < 2 or ends[0] != 0:
            self._complain(1, "a lesson begins with facts between two lines +++")
            return None, 0
        front = read_toml("\n".join(lines[1 : ends[1]]), 2, Front, self._complain)
        if front is not None:
            self._complain_all(
                1, vocabulary.scene_faults(StepSetup(robot=front.robot), front.robot)
            )
            self._robot = self._home = front.robot
            try:
                front = rendered(front)
            except FormulaError as error:
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
                self._fold(drafts[-1], fold[1], head.content, line + 1)
            elif head.type == "fence" and (near := get_close_matches(head.info, KNOWN, 1)):
                self._complain(line, f"unknown block {head.info.strip()!r}: did you mean {near[0]}")
            else:
                self._prose(drafts[-1], tokens, line)
        broken = {draft.line for draft in drafts if draft.broken}
        steps = [draft.step() for draft in drafts]
        is_test = self._path.parent.name == FOLDER
        self._complain_all(1, lacks_of_test(steps) if is_test else lacks(steps, broken))
        return drafts

    def _begin(self, heading: str, line: int) -> _Draft:
        match = HEADING.fullmatch(heading.strip())
        if match is None or match[1] not in KINDS:
            self._complain(
                line, f"heading {heading!r}: `# kind: Title`, kind one of {', '.join(KINDS)}"
            )
            return _Draft("play", heading, line, [])
        return _Draft(match[1], match[2], line, [])

    def _fence(self, draft: _Draft, what: str, content: str, line: int) -> None:
        """Read a fenced block of TOML."""
        before = len(self._problems)
        if what == "step":
            mark = self._checked(content, line, StepMark, lambda _: ())
            draft.optional = mark is not None and mark.optional
        elif what == "scene":
            draft.scene = self._checked(content, line, StepSetup, self._scene_faults)
        elif what == "script":
            draft.script = self._checked(content, line, Script, self._script_faults)
        else:
            kinds: dict[str, tuple[Any, Callable[[Any], Iterable[str]]]] = {
                "predict": (Prediction, vocabulary.prediction_faults),
                "task": (Task, self._task_faults),
                "quiz": (Quiz, _quiz_faults),
                "number": (NumberQuestion, vocabulary.number_faults),
                "open": (OpenQuestion, lambda _: ()),
            }
            self._add(draft, self._checked(content, line, *kinds[what]), line)
        draft.broken |= len(self._problems) > before

    def _add(self, draft: _Draft, block: Block | None, line: int) -> None:
        if block is None:
            return
        try:
            draft.blocks.append(rendered(block))
        except FormulaError as error:
            self._complain(line, str(error))

    def _scene_faults(self, scene: StepSetup) -> Iterator[str]:
        self._scene = scene.after(self._scene)
        self._robot = self._scene.robot or self._home
        return vocabulary.scene_faults(self._scene, self._robot)

    def _script_faults(self, script: Script) -> Iterator[str]:
        return vocabulary.script_faults(script, self._robot)

    def _task_faults(self, task: Task) -> Iterator[str]:
        return vocabulary.task_faults(task, self._robot)

    def _fold(self, draft: _Draft, title: str, content: str, line: int) -> None:
        """Read a fenced block of Markdown that is shown when its title is pressed."""
        if not title:
            self._complain(line, "a fold needs a title: ```fold I cannot play: tell me")
        self._prose(draft, self._markdown.parse(content), line, title)

    def _prose(self, draft: _Draft, tokens: list[Token], line: int, fold: str = "") -> None:
        """Read a paragraph, list, table or picture; lab links end the text block.

        Args:
            fold: a title, for a text that is shown when it is pressed.
        """
        links: list[LabLink] = []
        for token in tokens:
            for child in token.children or ():
                if child.type == "image":
                    self._embed(child, line)
            links += self._links(token.children or [], line)
        try:
            html = render(self._markdown, tokens)
        except FormulaError as error:
            self._complain(line, str(error))
            return
        if links and not _has_prose(tokens):
            html = Markup()  # the buttons show the same words
        if fold:
            html = folded(fold, html)
        last = draft.blocks[-1] if draft.blocks else None
        if isinstance(last, Text) and not last.links:
            draft.blocks[-1] = Text(last.html + html, tuple(links))
        else:
            draft.blocks.append(Text(html, tuple(links)))

    def _embed(self, image: Token, line: int) -> None:
        source = str(image.attrGet("src") or "")
        picture = (self._path.parent / source).resolve()
        try:
            if not picture.is_relative_to(self._path.parent.resolve()):
                raise ValueError(f"picture {source!r} is not in the lesson's folder")
            image.attrSet("src", embedded(picture))
        except OSError:
            self._complain(line, f"no picture {source!r}")
        except ValueError as error:
            self._complain(line, str(error))

    def _links(self, children: list[Token], line: int) -> Iterator[LabLink]:
        """Lab links of a text; in the text their words become bold instead of links."""
        for i, token in enumerate(children):
            if token.type != "link_open":
                continue
            address = str(token.attrGet("href") or "")
            if address.startswith("https://"):
                token.attrSet("target", "_blank")
                token.attrSet("rel", "noopener noreferrer")
                continue
            end = next(j for j in range(i, len(children)) if children[j].type == "link_close")
            label = "".join(child.content for child in children[i + 1 : end])
            token.tag = children[end].tag = "strong"
            token.attrs = {}
            _separate(children[end + 1 : end + 3])
            try:
                actions = read_link(address)
            except ValueError as error:
                self._complain(line, str(error))
                continue
            for action in actions:
                self._complain_all(line, vocabulary.action_faults(action, self._robot))
            yield LabLink(label, actions)

    def _checked(
        self, content: str, line: int, kind: Any, faults: Callable[[Any], Iterable[str]]
    ) -> Any:
        return read_checked(content, line, kind, faults, self._complain)

    def _complain(self, line: int, text: str) -> None:
        self._problems.append(Problem(str(self._path), line, text))

    def _complain_all(self, line: int, texts: Iterable[str]) -> None:
        for text in texts:
            self._complain(line, text)


def _separate(after: list[Token]) -> None:
    """Put a comma between a link and one that follows it directly: their words would run together.

    Args:
        after: the two tokens after the link.
    """
    kinds = [token.type for token in after]
    if kinds == ["text", "link_open"] and not after[0].content.strip():
        after[0].content = ", "


def _has_prose(tokens: list[Token]) -> bool:
    """Whether there is any text outside links."""
    inline = [child for token in tokens for child in token.children or ()]
    return any(child.level == 0 and child.content.strip(" \u00a0,.;:·|") for child in inline)


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


def _quiz_faults(quiz: Quiz) -> Iterator[str]:
    return vocabulary.option_faults([option.right for option in quiz.options])
