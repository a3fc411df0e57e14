"""The data channel of a page of the lab: its ticket, what it tells, and the commands it takes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from typing import Any

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL
from tests.support import waiting
from tests.support.channel import hello
from tests.support.student import Student

WAIT = 30.0
wait_for = partial(waiting.wait_for, seconds=WAIT)


@pytest.fixture(scope="module")
def room() -> Classroom:
    return Classroom()


@pytest.fixture(scope="module")
def server(room: Classroom) -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    yield server
    server.stop()


@pytest.fixture
def student(server: LabServer) -> Iterator[Student]:
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        yield student


def ticket_of(student: Student) -> str:
    """The ticket in the page, as its script finds it."""

    def found() -> re.Match[str] | None:
        contents = [str(widget.get("content", "")) for widget in student.widgets.values()]
        return re.search(r'data-ticket="([^"]+)"', " ".join(contents))

    student.read(lambda: found() is not None)
    return found()[1]  # type: ignore[index]


class Script:
    """The page's script: its data channel, and what it has been told."""

    def __init__(self, server: LabServer, ticket: str) -> None:
        address = f"ws://127.0.0.1:{server.server.get_port()}"
        self.socket: ClientConnection = connect(
            address, subprotocols=[Subprotocol(SUBPROTOCOL)], compression=None, close_timeout=0.5
        )
        self.socket.send(hello(ticket))
        self.told: dict[str, dict[str, Any]] = {}

    def __enter__(self) -> Script:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def read(self, kind: str) -> dict[str, Any]:
        """The next message of a kind."""
        while True:
            message = msgspec.json.decode(self.socket.recv(WAIT))
            told = self.told.get("state", {}) if message["is"] == "state" else {}
            self.told[message["is"]] = message = {**told, **message}
            if message["is"] == kind:
                return message

    def read_until(self, kind: str, condition: Any) -> dict[str, Any]:
        """The next message of a kind for which a condition holds."""
        while not condition(message := self.read(kind)):
            pass
        return message

    def light(self, symbol: str) -> None:
        self.socket.send(f'{{"is":"light","symbol":"{symbol}"}}')

    def do(self, command: str, /, **fields: Any) -> None:
        self.socket.send(msgspec.json.encode({"do": command, **fields}).decode())


def test_a_page_is_told_everything_first_and_then_what_changes(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        frame = script.read("frame")
        assert frame["anew"] and script.told["path"]["closed"]  # known before it is needed
        state = script.told.get("state") or script.read("state")  # in either order
        assert state["v"] == 2 and state["language"] == "en" and state["own"]
        assert state["titles"] == ["Trajectory tracking", "Path following"]
        assert state["clocks"] == [True, False]
        later = script.read("frame")
        assert "anew" not in later and later["running"]
        assert 1 <= len(later["rows"]) < 10
        script.do("ChooseLaw", side="right", law="set_point")
        state = script.read_until("state", lambda state: state["titles"][1] != "Path following")
        assert state["texts"][0] != state["texts"][1]
        script.do("ChoosePath", name="segment")
        assert not script.read_until("path", lambda path: not path["closed"])["closed"]


def test_commands_of_the_page_reach_its_lab(server: LabServer, student: Student) -> None:
    with Script(server, ticket_of(student)) as script:
        script.do("Hold", on=True)
        script.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)
        script.do("SetRunning", running=False)
        script.read_until("frame", lambda frame: not frame["running"])
        script.do("LookAt", ago=0.2)
        script.read_until("frame", lambda frame: frame["past"] is not None)
        script.do("Reset")
        assert script.read_until("frame", lambda frame: frame.get("anew"))["rows"][0][0] == 0


def test_what_a_symbol_of_joints_means_is_told_while_it_is_asked_for(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        script.read("frame")
        script.light("rho")
        before = script.read("lit")
        (base, tip), (other, _) = before["lines"]
        assert before["symbol"] == "rho" and base == other
        row = script.told["frame"]["rows"][-1]
        assert tip == pytest.approx(row[5:7], abs=2000)  # 20 mm: it has moved since then
        script.read_until("lit", lambda lit: lit["lines"] != before["lines"])
        script.light("q_1")
        assert len(script.read_until("lit", lambda lit: lit["symbol"] == "q_1")["lines"]) == 2
        script.light("")
        script.do("Set", name="rate", value=2)
        script.read_until("state", lambda state: state["rate"] == 2)
        script.read("frame")
        del script.told["lit"]
        for _ in range(5):
            script.read("frame")
        assert "lit" not in script.told
        script.light("lambda")  # the page knows it
        assert "Invalid enum value" in script.read("refused")["why"]


def test_a_symbol_without_a_meaning_on_the_robot_is_not_told(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        script.do("ChooseRobot", name="rod_gantry")
        script.read_until("state", lambda state: state.get("robot") == "rod_gantry")
        script.light("q_1")
        for _ in range(5):
            script.read("frame")
        assert "lit" not in script.told


def test_what_is_no_command_is_answered_and_the_channel_goes_on(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        for message, why in {
            '{"do": "Dance"}': "no such command",
            '{"do": "Freeze", "on": true}': "no such command",
            '{"do": "Hold", "on": "yes"}': "Expected `bool | null`",
            "hold": "malformed",
        }.items():
            script.socket.send(message)
            assert why in script.read("refused")["why"]
        script.do("Hold", on=True)
        script.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)


def test_a_command_that_is_not_possible_is_told_in_the_pages_language(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        script.do("SetLanguage", language="de")
        script.read_until("state", lambda state: state["language"] == "de")
        script.do("Set", name="rate", value=1000)
        state = script.read_until("state", lambda state: state["message"])
        assert state["level"] == "warning" and "1000" in state["message"]
        assert state["titles"] != ["Trajectory tracking", "Path following"]
        script.do("Set", name="rate", value=1000)  # told again, though nothing else changes
        assert script.read_until("state", lambda new: new["messages"] != state["messages"])


def test_a_canvas_of_another_size_is_framed_anew(server: LabServer, student: Student) -> None:
    with Script(server, ticket_of(student)) as script:
        script.read("frame")
        (page,) = [
            feed.page
            for feed in server._feeds.values()
            if feed._data and feed._data._stream.is_open
        ]
        page._settling = 0
        script.socket.send('{"is":"resized"}')
        wait_for(lambda: page._settling > 0)


def test_no_page_has_the_ticket_of_another(server: LabServer, student: Student) -> None:
    with Student(student.address) as other:
        other.open()
        assert ticket_of(student) != ticket_of(other)
        with Script(server, ticket_of(other)) as script, Script(server, ticket_of(student)) as own:
            script.do("Hold", on=True)
            script.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)
            own.do("Set", name="rate", value=2)
            own.read_until("state", lambda state: state["rate"] == 2)
            assert own.read("frame")["rows"][-1][1] == 0


def test_a_ticket_ends_with_its_tab(server: LabServer, student: Student) -> None:
    before = server._channel.tickets
    with Student(student.address) as other:
        other.open()
        ticket = ticket_of(other)
        script = Script(server, ticket)
        script.read("frame")
    with suppress(ConnectionClosed):
        while True:
            script.read("nothing")
    wait_for(lambda: server._channel.tickets <= before)
    with Script(server, ticket) as again, pytest.raises(ConnectionClosed):
        again.read("frame")


def test_a_page_that_is_built_anew_keeps_its_ticket(server: LabServer, student: Student) -> None:
    ticket = ticket_of(student)
    with Script(server, ticket) as script:
        script.read("frame")
        student.widgets.clear()
        script.do("ChooseRobot", name="two_link_arm")
        assert ticket_of(student) == ticket
        script.read_until("state", lambda state: state["robot"] == "two_link_arm")
        script.read("frame")


def test_a_lab_without_a_listener_is_told_nothing(server: LabServer, student: Student) -> None:
    ticket_of(student)
    (feed,) = wait_for(lambda: list(server._feeds.values()))
    moving = student.moving
    student.read(lambda: student.moving > moving + 20)
    source = feed._data._source
    assert source._latest == [] and source._simulation is None and feed._data._state is None


def test_a_teacher_is_told_of_the_lab_that_is_shown_and_cannot_act_on_it(
    server: LabServer, student: Student, room: Classroom
) -> None:
    address = f"{student.address}/c/{room.code}"
    with Student(address) as ada, Student(address) as teacher:
        ada.open()
        ada.set("Nickname", "Ada")
        ada.set("Join the class", True)
        teacher.open()
        learner = ticket_of(teacher)
        teacher.set("Teacher's key", room.key)
        teacher.set("Open the teacher's page", True)
        teacher.find("Follow")
        ticket = ticket_of(teacher)
        assert ticket != learner and learner not in server._channel._streams
        with Script(server, ticket) as script, Script(server, ticket_of(ada)) as own:
            script.read("frame")
            teacher.find("1. Ada")
            teacher.set("Follow", "1. Ada")
            assert not script.read_until("state", lambda state: not state["own"])["own"]
            own.do("Hold", on=True)
            script.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)
            script.do("Hold", on=False)
            assert "only shown" in script.read("refused")["why"]


def test_a_page_to_which_nothing_is_told_hears_that_the_lab_lives(
    server: LabServer, student: Student
) -> None:
    with Script(server, ticket_of(student)) as script:
        script.read("frame")
        script.do("SetRunning", running=False)
        script.read_until("frame", lambda frame: not frame["running"])
        for _ in range(2):
            script.told.clear()
            script.read("alive")


def test_a_page_that_could_not_be_built_comes_again(
    server: LabServer, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Its browser connects again; before, it stayed without a feed."""
    genuine, fails = server._feed, [True]

    def feed(*what: Any) -> Any:
        if fails and fails.pop():
            raise OSError("this once")
        return genuine(*what)

    monkeypatch.setattr(server, "_feed", feed)
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.wait_until_closed()
        assert "this once" in caplog.text
        student.reopen()
        assert ticket_of(student)
