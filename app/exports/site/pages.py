"""The pages of the static site as HTML."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, Literal

from onpath.app.common.product import product_version
from onpath.app.common.templates import environment, json_block
from onpath.app.exports.site.step_data import SiteStep
from onpath.app.exports.site.task_data import check_words
from onpath.app.exports.standalone.figure_words import CHART
from onpath.app.exports.standalone.page_style import page_style
from onpath.app.steps.player_words import player_words
from onpath.app.steps.step_html import live
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.schema import Lesson
from onpath.lessons.words import Words, language_name

POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
    "img-src 'self' data:; font-src 'self'; base-uri 'none'; form-action 'none'"
)
"""The pages' Content-Security-Policy: only scripts and styles of the site, no eval except
WebAssembly, pictures of the site and of the lessons' texts, the site's font for formulas, no
requests to other servers."""
MESSAGES = (
    *("lesson.begin_here", "lesson.go_on_here"),
    *("lesson.finish", "lesson.next", "lesson.skip", "report.not_happened"),
    *("site.forgotten", "site.forget_sure", "site.read_done", "site.no_progress", "site.not_kept"),
    *("site.no_platform", "site.no_room", "site.skip_short"),
    *("site.review", *CHART),
)


Version = Literal["1.2", "2004"]


@dataclass(frozen=True, slots=True)
class Package:
    """What kind of SCORM package a page belongs to.

    Attributes:
        partial: whether an unfinished lesson gets a score, too.
    """

    version: Version
    partial: bool = False


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of a run: its file, and a description in words."""

    address: str
    text: str


@dataclass(frozen=True, slots=True)
class LessonEntry:
    """A lesson in the list of the start page."""

    number: str
    lesson: Lesson
    address: str
    facts: list[str]


def start_page(
    words: Words,
    figure: dict[str, Any],
    entries: list[LessonEntry],
    lecture: str,
    around: dict[str, Any],
) -> str:
    """The start page.

    Args:
        figure: data of the free lab's figure.
        lecture: address of the lecture; empty if there is none.
        around: fields of every page: the address of its start page, and its other languages.
    """
    lessons = {
        entry.lesson.name: {
            "number": entry.number,
            "steps": len(entry.lesson.steps),
            "required": entry.lesson.required_steps(),
            "tasks": [task.id for task in entry.lesson.required_tasks()],
        }
        for entry in entries
    }
    data = {"words": _messages(words), "lesson": "", "figures": [figure], "lessons": lessons}
    fields = {"description": words("site.intro"), "entries": entries, "lecture": lecture}
    return _page("start", words, words("site.title"), data, around, **fields)


def entry_of(lesson: Lesson, number: str, address: str, words: Words) -> LessonEntry:
    """A lesson's entry in the list of the start page."""
    facts = [words("lesson.minutes", minutes=lesson_minutes(lesson))]
    if lesson.language != words.language:
        facts.append(words("lesson.english"))
    return LessonEntry(number=number, lesson=lesson, address=address, facts=facts)


def lesson_page(
    lesson: Lesson,
    number: str,
    steps: list[SiteStep],
    pictures: dict[int, Picture],
    following: dict[str, str] | None,
    words: Words,
    around: dict[str, Any],
    scorm: Package | None = None,
) -> str:
    """The page of a lesson, or of the lecture.

    Args:
        number: of the lesson; empty for the lecture.
        steps: the steps; their figures have names of files in place of modules.
        pictures: pictures by number of the step.
        following: address and title of the next lesson, if there is one.
        scorm: the SCORM package to which the page belongs, if any.
    """
    figures = list[dict[str, Any]]()
    for step in steps:
        remade = (each for values in step.remade.values() for each in values.values())
        for each in (step.figure, *remade):
            if each not in figures:
                figures.append(each)
    data = {
        "words": _messages(words) | check_words(words),
        "lesson": lesson.name,
        "version": lesson.version,
        "product": product_version(),
        "symbols": {name: words(f"symbol.{name}") for name in lesson.front.symbols},
        "scorm": scorm and asdict(scorm),
        "figures": figures,
        "steps": [
            {
                **step.data,
                "figure": figures.index(step.figure),
                "remade": {
                    name: {value: figures.index(each) for value, each in values.items()}
                    for name, values in step.remade.items()
                },
            }
            for step in steps
        ],
    }
    heading = f"{number}. {lesson.front.title}" if number else lesson.front.title
    fields = {"lesson": lesson, "heading": heading, "steps": steps, "pictures": pictures}
    fields |= {"description": lesson.front.summary, "next": following}
    fields["live"] = partial(live, lesson)
    name, title = "lesson" if number else "lecture", f"{heading} · OnPath"
    return _page(name, words, title, data, around, **fields)


def site_style() -> str:
    """The style sheet of all pages."""
    return page_style("site/site.css")


def _page(
    name: str, words: Words, title: str, data: Any, around: dict[str, Any], **fields: Any
) -> str:
    fields |= {"words": words, "title": title, "policy": POLICY, "data": json_block(data)}
    fields["language_name"] = language_name
    return environment().get_template(f"site/{name}.html").render({**fields, **around})


def _messages(words: Words) -> dict[str, str]:
    """The messages of a page's script; it fills in the {names} in them."""
    messages = player_words(words) | {key: words(key) for key in MESSAGES}
    messages["lesson.step"] = words("lesson.step", step="{step}", steps="{steps}")
    messages["site.done"] = words("site.done", done="{done}", all="{all}", tasks="{tasks}")
    messages["site.refused"] = words("site.refused", reason="{reason}")
    messages["site.cut"] = words("site.cut", most="{most}")
    return messages | {"point": words("report.point")}
