"""The list "From a slider to the torque" in app/README.md, followed on a running server."""

from __future__ import annotations

import re
import struct
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.commands import SetParameter
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.session import Session
from onpath.app.server.lab_server import LabServer
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.systems.parameters import Parameters
from tests.app.server.test_hostile import Guest, wait_for
from tests.support.checkout import FOLDERS, ROOT

GAIN = 905.0  # no other number of the lab has this value
PACKED = struct.pack(">d", GAIN)  # as in a message of the browser
OURS = tuple(f"{folder}/" for folder in FOLDERS)


def files_in_readme() -> list[str]:
    """The files of the list, in its order."""
    text = (ROOT / "app" / "README.md").read_text(encoding="utf-8")
    section = text.split("## From a slider to the torque")[1].split("\n## ")[0]
    steps = re.findall(r"^\d+\. (.*?)(?=^\d+\. |^$)", section, flags=re.MULTILINE | re.DOTALL)
    assert len(steps) > 9
    files = [file for step in steps for file in re.findall(r"`([\w/]+\.py)`", step)]
    previous, full = Path("app"), list[str]()
    for file in files:
        found = [
            each / file
            for each in (Path("app"), Path(), previous)
            if (ROOT / each / file).is_file()
        ]
        previous = found[0].parent
        full.append(str(found[0]))
    return full


def has_gain(value: Any, depth: int = 3) -> bool:
    """Whether the number is in a value: a local variable, or what it holds."""
    if isinstance(value, float):
        return value == GAIN
    if isinstance(value, bytes):
        return PACKED in value
    if isinstance(value, np.ndarray):
        return value.dtype == np.float64 and GAIN in value
    if depth and isinstance(value, dict):
        return any(has_gain(each, depth - 1) for each in tuple(value.values()))
    if depth and isinstance(value, (SetParameter, Parameters)):
        names = type(value).__dataclass_fields__
        return any(has_gain(getattr(value, name, None), depth - 1) for name in names)
    return False


class Follower:
    """Notes the files of the functions that the number passes, and of their callers."""

    def __init__(self) -> None:
        self.files: dict[str, None] = {}
        self.on = False

    def __call__(self, frame: FrameType, event: str, _: object) -> None:
        if self.on and event in ("call", "return") and has_gain({**frame.f_locals}):
            stack = list[str]()
            there: FrameType | None = frame
            while there is not None:
                stack.append(there.f_code.co_filename)
                there = there.f_back
            self.files |= dict.fromkeys(reversed(stack))

    @property
    def own(self) -> list[str]:
        """The project's files, in the order in which the number came to them."""
        base = f"{ROOT}/"
        files = [file.removeprefix(base) for file in tuple(self.files) if file.startswith(base)]
        return [file for file in files if file.startswith(OURS)]


def packed_gain(session: Session, run: ClosedLoopRun) -> float:
    """K1 in the settings that a loop is run with."""
    return float(kernel_of(session.robot, run.kind).settings.unpack(run.settings)["K1"][0])


@pytest.fixture
def followed() -> Iterator[tuple[Guest, Follower]]:
    """A browser in a lab, whose server's threads are profiled."""
    follower = Follower()
    threading.setprofile(follower)
    server = LabServer("127.0.0.1", 0, LoopCache())
    try:
        guest = Guest(server)
        threading.setprofile(None)
        yield guest, follower
        follower.on = False
        guest.socket.close()
    finally:
        threading.setprofile(None)
        server.stop()


def test_a_gain_passes_the_files_of_the_readme_in_their_order(
    followed: tuple[Guest, Follower],
) -> None:
    guest, follower = followed
    stated, session = files_in_readme(), guest.scheduled.session
    follower.on = True
    guest.update(guest.labelled("K1"), GAIN)
    wait_for(lambda: stated[-1] in follower.own)
    wait_for(lambda: [packed_gain(session, run) for run in session.runs.values()] == [GAIN, GAIN])
    follower.on = False
    assert [file for file in follower.own if file in stated] == stated
