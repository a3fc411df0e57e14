"""What opens over the page, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Literal

from msgspec import Struct

from onpath.app.channel.sheet_messages import (
    ClassMessage,
    DisplaySheet,
    KeepSheet,
    LanguageName,
    SheetName,
)
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.view.comparing import compare_sheet
from onpath.app.view.help import help_sheet
from onpath.app.view.laws import law_sheet
from onpath.app.view.lessons import lesson_sheet
from onpath.app.view.robots import robot_sheet
from onpath.app.view.search import index
from onpath.lessons.course import Course
from onpath.lessons.words import Words, language_name, languages


@dataclass(frozen=True, slots=True)
class SheetContext:
    """What sheets show besides the lab.

    Attributes:
        course: all lessons.
        code: of the lab, as it is shown.
        days: without use, after which the lab is deleted; 0 if it is not kept.
        preferences: the browser's switches, by name.
    """

    course: Course
    code: str
    days: int
    preferences: Mapping[str, bool]


def sheet_of(
    what: SheetName, snapshot: PageSnapshot, words: Words, context: SheetContext
) -> Struct:
    """What a sheet shows now."""
    robot, course = robot_of(snapshot), context.course
    make: dict[SheetName, Callable[[], Struct]] = {
        "robots": lambda: robot_sheet(words),
        "laws": lambda: law_sheet(robot, words),
        "compare": lambda: compare_sheet(robot, snapshot.run.laws, words),
        "keep": lambda: keep_sheet(context, words),
        "lessons": lambda: lesson_sheet(LessonState(course, snapshot.lesson.progress, words)),
        "help": lambda: help_sheet(words),
        "display": lambda: display_sheet(context.preferences),
        "index": lambda: index(robot, course, words, snapshot.plant is not None),
    }
    return make[what]()


def keep_sheet(context: SheetContext, words: Words) -> KeepSheet:
    """The code of the lab, if it is kept."""
    if not context.days:
        return KeepSheet(code="", until="")
    return KeepSheet(code=context.code, until=words("keep.until", days=context.days))


def display_sheet(preferences: Mapping[str, bool]) -> DisplaySheet:
    """The languages, and what the browser wants to hear."""
    return DisplaySheet(
        languages=[LanguageName(code=code, name=language_name(code)) for code in languages()],
        speaks=preferences["speaks"],
        sounds=preferences["sounds"],
    )


@dataclass(frozen=True, slots=True)
class OwnPlace:
    """What a student has told of oneself in the class; see `ClassMessage`.

    Attributes:
        asks: by what students are to identify themselves: "email", "idnumber" or "username".
        identification: what the student has typed.
        linked: "own" with a word, "shared" if another student has the same one.
    """

    asks: str = ""
    identification: str = ""
    linked: Literal["", "own", "shared"] = ""


ASKED = {
    "email": "class.id_email",
    "idnumber": "class.id_idnumber",
    "username": "class.id_username",
}
"""The label of the field in which a student types each identification."""
NOTHING_TOLD = OwnPlace()


def _stored(words: Words, days: int, class_days: int, today: date) -> str:
    """What is stored of a student, and until when."""
    stored = words("class.stored", days=days)
    if not class_days:
        return stored
    when = (today + timedelta(days=class_days)).strftime(words("class.date"))
    return f"{stored} {words('class.kept_until', days=class_days, date=when)}"


def class_message(
    words: Words,
    code: str | None,
    name: str,
    *,
    longest: int,
    days: int,
    privacy: str,
    class_days: int = 0,
    today: date = date.min,
    away: tuple[str, bool] = ("", False),
    own: OwnPlace = NOTHING_TOLD,
) -> ClassMessage:
    """The lab's place in a class.

    Args:
        code: of the class that the page's address has, which may be empty; None: there is no
            class, or the page is a teacher's.
        name: nickname of a member, or empty.
        longest: see `ClassMessage`.
        days: number of days without use after which the lab is deleted; 0 if it lasts only as long
            as the server.
        privacy: the address of the site's privacy notice; may be empty.
        class_days: number of days without a change after which the class is deleted; 0 if it is not
            stored.
        today: from which these days count.
        away: see `ClassMessage.away` and `asked`.
        own: what the student has told.
    """
    if code is None:
        return ClassMessage(membership="none")
    if not code:
        return ClassMessage(membership="elsewhere")
    return ClassMessage(
        membership="member" if name else "guest",
        code=code.upper(),
        name=name,
        longest=longest,
        stored=_stored(words, days, class_days, today),
        privacy=privacy,
        away=away[0],
        asked=away[1],
        asks=words(ASKED[own.asks]) if own.asks else "",
        identification=own.identification,
        linked=own.linked,
    )
