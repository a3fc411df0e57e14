"""What a log tells of each link."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.identification import identification_data
from onpath.app.notebook.identify import IdentificationResult


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("links") / "arm.csv"
    settings = {"speed": 5.0, "speed_profile": "stop_and_go", "encoder_counts": 20000}
    with pytest.warns(UserWarning):
        run = onpath.simulate(
            "planar_arm", "clover", "path_following", duration=12.0, coulomb=0.03, **settings
        )
    run.to_csv(path)
    return path


@pytest.fixture(scope="module")
def result(file: Path) -> IdentificationResult:
    return onpath.identify("planar_arm", file, links=True)


def test_a_log_tells_the_links_of_the_arm_that_it_is_of(
    result: IdentificationResult,
) -> None:
    assert [each.link for each in result.links] == sorted(each.link for each in result.links)
    told = [each for each in result.links if each.told is not None]
    assert len(told) == len(result.links) == 14
    for each in told:
        assert each.told is not None
        low, high = each.told.low, each.told.high
        assert low <= each.stated <= high, each.name
    inertia = next(each for each in result.links if each.name == "Izz1")
    assert inertia.told is not None
    assert inertia.told.high - inertia.told.low < 0.05 * inertia.stated
    assert dict(inertia.terms)["m3"] == pytest.approx(0.15**2)


def test_what_a_joint_that_rests_would_tell_is_not_told(tmp_path: Path, file: Path) -> None:
    """The last joint stands still: of its link only sums with those before it are told."""
    rows = np.genfromtxt(file, delimiter=",", names=True, dtype=None, encoding="utf-8")
    names = ["t_s", *(f"q{i}_measured_rad" for i in (1, 2)), *(f"tau{i}_Nm" for i in (1, 2))]
    still = tmp_path / "still.csv"
    columns = [np.array(rows[name], dtype=float) for name in names]
    columns.insert(3, 0.3 + 0 * columns[0])
    columns.append(0 * columns[0])
    head = "t,q1,q2,q3,tau1,tau2,tau3"
    np.savetxt(still, np.column_stack(columns), "%.9g", ",", header=head, comments="")
    known = {name: name for name in head.split(",")}
    result = onpath.identify("planar_arm", still, columns=known, links=True)
    alone = [p.name for p in result.links if p.told is not None and not p.told.others]
    assert not {"Izz3", "b3", "Ia3"} & set(alone)
    assert "not told by this log" in str(result)


def test_links_are_printed_and_refused_where_there_are_none(
    file: Path, result: IdentificationResult, capsys: pytest.CaptureFixture[str]
) -> None:
    printed = str(result)
    assert "link 2 (link2)" in printed and "Izz1R = Izz1 + Ia1 + 0.0225 m2" in printed
    links = identification_data(result.found)["links"]
    assert len(json.loads(json.dumps(links))) == 14 and links[0]["sum"]["Izz1"] == 1.0
    assert run_command(["identify", str(file), "--robot", "five_bar", "--links"]) == 2
    assert "not a chain of links" in capsys.readouterr().err
