"""Tells a page of its lab through its own websocket, and takes the commands that come back."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from datetime import date
from functools import partial
from typing import Any

import numpy as np
from msgspec import Struct, structs

from onpath.app.channel.class_messages import Lead
from onpath.app.channel.data_frame import LENGTH, FrameSource, frame_message, path_message
from onpath.app.channel.file_messages import DropFile, MakeFile, SendFile, SendPart
from onpath.app.channel.form_messages import AskForm, SetField
from onpath.app.channel.lesson_messages import LessonMessage
from onpath.app.channel.messages import (
    Alive,
    Dark,
    Hello,
    LabCode,
    Refused,
    Resized,
    Seen,
    Skip,
    changes,
    encoded,
    encoded_changes,
)
from onpath.app.channel.motion_messages import Plot
from onpath.app.channel.plant_messages import DrivePlant
from onpath.app.channel.reading import NoPageMessage, read_message
from onpath.app.channel.sheet_messages import ClassMessage, Request
from onpath.app.channel.state_messages import StateMessage
from onpath.app.channel.symbol_messages import Light, LitMessage
from onpath.app.classroom.admission import LONGEST_NAME
from onpath.app.common.work_thread import WorkThread
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion, PathSnapshot
from onpath.app.lab.snapshots.take_snapshot import take_lesson
from onpath.app.scene.client_scene import ClientScene
from onpath.app.server.first_projection import FirstProjection
from onpath.app.server.page_class import PageClass, is_of_class
from onpath.app.server.page_context import PageContext
from onpath.app.server.page_files import PageFiles
from onpath.app.server.page_form import PageForm
from onpath.app.server.page_log import PageLog
from onpath.app.server.page_requests import PageRequests
from onpath.app.server.tab_visibility import TabVisibility
from onpath.app.view.page_words import words_message
from onpath.app.view.sheets import NOTHING_TOLD, class_message
from onpath.app.view.state_message import Projection
from onpath.app.view.symbol_geometry import has_meaning, symbol_lines
from onpath.app.viser_adapter.data_channel import Message, PageStream
from onpath.models.systems.robots import Robot

EVERY = 3.0  # frames of simulation per data frame: 20 Hz
MOST_REQUESTS = 16  # requests of a page that may wait, and answers to it that may be unsent
BEAT = 1.0  # [s] without news, after which a page is told that its lab is alive


class PageData:
    """What one page is told of the lab that it has.

    Call everything but `close` in the simulation thread.

    Args:
        stream: to the page.
        own: the lab of the page, which gets its commands.
        context: of the page.
        sight: learns that the page is drawn.
    """

    def __init__(
        self, stream: PageStream, own: Lab, context: PageContext, sight: TabVisibility
    ) -> None:
        self._stream, self.own, self._is_own = stream, own, True
        self._context, self._text, self._sight = context, context.text, sight
        self._source, self._opened = FrameSource(), 0
        self._path: PathSnapshot | None = None
        self._robot: Robot | None = None
        self._projection: Projection | None = None  # the last one, with a scene or without
        self._language = ""
        self._state: StateMessage | None = None
        self._class: ClassMessage | None = None
        self._files = PageFiles(own.post, context.code if context.keep_days else "")
        self._server = PageRequests(context, self._files.exporter)
        self._thread = WorkThread("page")
        teaching = context.teaching
        submit, teaches = self._thread.submit, teaching is not None
        self._first_projection = FirstProjection(submit)
        self._log = PageLog(submit)
        self._form = PageForm(own.post, submit, context.switches, teaches=teaches)
        self._taught: PageClass | None = None
        if teaching is not None:
            delivery = self._files.delivery
            self._taught = PageClass(teaching, context.course, own.post, delivery)
        self._is_resized = self._skips = False
        self._requests, self._answers = deque[Request](), deque[Struct](maxlen=MOST_REQUESTS)
        self._lesson = self._measured = b""
        self._symbol = ""  # that is asked for
        self._plotted: tuple[str, ...] = ()  # fields that are asked for
        self._lit: tuple[str, bytes] = "", b""  # the last one told, and the robots at that time
        self._told = 0.0  # when anything was told last, [s]
        stream.receive = self._receive

    def close(self) -> None:
        """Start no further work. Thread-safe."""
        self._files.close()
        self._thread.close()
        self._text.close()
        if self._taught is not None:
            self._taught.close()

    def follow(
        self,
        lab: Lab,
        drawn: Motion | PageSnapshot,
        is_turn: bool,
        on_resize: Callable[[], None],
    ) -> None:
        """Note the present sample, and hand over a frame if it is its turn, or if a step has come.

        Args:
            drawn: how the robots are drawn now.
            on_resize: called if the page has reported that its canvas has changed size.
        """
        stream, self._is_own = self._stream, lab is self.own
        if not stream.is_open:
            return
        if stream.opened != self._opened:
            self._opened = stream.opened
            self._files.restart()
            self._form.restart()
            self._log.restart()
            if self._taught is not None:
                self._taught.restart()
            self._source.forget()
            self._path, self._state, self._class, self._language = None, None, None, ""
            self._lesson = self._measured = b""
            self._symbol, self._lit = "", ("", b"")
            self._plotted = ()
        self._source.ask(self._plotted)
        if self._is_resized:
            self._is_resized = False
            on_resize()
        self._source.note(lab.simulation)
        self._files.serve(lab)
        self._make_lesson(lab)
        if stream.is_busy or not (is_turn or self._has_step):
            return
        if messages := self._of_frame(lab, drawn):
            self._told = time.monotonic()
            stream.hand_over(*messages)

    def _of_frame(self, lab: Lab, drawn: Motion | PageSnapshot) -> list[Message]:
        """What the page is told in its turn."""
        robot, path, messages = lab.simulation.robot, drawn.path, list[Message]()
        if path is not self._path or robot is not self._robot:
            self._path, self._robot = path, robot
            messages.append(_text_of(path_message, robot, path))
        if (frame := self._source.take(lab)) is not None:
            messages.append(_text_of(frame_message, frame))
        if self._has_words:
            messages += [*self._of_lesson(), *self._of_answers(lab)]
        if self._symbol:
            messages += self._light(robot, drawn)
        messages += [partial(encoded, each) for each in self._files.take()]
        if not messages and time.monotonic() > self._told + BEAT:
            messages.append(_text_of(Alive))
        return messages

    def tell(self, snapshot: PageSnapshot, scene: ClientScene | None, robot: Robot) -> None:
        """Hand over what has changed of the texts, of the state and of what the lessons show.

        Args:
            scene: the robots' picture, if it is there.
            robot: of the lab.
        """
        text = self._text
        text.follow(snapshot)
        if self._skips:
            self._skips = False
            text.end_introduction()
        while self._requests:
            self._server.serve(self._requests.popleft(), snapshot, scene, self._answer)
        if self._files.follows and scene is not None:
            self._files.follows = False
            scene.look_at_path()
        stream, seen = self._stream, self._seen_on(snapshot, scene, robot)
        if stream.opened != self._opened or stream.is_busy or not stream.is_open or seen is None:
            return
        messages = list[Message]()
        if text.words.language != self._language:
            if not self._language and self._context.code:
                messages.append(_text_of(LabCode, self._context.code))
            self._language = text.words.language
            messages.append(partial(words_message, self._language))
        number = 0 if scene is None else scene.number
        state = text.state(snapshot, seen, number)
        if news := changes(state, self._state):
            self._state = state
            messages.append(partial(encoded_changes, StateMessage, news))
        if (seat := self._class_now(snapshot.nickname)) != self._class:
            self._class = seat
            messages.append(partial(encoded, seat))
        if (log := self._log.news(snapshot.log)) is not None:
            messages.append(partial(bytes, log))
        messages += self._of_lesson()
        messages += self._of_forms(snapshot, scene)
        while self._answers:
            messages.append(partial(encoded, self._answers.popleft()))
        if messages:
            stream.hand_over(*messages)

    def _class_now(self, nickname: str) -> ClassMessage:
        context = self._context
        return class_message(
            self._text.words,
            None if context.seat is None else context.seat.code,
            nickname,
            longest=LONGEST_NAME,
            days=context.keep_days,
            privacy=context.privacy_url,
            today=date.today(),
            class_days=0 if context.seat is None else context.seat.days(),
            away=("", False) if context.seat is None else context.seat.away(),
            own=NOTHING_TOLD if context.seat is None else context.seat.own(),
        )

    def _of_forms(self, snapshot: PageSnapshot, scene: ClientScene | None) -> list[Message]:
        """What the page is told of its fields, once it has asked for them."""
        if not self._form.is_asked:
            return []
        news = [*self._form.news(snapshot, scene, self._context.course, self._text.words)]
        if self._taught is not None:
            news += self._taught.news()
        return [partial(encoded, each) for each in news]

    @property
    def _has_words(self) -> bool:
        """Whether the page has the words of the language in which it is told everything else."""
        return self._language == self._text.words.language

    @property
    def _has_step(self) -> bool:
        """Whether the page waits for the message of a step that is made."""
        column = self._text.column
        if column is None or not column.message or not self._has_words:
            return False
        return column.message is not self._lesson

    def _make_lesson(self, lab: Lab) -> None:
        """Have the message of the open step made if it has changed."""
        text, robot = self._text, lab.simulation.robot
        presenting = lab.simulation.settings.presenting
        column = text.column if text.words.language == lab.words.language else None
        if column is not None and column.lacks(lab.lessons.version, robot, presenting):
            column.make(take_lesson(lab), robot)

    def _of_answers(self, lab: Lab) -> list[Message]:
        """Which answers have been stored since the page was told last."""
        sent, state = list(lab.lessons.sent), self._state
        if state is None or sent == state.sent:
            return []
        self._state = structs.replace(state, sent=sent)
        return [partial(encoded_changes, StateMessage, {"sent": sent})]

    def _of_lesson(self) -> list[Message]:
        column, messages = self._text.column, list[Message]()
        if column is None and not self._lesson:  # a teacher's page has none
            self._lesson = encoded(LessonMessage(lesson="", version=0))
            messages.append(partial(bytes, self._lesson))
        if column is not None and column.message:
            if column.message is not self._lesson:
                self._lesson, self._measured = column.message, b""
                messages.append(partial(bytes, column.message))
            if column.measured != self._measured:
                self._measured = column.measured
                messages.append(partial(bytes, column.measured))
        return messages

    def _seen_on(
        self, snapshot: PageSnapshot, scene: ClientScene | None, robot: Robot
    ) -> Projection | None:
        """How the picture shows the robots, or would, if there is none.

        While a picture is being built, the one before counts; None if there was none.
        """
        seen = self._first_projection.of(robot) if scene is None else scene.seen(snapshot)
        if seen is None and self._projection is not None:
            seen = replace(self._projection, drawn=False)
        self._projection = seen
        return seen

    def _answer(self, answer: Struct) -> None:
        """Send an answer with the next messages. Thread-safe."""
        self._answers.append(answer)

    def _light(self, robot: Robot, drawn: Motion | PageSnapshot) -> list[Message]:
        """What the symbol means that is asked for, unless the page knows it already."""
        if drawn.key.robot != robot.name or not has_meaning(self._symbol, robot):
            return []
        motion = drawn if isinstance(drawn, Motion) else drawn.motion
        now = self._symbol, motion.drawn.tobytes()
        if now == self._lit:
            return []
        self._lit = now
        return [_text_of(lit_message, self._symbol, robot, motion)]

    def _receive(self, text: str) -> bytes:
        """Post the command in a message; returns why not, if it is refused. On the event loop."""
        try:
            message = read_message(text)
        except NoPageMessage as error:
            return encoded(Refused(str(error)))
        match message:
            case Command() if self._is_own:
                self.own.post(message)
            case Command():
                return encoded(Refused("this lab is only shown"))
            case SendFile() | SendPart() | DropFile() | MakeFile():
                return self._hear_file(message)
            case DrivePlant():
                return self._hear_driver(message)
            case Lead():
                return self._hear_teacher(message)
            case SetField() if is_of_class(message):
                return self._hear_teacher(message)
            case AskForm() | SetField():
                self._form.hear(message, self._is_own)
            case Hello():
                return encoded(Refused("the channel is open"))
            case Seen() | Dark() | Resized() | Skip() | Light() | Plot():
                self._note(message)
            case _ if len(self._requests) < MOST_REQUESTS:
                self._requests.append(message)
            case _:
                return encoded(Refused("too many requests at once"))
        return b""

    def _note(self, message: Seen | Dark | Resized | Skip | Light | Plot) -> None:
        match message:
            case Seen():
                self._sight.hear()
            case Dark(on=on):
                self._context.look.dark = on
            case Resized(upright=upright):
                self._is_resized, self._context.look.upright = True, upright
            case Skip():
                self._skips = True
            case Light(symbol=symbol):
                self._symbol = symbol
            case Plot(fields=fields):
                self._plotted = fields

    def _hear_teacher(self, message: Lead | SetField) -> bytes:
        """Take an order to the class; returns why not, if the page may give none."""
        if self._taught is None or not self._taught.hear(message):
            return encoded(Refused("only a teacher of the class may do this"))
        return b""

    def _hear_driver(self, message: DrivePlant) -> bytes:
        """Take an order to a plant; returns why not, if the page may give none."""
        if self._context.drive is None:
            return encoded(Refused("this page does not drive a plant"))
        self._context.drive(message)
        return b""

    def _hear_file(self, message: SendFile | SendPart | DropFile | MakeFile) -> bytes:
        """Take a message about a file; returns the answer, if there is one. On the event loop."""
        if isinstance(message, MakeFile) and self.own.plant is not None:
            return encoded(Refused("what a plant does cannot be simulated again"))
        if isinstance(message, SendFile) and not self._is_own:
            return encoded(Refused("this lab is only shown"))
        answer = self._files.hear(message)
        return b"" if answer is None else encoded(answer)


def lit_message(symbol: str, robot: Robot, motion: Motion) -> LitMessage:
    """The message of what a symbol means."""
    lines = [
        np.rint(LENGTH * line).astype(int).tolist() for line in symbol_lines(symbol, robot, motion)
    ]
    return LitMessage(symbol, lines)


def _text_of(make: Callable[..., Struct], *args: Any) -> Message:
    """Makes a message's text, later."""
    return lambda: encoded(make(*args))
