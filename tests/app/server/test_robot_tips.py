"""The tips that a server's file suggests are built when they are chosen, and for all labs alike."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from onpath.app.cli.robot_options import RobotOptions
from onpath.app.common.robot_files import add_read, given_file, read_file
from onpath.app.exports.export_process import ExportProcess
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.view.robots import robot_sheet
from onpath.lessons.words import ENGLISH
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.catalogue import ROBOTS
from tests.support.robot_files import PLANAR, urdf
from tests.support.student import Student

FORK = (
    '<joint name="a" type="fixed"><parent link="link3"/><child link="tool0"/></joint>'
    '<link name="tool0"/></robot>'
)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LabServer]:
    server = served(tmp_path_factory.mktemp("robot") / "arm.urdf")
    yield server
    server.stop()


def served(file: Path) -> LabServer:
    """A server of an arm whose last link has three tips."""
    file.write_text(urdf("own", PLANAR).replace("</robot>", FORK), "utf-8")
    entry = RobotOptions(tip="tool0").entry_of(str(file))
    return LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(robot=entry))


def student(server: LabServer) -> Student:
    return Student(f"ws://127.0.0.1:{server.server.get_port()}", scene=False)


def cards(page: Student) -> dict[str, dict]:
    """Of the robots from files, by their tips."""
    return {card["tip"]: card for card in page.ask("robots")["robots"] if card["tip"]}


@pytest.mark.thorough
def test_a_tip_is_built_when_it_is_chosen_and_is_there_for_all(server: LabServer) -> None:
    with student(server) as page, student(server) as other:
        for each in (page, other):
            each.open()
            each.read(lambda each=each: each.state)
        offered = cards(page)
        assert set(offered) == {"tool0", "tip", "link3"}
        assert [tip for tip, card in offered.items() if card["is_built"]] == ["tool0"]
        first, count = page.state["robot"], len(ROBOTS)
        page.tell({"is": "choose_tip", "robot": first, "tip": "tip"})
        page.read(lambda: page.state["robot"] != first)
        name = page.state["robot"]
        given = given_file(name)
        assert len(ROBOTS) == count + 1 and given is not None and given.tip == "tip"
        assert not ROBOTS[name].guesses or ROBOTS[name].guesses[0].kind != "tip"
        card = cards(other)["tip"]
        assert card["is_built"] and other.state["robot"] == first
        index = other.ask("index")["found"]
        assert card["send"] in [each["send"][0] for each in index if each["kind"] == "robot"]
        other.tell(card["send"])
        other.read(lambda: other.state["robot"] == name)
        assert len(ROBOTS) == count + 1


@pytest.mark.thorough
def test_a_tip_that_fails_says_why_and_the_robot_stays(server: LabServer) -> None:
    with student(server) as page:
        page.open()
        page.read(lambda: page.state)
        first, names = page.state["robot"], set(ROBOTS)
        given = given_file(first)
        assert given is not None
        kept = given.file.read_text("utf-8")
        given.file.write_text("<robot>", "utf-8")  # somebody has spoiled it meanwhile
        for tip, told in (("link3", "arm.urdf"), ("link2", ENGLISH("robots.no_such_tip"))):
            page.tell({"is": "choose_tip", "robot": first, "tip": tip})
            page.read(lambda told=told: told in (said := page.state["message"]) and "…" not in said)
        given.file.write_text(kept, "utf-8")
        assert page.state["robot"] == first and set(ROBOTS) == names
        assert cards(page)["link3"]["is_built"] is False


@pytest.mark.thorough
def test_a_page_that_waits_for_another_one_s_robot_is_told_and_gets_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is built twice, whether it waits for its own robot or for another one."""
    build, read = Event(), ExportProcess.call
    calls = list[object]()

    def call(process: ExportProcess, *wanted: Any) -> Any:
        calls.append(wanted)
        assert build.wait(60)
        return read(process, *wanted)

    monkeypatch.setattr(ExportProcess, "call", call)
    server = served(tmp_path / "second.urdf")
    try:
        with student(server) as page, student(server) as same, student(server) as other:
            for each in (page, same, other):
                each.open()
                each.read(lambda each=each: each.state)
            first = page.state["robot"]
            page.tell({"is": "choose_tip", "robot": first, "tip": "tip"})
            page.read(lambda: "second.urdf" in page.state["message"])
            for each, tip in ((same, "tip"), (other, "link3")):
                each.tell({"is": "choose_tip", "robot": first, "tip": tip})
                told = ENGLISH("robots.waiting")
                each.read(lambda each=each, told=told: told in each.state["message"])
            build.set()
            for each, tip in ((page, "tip"), (same, "tip"), (other, "link3")):
                each.read(lambda each=each: each.state["robot"] != first)
                given = given_file(each.state["robot"])
                assert given is not None and given.tip == tip
        assert len(calls) == 2
    finally:
        build.set()
        server.stop()


@pytest.mark.thorough
def test_a_process_learns_of_robots_that_are_added_while_it_runs(server: LabServer) -> None:
    process, given = ExportProcess(), given_file(next(reversed(ROBOTS)))
    assert given is not None
    try:
        assert set(process.call(60, _names)) == set(ROBOTS)
        other = server.thread.call(lambda: add_read(read_file(given.file, Options(tip="link3"))))
        assert other.name in process.call(60, _names)
    finally:
        process.stop()


def _names() -> list[str]:
    return list(ROBOTS)


@pytest.mark.usefixtures("server")
def test_every_robot_is_offered_once() -> None:
    sheet = robot_sheet(ENGLISH)
    assert len({(card.name, card.tip, card.is_built) for card in sheet.robots}) == len(sheet.robots)
    assert {card.name for card in sheet.robots if card.is_built} == set(ROBOTS)
