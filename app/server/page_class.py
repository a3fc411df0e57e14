"""Tells a teacher's page of its class, and carries out what the teacher orders there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import monotonic

from msgspec import Struct

from onpath.app.channel.class_messages import Lead
from onpath.app.channel.form_messages import FieldValue, FormMessage, SetField
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.classroom.teaching.teacher_form import NO_CLASS, PREFIX, TeacherForm
from onpath.app.classroom.teaching.teacher_orders import TeacherOrders
from onpath.app.common.work_thread import WorkThread
from onpath.app.exports.exporter import Delivery
from onpath.app.lab.lab import Command
from onpath.app.server.told_values import ToldValues
from onpath.lessons.course import Course
from onpath.lessons.words import Words

REFRESH_INTERVAL = 1.0  # [s] between updates of a class's view


class PageClass:
    """The class on one teacher's page.

    Args:
        post: receives the commands for the teacher's own lab.
        delivery: brings files to the page; None if it takes none.
    """

    def __init__(
        self,
        teaching: TeacherContext,
        course: Course,
        post: Callable[[Command], object],
        delivery: Delivery | None = None,
    ) -> None:
        self._teaching, self._course, self._delivery = teaching, course, delivery
        self._orders = TeacherOrders(course, teaching, post, self._deliver)
        self._thread, self._computing = WorkThread("class"), WorkThread("truth")
        self._form: tuple[str, TeacherForm] | None = None  # and its language
        self._seen: tuple[FormMessage, dict[str, FieldValue], dict[str, str]] | None = None
        self._heard = dict[str, int]()
        self._next, self._busy = 0.0, False
        self.restart()

    def restart(self) -> None:
        """Forget what the page knows."""
        self._told_form, self._told = NO_CLASS, ToldValues()

    def close(self) -> None:
        """Start no further work. Thread-safe."""
        self._thread.close()
        self._computing.close()

    def hear(self, message: Lead | SetField) -> bool:
        """Take an order; returns whether the page may give one. On the event loop."""
        if not self._teaching.may_lead():
            return False
        self._thread.submit(lambda: self._carry_out(message))
        return True

    def news(self) -> Iterator[Struct]:
        """What has changed since the last time. In the simulation thread."""
        now = monotonic()
        if now >= self._next and not self._busy:
            self._next, self._busy = now + REFRESH_INTERVAL, True
            self._thread.submit(self._check)
        if self._seen is None:
            return
        form, values, refused = self._seen
        heard = dict(self._heard)
        if form != self._told_form:
            self._told_form = form
            yield form
        yield from self._told.news(values, refused, heard)

    def _carry_out(self, message: Lead | SetField) -> None:
        if isinstance(message, Lead):
            self._orders.lead(message)
        else:
            self._orders.set(message.name, message.value)
        self._check()
        if isinstance(message, SetField):
            before = self._heard.get(message.name, 0)
            self._heard = {**self._heard, message.name: max(message.number, before)}

    def _check(self) -> None:
        """Look at the class; in a thread, since it may be large."""
        try:
            language = self._teaching.progress().language
            if self._form is None or self._form[0] != language:
                words = Words(language)
                answers = ClassAnswers(self._course, words, self._teaching, self._computing.submit)
                form = TeacherForm(self._course, words, self._teaching, answers)
                self._form = language, form
            for step in self._form[1].near():
                self._teaching.prepare(step)
            self._seen = *self._form[1].shown(), dict(self._teaching.chosen.refused)
        finally:
            self._busy = False

    def _deliver(self, name: str, make: Callable[[], bytes]) -> None:
        words, delivery = Words(self._teaching.progress().language), self._delivery
        if delivery is None:
            return
        delivery.making(name, words)
        try:
            delivery.ready(name, make(), words)
        except Exception:
            delivery.failed(name, words)
            raise


def is_of_class(message: SetField) -> bool:
    """Whether a message sets a field of the teacher's page."""
    return message.name.startswith(PREFIX)
