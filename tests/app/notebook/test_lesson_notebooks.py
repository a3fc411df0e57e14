"""The notebooks of assets/examples run from top to bottom, and their exercises are checked."""

from __future__ import annotations

import json
from contextlib import redirect_stdout
from io import StringIO
from typing import Any

import pytest

from onpath.assets import asset_path

HOME = asset_path("examples")


def outputs(name: str, **answers: str) -> list[str]:
    """What the cells of a notebook print, with answers in place of its exercise's `None`."""
    cells = json.loads((HOME / f"{name}.ipynb").read_text("utf-8"))["cells"]
    names: dict[str, Any] = {}
    told = list[str]()
    for cell in cells:
        source = "".join(cell["source"])
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            for mark, answer in answers.items():
                source = source.replace(f"{mark} None", f"{mark} {answer}")
            with redirect_stdout(StringIO()) as out:
                exec(compile(source, name, "exec"), names)
            told.append(out.getvalue().strip())
    return told


@pytest.fixture(autouse=True)
def _beside_its_log(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(HOME)


RIGHT = "ell**2 * np.sin(q1 - q2) / (R * M11 * M22)"


def test_the_matrix_that_decides() -> None:
    *told, said = outputs("derive_d")
    assert "derivative: False" in told[1] and "alone: True" in told[1]
    assert float(told[2].split(":")[1]) < 1e-9
    assert told[3].endswith("0.00") and said.startswith("Not yet")
    mistakes = {
        RIGHT: "Right.",
        RIGHT.replace("q1 - q2", "q2 - q1"): "A sign",
        RIGHT.replace("R * ", ""): "Nearly",
        RIGHT.replace("R * M11 * M22", "R") + " * M11 * M22": "It is the inverse",
        RIGHT.replace("ell**2", "ell"): "ℓ is in both",
        "1.0": "Not quite",
    }
    for answer, begins in mistakes.items():
        assert outputs("derive_d", **{"return": answer})[-1].startswith(begins), answer


def test_the_zero_dynamics_of_alpha() -> None:
    """The limits are those of lesson 7."""
    *told, said = outputs("zero_dynamics_of_alpha")
    assert "0.0: swings at 4.0 Hz" in told[1] and "0.5: swings at 6.1 Hz" in told[1]
    assert "0.95: falls" in told[1] and said.startswith("Not yet")
    one, three = (float(part.split(":")[1]) for part in told[2].split(","))
    assert abs(one - 0.879) < 0.001 and abs(three - 0.723) < 0.001
    book = "zero_dynamics_of_alpha"
    better = "limit(3, np.array([0.01, 0.02, 0.02]))"
    assert outputs(book, **{"my_limit =": better})[-1] == "Right."
    assert "0.01" in outputs(book, **{"my_limit =": "limit(3, 0.01)"})[-1]
    assert outputs(book, **{"my_limit =": "0.9"})[-1].startswith("Not quite")


def test_an_arm_from_a_bad_log() -> None:
    """M11 is that with which the log was made, once the delay is taken off."""
    book = "identify_a_bad_log"
    *told, said = outputs(book)
    assert said.startswith("Not yet")
    naive, bumps = (float(each.split("M11 = ")[1].split()[0]) for each in told[1:3])
    assert abs(naive - 0.0226) > 0.002
    best = "min(np.arange(0.0, 30.0, 1.0), key=lambda late: fitted(1e-3 * late)[1])"
    found = outputs(book, **{"late_ms =": best})[-1]
    inertia = float(found.split()[3])
    assert found.startswith("Right") and abs(inertia - 0.0226) < 0.0003 < abs(bumps - 0.0226)
    assert outputs(book, **{"late_ms =": "0.012"})[-1].startswith("In milliseconds")
    assert outputs(book, **{"late_ms =": "25"})[-1].startswith("Not quite")
