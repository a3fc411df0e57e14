"""What opens over a page: laws that hold for every robot and language."""

from __future__ import annotations

import math
from typing import Any, get_args

import msgspec
import pytest

from onpath.app.channel.messages import LabMessage, encoded
from onpath.app.channel.reading import read_message
from onpath.app.channel.sheet_messages import Index, LessonSheet, SheetName
from onpath.app.exports.comparison import outcomes_of
from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import command_from, message_of
from onpath.app.lab.lab import Command
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.comparing import MOST, compare_sheet, compared
from onpath.app.view.keys import KEYS, shown_keys
from onpath.app.view.laws import law_sheet, suitable
from onpath.app.view.lessons import lesson_sheet
from onpath.app.view.robots import robot_sheet
from onpath.app.view.sheets import SheetContext, sheet_of
from onpath.assets.messages import languages
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.laws.expressions import FUNCTIONS
from onpath.models.control.laws.own import SPACE, VIEW
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.curves import circle
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, new_lab

COURSE, _ = built_in_course()
CONTEXT = SheetContext(
    course=COURSE, code="ab", days=30, preferences={"speaks": True, "sounds": False}
)
MARKUP = "<img src=x onerror=alert(1)>"


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("what", get_args(SheetName))
def test_every_sheet_is_a_message_of_its_name(what: SheetName, language: str) -> None:
    lab = new_lab(0.1)
    do(lab, c.ChooseRobot("spatial_arm"))
    sheet = sheet_of(what, take_page_snapshot(lab, 1.0), Words(language), CONTEXT)
    text = encoded(sheet)
    assert msgspec.json.decode(text)["is"] == what
    assert msgspec.json.decode(text, type=type(sheet)) == sheet and isinstance(sheet, LabMessage)


def test_a_command_with_plain_fields_is_read_back_from_its_message() -> None:
    for key in KEYS:
        if key.command is not None:
            text = msgspec.json.encode(message_of(key.command)).decode()
            assert command_from(text) == key.command


@pytest.mark.parametrize("words", [Words(language) for language in languages()])
def test_every_key_and_everything_that_is_found_sends_what_a_page_may_send(words: Words) -> None:
    lab = new_lab(0.1)
    found = sheet_of("index", take_page_snapshot(lab, 1.0), words, CONTEXT)
    assert isinstance(found, Index) and len(found.keys) == len(KEYS)
    combinations = [(key.key, key.control) for key in found.keys]
    assert len(set(combinations)) == len(combinations)
    for send in [key.send for key in found.keys] + [m for each in found.found for m in each.send]:
        read_message(msgspec.json.encode(send).decode())
    kinds: dict[str, list[str]] = {}
    for each in found.found:
        kinds.setdefault(each.kind, []).append(each.label)
    laws = [law for law in LAWS.values() if law.suits(lab.simulation.robot.system)]
    assert len(kinds["robot"]) == len(ROBOTS) and len(kinds["path"]) == len(presets())
    assert len(kinds["law"]) == 2 * len(laws) and len(kinds["lesson"]) == len(COURSE.lessons)
    assert all(len(set(labels)) == len(labels) for labels in kinds.values())


def test_a_key_that_opens_a_lesson_needs_one() -> None:
    assert [k.name for k in shown_keys(ENGLISH, "")] == [k.name for k in KEYS if k.name != "lesson"]


@pytest.mark.parametrize("words", [Words(language) for language in languages()])
def test_robots_differ_in_at_most_six_words_and_have_small_pictures(words: Words) -> None:
    cards = robot_sheet(words).robots
    assert [card.name for card in cards] == list(ROBOTS)
    assert len({card.differs for card in cards}) == len(cards)
    ours = [card for card in cards if ROBOTS[card.name].picture]  # others may come from files
    assert len(ours) >= 8
    for card in ours:
        assert 1 <= len(card.differs.split()) <= 6, card.differs
        assert card.picture.startswith("data:image/webp;base64,") and len(card.picture) < 20_000


def test_a_lesson_is_finished_when_its_steps_are_seen_and_its_tasks_passed() -> None:
    name, versions = next(iter(COURSE.lessons.items()))
    lesson = versions["en"]
    tasks = {task.id: 0.0 for task in lesson.required_tasks()}

    def card(notes: dict[str, Notes]) -> Any:
        sheet = lesson_sheet(LessonState(COURSE, Progress(notes=notes), ENGLISH))
        assert isinstance(sheet, LessonSheet)
        return next(each for each in sheet.lessons if each.name == name)

    new, begun = card({}), card({name: Notes(seen=1)})
    assert (new.done, new.begun, new.finished) == (0.0, False, False)
    assert 0 < begun.done < 1 and begun.begun and not begun.finished
    all_seen = card({name: notes_with(seen=len(lesson.steps))})
    assert begun.done < all_seen.done < 1 and not all_seen.finished
    done = card({name: notes_with(seen=len(lesson.steps), tasks=tasks)})
    assert done.done == 1 and done.finished


def test_the_first_lesson_is_the_first_card() -> None:
    cards = lesson_sheet(LessonState(COURSE, Progress(), ENGLISH)).lessons
    assert [card.name for card in cards] == [*COURSE.lessons, BEFORE, AFTER]


@pytest.mark.parametrize("words", [Words(language) for language in languages()])
def test_every_lesson_has_a_small_picture_of_its_own(words: Words) -> None:
    cards = lesson_sheet(LessonState(COURSE, Progress(), words)).lessons
    pictures = [card.picture for card in cards if card.number]
    assert len(pictures) == len(set(pictures)) == len(COURSE.lessons)
    for each in pictures:
        assert each.startswith("data:image/svg+xml;base64,") and len(each) < 2000


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("robot", ["five_bar", "spatial_arm"])
def test_the_sheet_of_laws_tells_every_law_and_every_name(robot: str, language: str) -> None:
    made = ROBOTS[robot].make(ROBOTS[robot].parameters())
    spatial = made.system.p == 3
    sheet = law_sheet(made, Words(language))
    assert [law.name for law in sheet.laws] == suitable(made)
    for law in sheet.laws:
        assert LAWS[law.name].source.split(",")[0] in law.source
        assert all((law.label, law.does, law.good, law.limits, law.objection))
    names = {name for each in sheet.names for name in each.names.split(", ")}
    assert names == {*VIEW, *(SPACE if spatial else ())}
    text = " ".join(sheet.own)
    assert all(name in text for name in FUNCTIONS)
    assert ("across2" in text) == spatial


def test_compared_laws_have_numbers_and_a_curve_whose_largest_value_they_state() -> None:
    laws = ["path_following", "trajectory_tracking", "u1 = 9; u2 = 0"]
    found = {
        law: outcomes_of("five_bar", FIVE_BAR.parameters(), circle(0.05), law, "brake")
        for law in laws
    }
    robot = FIVE_BAR.make(FIVE_BAR.parameters())
    for count in range(len(laws) + 1):
        some = {law: found[law] for law in laws[:count]}
        told = compared(some, laws, "brake", robot, ENGLISH)
        assert [row.law for row in told.rows] == laws[:count] and told.all == len(laws)
    told = compared(found, laws, "brake", robot, ENGLISH)
    assert told.acts == (0.5, 2.5) and b"null" not in encoded(told)
    follower, tracker, stopped = told.rows
    assert stopped.stopped and stopped.distance == 0
    for row in (follower, tracker):
        assert math.isclose(max(row.curve), row.distance, rel_tol=0.02)
        assert math.isclose(row.step * (len(row.curve) - 1), 4.5, abs_tol=row.step)
    assert follower.distance < 5 < tracker.distance and follower.delay > tracker.delay


def test_laws_that_are_compared_are_those_that_move_along_and_those_that_are_typed() -> None:
    robot = FIVE_BAR.make(FIVE_BAR.parameters())
    typed = "u1 = 1; u2 = 0"
    names = [
        law.name for law in compare_sheet(robot, {"left": typed, "right": typed}, ENGLISH).laws
    ]
    assert names.count(typed) == 1 and len(names) == len(set(names))
    assert all(LAWS[name].travels for name in names if name != typed)
    sheet = compare_sheet(robot, {"left": "contouring", "right": "path_following"}, ENGLISH)
    chosen = {law.name for law in sheet.laws if law.chosen}
    assert {"contouring", "path_following"} <= chosen and len(chosen) <= MOST


def test_a_message_of_a_key_is_a_command() -> None:
    for key in shown_keys(ENGLISH, MARKUP):
        read = read_message(msgspec.json.encode(key.send).decode())
        assert isinstance(read, Command) == (key.name not in ("view", "summary"))
