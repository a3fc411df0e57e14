"""What a teacher does on the page of a class."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from typing import Any

from onpath.app.channel.class_messages import Lead, Order
from onpath.app.channel.form_messages import FieldValue
from onpath.app.classroom.class_record import class_record
from onpath.app.classroom.classroom import IDENTIFICATIONS, Display
from onpath.app.classroom.concept_test_results import sheets_without_names
from onpath.app.classroom.gains_html import PAIRS
from onpath.app.classroom.grade_list import grade_sheet
from onpath.app.classroom.results import (
    asked_at,
    have_all_answered,
    prediction_at,
    votes_at,
)
from onpath.app.classroom.teaching.class_answers import picked
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.classroom.teaching.teacher_form import PREFIX
from onpath.app.lab.commands import CloseLesson, Set, TakeSetup, TakeStep
from onpath.app.lab.lab import Command
from onpath.app.lab.setups.share_code import decode
from onpath.lessons.course import Course
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.pace import Pace
from onpath.lessons.votes import Vote
from onpath.lessons.words import Words

COUNT_DOWN = 5.0  # [s] in which a vote is closed
TIMER = 60.0  # [s] that the timer gives


class TeacherOrders:
    """Carries out the orders of one teacher's page. Not thread-safe.

    Args:
        post: receives the commands for the teacher's own lab.
        deliver: brings a file to the page, given its name and what makes it.
    """

    def __init__(
        self,
        course: Course,
        teaching: TeacherContext,
        post: Callable[[Command], object],
        deliver: Callable[[str, Callable[[], bytes]], None],
    ) -> None:
        self._course, self._teaching, self._class = course, teaching, teaching.classroom
        self._chosen, self._post, self._deliver = teaching.chosen, post, deliver
        self._of_texts: Mapping[str, Callable[[Any], object]] = {
            "name": self._rename,
            "setup": self._send_code,
            "lesson": self._choose_lesson,
            "picked": self._pick,
            "route": self._choose_route,
            "asks": self._ask_for,
            "pace_lesson": self._choose_pace,
        }
        self._of_numbers: Mapping[str, Callable[[Any], object]] = {
            "follow": self._follow,
            "step": self._choose_step,
            "pair": self._choose_gains,
            "days": self._keep_for,
            "pace_first": partial(self._choose_border, "first"),
            "pace_last": partial(self._choose_border, "last"),
        }
        self._of_switches: Mapping[str, Callable[[Any], object]] = {
            "shown": self._show_answers,
            "revealed": self._reveal,
            "peeks": self._peek,
            "large": lambda on: post(Set("presenting", on)),
        }
        room = self._class
        self._acts: Mapping[Order, Callable[[int], object]] = {
            "freeze": lambda _: room.freeze(True),
            "thaw": lambda _: room.freeze(False),
            "send_setup": self._send_setup,
            "stop": lambda _: teaching.stop(),
            "own_lab": lambda _: self._follow(0),
            "back": lambda _: self._lead(-1),
            "next": lambda _: self._lead(1),
            "close_votes": lambda _: self._close(),
            "timer": lambda _: self._close(TIMER),
            "open_votes": lambda _: room.open_again(self._votes),
            "ask_again": self._ask_again,
            "play": self._play,
            "put_back": lambda _: self._put_lab_back(),
            "send_step": lambda _: self._push_step(TakeStep(*self._steps.shown(room.display))),
            "send_route": self._send_route,
            "set_aside": self._set_aside,
            "give_place": lambda number: teaching.give_place(self._code_of(number)),
            "keep_apart": lambda number: room.reject(self._code_of(number)),
            "remove": self._remove,
            "delete": self._delete,
            "end_standing": lambda _: room.push(None),
            "keep": self._keep,
            "let_go": lambda _: room.keep_within(None),
            "record": self._bring_record,
            "end": self._end,
            "forget": self._forget,
            "let_in": room.let_in,
            "throw_out": room.throw_out,
        }

    def set(self, name: str, value: FieldValue) -> None:
        """Give a field another value; one that it cannot have changes nothing."""
        refused = self._chosen.refused
        refused.pop(name, None)
        try:
            self._set(name.removeprefix(PREFIX), value)
        except ValueError as error:
            refused[name] = self._words.sentence(error)

    def lead(self, order: Lead) -> None:
        """Do what a button says."""
        self._chosen.told = ""
        try:
            self._acts[order.do](order.member)
        except (OSError, ValueError) as error:
            self._chosen.told = self._words.sentence(error)

    @property
    def _words(self) -> Words:
        return Words(self._teaching.progress().language)

    @property
    def _steps(self) -> StepsForAll:
        return StepsForAll(self._course, self._words.language)

    # Fields.

    def _set(self, name: str, value: FieldValue) -> None:
        kinds = {str: self._of_texts, float: self._of_numbers, bool: self._of_switches}
        act = kinds[type(value)].get(name)
        if act is not None:
            act(value)

    def _follow(self, number: float) -> None:
        self._chosen.followed, self._chosen.told = self._code_of(int(number)), ""

    def _code_of(self, number: int) -> str:
        """The lab code of a member; empty if the student has left."""
        numbers = {each.number: code for code, each in self._class.members().items()}
        return numbers.get(number, "")

    def _rename(self, name: str) -> None:
        self._class.rename(self._chosen.followed, name)

    def _send_code(self, code: str) -> None:
        self._chosen.setup = code
        self._push(TakeSetup(decode(code)))

    def _show_answers(self, on: bool) -> None:
        since = self._close() if on else 0.0
        self._class.show(replace(self._class.display, shown=on, since=since))

    def _reveal(self, on: bool) -> None:
        """Show the truth, among the answers, or hide it."""
        display = self._class.display
        since = self._close() if on else display.since
        self._class.show(replace(display, revealed=on, shown=on or display.shown, since=since))

    @property
    def _votes(self) -> list[Vote]:
        """The votes on what the displayed step asks."""
        name, index = self._steps.shown(self._class.display)
        lesson = self._course.lesson(name, self._words.language)
        return votes_at(lesson, index, self._class.votes)

    def _peek(self, on: bool) -> None:
        self._chosen.peeks = on

    def _close(self, wait: float = COUNT_DOWN) -> float:
        """Close the votes of the displayed step, and return when they are closed.

        A count-down lets students finish, unless all who are here have answered.
        """
        room, votes = self._class, self._votes
        here = [each.progress for each in room.present().values() if each.connected]
        wait = 0.0 if have_all_answered(here, votes) else wait
        room.close([each for each in votes if each.closes is None], wait)
        return max([each.closes or 0.0 for each in self._votes], default=0.0)

    def _choose_lesson(self, name: str) -> None:
        if self._course.has(name):
            self._display(name, 0)

    def _choose_step(self, index: float) -> None:
        self._display(self._steps.shown(self._class.display)[0], int(index))

    def _pick(self, typed: str) -> None:
        self._chosen.picked = picked(typed)

    def _choose_route(self, name: str) -> None:
        if name in self._course.routes:
            self._chosen.route = name

    def _choose_gains(self, pair: float) -> None:
        if int(pair) in range(len(PAIRS)):
            self._chosen.pair = int(pair)

    def _keep_for(self, days: float) -> None:
        if int(days) in range(1, self._class.most_days + 1):
            self._class.keep_for(int(days))

    def _ask_for(self, identification: str) -> None:
        if (known := IDENTIFICATIONS.get(identification)) is not None:
            self._class.ask_for(known)

    def _choose_pace(self, lesson: str) -> None:
        if self._course.has(lesson):
            self._chosen.pace = Pace(lesson, 0, 0)

    def _choose_border(self, border: str, index: float) -> None:
        """Choose the first or the last step within which the class is to stay."""
        pace = self._pace
        if self._course.has_steps(pace.lesson, int(index), int(index)):
            self._chosen.pace = replace(pace, **{border: int(index)})

    @property
    def _pace(self) -> Pace:
        return self._teaching.pace(self._steps.shown(self._class.display)[0])

    def _display(self, lesson: str, step: int) -> None:
        """Display a step, with its answers hidden."""
        if step in range(len(self._course.lesson(lesson, self._words.language).steps)):
            self._put_lab_back()
            self._chosen.picked, self._chosen.told = (), ""
            self._class.show(Display(lesson, step))

    # Buttons.

    def _push(self, push: TakeSetup | TakeStep, asks: Iterable[str] = ()) -> None:
        self._class.push(push, asks)
        self._tell_sent()

    def _push_step(self, step: TakeStep | None) -> None:
        if step is not None:
            self._put_lab_back()
            self._chosen.picked = ()
            self._push(step, self._asked_by(step))

    def _asked_by(self, step: TakeStep) -> list[str]:
        """What the class votes on in a step; a test is answered by each student alone."""
        if step.lesson in self._course.tests:
            return []
        asked = asked_at(self._course.lesson(step.lesson, self._words.language), step.step)
        return [item for item in asked if not step.again or item == str(step.step)]

    def _tell_sent(self) -> None:
        self._chosen.told = self._words(
            "class.sent", count=sum(e.connected for e in self._class.members().values())
        )

    def _ask_again(self, _: int) -> None:
        name, index = self._steps.shown(self._class.display)
        found = prediction_at(self._course.lesson(name, self._words.language), index)
        if found is None:
            self._chosen.told = self._words("class.no_prediction")
        else:
            self._push_step(TakeStep(name, found[0], again=True))

    def _play(self, _: int) -> None:
        """Play the demonstration in the teacher's own lab, and show that lab."""
        step = self._steps.demonstration(self._class.display)
        if step is not None:
            self._chosen.followed = ""
            self._post(step)

    def _put_lab_back(self) -> None:
        if self._teaching.progress().lesson:  # the teacher's own lab is in a step
            self._post(CloseLesson())

    def _send_route(self, _: int) -> None:
        routes = self._course.routes
        name = self._chosen.route if self._chosen.route in routes else next(iter(routes), "")
        if name:
            first = routes[name].stop[0]
            self._put_lab_back()
            self._push(TakeStep(first.lesson, first.steps[0] - 1, name))

    def _send_setup(self, _: int) -> None:
        self._teaching.send_setup()
        self._tell_sent()

    def _lead(self, by: int) -> None:
        """Take the class one step on, or back."""
        self._push_step(self._steps.beside(self._class.display, self._class.orders, by))

    def _keep(self, _: int) -> None:
        pace = self._pace
        first, last = sorted((pace.first, pace.last))
        self._class.keep_within(Pace(pace.lesson, first, last))

    def _set_aside(self, _: int) -> None:
        """Set aside all who are away; each is back as soon as they come."""
        self._chosen.told = self._words("class.set_aside_told", count=self._class.set_aside())

    def _remove(self, number: int) -> None:
        """Take a student out of the class; the lab goes on without it."""
        if code := self._code_of(number):
            self._class.leave(code)
            self._tell_gone(code, "class.removed")

    def _delete(self, number: int) -> None:
        if code := self._code_of(number):
            self._teaching.delete(code)
            self._chosen.numbered.clear()
            self._tell_gone(code, "class.deleted")

    def _tell_gone(self, code: str, how: str) -> None:
        if self._chosen.followed == code:
            self._chosen.followed = ""
        self._chosen.told = self._words(how)

    def _end(self, _: int) -> None:
        self._chosen.told = self._words("class.ended", count=self._class.end())

    def _forget(self, _: int) -> None:
        self._chosen.told = self._words("class.forgotten", count=self._teaching.forget())

    def _bring_record(self, _: int) -> None:
        made = datetime.now(UTC)
        self._deliver(f"onpath-class-{made:%Y-%m-%d}.xlsx", lambda: self._record(made))

    def _record(self, made: datetime) -> bytes:
        course, language = self._course, self._words.language
        members = {
            lab: replace(member, progress=of_today(course, member.progress))
            for lab, member in self._class.members().items()
        }
        students = [(lab, member.progress) for lab, member in members.items()]
        forms = course.forms(language)
        words = {lab: member.word for lab, member in members.items()}
        more = sheets_without_names(forms, students, self._class.code, words) if forms else []
        grades = grade_sheet(members.values(), course, language, self._class.state.asks)
        more += [] if grades is None else [grades]
        votes = self._class.votes
        return class_record(members.values(), course, language, made, more=more, votes=votes)
