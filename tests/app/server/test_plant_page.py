"""A server with a plant, by its pages' websockets: one drives, others watch."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from typing import Any

import pytest

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.plant import controller_process, lab_plant
from onpath.app.plant.lab_plant import PlantChoice
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.models.systems.catalogue import ROBOTS
from tests.support.still_arm import StillArm
from tests.support.student import Student


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[LabServer]:
    monkeypatch.setattr(controller_process, "START", "forkserver")
    multiprocessing.set_forkserver_preload([controller_process.__name__])
    monkeypatch.setattr(lab_plant, "LOST", 60.0)  # these pages send no signs of life
    plant = PlantChoice(address=("127.0.0.1", 0), fastest=50.0, silence=1000, asked=20.0)
    given = {"torque_limit": "5", "control_rate": "50"}
    options = ServerOptions(robot=ROBOTS["two_link_arm"], settings=given, plant=plant)
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    yield server
    server.stop()


def phase(page: Student, wanted: str) -> str:
    """What the page is told of the plant, once it is in a phase."""

    def told() -> dict[str, Any]:
        return page.told.get("state", {}).get("plant") or {"phase": ""}

    page.read(lambda: told()["phase"] in (wanted, "ended"))
    assert told()["phase"] == wanted, told()["text"]
    return told()["text"]


def test_a_page_that_watches_cannot_drive(server: LabServer) -> None:
    """Nor can anybody start a plant again but the page that drives; if that is lost, it ends."""
    assert server.desk is not None
    address, lab = f"ws://127.0.0.1:{server.server.get_port()}", server.desk.scheduled.lab
    with Student(address, scene=False) as driver, Student(address, scene=False) as watcher:
        driver.kept["onpath_drives"] = watcher.kept["onpath_drives"] = server.desk.key
        driver.open()
        phase(driver, "off")
        watcher.open()  # with the same key
        phase(watcher, "off")
        assert driver.state["own"] and not watcher.state["own"]
        assert driver.state["names"] == ["Simulated", "Plant"]
        watcher.tell({"is": "drive", "what": "start"})
        watcher.read(lambda: "not drive" in watcher.told.get("refused", {}).get("why", ""))
        assert lab.plant is not None and lab.plant.phase == "off"
        driver.tell({"is": "drive", "what": "start", "at_fault": "damp"})
        phase(driver, "waiting")
        with StillArm(int(lab.plant.address.rpartition(":")[2])) as arm:
            phase(driver, "running")
            phase(watcher, "running")
            watcher.tell({"do": "Set", "name": "K1", "value": 49})
            watcher.read(lambda: "only shown" in watcher.told["refused"]["why"])
            watcher.tell({"is": "drive", "what": "stop"})
            watcher.read(lambda: "not drive" in watcher.told["refused"]["why"])
            assert lab.plant.phase == "running" and lab.simulation.parameters.K1 != 49
            assert arm.codes and set(arm.codes) == {0}
            driver.close()
            assert "is lost" in phase(watcher, "ended")
            arm.wait_for_an_end()
