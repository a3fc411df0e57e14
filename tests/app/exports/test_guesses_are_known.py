"""What rests on a guess is known as such in tables, files and Python objects."""

from __future__ import annotations

import html
import json
import pickle
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.channel.state_messages import Said
from onpath.app.cli.compare import table
from onpath.app.cli.main import run_command
from onpath.app.exports.arena_page import Contents, arena_page, csv_rows, markdown
from onpath.app.exports.figures import experiment_figure
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lab_form import form_of
from onpath.app.view.robots import robot_card
from onpath.app.view.state_message import Projection, state_message
from onpath.lessons.words import Words
from onpath.models.closed_loop.trajectory import without_mark
from onpath.models.studies.record_file import read_records
from onpath.models.systems.robots import RobotEntry
from tests.support.guessed_robot import guessed_robot, in_catalogue
from tests.support.lab import loop_cache


@pytest.fixture(scope="module")
def entry() -> Iterator[RobotEntry]:
    with in_catalogue(guessed_robot()) as robot:
        yield robot


@pytest.fixture(scope="module")
def run(entry: RobotEntry) -> onpath.Run:
    return onpath.simulate(entry, duration=0.1)


def test_a_run_says_what_is_guessed(run: onpath.Run, entry: RobotEntry) -> None:
    assert run.guesses == pickle.loads(pickle.dumps(run)).guesses == entry.guesses
    shown_in_cell = run._repr_mimebundle_()["text/html"]
    (torque,) = (line for line in repr(run).splitlines() if "max torque" in line)
    assert torque.endswith("N m (guessed: mass and inertia)")
    assert "N m (guessed: mass and inertia)" in shown_in_cell
    for each in entry.guesses:
        assert each.line in repr(run) and each.line in shown_in_cell


def test_a_run_without_guesses_has_no_marks() -> None:
    run = onpath.simulate("planar_arm", duration=0.1)
    assert run.guesses == () and "guessed" not in repr(run)


@pytest.mark.thorough
def test_the_csv_marks_its_columns_and_is_read_all_the_same(
    run: onpath.Run, entry: RobotEntry, tmp_path: Path
) -> None:
    pandas = pytest.importorskip("pandas")
    file, plain = tmp_path / "marked.csv", tmp_path / "plain.csv"
    run.to_csv(file)
    names = file.read_text("utf-8").splitlines()[0].split(",")
    assert "tau1_Nm (guessed: mass and inertia)" in names and "y1_m (guessed: tip)" not in names
    assert "y1_m (guessed: end-point)" in names
    text = file.read_text("utf-8")
    plain.write_text(",".join(map(without_mark, names)) + text[text.index("\n") :], "utf-8")
    robot = entry.make(entry.parameters())
    (law, one), (other_law, other) = (read_records(each, robot)[0] for each in (file, plain))
    assert law == other_law and (one.q == other.q).all() and (one.u == other.u).all()
    frame = run.to_dataframe()
    assert list(frame.columns) == [without_mark(name) for name in names]
    assert isinstance(frame, pandas.DataFrame) and len(frame.attrs["guesses"]) == 7


def test_the_table_of_an_experiment_marks_its_numbers(
    entry: RobotEntry, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["experiment", "obstruction", "--robot", entry.name, "--set", "duration=0.2"]
    assert run_command(command) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if "max torque" in line and "guessed: mass" in line]
    assert [line for line in lines if "max distance" in line and "end-point" in line]
    assert run_command([*command, "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["guesses"]) == len(entry.guesses)


def test_the_tables_of_a_comparison_are_marked(entry: RobotEntry) -> None:
    assert "guessed" not in table({})
    titles = [line for line in table({}, entry.guesses).splitlines() if "guessed: " in line]
    assert len(titles) == 2


def test_the_arena_marks_its_tables(entry: RobotEntry) -> None:
    contents = Contents(
        rows={entry.name: []}, results={entry.name: []}, command="", figures={}, planned=0
    )
    for language in ("en", "de"):
        words = Words(language)
        for shown in (markdown(contents, words), arena_page(contents, words)):
            assert words("guess.tip") in shown
            for each in entry.guesses:
                assert each.line in shown
    assert list(csv_rows(contents)) == []


def test_pictures_of_torques_are_marked(run: onpath.Run) -> None:
    figure = experiment_figure(run.experiment, [run.trajectory])
    labels = [axes.get_ylabel() for axes in figure.axes]
    (torque,) = (label for label in labels if "(guessed: mass and inertia)" in label)
    assert torque.startswith("torque")


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_page_marks_plots_fields_and_the_robot(entry: RobotEntry, language: str) -> None:
    words = Words(language)
    lab = Lab(loop_cache(), entry)
    snapshot = take_page_snapshot(lab, 1.0)
    seen = Projection(height=1, cameras=np.zeros((0, 3, 3)), drawn=True, above=np.zeros(2), arrow=1)
    state = state_message(snapshot, words, {}, Said(), seen)
    marked = {
        row.name: row.label for row in state.rows if words("guess.mark", kinds="") in row.label
    }
    assert words("guess.mass") in marked["torques"] and words("guess.tip") in marked["distance"]
    fields = {f.name: f for g in form_of(snapshot, None, words).groups for f in g.fields}
    assert words("guess.effort") in fields["torque_limit"].label
    assert "(" not in fields["K1"].label
    for text in (fields["robot"].help, robot_card(entry, words).text):
        for each in entry.guesses:
            assert each.line in text and each.message.text(language)[1:] in text


@pytest.mark.thorough
def test_a_figure_marks_its_plots_and_says_what_is_guessed(entry: RobotEntry) -> None:
    page = onpath.figure(entry, law="path_following").html
    for each in entry.guesses:
        assert each.line in html.unescape(page)
    assert "(guessed: mass and inertia)" in page and "(guessed: end-point)" in page
