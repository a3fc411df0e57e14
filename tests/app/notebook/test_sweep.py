"""A sweep is a table: the same wherever it runs, and however often it is interrupted."""

from __future__ import annotations

import json
import math
import os
import random
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from inspect import signature
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from joblib import Parallel, delayed, parallel_config

import onpath
from onpath.app.common.result_folder import FILE
from onpath.app.common.workers import Job
from onpath.app.notebook import sweep as module
from onpath.app.notebook.simulate import planned
from onpath.app.notebook.sweep import SweepResult, _is_several
from onpath.models.studies import arena
from onpath.models.studies.experiments import run
from tests.support.robot_files import PLANAR, urdf

NUMBERS = ("max_distance_m", "rms_distance_m", "final_speed_rad_s", "max_torque_Nm")
VALUES: dict[str, list[Any]] = {
    "robot": ["five_bar", "two_link_arm"],
    "path": ["circle", "ellipse 0.05 0.03", onpath.circle(0.04)],
    "law": ["path_following", "trajectory_tracking", "across = -K1*xi - K2*dxi; along = 0*xi"],
    "K1": [300, 400.0, np.float64(900)],
    "hold": [None, (0.02, 0.05)],
    "start": [None, (0.05, 0.0)],
    "control_rate": [1000, 100],
    "profile": [None, [(0, 0), (0.1, 1)]],
}


@pytest.fixture(autouse=True)
def here() -> Iterator[None]:
    """One process, unless a test says otherwise."""
    with parallel_config(n_jobs=1):
        yield


class Summed:
    """A law with memory, as an object of a notebook."""

    def __init__(self, pull: float) -> None:
        self.pull, self.sum = pull, 0.0

    def __call__(self, now: Any) -> tuple[float, float]:
        self.sum += now.interval * now.xi[0]
        across = -self.pull * now.xi[0] - 40 * now.xi_rate[0] - 500 * self.sum
        return -now.K5 * (now.theta_rate - now.speed), across


@pytest.mark.thorough
@settings(max_examples=8, deadline=None)
@given(st.data())
def test_a_sweep_has_the_numbers_of_single_runs_in_the_order_of_its_arguments(data: Any) -> None:
    names = data.draw(st.lists(st.sampled_from([*VALUES]), min_size=1, max_size=3, unique=True))
    chosen = {
        name: data.draw(st.lists(st.sampled_from(VALUES[name]), min_size=1, max_size=2))
        for name in VALUES
        if name in names
    }
    order = sorted(chosen, key=lambda name: ["robot", "path", "law", name].index(name))
    result = onpath.sweep(**chosen, duration=0.1)
    assert result.varied == tuple(order) and len(result) == math.prod(map(len, chosen.values()))
    for number, values in enumerate(product(*(chosen[name] for name in order))):
        row, single = result.table[number], dict(zip(order, values, strict=True))
        alone = onpath.simulate(**single, duration=0.1)
        told = alone.summary()
        assert [row[name] for name in NUMBERS] == [told[name] for name in NUMBERS]
        assert row["reason"] == alone.reason
    last = result.run(len(result) - 1)
    assert np.array_equal(last.y, alone.y) and np.array_equal(last.torque, alone.torque)
    experiment, law = result.trials[-1]
    assert np.array_equal(run(experiment, law, arena._loop).fields["u"], alone.torque)


@pytest.mark.parametrize("several", [True, False])
@pytest.mark.parametrize(
    ("name", "one"),
    [
        ("K1", 400),
        ("task", "speed"),
        ("hold", (1, 2)),
        ("hold", [1, 2]),
        ("start", [0.05, 0]),
        ("start", np.array([0.05, 0])),
        ("push", (1, 2, (0.03, 0))),
        ("wall", (1, 2, (0.03, 0), 0.5)),
        ("profile", [(0, 1), (2, 3)]),
        ("profile", "0:1, 2:3"),
        ("law", Summed),
        ("hold", None),
    ],
)
def test_a_list_is_several_where_one_value_is_none(name: str, one: Any, several: bool) -> None:
    assert _is_several(name, [one] if several else one) == several
    assert not several or _is_several(name, [None, one])


def test_what_no_run_could_be_is_refused_and_what_one_cannot_do_is_a_row() -> None:
    wrong: list[dict[str, Any]] = [{"K1": [400, 9e9]}, {"K1": []}, {"K9": [1, 2]}]
    wrong.append({"law": ["path_folowing"]})
    for bad in wrong:
        with pytest.raises(ValueError, match=r"K1|K9|path_following"):
            onpath.sweep(**bad, duration=0.1)
    with pytest.raises(ValueError, match="it returned 'ab'"):
        onpath.sweep(law=lambda now: "ab", K1=[1, 2], duration=0.1)
    paths = ["circle", onpath.circle(0.4), onpath.circle(0.4)]
    rows = onpath.sweep(path=paths, duration=0.1).table
    assert [row["stopped_at_s"] for row in rows] == [None, 0.0, 0.0]
    assert "workspace" in rows[1]["reason"] and rows[1]["max_distance_m"] == math.inf
    assert len({row["path"] for row in rows}) == 3


def test_a_setting_without_effect_in_all_runs_is_told_once() -> None:
    with pytest.warns(UserWarning, match="K4") as told:
        onpath.sweep(K4=[100, 200], duration=0.05)
    assert len(told) == 1


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(i, marks=pytest.mark.thorough) for i in (1, 2))]
)
def test_an_interrupted_sweep_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    """Twice interrupted, also while a line is written."""
    choice, folder = random.Random(seed), tmp_path / "study"
    asked: dict[str, Any] = {"K1": [300, 400, 500, 600], "law": [Summed(400), "path_following"]}
    wanted, simulated = onpath.sweep(**asked, duration=0.05).table, list[Any]()
    work, results = module.numbers_of, Job.results

    def counted(trial: Any) -> Any:
        simulated.append(trial)
        return work(trial)

    def cut(self: Job[Any, Any]) -> Iterator[Any]:
        after = choice.randrange(1, 4)
        for number, found in enumerate(results(self)):
            if number == after:
                raise KeyboardInterrupt
            yield found

    with monkeypatch.context() as patched:
        patched.setattr(module, "numbers_of", counted)
        patched.setattr(Job, "results", cut)
        for _ in range(2):
            with pytest.warns(UserWarning, match="the same call goes on from"):
                part = onpath.sweep(**asked, duration=0.05, folder=folder)
            assert all(row in wanted for row in part.table) and len(part) < len(wanted)
            assert np.array_equal(
                part.run(0).y,
                onpath.simulate(
                    law="path_following"
                    if part.table[0]["law"] == "path_following"
                    else Summed(400),
                    K1=part.table[0]["K1"],
                    duration=0.05,
                ).y,
            )
            file = folder / FILE
            if choice.random() < 0.5:
                file.write_bytes(file.read_bytes()[: -choice.randrange(1, 40)])
        kept = sum(line.endswith(b"]") for line in (folder / FILE).read_bytes().splitlines())
        simulated.clear()
        patched.setattr(Job, "results", results)
        assert onpath.sweep(**asked, duration=0.05, folder=str(folder)).table == wanted
        assert len(simulated) == len(wanted) - kept
        simulated.clear()
        more_values = {**asked, "K1": [*asked["K1"], 700]}
        assert len(onpath.sweep(**more_values, duration=0.05, folder=folder)) == len(wanted) + 2
        assert len(simulated) == 2
        asked["law"] = [Summed(401)]  # another law, although of the same name
        onpath.sweep(**asked, duration=0.05, folder=folder)
        assert len(simulated) == 2 + 4


def test_it_shows_itself_as_a_table_and_a_picture(tmp_path: Path) -> None:
    result = onpath.sweep(law=["path_following", "contouring"], K1=[300, 500], duration=0.1)
    frame = result.to_dataframe()
    assert list(frame.columns[:2]) == ["law", "K1"] and len(frame) == 4
    html, text = result._repr_html_(), repr(result)
    assert html.count("<tr>") == 5 and "path_following" in html and text.endswith("4 runs")
    file = tmp_path / "a.svg"
    axes = result.plot(str(file), y="rms_distance_m").axes[0]
    assert file.stat().st_size > 1e4 and axes.get_xlabel() == "K1"
    legend = axes.get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["path_following", "contouring"]
    lines = {line.get_label(): line for line in axes.get_lines()}
    rms = [1e3 * row["rms_distance_m"] for row in result.table if row["law"] == "contouring"]
    np.testing.assert_allclose(np.array(lines["contouring"].get_ydata()), rms)
    with pytest.raises(ValueError, match="expected one of max_distance_m"):
        result.plot(y="nothing")
    with pytest.raises(ValueError, match=r"ending in \.png"):
        result.plot("a.txt")
    varied: dict[str, Any]
    for varied in ({"law": ["path_following"]}, {}, {"path": ["circle", onpath.circle(0.4)]}):
        onpath.sweep(**varied, duration=0.05).plot(file)
    stopped = SweepResult(("law",), [{"law": "<b>", "max_distance_m": math.inf, "reason": "&"}], [])
    assert "&lt;b&gt;" in stopped._repr_html_() and "<b>" not in stopped._repr_html_()


def test_a_sweep_over_a_gain_compiles_one_loop() -> None:
    arena._loop.cache_clear()
    onpath.sweep(K1=[*range(300, 330)], duration=0.02)
    assert arena._loop.cache_info().misses == 1


def test_a_few_short_runs_start_no_processes() -> None:
    arena._loop.cache_clear()
    with ThreadPoolExecutor(1) as unset:  # joblib is set for each thread
        unset.submit(onpath.sweep, K1=[300, 400], duration=0.02).result()
    assert arena._loop.cache_info().misses == 1  # in this process


def _misses(_: int) -> tuple[int, int]:
    time.sleep(0.2)  # so that each process gets some
    return os.getpid(), arena._loop.cache_info().misses


@pytest.fixture
def study(tmp_path: Path) -> dict[str, Any]:
    """Custom laws and a custom robot; a law ends the process in which it is first called."""
    (tmp_path / "arm.urdf").write_text(urdf("arm", PLANAR), "utf-8")
    (tmp_path / "law.py").write_text(
        "def stiff(now):\n    across = -900 * now.xi[0] - 60 * now.xi_rate[0]\n"
        "    return -now.K5 * (now.theta_rate - now.speed), across\n",
        "utf-8",
    )
    arm = onpath.robot(tmp_path / "arm.urdf", armature=0.001)
    laws = ["path_following", Summed(300), Summed, f"{tmp_path / 'law.py'}:stiff"]
    return {"robot": [arm], "law": [laws[0], laws[1], laws[3]], "K1": [300, 500]}


def killer(marker: Path, times: int) -> Any:
    """A law whose first calls, in other processes, end these."""
    parent = os.getpid()

    def killing(now: Any) -> tuple[float, float]:
        if os.getpid() != parent and now.t > 0.05 and len(list(marker.iterdir())) < times:
            (marker / str(random.random())).touch()
            os._exit(3)
        return -now.K5 * (now.theta_rate - now.speed), -300 * now.xi[0] - 30 * now.xi_rate[0]

    return killing


@pytest.mark.thorough
def test_processes_give_the_same_table_also_if_one_is_lost(
    study: dict[str, Any], tmp_path: Path
) -> None:
    """Laws and robots that are objects of this process go along; each compiles a loop once."""
    marker = tmp_path / "killed"
    marker.mkdir()
    study["law"].append(killer(marker, 1))
    alone = onpath.sweep(**study, duration=0.2)
    with parallel_config("loky", n_jobs=2):
        shared = onpath.sweep(**study, duration=0.2)
        assert len([*marker.iterdir()]) == 1 and repr(shared) == repr(alone)
        assert shared.table == alone.table
        before = dict(Parallel()(delayed(_misses)(i) for i in range(8)))
        onpath.sweep(K1=[*range(300, 330)], K2=[30], duration=0.02, control_rate=[1000])
        after = dict(Parallel()(delayed(_misses)(i) for i in range(8)))
        assert all(count - before.get(pid, 0) <= 1 for pid, count in after.items())


@pytest.mark.thorough
def test_a_law_that_always_ends_its_process_is_a_row(tmp_path: Path) -> None:
    marker = tmp_path / "killed"
    marker.mkdir()
    laws = [killer(marker, 100), "path_following"]
    with parallel_config("loky", n_jobs=2):
        rows = onpath.sweep(law=laws, K1=[300, 400], duration=0.2).table
    assert [row["reason"] for row in rows] == [module.LOST] * 2 + [""] * 2


@pytest.mark.thorough
def test_a_cluster_of_dask_gives_the_same_table_also_if_a_worker_is_lost(
    study: dict[str, Any], tmp_path: Path
) -> None:
    from distributed import Client, LocalCluster

    marker = tmp_path / "killed"
    marker.mkdir()
    study["law"].append(killer(marker, 1))
    alone = onpath.sweep(**study, duration=0.2)
    given: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(**given) as cluster, Client(cluster), parallel_config("dask"):
        shared = onpath.sweep(**study, duration=0.2)
    assert len([*marker.iterdir()]) == 1 and shared.table == alone.table


def test_a_folder_has_a_line_for_each_run(tmp_path: Path) -> None:
    onpath.sweep(K1=[300, 400], duration=0.05, folder=tmp_path)
    lines = [json.loads(line) for line in (tmp_path / FILE).read_text("utf-8").splitlines()]
    assert len({key for key, _ in lines}) == 2 and all("reason" in row for _, row in lines)
    with pytest.raises(OSError, match="no_such"):
        onpath.sweep(folder=tmp_path / "no_such" / "folder")


def test_a_sweep_has_the_defaults_of_a_run() -> None:
    runs, rows = (signature(each).parameters for each in (onpath.simulate, planned))
    assert [*runs] == [*rows]
    for name in [*runs][3:]:
        assert runs[name] == rows[name]
