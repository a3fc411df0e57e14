"""A class of scripted students, who do what classes do, while things go wrong.

The server has one core, the students have the others. A student is a page's own websocket: it keeps
each vote until the server says that it is stored, and sends it again whenever it has connected
again, as assets/web does. Times are those that students see.
"""

from __future__ import annotations

import asyncio
import json
import os
import random
import secrets
import statistics
import sys
import tempfile
from collections.abc import Awaitable, Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException
from websockets.typing import Subprotocol

from onpath.app.channel.form_messages import AskForm
from onpath.app.channel.messages import encoded
from onpath.app.classroom.admission import class_code_of
from onpath.app.common.access_codes import shown
from onpath.app.storage.database_url import DATABASE
from onpath.app.storage.records import Records, file_url
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL
from onpath.lessons.progress import read_progress
from tests.bench.client_protocol import SEEN, hello
from tests.bench.simulated_browser import SEES
from tests.support.lab_process import LabProcess, free_ports
from tests.support.site import HOST, NGINX, ORIGIN, site
from tests.support.starved import starved

KEY = "k7mf2xqa9tzr"
LESSON, QUESTION = "01-path-or-timetable", 4
AGAIN = 0.5  # [s] between a page's tries to connect
PATIENCE = 400.0  # [s], longer than the longest cut; only ends a run that would hang


class Page:
    """A page's own websocket, which connects again whenever it is lost.

    Args:
        address: URL of the websocket.
        through: port on this machine that has it; 0: that of the address.

    Attributes:
        told: the last message of each kind; of the form's values, all.
        option: what was voted for last. A vote for the same again is no other answer.
        since: when it was connected last.
        seen: when each step of `LESSON` was shown first, since it was connected last.
        moved: when robots moved first since then; 0: they have not.
    """

    def __init__(self, address: str, through: int, origin: str) -> None:
        self._address, self._through, self._origin = address, through, origin
        self.told, self.seen = dict[str, dict[str, Any]](), dict[int, float]()
        self.code = self.teacher = ""
        self.since = self.moved = 0.0
        self.option = 0
        self.pending = dict[str, dict[str, Any]]()
        self.stored = dict[str, float]()
        self._awake = asyncio.Event()
        self._awake.set()
        self._page = ""
        self._socket: ClientConnection | None = None
        self._dead: ClientConnection | None = None  # of a cable that was pulled
        self._tasks = list[asyncio.Task[None]]()
        self._number = 0

    def load(self) -> None:
        """Load the page, and be connected from now on."""
        self._page = secrets.token_hex(16)
        self.plug_in()

    def plug_in(self) -> None:
        """Be connected from now on, as the page that it was."""
        if self._dead is not None:
            self._dead.transport.abort()
        self._tasks = [asyncio.create_task(each) for each in (self._stay(), self._draw())]

    async def pull(self, *, silently: bool = False) -> None:
        """Be cut off; silently as by a cable: nobody is told."""
        for task in self._tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task
        self._dead, self._socket = self._socket, None
        if self._dead is not None and not silently:
            self._dead.transport.abort()
        self.since = 0.0

    def sleep(self) -> None:
        """Read and send nothing, as a page on a phone that has been put away."""
        self._awake.clear()

    def wake(self) -> None:
        """Go on after a sleep."""
        self._awake.set()

    async def _stay(self) -> None:
        while True:
            await self._awake.wait()
            with suppress(OSError, WebSocketException, TimeoutError):
                await self._serve()
            self._socket, self.since = None, 0.0
            await asyncio.sleep(AGAIN)

    async def _draw(self) -> None:
        """Say that it is drawn, whether or not it is told anything."""
        while True:
            await self._awake.wait()
            if (socket := self._socket) is not None:
                with suppress(WebSocketException):
                    await socket.send(SEEN)
            await asyncio.sleep(SEES)

    async def _serve(self) -> None:
        way = {"host": "127.0.0.1", "port": self._through} if self._through else {}
        self._socket = socket = await connect(
            self._address,
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            compression=None,
            max_size=None,
            ping_interval=None,  # a browser does not ping
            close_timeout=0.5,
            additional_headers={"Origin": self._origin} if self._origin else {},
            **way,
        )
        self.told.clear()
        self.seen.clear()
        self.moved = 0.0
        await socket.send(hello(self._page, labs=self.code, teacher=self.teacher))
        async for raw in socket:
            await self._awake.wait()
            await self._take(json.loads(raw))

    async def _take(self, message: dict[str, Any]) -> None:
        kind = message["is"]
        match message:
            case {"is": "lab", "code": code}:
                self.code, self.since = code, monotonic()
                await self.tell(json.loads(encoded(AskForm())), *self.pending.values())
            case {"is": "store", "key": "teacher", "value": value}:
                self.teacher = value
            case {"is": "state"}:
                for key in {*message.get("sent", ())} & self.pending.keys():
                    del self.pending[key]
                    self.stored[key] = monotonic()
            case {"is": "lesson", "lesson": lesson} if lesson == LESSON:
                self.seen.setdefault(message["index"], monotonic())
            case {"is": "frame"}:
                self.moved = self.moved or monotonic()
            case {"is": "values"}:
                known = self.told.get("values", {}).get("values", {})
                message = {**message, "values": {**known, **message.get("values", {})}}
            case _:
                pass
        self.told[kind] = message

    async def tell(self, *messages: dict[str, Any]) -> None:
        """Send messages, if it is connected."""
        socket = self._socket
        if socket is not None:
            with suppress(WebSocketException):
                for message in messages:
                    await socket.send(json.dumps(message))

    async def vote(self, key: str) -> float:
        """Answer the question otherwise, and return how long it takes until this is stored, [s]."""
        begun, option = monotonic(), 1 - self.option
        self.option = option
        vote = {"do": "Predict", "lesson": LESSON, "step": QUESTION, "option": option, "key": key}
        self.pending[key] = vote
        if self.since:
            await self.tell(vote)
        await until(lambda: key in self.stored, f"{key} is stored")
        return self.stored[key] - begun

    async def set(self, name: str, value: Any) -> None:
        """Set a field of the teacher's page."""
        self._number += 1
        await self.tell({"is": "set", "name": name, "value": value, "number": self._number})


async def until(condition: Callable[[], Any], what: str) -> None:
    """Wait for something.

    Raises:
        ValueError: it does not come.
    """
    end = monotonic() + PATIENCE
    while not condition():
        if monotonic() > end:
            raise ValueError(f"in vain: {what}")
        await asyncio.sleep(0.01)


@dataclass
class Lecture:
    """A teacher, students, and the server's processes.

    Attributes:
        address, through, origin: see `Page`.
        processes: of the server; the first one that has connections can be killed.
        records: what is stored.
    """

    address: str
    through: int
    origin: str
    processes: list[LabProcess]
    records: Records
    students: list[Page] = field(default_factory=list[Page])
    _round: int = 0

    def page(self) -> Page:
        """A new page of the class."""
        page = Page(self.address, self.through, self.origin)
        page.load()
        return page

    async def begin(self, count: int, within: float) -> None:
        """A teacher comes, students join within a time, [s], and are sent the question."""
        self.teacher = self.page()
        await until(lambda: "class" in self.teacher.told, "the teacher's page")
        await self.teacher.tell({"is": "teach", "key": shown(KEY)})
        await until(lambda: "class.table" in self._values, "the teacher's form")

        async def come(number: int) -> Page:
            await asyncio.sleep(within * number / count)
            page = self.page()
            await until(lambda: page.told.get("class", {}).get("membership") == "guest", "a seat")
            await page.tell({"is": "join", "code": "", "name": f"Student {number}"})
            await until(lambda: page.told["class"]["membership"] == "member", "a member")
            return page

        self.students = list(await asyncio.gather(*map(come, range(count))))
        await self.teacher.set("class.lesson", LESSON)
        await self.teacher.set("class.step", QUESTION)
        await until(lambda: self._values.get("class.step") == QUESTION, "the step")
        await self.push("send_step", QUESTION)

    @property
    def _values(self) -> dict[str, Any]:
        return self.teacher.told.get("values", {}).get("values", {})

    async def push(self, order: str, step: int) -> float:
        """Send a step to all, and return how long it takes until the last one sees it, [s]."""
        for each in self.students:
            each.seen.pop(step, None)
        begun = monotonic()
        await self.teacher.tell({"is": "lead", "do": order})
        await until(lambda: all(step in each.seen for each in self.students), f"step {step}")
        return max(each.seen[step] for each in self.students) - begun

    async def votes(self, within: float = 0.0, of: Sequence[Page] = ()) -> list[float]:
        """Students vote within a time, [s]: how long each waits until the vote is stored, [s].

        Args:
            of: those who vote; all by default.

        Raises:
            ValueError: a vote was lost or doubled.
        """
        self._round += 1
        key = f"round{self._round}"

        async def vote(each: Page) -> float:
            await asyncio.sleep(random.uniform(0.0, within))  # as people do
            return await each.vote(key)

        voters = of or self.students
        waits = list[float](await asyncio.gather(*map(vote, voters)))
        for each in voters:
            state = self.records.load(each.code) or {}
            notes = read_progress(state.get("lessons")).notes[LESSON]
            if [given.key for given in notes.given].count(key) != 1:
                raise ValueError(f"a vote of {key} was lost or doubled")
        return waits

    async def reload(self) -> tuple[float, float]:
        """All load the page again: until all have a working vote, and robots that move, [s]."""
        for each in self.students:
            await each.pull()
        begun = monotonic()
        for each in self.students:
            each.load()
        await self.votes()
        voted = max(max(each.stored.values()) for each in self.students)
        await until(lambda: all(each.moved for each in self.students), "robots")
        return voted - begun, max(each.moved for each in self.students) - begun

    async def kill(self) -> float:
        """kill -9 while all vote: until the last vote is stored, [s]."""
        process = next(each for each in self.processes if each.connections())
        begun = monotonic()
        process.kill()
        with server_core():
            process.start_again(waits=False)
        await self.votes()
        return max(max(each.stored.values()) for each in self.students) - begun

    async def starve(self, seconds: float) -> float:
        """All vote while the server has a tenth of a core: from then on, until all is stored, [s].

        It is 0 if everything was stored meanwhile.
        """
        process = next(each for each in self.processes if each.connections())
        pid = process.process.pid
        with starved(pid):
            votes = asyncio.create_task(self.votes(within=seconds))
            await asyncio.sleep(seconds)
            end = monotonic()
        await votes
        if process.process.poll() is not None or process.process.pid != pid:
            raise ValueError("the process has ended")
        return max(0.0, max(max(each.stored.values()) for each in self.students) - end)

    async def cut_off(self, seconds: float) -> float:
        """The cable is pulled, and all vote meanwhile: from its return until the last is back."""
        for each in self.students:
            await each.pull(silently=True)
        votes = asyncio.create_task(self.votes())
        await asyncio.sleep(seconds)
        begun = monotonic()
        for each in self.students:
            each.plug_in()
        await votes
        await until(lambda: all(QUESTION in each.seen for each in self.students), "the question")
        return max(max(max(e.stored.values()), e.seen[QUESTION]) for e in self.students) - begun

    async def doze(self, seconds: float) -> float:
        """Half of the phones sleep while the others vote: from their waking until all are back."""
        sleeping, voting = self.students[::2], self.students[1::2]
        for each in sleeping:
            each.sleep()
        await self.votes(of=voting)
        await asyncio.sleep(seconds)
        begun = monotonic()
        for each in sleeping:
            each.wake()
        await self.votes(of=sleeping)
        return max(max(each.stored.values()) for each in sleeping) - begun

    async def end(self) -> None:
        """All leave."""
        for each in (*self.students, self.teacher):
            await each.pull()


@contextmanager
def server_core() -> Iterator[None]:
    """Start a server on the first core, and go on on the others, if there are several."""
    cores = list(range(os.cpu_count() or 1))
    os.sched_setaffinity(0, cores[:1])
    try:
        yield
    finally:
        os.sched_setaffinity(0, cores[1:] or cores)


Row = Callable[[Lecture], Awaitable[str]]


async def quiet(lecture: Lecture) -> str:
    """The row of a quiet lecture."""
    waits = await lecture.votes(within=10.0)
    pushed = await lecture.push("next", QUESTION + 1)
    back = await lecture.push("back", QUESTION)
    found = f"vote {statistics.median(waits):.2f} / {max(waits):.2f} s"
    return f"{found}; a push is seen by all after {pushed:.2f} and {back:.2f} s"


async def reloaded(lecture: Lecture) -> str:
    """The row of a class that reloads."""
    voted, moved = await lecture.reload()
    return f"a working vote for all after {voted:.1f} s, robots after {moved:.1f} s"


async def killed(lecture: Lecture) -> str:
    """The row of a process that is killed."""
    return f"the last vote is stored after {await lecture.kill():.1f} s"


def starving(seconds: float) -> Row:
    """The row of a tenth of the machine."""

    async def row(lecture: Lecture) -> str:
        return f"the last vote is stored {await lecture.starve(seconds):.1f} s later"

    return row


def cut(seconds: float) -> Row:
    """The row of a cable that is pulled."""

    async def row(lecture: Lecture) -> str:
        return f"the last one is back {await lecture.cut_off(seconds):.1f} s after the network"

    return row


def dozing(seconds: float) -> Row:
    """The row of phones that sleep."""

    async def row(lecture: Lecture) -> str:
        return f"the last one is back {await lecture.doze(seconds):.1f} s after it wakes"

    return row


def rows(long: bool) -> dict[str, tuple[bool, Row]]:
    """The rows of the table: whether there are two processes behind nginx, and what is done."""
    return {
        "quiet": (False, quiet),
        "all reload": (False, reloaded),
        "kill -9, one process": (False, killed),
        "kill -9, two behind nginx": (True, killed),
        "a tenth of a core for 30 s": (False, starving(30.0 if long else 5.0)),
        "cable pulled": (False, cut(300.0 if long else 3.0)),
        "half of the phones asleep": (False, dozing(300.0 if long else 3.0)),
    }


def bench_class(count: int, only: str = "", *, long: bool = True) -> None:
    """Print what each row of the table gives with so many students, with a server of its own each.

    Args:
        only: how the names of the rows begin.
        long: whether times are those of the table.

    Raises:
        ValueError: a vote was lost or doubled, or something did not come.
    """
    for name, (two, row) in rows(long).items():
        if name.startswith(only) and not (two and NGINX is None):
            told = asyncio.run(_of(count, 60.0 if long else 2.0, two, row))
            sys.stdout.write(f"{name:28} {told}\n")
            sys.stdout.flush()


def minute_of(count: int) -> None:
    """The rows without a kill in turn, with one class, each for a few seconds.

    Raises:
        ValueError: a vote was lost or doubled, or something did not come.
    """

    async def run() -> None:
        with _served(count, two=False) as lecture:
            await lecture.begin(count, within=2.0)
            for row in (quiet, reloaded, starving(3.0), cut(2.0), dozing(2.0)):
                sys.stdout.write(f"{await row(lecture)}\n")
            await lecture.end()

    cores = os.sched_getaffinity(0)
    try:
        asyncio.run(run())
    finally:
        os.sched_setaffinity(0, cores)


async def _of(count: int, within: float, two: bool, row: Row) -> str:
    with ExitStack() as stack:
        lecture = stack.enter_context(_served(count, two))
        await lecture.begin(count, within)
        told = await row(lecture)
        await lecture.end()
        return told


@contextmanager
def _served(count: int, two: bool) -> Iterator[Lecture]:
    """One process, or two behind nginx as supplied, with a database file."""
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        url, path = file_url(folder / "labs.db"), f"c/{class_code_of(KEY)}/"
        own = {"ONPATH_TEACHER_KEY": KEY, "XDG_DATA_HOME": name}
        options = ["--classroom", "--most-clients", str(count + 10)]
        with server_core():
            if two:
                found = stack.enter_context(site(folder, str(url), options, **own))
                processes, through, origin = found.processes, found.port, ORIGIN
                address = f"ws://{HOST}/{path}"
            else:
                (port,) = free_ports(1)
                told = [*options, "--log-level", "error"]
                process = LabProcess(port, told, {DATABASE: str(url), **own})
                stack.callback(process.kill)
                process.wait_until_well()
                processes, through, origin = [process], 0, ""
                address = f"ws://127.0.0.1:{port}/{path}"
        records = Records(url)
        stack.callback(records.close)
        yield Lecture(address, through, origin, processes, records)
