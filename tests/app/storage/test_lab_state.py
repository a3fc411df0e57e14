"""What a student did outlives the server: a new one, with the same database, goes on from there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from onpath.app.common.access_codes import normalised, shown
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.lab_state import put_back
from onpath.app.storage.records import Records, file_url
from onpath.app.storage.write_behind import WriteBehind
from onpath.lessons.course import Course, read_course
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache, new_lab, run
from tests.support.lesson_texts import write_lesson


@pytest.fixture
def course(tmp_path: Path) -> Course:
    write_lesson(tmp_path / "course")
    return read_course([tmp_path / "course"])[0]


class Server:
    """Labs with a database, without a network."""

    def __init__(self, file: Path, course: Course) -> None:
        self.records = Records(file_url(file))
        self.keeper = WriteBehind(self.records, interval=0.0)
        self.registry = LabRegistry(
            SimulationThread(),
            lambda: Lab(loop_cache(), FIVE_BAR, course),
            load=self.records.load,
            keeper=self.keeper,
        )

    def stop(self) -> None:
        self.keeper.close()
        self.records.close()


@pytest.fixture
def servers(tmp_path: Path, course: Course) -> Iterator[list[Server]]:
    made = [Server(tmp_path / "labs.db", course)]
    yield made
    made[-1].stop()


def restart(servers: list[Server], tmp_path: Path, course: Course) -> Server:
    servers[-1].stop()
    servers.append(Server(tmp_path / "labs.db", course))
    return servers[-1]


def test_path_gains_and_lesson_survive_a_restart(
    servers: list[Server], tmp_path: Path, course: Course
) -> None:
    entry = servers[0].registry.join(1, None)
    lab = entry.scheduled.lab
    do(lab, c.Set("K2", 33), c.ChoosePath("clover"), c.OpenLesson("01-a"))
    do(lab, c.GoToStep(1), c.Predict(times=(0.0, 1.0), values=(1.0, 2.0)), c.GoToStep(1))
    do(lab, c.Set("K1", 444))
    run(lab, 2.5)
    again = restart(servers, tmp_path, course).registry.join(1, entry.code)
    other = again.scheduled.lab
    assert again.code == entry.code and other is not lab
    assert other.lessons.progress == lab.lessons.progress
    assert (
        other.simulation.parameters == lab.simulation.parameters
        and other.simulation.parameters.K1 == 444
    )
    do(other, c.CloseLesson())
    assert other.simulation.parameters.K2 == 33 and other.simulation.editor.design.name == "clover"


def test_a_visit_that_did_nothing_leaves_nothing(servers: list[Server]) -> None:
    entry = servers[0].registry.join(1, None)
    run(entry.scheduled.lab, 3.0)
    servers[0].keeper.close()
    assert servers[0].records.load(entry.code) is None


def test_a_code_that_was_noted_down_opens_the_lab_elsewhere(
    servers: list[Server], tmp_path: Path, course: Course
) -> None:
    entry = servers[0].registry.join(1, None)
    do(entry.scheduled.lab, c.ChoosePath("clover"))
    run(entry.scheduled.lab, 1.5)
    server = restart(servers, tmp_path, course)
    own = server.registry.join(7, None)
    typed = f" {shown(entry.code).upper()} "
    found = server.registry.enter(7, normalised(typed))
    assert found.code == entry.code and found.scheduled.simulation.editor.design.name == "clover"
    assert found.client == 7 and own.client is None
    with pytest.raises(ValueError, match="another window"):
        server.registry.enter(8, entry.code)
    with pytest.raises(ValueError, match="no lab"):
        server.registry.enter(8, "222222222222")
    assert len(server.registry) == 2


def test_what_cannot_be_read_is_said_and_not_overwritten(servers: list[Server]) -> None:
    records = servers[0].records
    records.save("222222222222", {"setup": {"robot": "hexapod"}, "lessons": {}})
    entry = servers[0].registry.join(1, "222222222222")
    assert entry.code != "222222222222" and "cannot be read" in entry.scheduled.lab.message
    do(entry.scheduled.lab, c.ChoosePath("clover"))
    run(entry.scheduled.lab, 1.5)
    servers[0].keeper.close()
    assert records.load("222222222222") == {"setup": {"robot": "hexapod"}, "lessons": {}}
    assert records.load(entry.code) is not None


def test_a_path_accepted_then_and_refused_today_does_not_lock_the_lab() -> None:
    """Bends with a radius of a millimetre."""
    angle = np.arange(16) * np.pi / 8
    radius = 45_000 + 15_000 * np.cos(8 * angle)
    points = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    path = {"name": "edited", "numbers": np.rint(points).astype(int).ravel().tolist()}
    setup = {"benches": {"five_bar": {"parameters": {"K1": 300.0}, "path": path}}}
    lab = new_lab()
    put_back(lab, {"setup": setup, "lessons": {}, "before": setup})
    assert lab.simulation.parameters.K1 == 300.0 and lab.simulation.editor.design.name == "circle"
    assert "bend" in lab.message and "The circle is used" in lab.message
