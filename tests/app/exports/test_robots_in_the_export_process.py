"""Files are made in another process, which must know robots that came from files."""

from __future__ import annotations

from pathlib import Path

import pytest

from onpath.app.exports.export_process import ExportProcess
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.catalogue import ROBOTS, add_robot
from onpath.models.systems.robot_file import read_robot
from tests.support.robot_files import PLANAR, urdf


def equations(robot: str) -> list[float]:
    """The tip at a configuration."""
    entry = ROBOTS[robot]
    system = entry.make(entry.parameters()).system
    numbers = [0.0] * system.parameters.numel()
    return system.function("output")([0.1, 0.2, 0.3], [0.0] * 3, numbers).full()[:, 0].tolist()


@pytest.mark.thorough
def test_the_process_knows_robots_from_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "own.urdf"
    file.write_text(urdf("own", PLANAR))
    entry = read_robot(file, Options()).entry
    monkeypatch.setitem(ROBOTS, entry.name, entry)
    assert add_robot(read_robot(file, Options()).entry) is entry  # whose loops may be compiled
    process = ExportProcess()
    try:
        assert process.call(60.0, equations, entry.name) == equations(entry.name)
    finally:
        process.stop()
