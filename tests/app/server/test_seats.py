"""Labs' places in a class, after any order of what students, their browsers and the teacher do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Struct
from typing_extensions import override

from onpath.app.channel.sheet_messages import (
    AskPlace,
    ClassMessage,
    JoinClass,
    LeaveClass,
    SeatAnswer,
    SeatRequest,
    Teach,
)
from onpath.app.classroom.admission import LONGEST_NAME, Admission, cleaned
from onpath.app.classroom.classroom import Classroom, ClassState
from onpath.app.common.access_codes import new_code, shown
from onpath.app.common.presses import Presses
from onpath.app.common.throttle import TRIES, WITHIN
from onpath.app.lab.lab import Lab
from onpath.app.server.class_service import ClassService
from onpath.app.server.page_context import PageContext
from onpath.app.server.page_requests import PageRequests
from onpath.app.view.sheets import class_message
from onpath.lessons.words import ENGLISH
from tests.support.built_in import built_in_course
from tests.support.lab import loop_cache

COURSE, _ = built_in_course()
LABS = 3
NAMES = ["Ada", "ADA", "  ", "", "Zoë", "n" * 60, "\u202e", "<b>Bob</b>"]


@cache
def room() -> Classroom:
    return Classroom()  # its code takes a while by design


def empty_room(clock: Callable[[], float]) -> Classroom:
    """A class whose clock is in the test's hands."""
    made = room()
    made.restore(ClassState())
    made.clock, made._door = clock, Admission(clock)
    return made


class AtOnce(Presses):
    """Presses without threads."""

    @override
    def run(self, act: Any) -> bool:
        act()
        return True


class Page:
    """A lab and its page."""

    def __init__(self, code: str) -> None:
        self.code, self.lab, self.is_open = code, Lab(loop_cache()), True
        self.visit: Any = SimpleNamespace(teacher=None, kept=dict[str, str]())
        self.visit.keep = self.visit.kept.__setitem__
        self.answers = list[Struct]()


class World:
    """A class with some pages, on a clock of its own; what must be true of each of them."""

    def __init__(self) -> None:
        self.now = 1000.0
        self.room = empty_room(lambda: self.now)
        self.pages = [Page(f"lab {k}") for k in range(LABS)]
        registry: Any = SimpleNamespace(find=self._find)
        self.service = ClassService(self.room, registry, COURSE)
        self.service.stop()  # its rounds: `look` is called by hand
        self.members = dict[str, str]()
        self.frozen, self.teachers = False, set[str]()
        self.enter: Callable[[str], None] = lambda _: None
        self.failures: dict[str, list[float]] = {page.code: [] for page in self.pages}

    def _find(self, code: str) -> Any:
        page = next(page for page in self.pages if page.code == code)
        client = 1 if page.is_open else None
        return SimpleNamespace(scheduled=SimpleNamespace(lab=page.lab), client=client)

    def seat(self, page: Page) -> Any:
        """As a page has it that is opened now."""
        if page.visit.teacher is not None:
            return None
        return self.service.seat(page.visit, page.code, lambda: None, self.enter)

    def ask(self, page: Page, request: SeatRequest) -> SeatAnswer:
        text: Any = SimpleNamespace(words=ENGLISH, preferences={})
        context = PageContext(
            code=page.code,
            course=COURSE,
            keep_days=7,
            enter=lambda _: None,
            text=text,
            choose_tip=lambda *_: None,
            remark=lambda _: None,
            seat=self.seat(page),
            presses=AtOnce(),
        )
        told, anything = list[Struct](), SimpleNamespace()
        serving = PageRequests(context, anything)  # type: ignore[arg-type]
        serving.serve(request, anything, None, told.append)  # type: ignore[arg-type]
        (answer,) = told
        assert isinstance(answer, SeatAnswer)
        return answer

    def shown(self, page: Page) -> ClassMessage:
        """What the page is told of its place."""
        seat, name = self.seat(page), self.service.nickname(page.code)
        place = None if seat is None else seat.code
        away = ("", False) if seat is None else seat.away()
        told = {"longest": LONGEST_NAME, "days": 7, "privacy": "", "away": away}
        return class_message(ENGLISH, place, name, **told)  # pyright: ignore[reportArgumentType]

    # What people do

    def join(self, page: Page, name: str) -> None:
        answer = self.ask(page, JoinClass(code="anything", name=name))
        assert answer.of == "join" and not answer.address
        try:
            wanted = cleaned(name)
        except ValueError:
            wanted = ""
        assert bool(answer.why) == (not wanted or page.code in self.teachers)
        if not answer.why:
            self.members[page.code] = wanted

    def leave(self, page: Page) -> None:
        answer = self.ask(page, LeaveClass())
        assert bool(answer.why) == (page.code in self.teachers)
        self.members.pop(page.code, None)

    def teach(self, page: Page, is_right: bool) -> None:
        key = shown(self.room.key if is_right else new_code())
        answer = self.ask(page, Teach(key=key))
        if page.code in self.teachers:
            assert answer.why
            return
        lately = [at for at in self.failures[page.code] if at > self.now - WITHIN]
        may = len(lately) < TRIES
        assert bool(answer.why) == (not may or not is_right)
        if may and not is_right:
            self.failures[page.code].append(self.now)
        if may and is_right:
            self.teachers.add(page.code)
            self.members.pop(page.code, None)
            assert self.room.is_pass(page.visit.kept["teacher"])

    def freeze(self, on: bool) -> None:
        self.room.freeze(on)
        self.frozen = on

    def remove(self, page: Page) -> None:
        self.room.leave(page.code)
        self.members.pop(page.code, None)

    def end(self) -> None:
        assert self.room.end() == len(self.members)
        self.members, self.frozen = {}, False

    def close(self, page: Page) -> None:
        page.is_open = not page.is_open

    # What must be true then

    def check(self) -> None:
        self.service._attendance.check()
        names = set[str]()
        for page in self.pages:
            page.lab.drain()
            told, name = self.shown(page), self.members.get(page.code)
            if page.code in self.teachers:
                assert told == ClassMessage(membership="none")
            elif name is None:
                assert (told.membership, told.name) == ("guest", "")
            else:
                assert told.membership == "member" and told.name.casefold() not in names
                assert told.name.startswith(name[: LONGEST_NAME - 3])
                assert told.name == name or told.name[-1].isdigit()
                names.add(told.name.casefold())
                member = self.room.member(page.code)
                assert member is not None and member.connected == page.is_open
            assert bool(page.lab.frozen) == (self.frozen and name is not None)
        assert set(self.room.members()) == set(self.members)


@contextmanager
def world() -> Iterator[World]:
    made = World()
    yield made
    made.service.stop()


PAGES = st.integers(0, LABS - 1)
STEPS = st.one_of(
    st.tuples(st.just("join"), PAGES, st.sampled_from(NAMES)),
    st.tuples(st.sampled_from(["leave", "remove", "close"]), PAGES),
    st.tuples(st.just("teach"), PAGES, st.sampled_from([False, False, False, True])),
    st.tuples(st.just("guess"), PAGES),
    st.tuples(st.just("freeze"), st.booleans()),
    st.tuples(st.just("end")),
    st.tuples(st.just("wait"), st.floats(0.0, WITHIN)),
)


@pytest.mark.thorough
@given(st.lists(STEPS, max_size=25))
def test_a_lab_is_in_the_class_as_long_as_its_student_and_its_teacher_want(
    steps: list[tuple[Any, ...]],
) -> None:
    with world() as made:
        made.check()
        for what, *given_ in steps:
            if what == "wait":
                made.now += given_[0]
            elif what in ("freeze", "end"):
                getattr(made, what)(*given_)
            elif what == "guess":  # as fast as a script can
                for _ in range(TRIES + 1):
                    made.teach(made.pages[given_[0]], is_right=False)
            else:
                getattr(made, what)(made.pages[given_[0]], *given_[1:])
            made.check()


@pytest.mark.parametrize("is_given", [True, False])
def test_who_comes_back_under_a_name_that_is_away_gets_the_place_if_the_teacher_says_so(
    is_given: bool,
) -> None:
    with world() as made:
        old, new, other = made.pages
        made.join(old, "Ada")
        made.join(other, "Ben")
        made.close(old)
        made.check()
        entered = list[str]()
        new.visit.has_ended = False
        made.enter = entered.append
        made.join(new, "ADA")
        assert (made.shown(new).name, made.shown(new).away) == ("ADA 2", "Ada")
        assert made.shown(other).away == "" and not made.shown(new).asked
        assert not made.ask(new, AskPlace()).why and made.shown(new).asked
        assert not made.ask(other, AskPlace()).why  # has no such place, and so asks for nothing
        assert made.room.claims == {new.code: old.code} and entered == []
        if is_given:
            made.service._give_place(new.code)
            assert entered == [old.code] and set(made.room.members()) == {old.code, other.code}
        else:
            made.room.reject(new.code)
            made.service._give_place(new.code)  # too late
            assert entered == [] and len(made.room.members()) == 3
        assert made.room.claims == {}


def test_a_place_whose_student_is_here_is_not_offered() -> None:
    with world() as made:
        old, new, _ = made.pages
        made.join(old, "Ada")
        made.check()
        made.join(new, "Ada")
        assert made.shown(new).away == "" and not made.ask(new, AskPlace()).why
        assert made.room.claims == {}


def test_whoever_guesses_keys_waits_even_with_the_right_one_and_nobody_else_does() -> None:
    with world() as made:
        thief, teacher, _ = made.pages
        for _ in range(TRIES):
            made.teach(thief, is_right=False)
        made.teach(thief, is_right=True)
        assert not made.teachers
        made.teach(teacher, is_right=True)
        made.now += WITHIN + 1
        made.teach(thief, is_right=True)
        assert made.teachers == {thief.code, teacher.code}
