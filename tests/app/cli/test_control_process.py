"""A controller in a process of its own, and a plant in another that misbehaves."""

from __future__ import annotations

import io
import multiprocessing
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.cli.control import ControlCommand
from onpath.app.cli.driving import Driving, write_log
from onpath.app.cli.main import run_command
from onpath.app.common.end_signals import END_SIGNALS
from onpath.app.common.own_laws import compiled_law
from onpath.app.plant import controller_process
from onpath.app.plant.controller_process import ControllerPlan, ControllerProcess
from onpath.app.plant.datagrams import Measured
from onpath.app.plant.plant_link import PlantReport
from onpath.assets import asset_path
from onpath.models.controller.functions import REFUSALS
from onpath.models.studies.record_file import log_columns, read_records
from onpath.models.systems.catalogue import ROBOTS
from tests.support.checkout import ROOT
from tests.support.lab_process import free_ports
from tests.support.plant_end import measurement, torque_in
from tests.support.still_arm import StillArm
from tests.support.waiting import wait_for

pytest.importorskip("mujoco")
RATE, INT = 50, signal.SIGINT
CODE = {"0": 0, **{f"`{name.upper()}`": number for number, name in enumerate(REFUSALS, 1)}}
TABLE = (ROOT / "app" / "plant" / "README.md").read_text("utf-8")
FAULTS = re.findall(r"^\| `(\w+)` \|.*\| (0|`[A-Z_]+`) \|$", TABLE, re.MULTILINE)


@pytest.fixture
def forked(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the processes be forked from one that has imported everything, which is quicker."""
    monkeypatch.setattr(controller_process, "START", "forkserver")
    multiprocessing.set_forkserver_preload([controller_process.__name__])


@pytest.fixture
def beside() -> Iterator[ControllerProcess]:
    pose = {"joint1": 0.6985, "joint2": 1.031, "joint3": 1.007}
    entry = onpath.robot(asset_path("robots/planar_arm.urdf"), pose=pose)
    gains = {"K1": 64, "K2": 16, "K3": 100, "speed": 0.5}
    settings = {"torque_limit": 20.0, "control_rate": RATE, **gains}
    plan = ControllerPlan(
        robot=entry,
        paths=onpath.controller(entry, **settings).design.paths,
        laws=("path_following",),
        at_fault="damp",
        fastest=5.0,
        settings=settings,
        silence=40,  # 0.8 s, since a busy machine lets both wait
    )
    process = ControllerProcess(plan, ("127.0.0.1", 0))
    yield process
    process.close()


@pytest.mark.usefixtures("forked")
def test_a_law_of_ones_own_acts_in_the_other_process_too() -> None:
    own, entry = "across = -K1*xi - K2*dxi; along = K5*(speed - dtheta)", ROBOTS["two_link_arm"]
    settings = {"torque_limit": 5.0, "control_rate": RATE}
    plan = ControllerPlan(
        robot=entry,
        paths=onpath.controller(entry, **settings).design.paths,
        laws=(compiled_law(own),),
        at_fault="damp",
        fastest=5.0,
        settings=settings,
        own=(own,),
    )
    process = ControllerProcess(plan, ("127.0.0.1", 0))
    assert process.report().law == plan.laws[0]
    process.close()


def plant(beside: ControllerProcess, fault: str, rate: int = RATE) -> subprocess.Popen[str]:
    """An arm in MuJoCo that does something else after a second, for a fifth of a second."""
    example = [sys.executable, str(asset_path("examples/plant.py")), "--fast", "--rate", str(rate)]
    given = ["--port", str(beside.address[1]), "--seconds", "1.2", "--at", "1", "--pause", "1.2"]
    return subprocess.Popen([*example, *given, "--fault", fault], stdout=subprocess.PIPE, text=True)


def ended(beside: ControllerProcess, running: subprocess.Popen[str]) -> PlantReport:
    """The report once the plant has gone, and the controller has ended."""
    while True:
        report = beside.report()
        if report.code and running.poll() is not None:
            return report


def test_what_does_no_harm_is_ignored(beside: ControllerProcess) -> None:
    harmless = [fault for fault, code in FAULTS if code == "0"]
    assert set(harmless) == {"twice", "back", "second"}
    running = plant(beside, ",".join(harmless))
    report = ended(beside, running)
    assert int(running.communicate()[0].split()[-1]) == 0
    assert (report.repeated, report.foreign) == (20, 0)
    assert report.answered == 60 and report.code == CODE["`LATE`"]  # since the plant has left


@pytest.mark.usefixtures("forked")
@pytest.mark.parametrize(("fault", "code"), [each for each in FAULTS if each[1] != "0"])
def test_what_the_table_says_ends_it(beside: ControllerProcess, fault: str, code: str) -> None:
    running = plant(beside, fault)
    report = ended(beside, running)
    told = int(running.communicate()[0].split()[-1])
    assert report.code == CODE[code]
    assert told == (0 if fault == "die" else CODE[code])
    assert report.answered == (50 if fault == "die" else 60)


@pytest.mark.usefixtures("forked")
@pytest.mark.parametrize("gone", [True, False])
def test_a_process_that_asks_no_more_is_missed(beside: ControllerProcess, gone: bool) -> None:
    """The next measurements get the torque for a fault, damping, and the code for it."""
    place = beside.robot.rest(np.array(beside.robot.home))
    moving = np.array([0.1, 0.0, 0.0])
    count, answer = 0, (0, 0, np.zeros(3))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as arm:
        arm.connect(beside.address)
        arm.settimeout(20)
        while answer[1] == 0 and count < 100_000:
            count += 1
            arm.send(measurement(Measured(count, count / RATE, place, moving)))
            answer = torque_in(arm.recv(2048), 3) or answer
            if gone and count == 1:  # before, it would end without a plant to answer
                beside._connection.close()
        while answer[0] != count + 1:
            arm.send(measurement(Measured(count + 1, (count + 1) / RATE, place, moving)))
            answer = torque_in(arm.recv(2048), 3) or answer
    assert answer[1] == CODE["`STOPPED`"] and answer[2][0] < 0


@pytest.mark.usefixtures("forked")
def test_a_controller_that_is_killed_is_missed(beside: ControllerProcess) -> None:
    beside._process.kill()
    beside._process.join()
    for ask in (beside.report, beside.stop):
        with pytest.raises(OSError, match="gets no torque"):
            ask()


@pytest.mark.usefixtures("forked")
def test_what_is_typed_acts_and_the_log_is_that_of_a_real_arm(
    beside: ControllerProcess,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("K1=49\nbogus=3\npath=circle 0.04\n"))
    running, driving = plant(beside, "none", 2 * RATE), Driving(beside, "damp")
    kept = {number: signal.getsignal(number) for number in END_SIGNALS}
    try:
        assert driving.run() == 1  # the plant leaves
    finally:
        for number, handler in kept.items():
            signal.signal(number, handler)
    running.communicate()
    told = capsys.readouterr()
    assert "no measurement came" in told.out and "bogus" in told.err
    assert beside.parameters.K1 == 49 and len(driving.rows) == 120
    write_log(file := tmp_path / "run.csv", beside.robot, driving.rows)
    ((_, record),) = read_records(file, beside.robot, log_columns(beside.robot, {"t": "t_s"}, {}))
    q = np.array(driving.rows)[:, 1:4]
    assert len(record.q) == 120 and np.allclose([record.q[0], record.q[-1]], [q[0], q[-1]])


@pytest.mark.usefixtures("forked")
def test_ctrl_c_ends_a_whole_run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The plant gets the torque that was chosen until it is silent, and the last line says so."""
    made = ControlCommand._plan
    patient = lambda self: replace(made(self), silence=3000, asked=60.0)  # noqa: E731
    monkeypatch.setattr(ControlCommand, "_plan", patient)
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    kept = {number: signal.getsignal(number) for number in END_SIGNALS}
    arm = StillArm(port := free_ports(1)[0], speed=1.0)

    def press() -> None:
        with arm:
            wait_for(lambda: arm.codes and signal.getsignal(INT) is not kept[INT], 60.0)
            os.kill(os.getpid(), INT)
            arm.wait_for_an_end()
            wait_for(lambda: arm.torques[-1].any(), 60.0)  # it damps the motion

    pressing = threading.Thread(target=press, daemon=True)
    pressing.start()
    given = ["--robot", "two_link_arm", "--set", "torque_limit=5,control_rate=50"]
    command = ["control", f"udp://127.0.0.1:{port}", *given, "--at-fault", "damp"]
    try:
        assert run_command(command) == 0, capsys.readouterr().err
    finally:
        for number, handler in kept.items():
            signal.signal(number, handler)
    pressing.join()
    assert capsys.readouterr().out.strip().endswith("The plant is silent.")
    first = next(i for i, code in enumerate(arm.codes) if code)
    assert first > 0 and set(arm.codes[first:]) == {CODE["`STOPPED`"]}
