"""What is exported is what was simulated, tick by tick."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.legend import Legend
from matplotlib.text import Text

from onpath.app.exports.files import csv_bytes
from onpath.app.exports.history_figure import draw_history, held_times, history_figure
from onpath.app.exports.recording import record_scene
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.words import Words, languages
from onpath.models.control.sides import SIDES
from tests.support.csv_columns import read_csv
from tests.support.lab import (
    FOLLOWER,
    FRAME,
    TRACKER,
    do,
    finish,
    loop_cache,
    new_lab,
    replayed,
    run,
    y,
)


def watched(lab: Lab, frames: int) -> list[tuple[float, dict[str, dict[str, np.ndarray]]]]:
    """(time, what each robot's log said) at the end of each frame."""
    seen = []
    for _ in range(frames):
        lab.advance(lab.simulation.settings.rate * FRAME)
        rows = {
            n: {k: v.copy() for k, v in r.shown().items()} for n, r in lab.simulation.runs.items()
        }
        seen.append((lab.simulation.time, rows))
    return seen


def eventful() -> tuple[Lab, list]:
    lab = new_lab()
    seen = watched(lab, 20)
    do(lab, c.Hold(True))
    seen += watched(lab, 15)
    do(lab, c.Hold(False), c.Set("K3", 300), c.Set("payload", 0.1))
    do(
        lab,
        c.Grab(FOLLOWER, y(lab.simulation, FOLLOWER) + np.array([0.0, 0.03])),
    )
    seen += watched(lab, 15)
    do(lab, c.Release(), c.ChoosePath("ellipse"), c.Set("encoder_counts", 4000))
    seen += watched(lab, 30)
    do(lab, c.ChoosePath("segment"), c.Set("rate", 4.0))
    seen += watched(lab, 5)
    do(lab, c.Set("control_rate", 50), c.Set("rate", 0.125))
    seen += watched(lab, 20)
    return lab, seen


@pytest.mark.thorough
def test_replay_is_what_was_simulated_to_the_last_bit() -> None:
    lab, seen = eventful()
    runs = replayed(lab.simulation)
    assert set(runs) == set(SIDES)
    for name, trajectory in runs.items():
        assert trajectory.t == pytest.approx(np.arange(len(trajectory.t)) * 1e-3)
        assert trajectory.t[-1] == pytest.approx(lab.simulation.time - 1e-3)
        for time, rows in seen:
            at = round(time * 1e3) - 1  # the row of the frame's last tick
            for field, value in rows[name].items():
                assert np.array_equal(trajectory.fields[field][at], value), (field, time)
        held = trajectory.t[trajectory.held]
        assert held[0] == pytest.approx(0.334, abs=2e-3)
        assert held[-1] == pytest.approx(0.583, abs=2e-3)


def test_replay_after_going_on_from_the_past() -> None:
    lab = new_lab(1.0)
    do(lab, c.LookAt(0.5), c.GoOn(), c.Set("K1", 100))
    seen = watched(lab, 20)
    for name, trajectory in replayed(lab.simulation).items():
        assert np.allclose(np.diff(trajectory.t), 1e-3, atol=1e-9)
        for time, rows in seen:
            row = trajectory.fields["q"][round(time * 1e3) - 1]
            assert np.array_equal(row, rows[name]["q"])


def test_two_kilohertz_gives_whole_milliseconds() -> None:
    lab = new_lab()
    do(lab, c.Set("control_rate", 2000))
    for k in range(12):  # every frame another path, so that no segment joins the next
        do(lab, c.SelectPoint(0), c.NudgePoint(0.0005 * (-1) ** k, 0.0))
        lab.advance(FRAME)
    for trajectory in replayed(lab.simulation).values():
        assert trajectory.t == pytest.approx(np.arange(len(trajectory.t)) * 1e-3, abs=1e-9)
        assert len(trajectory.t) == 200


@pytest.mark.thorough
def test_csv_tells_the_distance_to_the_path_as_it_was() -> None:
    lab, _ = eventful()
    columns = read_csv(
        io.StringIO(csv_bytes(lab.simulation.robot, lab.simulation.history.all()).decode())
    )
    assert set(columns) == set(SIDES)
    first = slice(0, 330)  # on the circle
    radius = np.hypot(columns[TRACKER]["y1_m"], columns[TRACKER]["y2_m"])[first]
    assert columns[TRACKER]["distance_m"][first] == pytest.approx(np.abs(radius - 0.05), abs=1e-9)
    assert len(columns[TRACKER]["t_s"]) == round(lab.simulation.time * 1e3)


def test_one_robot_that_stands_still_does_not_spoil_the_export() -> None:
    lab = new_lab(0.3)
    lab.simulation.runs[FOLLOWER].fields()["v"][:] = 500.0
    run(lab, 0.4)
    assert lab.simulation.runs[FOLLOWER].diverged
    both = replayed(lab.simulation)
    assert both[FOLLOWER].t[-1] < 0.32 < 0.69 < both[TRACKER].t[-1]
    later = [s for s in lab.simulation.history.all() if s.time > 0.4]
    assert set(replay(lab.simulation.robot, later)) == {TRACKER}
    assert b",right," not in csv_bytes(lab.simulation.robot, later)
    assert draw_history(replay(lab.simulation.robot, later)).startswith(b"\x89PNG")
    lab.simulation.runs[TRACKER].fields()["v"][:] = 500.0
    run(lab, 0.2)
    end = [s for s in lab.simulation.history.all() if s.time > 0.75]
    with pytest.raises(ValueError, match="stood still"):
        replay(lab.simulation.robot, end)


def test_picture_and_page_are_whole() -> None:
    lab = new_lab(0.6)
    history = lab.simulation.history.all()
    picture = draw_history(replay(lab.simulation.robot, history))
    assert picture.startswith(b"\x89PNG") and picture.endswith(b"IEND\xaeB`\x82")
    page = record_scene(lab.simulation.robot, history)
    assert page.lstrip()[:15].lower() == b"<!doctype html>" and page.rstrip().endswith(b"</html>")
    assert len(page) < 3_000_000


@pytest.mark.parametrize("language", languages())
def test_the_picture_says_what_it_shows(language: str) -> None:
    lab, words = new_lab(0.3), Words(language)
    do(lab, c.Set("K1", 650.0), c.Set("payload", 0.1), c.Hold(True))
    run(lab, 0.3)
    do(lab, c.Hold(False), c.ChooseLaw("left", "waiting_clock"))
    finish(loop_cache())
    run(lab, 0.3)
    simulation = lab.simulation
    drawn = replay(simulation.robot, simulation.history.all())
    figure = history_figure(drawn, words, simulation.parameters, "five_bar", "circle")
    said = " ".join(text.get_text() for text in figure.findobj(match=Text))
    assert (
        words.get("path.circle", "circle") in said
        and words.get("machine.five_bar.label", "") in said
    )
    assert "K1" in said and "= 650" in said and f"= {words.written('0.1')} kg" in said
    assert "ξ" in said and "θ" in said and "η" in said
    legends = [legend.get_texts() for legend in figure.findobj(match=Legend)]
    marked = {text.get_text() for texts in legends for text in texts}
    assert {words("figure.held"), words("figure.law"), words("figure.motor", number=2)} <= marked
    styles = {line.get_linestyle() for axes in figure.axes for line in axes.lines}
    legend_styles = {
        line.get_linestyle() for each in figure.findobj(match=Legend) for line in each.get_lines()
    }
    assert styles <= legend_styles


def test_a_hold_is_marked_for_as_long_as_it_was() -> None:
    lab = new_lab(0.3)
    do(lab, c.Hold(True))
    run(lab, 0.2)
    do(lab, c.Hold(False))
    run(lab, 0.3)
    ((begin, end),) = held_times(replayed(lab.simulation)[FOLLOWER])
    assert begin == pytest.approx(0.3, abs=0.02) and end == pytest.approx(0.5, abs=0.02)
