"""The teacher's page as data: what it shows of a class, and what each of its orders does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.class_messages import Lead, Order
from onpath.app.channel.form_messages import FieldValue, FormField
from onpath.app.channel.messages import encoded
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherChoices, TeacherContext
from onpath.app.classroom.teaching.teacher_form import PREFIX, TeacherForm
from onpath.app.classroom.teaching.teacher_orders import TeacherOrders
from onpath.app.lab.commands import CloseLesson, DemonstrateStep, Set, TakeSetup, TakeStep
from onpath.app.lab.lab import Command
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.share_code import encode
from onpath.app.server.built_in_course import built_in_course
from onpath.app.storage.records import NotKept
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress
from onpath.lessons.words import Words, languages

COURSE = built_in_course()
LESSON = next(iter(COURSE.lessons))
HOSTILE = '<img src=x onerror="alert(1)">'
FIRST, SECOND = "a" * 12, "b" * 12


class Desk:
    """A teacher's page without a server."""

    def __init__(self, language: str = "en") -> None:
        self.room, self.posted = Classroom(lambda: 0.0), list[Command]()
        self.files = dict[str, bytes]()
        self.calls, self.progress = list[str](), Progress(language=language)
        self.presents, self.has_lab = False, True
        for code, name in ((FIRST, HOSTILE), (SECOND, "Bob")):
            self.room.join(code, self.room.code, name)
        words = Words(language)
        self.teaching = TeacherContext(
            classroom=self.room,
            chosen=TeacherChoices(),
            may_lead=lambda: True,
            address="http://192.0.2.7:8080/c/m63eyz/",
            is_local=False,
            has_lab=self.has_lab,
            progress=lambda: self.progress,
            presents=lambda: self.presents,
            why_still=lambda _: "",
            prepare=lambda _: None,
            send_setup=lambda: self.calls.append("send_setup"),
            delete=self.room.leave,
            give_place=lambda code: self.calls.append(f"give_place {code}"),
            forget=self.room.end,
            stop=lambda: self.calls.append("stop"),
        )
        self.orders = TeacherOrders(COURSE, self.teaching, self.posted.append, self._deliver)
        answers = ClassAnswers(COURSE, words, self.teaching, lambda _: None)
        self.form = TeacherForm(COURSE, words, self.teaching, answers)

    def _deliver(self, name: str, make: Callable[[], bytes]) -> None:
        self.files[name] = make()

    def lead(self, order: Order) -> None:
        """Press a button, which must be there."""
        button = self.fields[PREFIX + order]
        assert button.act is not None
        self.orders.lead(Lead(button.act["do"], button.act["member"]))

    def set(self, name: str, value: FieldValue) -> None:
        """Set a field, which must be there."""
        assert PREFIX + name in self.fields
        self.orders.set(PREFIX + name, value)

    @property
    def fields(self) -> dict[str, FormField]:
        return {
            field.name: field for group in self.form.shown()[0].groups for field in group.fields
        }

    @property
    def values(self) -> dict[str, FieldValue]:
        return {name.removeprefix(PREFIX): value for name, value in self.form.shown()[1].items()}


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_each_field_with_a_value_is_told_it_and_each_choice_has_it(desk: Desk) -> None:
    for name, field in desk.fields.items():
        if field.kind in ("button", "note"):
            continue
        value = desk.values[name.removeprefix(PREFIX)]
        assert field.kind != "choice" or value in [option.value for option in field.options]


def test_labs_are_frozen_and_let_go(desk: Desk) -> None:
    desk.lead("freeze")
    assert desk.room.orders.frozen and PREFIX + "freeze" not in desk.fields
    desk.lead("thaw")
    assert not desk.room.orders.frozen


def test_a_setup_is_sent_the_teachers_own_or_that_of_a_code(desk: Desk) -> None:
    desk.lead("send_setup")
    assert desk.calls == ["send_setup"] and "2" in str(desk.values["told"])
    setup = Setup()
    desk.set("setup", encode(setup))
    assert desk.room.orders.push == TakeSetup(setup) and desk.values["standing"]
    desk.lead("end_standing")
    assert desk.room.orders.push is None and desk.values["standing"] == ""
    desk.set("setup", "no code")
    assert desk.room.orders.push is None and desk.teaching.chosen.refused[PREFIX + "setup"]
    desk.set("setup", encode(setup))
    assert not desk.teaching.chosen.refused


def test_a_student_is_followed_renamed_removed_or_deleted(desk: Desk) -> None:
    assert PREFIX + "remove" not in desk.fields
    desk.set("follow", 2.0)
    assert desk.teaching.chosen.followed == SECOND and desk.values["name"] == "Bob"
    assert "Bob" in str(desk.values["who"])
    desk.set("name", "Bert")
    assert desk.values["name"] == "Bert"
    desk.set("name", " ")
    assert desk.teaching.chosen.refused[PREFIX + "name"] and desk.values["name"] == "Bert"
    assert "Bert" in desk.fields[PREFIX + "delete"].asks
    desk.lead("own_lab")
    assert desk.values["follow"] == 0 and desk.values["who"] == ""
    for order, left in (("remove", 1), ("delete", 0)):
        desk.set("follow", 2.0 if left else 1.0)
        desk.lead(order)  # type: ignore[arg-type]
        assert len(desk.room.members()) == left and desk.values["follow"] == 0


def test_the_button_for_one_student_never_acts_on_another(desk: Desk) -> None:
    desk.set("follow", 1.0)
    button = desk.fields[PREFIX + "delete"].act
    desk.set("follow", 2.0)
    assert button is not None
    desk.orders.lead(Lead("delete", button["member"]))
    assert list(desk.room.members()) == [SECOND] and desk.values["follow"] == 2
    desk.orders.lead(Lead("delete", button["member"]))  # who is not there any more
    assert list(desk.room.members()) == [SECOND]


def test_a_teacher_reads_in_german_why_an_order_was_refused() -> None:
    desk = Desk("de")
    desk.set("follow", 1.0)
    desk.set("name", " ")
    refused = desk.teaching.chosen.refused
    assert refused == {f"{PREFIX}name": "ein Spitzname hat mindestens ein Zeichen"}
    desk.set("name", "Eva")
    assert not refused and desk.room.members()[FIRST].name == "Eva"


def test_a_teacher_reads_in_german_what_cannot_be_forgotten() -> None:
    def fails() -> int:
        raise NotKept("error.database", reason="disk full")

    desk = Desk("de")
    teaching = replace(desk.teaching, forget=fails)
    TeacherOrders(COURSE, teaching, desk.posted.append, desk._deliver).lead(Lead("forget", 0))
    assert desk.values["told"] == "die Datenbank meldet: disk full"


def test_the_class_is_led_from_step_to_step(desk: Desk) -> None:
    assert PREFIX + "back" not in desk.fields
    for step in (0, 1):  # a lesson begins with its first step
        desk.lead("next")
        assert desk.room.orders.push == TakeStep(LESSON, step) and desk.values["step"] == step
    desk.lead("back")
    assert desk.room.orders.push == TakeStep(LESSON, 0)
    desk.set("lesson", list(COURSE.lessons)[1])
    desk.set("step", 2.0)
    desk.lead("send_step")
    assert desk.room.orders.push == TakeStep(list(COURSE.lessons)[1], 2)
    desk.set("route", list(COURSE.routes)[-1])
    desk.lead("send_route")
    assert isinstance(desk.room.orders.push, TakeStep)
    assert desk.room.orders.push.route == list(COURSE.routes)[-1]


def test_answers_and_truth_are_shown_and_asked_again(desk: Desk) -> None:
    desk.set("step", 1.0)
    desk.set("revealed", True)
    assert desk.values["shown"] and desk.values["revealed"]  # the truth is among the answers
    desk.set("shown", False)
    assert desk.room.display.revealed and not desk.room.display.shown
    desk.set("picked", "2, 5")
    assert desk.values["picked"] == "2, 5"
    desk.lead("ask_again")
    assert desk.room.orders.push == TakeStep(LESSON, 1, again=True)
    assert not desk.values["shown"] and desk.values["picked"] == ""


@pytest.mark.parametrize("test", COURSE.tests)
def test_a_test_is_not_asked_again_and_its_steps_have_no_titles_of_one_form(
    desk: Desk, test: str
) -> None:
    assert PREFIX + "ask_again" not in desk.fields  # nothing is asked at first
    desk.set("step", 1.0)
    assert PREFIX + "ask_again" in desk.fields
    desk.set("lesson", test)
    assert desk.room.display.lesson == test and PREFIX + "ask_again" not in desk.fields
    titles = [step.title for step in COURSE.lesson(test, "en").steps]
    shown = encoded(desk.form.shown()[0]).decode()
    assert PREFIX + "next" in desk.fields
    assert not [title for title in titles if title in shown]


def test_a_demonstration_is_played_and_the_teachers_lab_put_back(desk: Desk) -> None:
    desk.set("step", 1.0)
    desk.set("follow", 1.0)
    desk.lead("play")
    assert desk.posted == [DemonstrateStep(LESSON, 2)] and desk.teaching.chosen.followed == ""
    desk.progress = Progress(lesson=LESSON)
    desk.lead("put_back")
    assert desk.posted[1:] == [CloseLesson()]
    desk.set("large", True)
    assert desk.posted[2:] == [Set("presenting", True)]


def test_the_class_is_kept_within_steps(desk: Desk) -> None:
    desk.set("pace_lesson", LESSON)
    desk.set("pace_first", 3.0)
    desk.set("pace_last", 1.0)
    desk.lead("keep")
    assert desk.room.orders.pace == Pace(LESSON, 1, 3)
    desk.lead("let_go")
    assert desk.room.orders.pace is None


def test_the_record_is_a_workbook_and_the_end_asks_before(desk: Desk) -> None:
    desk.lead("record")
    ((name, content),) = desk.files.items()
    assert name.startswith("onpath-class-") and content.startswith(b"PK")
    for order in ("end", "forget"):
        assert desk.fields[PREFIX + order].asks
    desk.lead("end")
    assert desk.room.members() == {} and desk.values["told"]
    desk.lead("stop")
    assert desk.calls == ["stop"]


@pytest.mark.parametrize("language", languages())
def test_a_nickname_with_markup_is_only_text_and_on_a_projection_in_one_group(
    language: str,
) -> None:
    desk = Desk(language)
    desk.set("follow", 1.0)
    desk.presents = True
    form, values = desk.form.shown()
    for group in form.groups:
        for field in group.fields:
            shown = str(values.get(field.name, ""))
            assert field.kind != "html" or "<img" not in shown
            told = shown + encoded(field).decode()
            assert group.name == "class" or ("onerror" not in told and "Bob" not in told)


values = st.one_of(
    st.booleans(), st.floats(-1e9, 1e9), st.text(max_size=20), st.sampled_from([*COURSE.lessons])
)
names = st.sampled_from(
    [
        *("follow", "name", "setup", "lesson", "picked", "route", "pace_lesson", "step", "pair"),
        *("pace_first", "pace_last", "shown", "revealed", "large", "table", "nothing", ""),
    ]
)
leads = st.builds(Lead, st.sampled_from(get_args(Order)), st.integers(0, 4))


@pytest.mark.thorough
@given(st.lists(st.one_of(leads, st.tuples(names, values)), max_size=12))
@settings(max_examples=25, deadline=None)
def test_whatever_a_teacher_orders_the_page_can_be_shown(ways: list[Any]) -> None:
    desk = Desk()
    for way in ways:
        if isinstance(way, Lead):
            desk.orders.lead(way)
        else:
            desk.orders.set(PREFIX + way[0], way[1])
        form, told = desk.form.shown()
        for group in form.groups:
            for field in group.fields:
                options = [option.value for option in field.options]
                assert field.kind != "choice" or told[field.name] in options
