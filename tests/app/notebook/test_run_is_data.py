"""A run is data: it is pickled, read elsewhere without its files, and becomes a data frame."""

from __future__ import annotations

import builtins
import io
import pickle
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.notebook import run as module
from onpath.app.notebook.run import Run
from onpath.models.systems.catalogue import ROBOTS, robot_named
from tests.support.robot_files import PLANAR, urdf

LAW = """
class Gentle:
    own_gains = (onpath.own_gain("gentle_pull", 300, "1/s²", (0, 900, 1), "pull", label="P"),)
    label = "A gentle law"
    def command(self, view):
        across = -view.own_gains["gentle_pull"] * view.output.xi - 40 * view.output.xi_rate
        return onpath.followed(view, onpath.tangential(view), across)
"""
ELSEWHERE = """
import pickle, sys
from pathlib import Path
import numpy as np
import onpath
run, arrays, words, table = pickle.loads(Path("run.pickle").read_bytes())
for name, values in arrays.items():
    assert np.array_equal(getattr(run, name), values), name
assert (repr(run), run.summary()) == words
run.to_csv("again.csv")
assert Path("again.csv").read_bytes() == table
frame = run.to_dataframe()
assert list(frame.columns) == table.decode().split("\\n", 1)[0].split(",")
assert len(frame) == len(run.t) and (frame["law"] == run.law).all()
entry = run.experiment.entry
here = onpath.simulate(entry, run.experiment.path, duration=0.1)
legend = run.plot(here, "both.svg").axes[0].get_legend()
assert "A gentle law" in [text.get_text() for text in legend.get_texts()]
assert Path("both.svg").stat().st_size > 1e4
assert np.isfinite(entry.make(run.experiment.parameters).position(run.y)).all()
assert run.experiment.robot().drawing and run.experiment.robot().skeleton
again = pickle.loads(pickle.dumps(run))
assert "Gentle" not in onpath.laws() and np.array_equal(again.y, run.y)
"""


def arrays_of(run: Run) -> dict[str, Any]:
    names = ("t", "q", "v", "y", "theta", "theta_rate", "theta_ref", "xi", "xi_rate", "distance")
    return {name: getattr(run, name) for name in (*names, "speed", "torque", "force", "held")}


@pytest.mark.thorough
def test_a_run_is_read_elsewhere_without_the_files_of_its_robot_and_law(tmp_path: Path) -> None:
    made, other = tmp_path / "made", tmp_path / "other"
    made.mkdir()
    other.mkdir()
    (made / "arm.urdf").write_text(urdf("arm", PLANAR), "utf-8")
    (made / "law.py").write_text(f"import onpath\n{LAW}", "utf-8")
    arm = onpath.robot(made / "arm.urdf", armature=0.001)
    path = onpath.circle(0.04)
    run = onpath.simulate(
        arm, path, f"{made / 'law.py'}:Gentle", hold=(0.1, 0.2), duration=0.3, gentle_pull=250
    )
    run.to_csv(made / "run.csv")
    told = (repr(run), run.summary()), (made / "run.csv").read_bytes()
    (other / "run.pickle").write_bytes(pickle.dumps((run, arrays_of(run), *told)))
    shutil.rmtree(made)
    done = subprocess.run(
        [sys.executable, "-c", ELSEWHERE], cwd=other, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("robot", ["five_bar", "flexible", "rod_gantry", "planar_arm"])
def test_a_pickled_run_is_the_same_run(robot: str) -> None:
    noise: dict[str, Any] = {"sensor_noise": 1e-4, "profile": [(0, 0), (0.1, 1)], "seed": 3}
    run = onpath.simulate(robot, hold=(0.1, 0.15), duration=0.2, **noise)
    again = pickle.loads(pickle.dumps(run))
    for name, values in arrays_of(run).items():
        assert np.array_equal(getattr(again, name), values), name
    assert repr(again) == repr(run) and again.experiment.parameters == run.experiment.parameters
    assert again.experiment.schedule == run.experiment.schedule
    assert again.experiment.robot() is run.experiment.robot()
    texts = [io.StringIO(), io.StringIO()]
    for each, text in zip((run, again), texts, strict=True):
        each.to_dataframe().to_csv(text, index=False)
    assert texts[0].getvalue() == texts[1].getvalue()
    repeated = onpath.simulate(again.experiment.entry, hold=(0.1, 0.15), duration=0.2, **noise)
    assert np.array_equal(repeated.y, run.y)


def test_its_data_frame_has_the_numbers_of_its_csv_file(tmp_path: Path) -> None:
    import pandas

    run = onpath.simulate(hold=(0.1, 0.2), duration=0.3, encoder_counts=2000)
    run.to_csv(tmp_path / "a.csv")
    read, frame = pandas.read_csv(tmp_path / "a.csv"), run.to_dataframe()
    assert list(read.columns) == list(frame.columns) and frame["held"].dtype == bool
    numbers = [name for name in frame.columns if name not in ("law", "held")]
    np.testing.assert_allclose(frame[numbers], read[numbers], rtol=1e-8, atol=1e-300)
    assert np.array_equal(frame["held"], read["held"] == 1)


def test_without_pandas_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    imported = builtins.__import__

    def without(name: str, *arguments: Any) -> Any:
        if name == "pandas":
            raise ImportError(name)
        return imported(name, *arguments)

    run = onpath.simulate(duration=0.05)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match=r'pip install "onpath\[pandas\]"'):
        run.to_dataframe()


def test_another_version_reads_a_run_or_refuses_it_in_a_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "FORMAT", 99)
    later = pickle.dumps(onpath.simulate(duration=0.05))
    monkeypatch.undo()
    with pytest.raises(ValueError, match=r"in a form that OnPath .* does not read"):
        pickle.loads(later)
    _, (form, made_by, data) = onpath.simulate(duration=0.05).__reduce__()
    data["experiment"]["settings"]["K9"] = 1.0
    with pytest.raises(ValueError, match="no setting K9 of Five-bar"):
        module.read_run(form, made_by, data)
    with pytest.raises(ValueError, match="unknown robot 'five_bat'"):
        pickle.loads(pickle.dumps(ROBOTS["five_bar"]).replace(b"five_bar", b"five_bat"))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("a.txt",), "ending in .png, .svg or .pdf"),
        (("a.png", "b.png"), "one file"),
        (("no_such_folder/a.png",), "no folder"),
    ],
)
def test_a_picture_that_cannot_be_written_is_refused(given: tuple[str, ...], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        onpath.simulate(duration=0.05).plot(*given)
    with pytest.raises(TypeError, match="expected a run, got 3"):
        onpath.simulate(duration=0.05).plot(3)  # type: ignore[arg-type]


@pytest.mark.thorough
def test_plot_takes_the_file_as_other_methods_do(tmp_path: Path) -> None:
    runs = [onpath.simulate(law=law, duration=0.1) for law in ("path_following", "contouring")]
    files = [tmp_path / name for name in ("a.svg", "b.svg", "c.svg")]
    runs[0].plot(runs[1], str(files[0]))
    runs[0].plot(files[1], runs[1])
    runs[0].plot(runs[1], file=files[2])
    assert len({file.read_bytes() for file in files}) == 1


FILES = {
    "same": (urdf("arm", PLANAR), {"armature": 0.001}),
    "armature": (urdf("arm", PLANAR), {"armature": 0.002}),
    "nothing locked": (urdf("arm", PLANAR), {"armature": 0.001, "lock": {}}),
}


@pytest.mark.thorough
@settings(max_examples=10, deadline=None)
@given(st.lists(st.sampled_from([*FILES]), min_size=2, max_size=2))
def test_robots_are_equal_if_they_are_made_equally(
    tmp_path_factory: pytest.TempPathFactory, chosen: list[str]
) -> None:
    entries = []
    for kind in chosen:
        text, options = FILES[kind]
        file = tmp_path_factory.mktemp("robot") / "arm.urdf"
        file.write_text(text, "utf-8")
        entries.append(onpath.robot(file, **options))
    alike = FILES[chosen[0]][1]["armature"] == FILES[chosen[1]][1]["armature"]
    assert (entries[0] == entries[1]) == alike == (len({*entries}) == 1)
    assert entries[0] != robot_named("five_bar") and entries[0] != entries[0].name
    assert [pickle.loads(pickle.dumps(each)) for each in entries] == entries


def test_a_robot_that_is_made_otherwise_does_not_take_the_place_of_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from onpath.models.systems.catalogue import robot_again

    arm = ROBOTS["planar_arm"]
    assert arm.source is not None
    data = arm.source.data()
    data["chain"]["bodies"][1]["mass"] += 0.5
    other = robot_again("planar_arm", data)
    assert other != arm and ROBOTS["planar_arm"] is arm
    runs = [onpath.simulate(each, duration=0.1) for each in (arm, other)]
    assert not np.array_equal(runs[0].torque, runs[1].torque)
    with pytest.raises(ValueError, match="one robot on one path"):
        runs[0].plot(runs[1])
