"""Connects the server to a class: decides which page each client gets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from onpath.app.classroom.class_keeper import ClassKeeper
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.teacher_context import TeacherChoices, TeacherContext
from onpath.app.lab.commands import CloseLesson, ReportState, TakeSetup
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.server.class_remote import ClassRemotes
from onpath.app.server.class_wall import ClassWall
from onpath.app.server.followed_lab import FollowedLab
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.page_context import ClassSeat
from onpath.app.server.site_address import is_local
from onpath.app.server.step_loops import StepLoops
from onpath.app.server.visit import Visit
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.storage.lab_state import keep
from onpath.app.storage.records import HeldElsewhere, Records
from onpath.app.storage.write_behind import WriteBehind
from onpath.app.view.sheets import NOTHING_TOLD, OwnPlace
from onpath.app.viser_adapter.addresses import class_address
from onpath.lessons.course import Course
from onpath.lessons.progress import Progress
from onpath.models.errors import CodedError


class ClassService:
    """A class of one server process.

    Args:
        course: the lessons, which may have changed since the class was stored.
        records: store the class, and students' data, which a teacher may delete.
        keeper: stores a student's lab on joining.
        visits: the numbers of the pages of the class.
        lost: called with the pages of the class when another process has taken it over.
        send: sends what has been handed over for all pages.
    """

    def __init__(
        self,
        classroom: Classroom,
        registry: LabRegistry,
        course: Course,
        records: Records | None = None,
        keeper: WriteBehind | None = None,
        visits: Callable[[], set[int]] = set,
        lost: Callable[[set[int]], None] = lambda _: None,
        send: Callable[[], None] = lambda: None,
    ) -> None:
        self._class, self._registry, self._course = classroom, registry, course
        self._records, self._keeper = records, keeper
        self._visits, self._lost = visits, lost
        self._places = dict[str, tuple[Visit, Callable[[str], None]]]()  # who asks for one, by lab
        self._loops = StepLoops(registry)
        self.remotes = ClassRemotes(classroom, course, self._teaching_without_lab)
        self.remotes.rounds.start()
        self.wall = ClassWall(classroom, course=course, registry=registry, send=send)
        self._attendance = ClassSync(classroom, self._student)
        self._attendance.rounds.start()
        self._class_keeper: ClassKeeper | None = None
        if records is not None:
            self._class_keeper = ClassKeeper(classroom, records, self._give_up)
            self._class_keeper.rounds.start()

    def stop(self) -> None:
        """Stop, with the server."""
        self._attendance.rounds.stop()
        self.remotes.rounds.stop()
        self._loops.close()
        self.wall.close()
        if self._class_keeper is not None:
            self._class_keeper.stop()

    @property
    def stored_as(self) -> str:
        """The name of the class in the database; empty if it is not stored."""
        return self._class_keeper.id if self._class_keeper is not None else ""

    @property
    def in_use(self) -> bool:
        """Whether the class has pages here, so that it must not move to another process."""
        return bool(self._visits())

    def greet(self, visit: Visit) -> bool:
        """Receive a page; a teacher's browser becomes a teacher's again.

        Returns:
            Whether this process has the class; if not, another one has it open.
        """
        if self._class_keeper is not None and not self._class_keeper.open():
            return False
        pace = self._class.orders.pace
        if pace is not None and not self._course.has_steps(pace.lesson, pace.first, pace.last):
            self._class.keep_within(None)
        shown = visit.hello.teacher
        if shown and self._class.is_pass(shown):
            visit.teacher = shown, TeacherChoices()
        return True

    def nickname(self, code: str) -> str:
        """Nickname of the student of a lab; empty until the student joins."""
        member = self._class.member(code)
        return member.name if member else ""

    def seat(
        self,
        visit: Visit,
        code: str,
        reopen: Callable[[], None],
        enter: Callable[[str], None] = lambda _: None,
    ) -> ClassSeat:
        """A lab's place in the class.

        Args:
            code: code of the lab.
            reopen: shows the lab on the page anew.
            enter: shows the lab of another code on the page; raises ValueError.
        """

        def teach(key: str) -> str:
            shown = self._class.admit(key, code)
            self._class.leave(code)
            visit.teacher = shown, TeacherChoices()
            visit.keep("teacher", shown)
            reopen()
            return ""

        def join(typed: str, nickname: str) -> str:
            self._class.join(code, typed, nickname)
            entry, keeper = self._registry.find(code), self._keeper
            if entry is not None and keeper is not None:  # the class needs the lab in the database
                submit = partial(keeper.submit, code)
                entry.scheduled.lab.post(ReportState(lambda lab: keep(lab, submit)))
            return ""

        def away() -> tuple[str, bool]:
            former = self._class.member(self._class.former_place(code))
            return ("" if former is None else former.name), code in self._class.claims

        def ask_place() -> None:
            self._class.claim(code)
            self._places[code] = visit, enter

        def own() -> OwnPlace:
            member, members = self._class.member(code), self._class.members().values()
            if member is None:
                return NOTHING_TOLD
            same = member.word and sum(each.word == member.word for each in members)
            linked = "" if not same else "own" if same == 1 else "shared"
            return OwnPlace(self._class.state.asks, member.identification, linked)

        return ClassSeat(
            join=join,
            leave=lambda: self._class.leave(code),
            away=away,
            ask_place=ask_place,
            forget=lambda: self._delete(code),
            identify=partial(self._class.identify, code),
            link=partial(self._class.link, code),
            own=own,
            days=lambda: self._class.days,
            teach=teach,
            code=self._class.code,
        )

    def followed(self, chosen: TeacherChoices) -> FollowedLab:
        """The lab that a teacher follows instead of their own."""
        return FollowedLab(self._class, chosen, self._lab)

    def teaching(
        self,
        visit: Visit,
        teacher: tuple[str, TeacherChoices],
        lab: Lab,
        reopen: Callable[[], None],
        site: str,
    ) -> TeacherContext:
        """A teacher's page.

        Args:
            teacher: of the visit.
            lab: the teacher's own lab, whose open lesson is closed.
            reopen: shows the lab on the page anew.
            site: address of the site for students.
        """
        shown, chosen = teacher
        lab.post(CloseLesson())

        def send_setup() -> None:
            push = self._class.push
            lab.post(ReportState(lambda state: push(TakeSetup(capture(state.simulation)))))

        def stop() -> None:
            visit.teacher = None
            visit.keep("teacher", "")
            reopen()
            self._class.revoke(shown)

        return replace(
            self._teaching_without_lab(visit, site, teacher),
            has_lab=True,
            progress=lambda: lab.lessons.progress,
            presents=lambda: lab.simulation.settings.presenting,
            why_still=self.followed(chosen).why_still,
            send_setup=send_setup,
            stop=stop,
        )

    def _teaching_without_lab(
        self, visit: Visit, site: str, teacher: tuple[str, TeacherChoices]
    ) -> TeacherContext:
        """A teacher's page that shows no lab; see `teaching`."""
        shown, chosen = teacher
        progress = Progress(language=visit.language)
        return TeacherContext(
            classroom=self._class,
            chosen=chosen,
            may_lead=lambda: self._class.is_pass(shown),
            address=f"{site}{class_address(self._class.code)}",
            is_local=is_local(site),
            has_lab=False,
            progress=lambda: progress,
            presents=lambda: False,
            why_still=lambda _: "",
            prepare=self._loops.prepare,
            send_setup=lambda: None,
            delete=self._delete,
            give_place=self._give_place,
            forget=self._forget,
            stop=lambda: self._class.revoke(shown),
        )

    def _student(self, code: str) -> tuple[Lab, bool] | None:
        entry = self._registry.find(code)
        return None if entry is None else (entry.scheduled.lab, entry.client is not None)

    def _lab(self, code: str) -> ScheduledLab | None:
        """The lab with this code, for a teacher's page."""
        entry = self._registry.find(code)
        return None if entry is None else entry.scheduled

    def _give_up(self) -> None:
        """Send all pages away when another process has the class; they reconnect to that one."""
        self._lost(self._visits())

    def _give_place(self, code: str) -> None:
        """Show a student the former lab, which has the student's place, in place of the new one.

        Raises:
            ValueError: it is open elsewhere.
        """
        former = self._class.claims.get(code, "")
        visit, enter = self._places.pop(code, (None, None))
        self._class.reject(code)
        if former and visit is not None and enter is not None and not visit.has_ended:
            enter(former)
            self._class.leave(code)

    def _delete(self, code: str) -> None:
        """Delete a student's lab with all stored data, and the student's seat.

        Raises:
            NotKept: it could not be deleted; the student is still in the class.
            ValueError: the lab is open in another process.
        """
        delete = self._records.delete if self._records is not None else lambda _: 0
        entry = self._registry.find(code)
        client = None if entry is None else entry.client
        try:
            self._registry.delete(code, delete)
        except HeldElsewhere:
            raise CodedError("error.lab_is_open") from None
        finally:
            if client is not None and self._registry.find(code) is not entry:
                self._lost({client})  # the page comes back with a new lab
        self._class.leave(code)
        if self._class_keeper is not None:
            self._class_keeper.check()

    def _forget(self) -> int:
        """Delete the class and all of its students' labs. Returns their number."""
        codes = list(self._class.members())
        for code in codes:
            self._delete(code)
        self._class.end()
        return len(codes)
