"""The remote controls of a class: pages for a phone that show no lab, only the teacher's form.

A page is let in from a place that is the teacher's already, by a number that both show; no key is
typed on it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from time import monotonic

from msgspec import Struct

from onpath.app.channel.class_messages import Lead, RemoteMessage
from onpath.app.channel.form_messages import AskForm, SetField
from onpath.app.channel.messages import Alive, Refused, Seen, encoded
from onpath.app.channel.reading import NoPageMessage, read_message
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.teacher_context import TeacherChoices, TeacherContext
from onpath.app.common.error_log import log_error
from onpath.app.common.periodic import Periodic
from onpath.app.server.page_class import PageClass, is_of_class
from onpath.app.server.page_data import BEAT
from onpath.app.server.visit import Visit
from onpath.app.view.page_words import words_message
from onpath.lessons.course import Course
from onpath.lessons.words import Words

EVERY = 0.25  # [s] between looks at what the pages are to be told


class ClassRemotes:
    """All remote controls of a class.

    Args:
        teaching: what a page may do, given its visit, the address of the site for students, and
            the teacher.
    """

    def __init__(
        self,
        classroom: Classroom,
        course: Course,
        teaching: Callable[[Visit, str, tuple[str, TeacherChoices]], TeacherContext],
    ) -> None:
        self._class, self._course, self._teaching = classroom, course, teaching
        self._remotes, self._lock = list[Remote](), threading.Lock()
        self.rounds = Periodic("remotes", EVERY, self._tell)
        self.rounds.awake.clear()  # until there is a remote control

    def add(self, visit: Visit, site: str) -> None:
        """Show a page the form, or the number with which it is let in, until its visit ends."""
        teaching = partial(self._teaching, visit, site)
        remote = Remote(visit, self._class, self._course, teaching)
        with self._lock:
            self._remotes.append(remote)
            self.rounds.awake.set()
        visit.at_end(partial(self._remove, remote))

    def _remove(self, remote: Remote) -> None:
        with self._lock:
            self._remotes.remove(remote)
            if not self._remotes:
                self.rounds.awake.clear()
        remote.close()

    def _tell(self) -> None:
        with self._lock:
            remotes = list(self._remotes)
        for remote in remotes:
            try:
                remote.tell()
            except Exception as error:  # the others are told all the same
                log_error(error)


class Remote:
    """One page. Call `tell` in one thread.

    Args:
        teaching: what it may do as a teacher's.
    """

    def __init__(
        self,
        visit: Visit,
        classroom: Classroom,
        course: Course,
        teaching: Callable[[tuple[str, TeacherChoices]], TeacherContext],
    ) -> None:
        self._visit, self._class, self._course = visit, classroom, course
        self._teaching, self._words = teaching, Words(visit.language)
        self._page: PageClass | None = None
        self._number, self._opened = 0, 0
        self._told: RemoteMessage | None = None
        self._beat = 0.0  # when anything was told last, [s]
        visit.stream.receive = self._receive

    def close(self) -> None:
        """Start no further work, and ask no more."""
        self._class.take_back(self._number)
        if self._page is not None:
            self._page.close()

    def tell(self) -> None:
        """Tell the page what has changed."""
        visit, stream = self._visit, self._visit.stream
        if not stream.is_open:
            return
        if stream.opened != self._opened:
            self._opened, self._told = stream.opened, None
            stream.say(words_message(visit.language))
            if self._page is not None:
                self._page.restart()
        teacher = visit.teacher
        if teacher is not None and not self._class.is_pass(teacher[0]):
            self._end()
        elif teacher is not None and self._page is None:
            self._page = PageClass(self._teaching(teacher), self._course, post=lambda _: None)
        if (message := self._message()) != self._told:
            self._told = message
            self._say(message)
        news = [] if self._page is None else list(self._page.news())
        if not news and monotonic() > self._beat + BEAT:
            news = [Alive()]
        for each in news:
            self._say(each)

    def _say(self, message: Struct) -> None:
        self._beat = monotonic()
        self._visit.stream.say(encoded(message))

    def _message(self) -> RemoteMessage:
        if self._page is not None:
            return RemoteMessage("", "", votes=bool(self._class.open_votes))
        if self._number not in self._class.asking:
            self._number = self._class.ask_in(self._grant)
        if not self._number:
            return RemoteMessage("-", self._words("remote.full"), votes=False)
        return RemoteMessage(str(self._number), self._words("remote.ask"), votes=False)

    def _grant(self, shown: str) -> None:
        """The page has been let in, with this pass."""
        self._visit.teacher = shown, TeacherChoices()
        self._visit.keep("teacher", shown)

    def _end(self) -> None:
        """It has been thrown out."""
        self._visit.teacher = None
        self._visit.keep("teacher", "")
        page, self._page = self._page, None
        if page is not None:
            page.close()

    def _receive(self, text: str) -> bytes:
        """Take an order; returns why not, if it is refused. On the event loop."""
        try:
            message = read_message(text)
        except NoPageMessage as error:
            return encoded(Refused(str(error)))
        if isinstance(message, Seen | AskForm):
            return b""
        page = self._page
        if isinstance(message, SetField) and not is_of_class(message):
            page = None
        if isinstance(message, Lead | SetField) and page is not None and page.hear(message):
            return b""
        return encoded(Refused("only a teacher of the class may do this"))
