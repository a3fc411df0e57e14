"""Files to and from a page, over its data channel."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import Any

import msgspec
import pytest

from onpath.app.channel.file_messages import MakeFile
from onpath.app.channel.messages import encoded
from onpath.app.lab.commands import SetLanguage
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.page_files import PART, ChannelDelivery, PageFiles
from onpath.lessons.words import ENGLISH, Words
from tests.app.server.test_page_data import Script
from tests.support.lab import do, new_lab
from tests.support.waiting import wait_for

CIRCLE = "x,y\n0,0.05\n0.05,0\n0,-0.05\n-0.05,0\n0,0.05\n"


def told(files: PageFiles) -> list[dict[str, Any]]:
    return [msgspec.json.decode(encoded(each)) for each in files.take()]


def test_a_file_comes_in_parts_that_are_the_file() -> None:
    delivery, content = ChannelDelivery(), bytes(range(256)) * (PART // 100)
    delivery.making("a.png", ENGLISH)
    delivery.ready("a.png", content, ENGLISH)
    first = [msgspec.json.decode(encoded(each)) for each in delivery.take()]
    assert [each.get("state") for each in first] == ["making", "coming", None]
    assert first[1]["size"] == len(content) and "a.png" in first[1]["text"]
    delivery.restart()  # the page has connected again, and begins anew
    parts, begun = b"", 0
    while messages := delivery.take():
        for each in messages:
            message = msgspec.json.decode(encoded(each))
            begun += message["is"] == "download"
            if message["is"] == "part":
                assert message["number"] == first[1]["number"]
                part = base64.b64decode(message["content"])
                assert len(part) <= PART
                parts += part
    assert parts == content and begun == 1


def test_an_empty_file_comes_too() -> None:
    delivery = ChannelDelivery()
    delivery.ready("a.csv", b"", ENGLISH)
    assert len(delivery.take()) == 2
    assert not delivery.take()


@pytest.mark.thorough
def test_what_is_made_is_told_in_the_pages_language_and_one_at_a_time() -> None:
    lab, commands = new_lab(0.2), list[Any]()
    do(lab, SetLanguage("de"))
    files = PageFiles(commands.append)
    for kind in ("table", "picture"):
        files.hear(MakeFile(kind))
    files.serve(lab)
    (making,) = told(files)
    german = Words("de")
    assert making["text"] == german("export.making", name="onpath.csv")
    assert lab.message == german("export.busy")
    messages = list[dict[str, Any]]()

    def has_come() -> bool:
        messages.extend(told(files))
        return any(each["is"] == "part" for each in messages)

    wait_for(has_come, 120.0)
    while more := told(files):
        messages += more
    content = b"".join(base64.b64decode(m["content"]) for m in messages if m["is"] == "part")
    assert content.startswith(b"t_s,side,law,")
    assert len(content) == messages[0]["size"]
    files.close()


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture
def script(server: LabServer) -> Iterator[Script]:
    with Script(f"ws://127.0.0.1:{server.server.get_port()}") as script:
        script.wait()  # what comes before the lab is there is refused
        yield script


def say(script: Script, kind: str, /, **fields: Any) -> None:
    script.socket.send(msgspec.json.encode({"is": kind, **fields}).decode())


def send(script: Script, number: int, content: bytes, **use: Any) -> dict[str, Any]:
    """Send a file in parts; returns the last answer."""
    say(
        script,
        "send",
        number=number,
        name="a.csv",
        size=len(content),
        use={"kind": "path", **use},
    )
    at = 0
    while (answer := script.read_until("file", lambda m: m["number"] == number))["state"] not in (
        "used",
        "refused",
    ):
        if answer["state"] == "awaited":
            assert answer["received"] == at
            say(script, "part", number=number, content=content[at : at + 20])
            at += 20
    return answer


@pytest.mark.thorough
def test_the_robots_follow_the_path_in_a_file_of_the_page(script: Script) -> None:
    assert send(script, 1, CIRCLE.encode(), size=60.0)["state"] == "used"

    def is_there(path: dict[str, Any]) -> bool:
        across = [point[0] for point in path["points"]]
        return max(across) - min(across) == pytest.approx(6000, rel=0.05)  # 60 mm in 10 µm

    path = script.told["path"]  # the last one may come before the answer
    if not is_there(path):
        path = script.read_until("path", is_there)  # after the blend
    assert path["closed"]


@pytest.mark.thorough
def test_the_same_file_is_read_again_without_coming_again(script: Script) -> None:
    content = CIRCLE.encode()
    assert len(send(script, 1, content)["lines"]) == 1
    fields = {"name": "a.csv", "size": len(content), "use": {"kind": "path", "size": 80.0}}
    for number in (2, 3):
        say(script, "send", number=number, again=number - 1, **fields)
        assert script.read("file")["state"] == "reading"
        assert script.read("file")["state"] == "used"
    say(script, "send", number=4, again=1, **fields)  # that one is no longer known by this number
    assert script.read("file")["state"] == "awaited"


def test_a_file_that_cannot_be_used_is_refused_with_a_sentence(script: Script) -> None:
    assert send(script, 1, b"no numbers here")["why"]
    say(script, "send", number=2, name="a", size=10**7, use={"kind": "path"})
    answer = script.read("file")
    assert (answer["state"], "MB" in answer["why"]) == ("refused", True)
    say(script, "part", number=9, content=b"x")
    assert script.read("file")["state"] == "refused"
    for wrong in (
        {"number": 3, "name": "a", "size": -1, "use": {"kind": "path"}},
        {"number": 3, "name": "a", "size": 1, "use": {"kind": "law"}},
        {"number": 3, "name": "a" * 300, "size": 1, "use": {"kind": "path"}},
        {"number": 3, "name": "a", "size": 1, "use": {"kind": "path", "size": 1e9}},
    ):
        say(script, "send", **wrong)
        assert script.read("refused")["why"]
    say(script, "send", number=4, name="a", size=0, use={"kind": "path"})
    assert script.read("file")["state"] == "reading"
    assert script.read("file")["why"] == ENGLISH("error.file_empty")


def test_a_page_that_gives_up_a_file_may_send_another(script: Script) -> None:
    say(script, "send", number=1, name="a", size=100, use={"kind": "path"})
    assert script.read("file")["state"] == "awaited"
    say(script, "send", number=2, name="a", size=100, use={"kind": "path"})
    assert script.read("file")["state"] == "refused"
    say(script, "drop", number=1)
    assert send(script, 3, CIRCLE.encode())["state"] == "used"


@pytest.mark.thorough
def test_the_record_of_the_lessons_comes_as_a_file(script: Script) -> None:
    say(script, "make", file="report")
    script.read_until("download", lambda m: m["state"] == "making")
    begin = script.read_until("download", lambda m: m["state"] == "coming")
    content = b""
    while len(content) < begin["size"]:
        content += base64.b64decode(script.read("part")["content"])
    assert b"<html" in content[:500] and len(content) == begin["size"]
