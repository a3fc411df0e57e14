"""`onpath control` listens only where it may."""

from __future__ import annotations

import pytest

from onpath.app.cli.control import plant_address
from onpath.app.cli.main import run_command


@pytest.mark.parametrize(
    ("address", "missing"),
    [
        ("udp://0.0.0.0:9000", "--open-to-others"),
        ("udp://192.168.1.4:9000", "--open-to-others"),
        ("udp://[::]:9000", "--open-to-others"),
        ("udp://arm.example:9000", "--open-to-others"),
        ("udp://127.0.0.1", "udp://HOST:PORT"),
        ("udp://127.0.0.1:70000", "udp://HOST:PORT"),
        ("udp://127.0.0.1:9000/q", "udp://HOST:PORT"),
        ("tcp://127.0.0.1:9000", "udp://HOST:PORT"),
        ("127.0.0.1:9000", "udp://HOST:PORT"),
        ("udp://127.0.0.1:9000", "torque_limit"),
    ],
)
def test_it_is_refused_in_a_line(
    address: str, missing: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["control", address]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert missing in line


@pytest.mark.parametrize(
    ("options", "missing"),
    [
        (["--classroom"], "--classroom"),
        (["--lessons", "."], "--lessons"),
        (["--database", "sqlite://"], "--database"),
        (["--origin", "https://lab.example"], "--origin"),
        (["--trusted-proxy", "10.0.0.7"], "--trusted-proxy"),
        (["--socket", "lab.sock"], "--socket"),
        (["--host", "0.0.0.0"], "--open-to-others"),
        (["--host", "0.0.0.0", "--set", "torque_limit=0", "--open-to-others"], "torque_limit"),
        (["--set", "torque_limit=0"], "torque_limit"),
        ([], "udp://HOST:PORT"),
    ],
)
def test_a_plant_in_the_lab_is_refused_in_a_line(
    options: list[str], missing: str, capsys: pytest.CaptureFixture[str]
) -> None:
    plant = ["--plant", "udp://127.0.0.1" if not options else "udp://127.0.0.1:9000"]
    given = ["--set", "torque_limit=5"] if "--set" not in options else []
    assert run_command(["serve", *plant, *given, *options]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert missing in line


def test_an_address_that_others_can_reach_is_said_twice() -> None:
    assert plant_address("udp://[::]:9000", open_to_others=True) == ("::", 9000)
    assert plant_address("udp://0.0.0.0:1", open_to_others=True) == ("0.0.0.0", 1)
    assert plant_address("udp://[::1]:9000", open_to_others=False) == ("::1", 9000)
    assert plant_address("udp://localhost:9000", open_to_others=False) == ("localhost", 9000)
