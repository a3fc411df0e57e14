"""The files that a page sends, and those that it gets, through its data channel."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from msgspec import Struct
from typing_extensions import override

from onpath.app.channel.file_inbox import MOST_BYTES, SECONDS, FileInbox
from onpath.app.channel.file_messages import (
    DownloadMessage,
    DownloadPart,
    DropFile,
    FileMessage,
    LogFile,
    MakeFile,
    PathFile,
    PathHelp,
    SendFile,
    SendPart,
)
from onpath.app.exports.exporter import Delivery, Exporter
from onpath.app.exports.log_upload import LogUpload, ReadLog
from onpath.app.exports.path_upload import Read, Upload
from onpath.app.exports.upload_reader import UploadReader
from onpath.app.lab.commands.logs import ShowLog
from onpath.app.lab.commands.path import FollowCurve
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.shown_log import ShownLog
from onpath.lessons.words import Words
from onpath.models.errors import CodedError, Message
from onpath.models.path_files.placing import RADIUS, ROUND, SMOOTH, Placing

PART = 65_536  # [B] of a file that are sent to the page with each data frame

FileRequest = SendFile | SendPart | DropFile | MakeFile
"""What a page says of files."""


@dataclass(slots=True)
class _Coming:
    """A file for the page.

    Attributes:
        begin: its first message.
        sent: how much has been sent, [B]; None before the first message.
    """

    begin: DownloadMessage
    content: bytes
    sent: int | None = None


class ChannelDelivery(Delivery):
    """Brings files to a page in parts, with the frames of data."""

    def __init__(self) -> None:
        self._news, self._coming = deque[DownloadMessage](), deque[_Coming]()
        self._number = 0

    @override
    def making(self, name: str, words: Words) -> None:
        self._number += 1
        self._news.append(self._message(name, "making", words))

    @override
    def ready(self, name: str, content: bytes, words: Words) -> None:
        begin = self._message(name, "coming", words, len(content))
        self._coming.append(_Coming(begin, content))

    @override
    def failed(self, name: str, words: Words) -> None:
        self._news.append(self._message(name, "failed", words))

    def _message(
        self,
        name: str,
        state: Literal["making", "coming", "failed"],
        words: Words,
        size: int = 0,
    ) -> DownloadMessage:
        key = "ready" if state == "coming" else state
        text = words(f"export.{key}", name=name)
        return DownloadMessage(self._number, name, state, text, size)

    def take(self) -> list[Struct]:
        """The messages that the page is told next."""
        told = list[Struct]()
        while self._news:
            told.append(self._news.popleft())
        if self._coming:
            file = self._coming[0]
            if file.sent is None:
                told.append(file.begin)
                file.sent = 0
            part = file.content[file.sent : file.sent + PART]
            told.append(DownloadPart(file.begin.number, part))
            file.sent += len(part)
            if file.sent == len(file.content):
                self._coming.popleft()
        return told

    def restart(self) -> None:
        """The page has connected again: it has none of the file that was coming."""
        for file in self._coming:
            file.sent = None


class PageFiles:
    """The files of one page.

    Args:
        post: takes the command that follows the path in a file.
        code: the lab's code, for the record of lessons; empty for none.

    Attributes:
        delivery: brings files to the page.
        follows: whether the robots have been given the path of another file since this was reset.
    """

    def __init__(self, post: Callable[[Command], object], code: str = "") -> None:
        self._post, self._code = post, code
        self.delivery = ChannelDelivery()
        self.exporter = Exporter(self.delivery)
        self._inbox, self._reader = FileInbox(MOST_BYTES), UploadReader()
        self._wanted = deque[MakeFile]()
        self._arrived = deque[tuple[SendFile, bytes]]()
        self._news = deque[FileMessage]()
        self._language = "en"
        self.follows = False

    def hear(self, message: FileRequest) -> FileMessage | None:
        """Take a message of the page; returns the answer. On the event loop."""
        match message:
            case MakeFile():
                self._wanted.append(message)
                return None
            case DropFile():
                self._inbox.drop(message)
                return None
            case SendFile() | SendPart():
                return self._taken(message)

    def _taken(self, message: SendFile | SendPart) -> FileMessage:
        inbox = self._inbox
        file = message if isinstance(message, SendFile) else inbox.file
        try:
            if isinstance(message, SendFile):
                content = inbox.begin(message)
                asyncio.get_running_loop().call_later(SECONDS, self._expire, message.number)
            else:
                content = inbox.take(message)
        except CodedError as error:
            return self._refusal(message.number, error)
        if content is None:
            return FileMessage(message.number, "awaited", inbox.received)
        assert file is not None
        self._arrived.append((file, content))
        return FileMessage(message.number, "reading", len(content))

    def _expire(self, number: int) -> None:
        file = self._inbox.file
        if file is not None and file.number == number and self._inbox.expire():
            self._news.append(self._refusal(number, CodedError("error.file_late")))

    def _refusal(self, number: int, reason: Exception | Message) -> FileMessage:
        return FileMessage(number, "refused", why=Words(self._language).sentence(reason))

    def serve(self, lab: Lab) -> None:
        """Begin with what the page has asked for. In the simulation thread."""
        self._language = lab.words.language
        exporter = self.exporter
        while self._wanted:
            wanted = self._wanted.popleft()
            if wanted.file == "report":
                exporter.report(self._code if wanted.with_code else "")
            else:
                make = {
                    "table": exporter.csv,
                    "picture": exporter.picture,
                    "lines": exporter.lines,
                    "film": exporter.recording,
                }
                make[wanted.file]()
        exporter.serve(lab)
        while self._arrived:
            self._read(*self._arrived.popleft(), lab)

    def _read(self, file: SendFile, content: bytes, lab: Lab) -> None:
        if isinstance(file.use, LogFile):
            self._read_log(file, file.use, content, lab)
        else:
            self._read_path(file, file.use, content, lab)

    def _read_log(self, file: SendFile, use: LogFile, content: bytes, lab: Lab) -> None:
        upload = LogUpload(
            name=file.name,
            content=content,
            robot=lab.simulation.entry.name,
            parameters=lab.simulation.parameters,
            columns=use.columns,
            units=use.units,
        )
        words = Words(self._language)

        def take(read: ReadLog) -> None:
            if isinstance(read.found, ShownLog):
                self._post(ShowLog(read.found, read.is_whole))
            self._news.append(_log_message(file, read, words))

        self._reader.read_log(upload, take, lambda why: self._refuse(file, why))

    def _refuse(self, file: SendFile, reason: Exception | Message) -> None:
        self._news.append(self._refusal(file.number, reason))

    def _read_path(self, file: SendFile, use: PathFile, content: bytes, lab: Lab) -> None:
        simulation = lab.simulation
        upload = Upload(
            name=file.name,
            content=content,
            placing=_placing(use),
            robot=simulation.entry.name,
            parameters=simulation.parameters,
        )
        words = Words(self._language)

        def take(read: Read) -> None:
            found = read.found
            if isinstance(found, FollowCurve):
                self._post(found)
                self.follows |= not (file.again or read.why)
            self._news.append(_message(file, read, words))

        self._reader.read(upload, self._language, take, lambda why: self._refuse(file, why))

    def take(self) -> list[Struct]:
        """The messages that the page is told next. In the simulation thread."""
        told = list[Struct]()
        while self._news:
            told.append(self._news.popleft())
        return told + self.delivery.take()

    def restart(self) -> None:
        """The page has connected again."""
        self.delivery.restart()

    def close(self) -> None:
        """Make no further files. Thread-safe."""
        self.exporter.close()


def _placing(use: PathFile) -> Placing:
    return Placing(
        fit=use.size / 1e3 or None,
        centre=(use.right / 1e3, use.up / 1e3) if use.size or use.right or use.up else None,
        corners=ROUND if use.radius else SMOOTH,
        radius=use.radius / 1e3 or RADIUS,
        closed=False if use.opened else None,
        part=use.parts or None,
        turn=use.turn,
    )


def _message(file: SendFile, read: Read, words: Words) -> FileMessage:
    """What a page is told of a file that was read."""
    refusal = None if isinstance(read.found, FollowCurve) else read.found
    why = read.why if refusal is None else words.sentence(refusal)
    return FileMessage(
        number=file.number,
        state="refused" if why else "used",
        received=file.size,
        why=why,
        lines=tuple(
            tuple(np.rint(1000 * line).astype(int).ravel().tolist()) for line in read.lines
        ),
        helps=tuple(_help(placing, words.sentence(text)) for text, placing in read.helps),
    )


def _log_message(file: SendFile, read: ReadLog, words: Words) -> FileMessage:
    """What a page is told of a log that was read."""
    found = read.found
    why = "" if isinstance(found, ShownLog) else words.sentence(found)
    return FileMessage(
        number=file.number,
        state="refused" if why else "used",
        received=file.size,
        why=why,
        columns=read.columns,
        quantities=read.quantities,
    )


def _help(placing: Placing, text: str) -> PathHelp:
    radius = 1e3 * placing.radius if placing.corners == ROUND else 0.0
    return PathHelp(text=text, size=1e3 * (placing.fit or 0.0), radius=radius)
