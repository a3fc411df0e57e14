"""What a page is told of its lab, and the commands that it sends."""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterator
from functools import partial
from typing import Any

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.classroom.classroom import Classroom
from onpath.app.common import error_log
from onpath.app.scene.client_scene import ClientScene
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL
from tests.bench.client_protocol import SEEN, hello
from tests.bench.simulated_browser import SEES
from tests.support import waiting
from tests.support.own_socket import feeds
from tests.support.student import Student

WAIT = 30.0
wait_for = partial(waiting.wait_for, seconds=WAIT)


class Script:
    """The page's script without viser's part: its websocket, and what it has been told."""

    def __init__(self, address: str, page: str = "") -> None:
        self.page = page or secrets.token_hex(16)
        self.socket: ClientConnection = connect(
            address, subprotocols=[Subprotocol(SUBPROTOCOL)], compression=None, close_timeout=0.5
        )
        self.socket.send(hello(self.page))
        self.told: dict[str, dict[str, Any]] = {}

    def __enter__(self) -> Script:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def read(self, kind: str) -> dict[str, Any]:
        """The next message of a kind."""
        while True:
            message = msgspec.json.decode(self._received())
            told = self.told.get("state", {}) if message["is"] == "state" else {}
            self.told[message["is"]] = message = {**told, **message}
            if message["is"] == kind:
                return message

    def _received(self) -> str | bytes:
        """The next message; the page tells that it is drawn while none comes."""
        end = time.monotonic() + WAIT
        while True:
            try:
                return self.socket.recv(SEES)
            except TimeoutError:
                if time.monotonic() > end:
                    raise
                self.socket.send(SEEN)

    def read_until(self, kind: str, condition: Any) -> dict[str, Any]:
        """The next message of a kind for which a condition holds.

        Raises:
            TimeoutError: none comes.
        """
        end = time.monotonic() + WAIT
        while not condition(message := self.read(kind)):
            if time.monotonic() > end:
                raise TimeoutError(kind)
        return message

    def light(self, symbol: str) -> None:
        self.wait()
        self.socket.send(f'{{"is":"light","symbol":"{symbol}"}}')

    def wait(self) -> None:
        """Wait for the lab."""
        if "frame" not in self.told:
            self.read("frame")

    def do(self, command: str, /, **fields: Any) -> None:
        self.wait()
        self.socket.send(msgspec.json.encode({"do": command, **fields}).decode())


@pytest.fixture
def address(server: LabServer) -> str:
    return f"ws://127.0.0.1:{server.server.get_port()}"


@pytest.fixture
def script(address: str) -> Iterator[Script]:
    with Script(address) as script:
        yield script


def test_a_page_is_told_everything_first_and_then_what_changes(script: Script) -> None:
    frame = script.read("frame")
    assert frame["anew"] and script.told["path"]["closed"]  # known before it is needed
    state = script.told.get("state") or script.read("state")  # in either order
    assert state["language"] == "en" and state["own"]
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


def test_commands_of_the_page_reach_its_lab(script: Script) -> None:
    script.do("Hold", on=True)
    script.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)
    script.do("SetRunning", running=False)
    script.read_until("frame", lambda frame: not frame["running"])
    script.do("LookAt", ago=0.2)
    script.read_until("frame", lambda frame: frame["past"] is not None)
    script.do("Reset")
    assert script.read_until("frame", lambda frame: frame.get("anew"))["rows"][0][0] == 0


def test_what_a_symbol_of_joints_means_is_told_while_it_is_asked_for(script: Script) -> None:
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


def test_a_symbol_without_a_meaning_on_the_robot_is_not_told(script: Script) -> None:
    script.do("ChooseRobot", name="rod_gantry")
    script.read_until("state", lambda state: state.get("robot") == "rod_gantry")
    script.light("q_1")
    for _ in range(5):
        script.read("frame")
    assert "lit" not in script.told


def test_what_is_no_command_is_answered_and_the_channel_goes_on(script: Script) -> None:
    script.wait()
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


def test_a_command_that_is_not_possible_is_told_in_the_pages_language(script: Script) -> None:
    script.do("SetLanguage", language="de")
    script.read_until("state", lambda state: state["language"] == "de")
    script.do("Set", name="rate", value=1000)
    state = script.read_until("state", lambda state: state["message"])
    assert state["level"] == "warning" and "1000" in state["message"]
    assert state["titles"] != ["Trajectory tracking", "Path following"]
    script.do("Set", name="rate", value=1000)  # told again, though nothing else changes
    assert script.read_until("state", lambda new: new["messages"] != state["messages"])


@pytest.mark.thorough
def test_a_page_to_which_nothing_is_told_hears_that_the_lab_lives(script: Script) -> None:
    script.read("frame")
    script.do("SetRunning", running=False)
    script.read_until("frame", lambda frame: not frame["running"])
    for _ in range(2):
        script.told.clear()
        script.read("alive")


def test_a_page_that_listens_again_is_told_everything(server: LabServer, address: str) -> None:
    with Script(address) as script:
        script.read("frame")
        script.do("Set", name="rate", value=2)
        script.read_until("state", lambda state: state["rate"] == 2)
        with Script(address, script.page) as again:
            assert again.read("state")["rate"] == 2
            assert again.read("words")["language"] == "en" if "words" not in again.told else True
            with pytest.raises(ConnectionClosed):
                script.read("nothing")
        assert len(server.visits) <= 1


def test_a_canvas_of_another_size_is_framed_anew(server: LabServer, address: str) -> None:
    with Student(address) as student:
        student.open()
        student.read(lambda: student.moving > 3)
        (feed,) = feeds(server).values()
        page = feed.scene
        assert page is not None
        page._settling = 0
        student.tell({"is": "resized"})
        wait_for(lambda: page._settling > 0)


def test_a_page_that_is_told_nothing_of_another_s_lab(address: str) -> None:
    with Script(address) as other, Script(address) as own:
        other.do("Hold", on=True)
        other.read("frame")
        other.do("Hold", on=True)
        other.read_until("frame", lambda frame: frame["rows"][-1][1] == 3)
        own.read("frame")
        own.do("Set", name="rate", value=2)
        own.read_until("state", lambda state: state["rate"] == 2)
        assert own.read("frame")["rows"][-1][1] == 0


def test_a_page_keeps_its_websocket_when_its_scene_is_built_anew(address: str) -> None:
    with Student(address) as student:
        student.open()
        student.read(lambda: student.moving and student.state)
        student.tell({"do": "ChooseRobot", "name": "two_link_arm"})
        student.read(lambda: student.state["robot"] == "two_link_arm")
        moving = student.moving
        student.read(lambda: student.moving > moving)
        with Script(address, student.page) as script:
            script.read_until("state", lambda state: state["robot"] == "two_link_arm")
            script.read("frame")


def test_a_lab_whose_page_does_not_listen_is_told_nothing(server: LabServer, address: str) -> None:
    with Student(address) as student:
        student.open()
        student.read(lambda: student.moving > 3)
        student.listen_no_more()  # viser's websocket remains
        (visit,) = server.visits
        wait_for(lambda: not visit.stream.is_open)
        opened, moving = visit.stream.opened, student.moving
        student.read(lambda: student.moving > moving + 20)
        assert visit.stream.opened == opened and not visit.stream.is_busy


@pytest.mark.thorough
def test_a_teacher_is_told_of_the_lab_that_is_shown_and_cannot_act_on_it(
    address: str, room: Classroom
) -> None:
    address = f"{address}/c/{room.code}"
    with Student(address) as ada, Student(address) as teacher:
        ada.open()
        ada.join("Ada")
        teacher.open()
        teacher.teach(room.key)
        teacher.set("class.follow", 1)
        teacher.read(lambda: not teacher.state["own"])
        ada.tell({"do": "Hold", "on": True})
        teacher.read(lambda: teacher.told["frame"]["rows"][-1][1] == 3)
        teacher.tell({"do": "Hold", "on": False})
        teacher.read(lambda: "only shown" in teacher.told.get("refused", {}).get("why", ""))


@pytest.mark.parametrize("part", ["_feed", "_build"])
def test_a_page_that_could_not_be_made_comes_again(
    server: LabServer,
    address: str,
    part: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fails = [True]
    holder, name = (server, "_feed") if part == "_feed" else (ClientScene, "__init__")
    genuine = getattr(holder, name)

    def made(*what: Any, **named: Any) -> Any:
        if fails and fails.pop():
            raise OSError("this once")
        return genuine(*what, **named)

    monkeypatch.setattr(holder, name, made)
    before = error_log._seen.total()
    with Student(address) as student:
        student.open()
        student.wait_until_closed()
        assert error_log._seen.total() > before  # logged in full once in a process
        student.reopen()
        student.read(lambda: student.moving)
