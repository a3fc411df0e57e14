"""What a teacher's page shows of the class, as data: groups of fields, and their values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import msgspec

from onpath.app.channel.class_messages import Lead, Order
from onpath.app.channel.form_messages import (
    FieldValue,
    FormField,
    FormGroup,
    FormMessage,
    FormOption,
)
from onpath.app.classroom import class_html as page
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.gains_html import PAIRS, gains_view
from onpath.app.classroom.pace_html import pace_view
from onpath.app.classroom.results import asked_at
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.lesson_labels import lesson_titles, step_label, step_titles
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherChoices, TeacherContext
from onpath.app.lab.commands import TakeStep
from onpath.lessons.course import Course
from onpath.lessons.pace import Pace
from onpath.lessons.words import Words

PREFIX = "class."
"""Begins the names of all fields of the teacher's page."""
DAYS = (1, 2, 7, 14, 30, 90)
"""For how many days a teacher may have a class kept, up to what the server allows."""
NO_CLASS = FormMessage(place="class", groups=())


class TeacherForm:
    """The form of one teacher's page. Only the group "class" shows nicknames.

    Args:
        answers: the class's answers, in the same language.
    """

    def __init__(
        self, course: Course, words: Words, teaching: TeacherContext, answers: ClassAnswers
    ) -> None:
        self._course, self._words, self._teaching = course, words, teaching
        self._answers, self._steps = answers, StepsForAll(course, words.language)
        self._peek = ClassAnswers(course, words, teaching, peeks=True)
        self._titles = {name: title for title, name in lesson_titles(course, words).items()}

    def shown(self) -> tuple[FormMessage, dict[str, FieldValue]]:
        """The form as it is now, and the values of its fields."""
        groups = [self._lead(), self._class()]
        if self._course.lessons:
            groups += [self._predictions(), self._pace()]
        groups.append(self._gains())
        if self._teaching.has_lab:
            groups.append(self._record())
        return FormMessage(place="class", groups=tuple(groups)), dict(self._values())

    def near(self) -> list[TakeStep]:
        """The displayed step and the next one, to which the class may be taken soon."""
        classroom = self._teaching.classroom
        if not self._course.lessons:
            return []
        after = self._steps.beside(classroom.display, classroom.orders, 1)
        return [TakeStep(*self._shown), *([] if after is None else [after])]

    # Fields.

    def _lead(self) -> FormGroup:
        """What is always seen; nothing in it is final."""
        words, orders = self._words, self._teaching.classroom.orders
        fields = [*self._of_asking()]
        if self._teaching.has_lab and not self._large and not self._teaching.classroom.members():
            fields.append(_html("joining"))  # what is needed before anything else
        if self._course.lessons:
            fields += self._beside(-1)
            fields += self._beside(1)
            if not self._large:  # on a projection, they stand with the question
                fields += self._of_answers()
        freezing = "thaw" if orders.frozen else "freeze"
        label = words("class.unfreeze" if orders.frozen else "class.freeze")
        fields.append(_button(freezing, label, tone="warning"))
        if self._followed is not None and self._teaching.has_lab:
            fields.append(_button("own_lab", words("class.own_lab")))
        return _group("lead", words("class.lead"), [_note("told"), _note("who"), *fields])

    def _of_asking(self) -> Iterator[FormField]:
        """Whether to let in the phones that ask."""
        for number in self._teaching.classroom.asking:
            label = self._words("class.let_in", number=str(number))
            yield _button("let_in", label, member=number, name=f"let_in{number}")

    def _of_answers(self) -> Iterator[FormField]:
        """What is done with a question, if there is one: closed, looked at, shown, asked again
        outside a test."""
        words = self._words
        yield from self._of_votes()
        if not self._large:
            yield _html("dots")
        if not self._asks:
            return
        if not self._large:
            yield _note("proposal")
            yield _switch("peeks", words("class.peek"))
            if self._choices.peeks:
                yield _html("peek")
        yield _switch("shown", words("class.show_answers"))
        yield _switch("revealed", words("class.truth"))
        if self._shown[0] not in self._course.tests:
            yield _button("ask_again", words("class.ask_again"))

    @property
    def _asks(self) -> bool:
        """Whether the displayed step asks something; what is shown already can be hidden, too."""
        (name, index), display = self._shown, self._teaching.classroom.display
        asked = asked_at(self._course.lesson(name, self._words.language), index)
        return bool(asked) or name in self._course.tests or display.shown

    def _beside(self, by: int) -> Iterator[FormField]:
        """The button for the next step, or for the one before, if there is one."""
        words, classroom = self._words, self._teaching.classroom
        step = self._steps.beside(classroom.display, classroom.orders, by)
        if step is None:
            return
        if by < 0:
            yield _button("back", words("class.back"))
            return
        there = self._course.lesson(step.lesson, words.language)
        label = step_label(there, step.step, words, self._large)
        if step.lesson != self._shown[0]:
            label = f"{self._titles[step.lesson]}, {label}"
        yield _button("next", words("class.next_step", step=label), tone="main")

    def _class(self) -> FormGroup:
        words, classroom = self._words, self._teaching.classroom
        members = classroom.members().values()
        followable = {f"{each.number}. {each.name}": each.number for each in members}
        fields = [
            *([_html("grid")] if members and self._course.lessons else []),
            _html("code"),
            _html("table"),
            *self._of_claims(),
            *self._of_absent(),
            _choice("follow", words("class.follow"), {words("class.own_lab"): 0, **followable}),
            _note("still"),
            *self._of_member(),
            *self._of_phones(),
            _note("standing"),
        ]
        if classroom.orders.push is not None:
            fields.append(_button("end_standing", words("class.push_end")))
        if self._teaching.has_lab:
            fields.append(_button("send_setup", words("class.push_setup")))
        fields += [
            _text("setup", words("class.push_code"), words("keep.paste_hint")),
            _button("stop", words("class.stop_teaching")),
        ]
        return _group("class", words("class.title"), fields)

    def _of_phones(self) -> Iterator[FormField]:
        """The phones that were let in, which can be thrown out."""
        for at in range(1, len(self._teaching.classroom.state.phones) + 1):
            label = self._words("class.throw_out", number=at)
            yield _button("throw_out", label, member=at, name=f"throw_out{at}")

    def _of_claims(self) -> Iterator[FormField]:
        """Whether a student who has come back is the one who is away; one after the other."""
        words, classroom = self._words, self._teaching.classroom
        for lab, former in list(classroom.claims.items()):
            new, old = classroom.member(lab), classroom.member(former)
            if new is None or old is None or old.connected:
                continue
            yield _note("claim", words("class.claim", name=new.name, former=old.name))
            yield _button("give_place", words("class.give_place"), member=new.number)
            yield _button("keep_apart", words("class.keep_apart"), member=new.number)
            return

    def _of_absent(self) -> Iterator[FormField]:
        """What can be done with all who are away."""
        words, members = self._words, self._teaching.classroom.present().values()
        if away := sum(not each.connected for each in members):
            yield _button("set_aside", words("class.set_aside", count=away))

    def _of_member(self) -> Iterator[FormField]:
        """What can be done with the student who is followed."""
        words, member = self._words, self._followed
        if member is None:
            return
        yield _text("name", words("class.nickname"), words("class.rename_hint"))
        yield _button("remove", words("class.remove"), member=member.number)
        yield _button(
            "delete",
            words("class.delete"),
            member=member.number,
            asks=words("class.delete_sure", name=member.name),
        )

    def _predictions(self) -> FormGroup:
        words, display = self._words, self._teaching.classroom.display
        lesson, _ = self._shown
        fields = [*self._of_answers()] if self._large else []
        if self._teaching.has_lab and self._steps.demonstration(display) is not None:
            fields.append(_button("play", words("class.play")))
        if self._teaching.progress().lesson:
            fields.append(_button("put_back", words("class.put_back")))
        titles = {title: name for name, title in self._titles.items()}
        fields += [
            _html("answers"),
            _choice("lesson", words("class.lesson"), titles),
            _choice("step", words("class.step_head"), self._step_options(lesson)),
            _button("send_step", words("class.push_step")),
            _text("picked", words("class.picked"), words("class.picked_hint")),
        ]
        if self._course.routes:
            routes = {
                route.text(route.title, words.language): name
                for name, route in self._course.routes.items()
            }
            fields.append(_choice("route", words("route.route"), routes))
            fields.append(_button("send_route", words("route.send")))
        if self._teaching.has_lab:
            fields.append(_switch("large", words("lesson.presenting")))
        fields.append(_html("code_again"))
        return _group("predictions", words("class.predictions"), fields)

    def _of_votes(self) -> Iterator[FormField]:
        """The button that closes the votes of the displayed step, or opens them again."""
        classroom, (lesson, index) = self._teaching.classroom, self._shown
        asked = asked_at(self._course.lesson(lesson, self._words.language), index)
        votes = [each for each in classroom.votes if each.lesson == lesson and each.item in asked]
        if any(each.closes is None for each in votes):
            yield _button("close_votes", self._words("class.close_vote"))
            if not self._large:
                yield _button("timer", self._words("class.timer"))
        elif votes:
            yield _button("open_votes", self._words("class.open_vote"))

    def _pace(self) -> FormGroup:
        words, steps = self._words, self._step_options(self._chosen_pace.lesson)
        titles = {title: name for name, title in self._titles.items()}
        fields = [
            _choice("pace_lesson", words("class.lesson"), titles),
            _choice("pace_first", words("pace.first"), steps),
            _choice("pace_last", words("pace.last"), steps),
            _button("keep", words("pace.keep")),
        ]
        if self._teaching.classroom.orders.pace is not None:
            fields.append(_button("let_go", words("pace.end")))
        fields += [_note("kept"), _html("bars")]
        return _group("pace", words("pace.title"), fields)

    def _gains(self) -> FormGroup:
        words = self._words
        pairs = {words("gains.pair", across=x, up=y): i for i, (x, y) in enumerate(PAIRS)}
        fields = [_choice("pair", words("gains.axes"), pairs), _html("gains")]
        return _group("gains", words("gains.title"), fields)

    def _record(self) -> FormGroup:
        words, asks = self._words, self._teaching.classroom.state.asks
        grades = [_note("grades", words("class.grades"))] if asks else []
        fields = [
            _note("record_text", words("class.record_text")),
            *self._of_days(),
            _choice("asks", words("class.asks"), self._identifications()),
            *grades,
            _button("record", words("class.export")),
            _button("end", words("class.end"), asks=words("class.end_sure")),
            _button(
                "forget", words("class.forget"), asks=words("class.forget_sure"), tone="warning"
            ),
        ]
        return _group("record", words("class.record"), fields)

    def _of_days(self) -> Iterator[FormField]:
        """For how long the class is kept, if it is stored."""
        words, most = self._words, self._teaching.classroom.most_days
        offered = sorted({each for each in DAYS if each < most} | {most})
        if most:
            options = {words("class.days", days=days): days for days in offered}
            yield _choice("days", words("class.keep_for"), options)

    def _identifications(self) -> dict[str, FieldValue]:
        """By what students may be asked to identify themselves."""
        return {
            self._words("class.asks_nothing"): "",
            self._words("class.asks_email"): "email",
            self._words("class.asks_idnumber"): "idnumber",
            self._words("class.asks_username"): "username",
        }

    # Values.

    def _values(self) -> Iterator[tuple[str, FieldValue]]:
        """The values of all fields, by their names."""
        for name, value in self._of_class():
            yield PREFIX + name, value
        if self._course.lessons:
            for name, value in self._of_lessons():
                yield PREFIX + name, value

    def _of_class(self) -> Iterator[tuple[str, FieldValue]]:
        words, chosen, large = self._words, self._choices, self._large
        classroom, member = self._teaching.classroom, self._followed
        members = classroom.present().values()
        yield "told", chosen.told
        who = words("class.following", name=member.name) if member is not None else ""
        yield "who", who if self._teaching.has_lab and not large else ""
        code = page.class_code(
            address=self._teaching.address,
            is_local=self._teaching.is_local,
            code=classroom.code,
            count=len(members),
            words=words,
            large=large,
            screens="" if large else self._teaching.address,
        )
        yield "code", code
        yield "joining", code
        yield "table", page.table(members, self._course, classroom.clock(), words)
        yield "follow", 0 if member is None else member.number
        yield "still", self._teaching.why_still(words)
        yield "name", "" if member is None else member.name
        yield "standing", self._standing()
        yield "setup", chosen.setup
        yield "pair", chosen.pair
        yield "days", classroom.days
        yield "asks", classroom.state.asks
        gains = [each.gains for each in members]
        yield "gains", gains_view(PAIRS[chosen.pair], gains, words, large)
        yield "code_again", code

    def _of_lessons(self) -> Iterator[tuple[str, FieldValue]]:
        words, chosen, large = self._words, self._choices, self._large
        classroom, pace = self._teaching.classroom, self._chosen_pace
        yield "shown", classroom.display.shown
        yield "revealed", classroom.display.revealed
        yield "answers", self._answers.view(large)
        yield "dots", "" if large else self._answers.dots()
        yield "grid", self._answers.grid()
        yield "proposal", "" if large else self._answers.proposal()
        yield "peeks", chosen.peeks
        yield "peek", self._peek.view(large=False) if chosen.peeks else ""
        yield from zip(("lesson", "step"), self._shown, strict=True)
        yield "picked", ", ".join(map(str, chosen.picked))
        yield "route", chosen.route or next(iter(self._course.routes), "")
        yield "large", large
        yield "pace_lesson", pace.lesson
        yield "pace_first", pace.first
        yield "pace_last", pace.last
        kept = classroom.orders.pace
        yield "kept", words("pace.none") if kept is None else self._kept(kept)
        lesson = self._course.lesson(pace.lesson, words.language)
        students = [each.progress for each in classroom.members().values()]
        yield "bars", pace_view(lesson, students, kept, words, large)

    def _kept(self, pace: Pace) -> str:
        """Within which steps the class is kept."""
        title = self._titles[pace.lesson]
        return self._words("pace.kept", lesson=title, first=pace.first + 1, last=pace.last + 1)

    def _standing(self) -> str:
        """What students who join receive."""
        push, words = self._teaching.classroom.orders.push, self._words
        if push is None:
            return ""
        if not isinstance(push, TakeStep):
            return words("class.standing_setup")
        title = self._titles.get(push.lesson, "")
        return words("class.standing_step", lesson=title, step=push.step + 1)

    # What both need.

    @property
    def _choices(self) -> TeacherChoices:
        return self._teaching.chosen

    @property
    def _large(self) -> bool:
        return self._teaching.presents()

    @property
    def _followed(self) -> Member | None:
        return self._teaching.classroom.member(self._choices.followed)

    @property
    def _shown(self) -> tuple[str, int]:
        """Lesson and index of the displayed step."""
        return self._steps.shown(self._teaching.classroom.display)

    @property
    def _chosen_pace(self) -> Pace:
        return self._teaching.pace(self._shown[0])

    def _step_options(self, lesson: str) -> dict[str, int]:
        titles = step_titles(self._course.lesson(lesson, self._words.language), self._words)
        return {title: index for index, title in enumerate(titles)}


def _group(name: str, title: str, fields: Iterable[FormField]) -> FormGroup:
    return FormGroup(name=name, title=title, fields=tuple(fields))


def _button(
    order: Order, label: str, *, tone: str = "", asks: str = "", member: int = 0, name: str = ""
) -> FormField:
    act = msgspec.to_builtins(Lead(order, member))
    name = f"{PREFIX}{name or order}"
    return FormField(name=name, kind="button", label=label, act=act, asks=asks, tone=tone)


def _choice(name: str, label: str, options: Mapping[str, FieldValue]) -> FormField:
    """A choice, from the label of each option to its value."""
    offered = tuple(FormOption(value=value, label=text) for text, value in options.items())
    return FormField(name=PREFIX + name, kind="choice", label=label, options=offered)


def _switch(name: str, label: str) -> FormField:
    return FormField(name=PREFIX + name, kind="switch", label=label)


def _text(name: str, label: str, help: str) -> FormField:
    return FormField(name=PREFIX + name, kind="text", label=label, help=help)


def _note(name: str, text: str = "") -> FormField:
    return FormField(name=PREFIX + name, kind="note", label=text)


def _html(name: str) -> FormField:
    return FormField(name=PREFIX + name, kind="html", label="")
