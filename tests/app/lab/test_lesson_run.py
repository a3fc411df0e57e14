"""A student's way through a lesson, without a browser."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.history import RECENT
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.lesson_run import CHECK_INTERVAL, LessonRun
from onpath.app.lab.sketches import sketched
from onpath.lessons.action_schema import Action
from onpath.lessons.checks import judge
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import MOST_POINTS, Answer
from onpath.lessons.progress import Progress, read_progress
from onpath.lessons.schema import Sketch
from onpath.lessons.task_schema import Event, Task
from onpath.lessons.words import ENGLISH, Words
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.lab import FOLLOWER, FRAME, TRACKER, do, loop_cache, run
from tests.support.lesson_texts import write_lesson

NAME = "01-a"


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Of one small lesson."""
    folder: Path = tmp_path_factory.mktemp("course")
    write_lesson(folder)
    found, problems = read_course([folder])
    assert problems == []
    return found


@pytest.fixture
def lab(course: Course) -> Lab:
    """A lab with that lesson open."""
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.OpenLesson(NAME))
    return lab


def test_a_scene_sets_the_lab_up_and_the_free_lab_comes_back(course: Course) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.Set("K2", 33), c.ChoosePath("clover"))
    do(lab, c.OpenLesson(NAME))
    assert (
        lab.simulation.parameters.K1 == 300
        and lab.simulation.parameters.K2 == FIVE_BAR.parameters().K2
    )
    assert lab.simulation.editor.design.name == "circle" and lab.simulation.running
    do(lab, c.CloseLesson())
    assert lab.simulation.parameters.K2 == 33 and lab.simulation.editor.design.name == "clover"
    assert lab.lessons.lesson is None and lab.locked is None


def test_nothing_happens_before_a_prediction(lab: Lab) -> None:
    do(lab, c.GoToStep(1))
    for command in (c.SetRunning(True), c.StepOnce(), c.GoOn(), c.PlayStep()):
        do(lab, command)
        run(lab, 0.2)
        assert lab.simulation.time == 0.0 and not lab.simulation.running
    assert lab.message == str(lab.locked) == ENGLISH("lesson.locked")
    do(lab, c.Predict(times=(0.0, 1.0, 2.0), values=(0.0, 40.0, 0.0)))
    assert lab.locked is None and lab.message == ""
    do(lab, c.SetRunning(True))
    run(lab, 0.2)
    assert lab.simulation.time > 0.1


def test_why_nothing_happens_is_told_in_the_language_of_the_lab(lab: Lab) -> None:
    german = Words("de")("lesson.locked")
    do(lab, TakeStep(NAME, 2))
    play = c.Act((Action(run=True),))
    for command in (c.SetRunning(True), c.StepOnce(), c.GoOn(), c.PlayStep(), play):
        do(lab, c.SetLanguage("de"))  # clears the message
        assert lab.message == ""
        do(lab, command)
        assert lab.message == german and lab.message_level == "warning"
    assert lab.locked is not None and lab.locked.text("de") == german != str(lab.locked)


def test_skipping_is_one_step_and_locks_nothing(lab: Lab) -> None:
    do(lab, c.GoToStep(1), c.GoToStep(1))
    assert lab.lessons.index == 2 and lab.locked is None
    answer = lab.lessons.answer()
    assert answer is not None and answer.skipped


def test_skipping_the_prediction_of_a_pushed_step_does_not_skip_what_happens(
    lab: Lab,
) -> None:
    do(lab, TakeStep(NAME, 2))
    run_ = lab.lessons
    assert run_.waits and lab.locked
    do(lab, c.GoToStep(1))
    assert run_.index == 2 and not run_.waits and not lab.locked
    assert run_.notes.answers["1"].skipped
    do(lab, c.PlayStep())
    assert run_.playing
    do(lab, c.GoToStep(1))
    assert run_.index == 3


def test_prediction_and_truth_are_kept_side_by_side(lab: Lab) -> None:
    do(lab, c.GoToStep(1), c.Predict(times=(0.0, 2.0), values=(5.0, 99.0)), c.GoToStep(1))
    do(lab, c.PlayStep())
    run(lab, 0.3)
    assert lab.lessons.playing and lab.lessons.truth(lab.simulation) is not None
    run(lab, 2.0)
    assert not lab.lessons.playing and not lab.simulation.running
    notes = lab.lessons.notes
    truth, answer = notes.truths["1"], notes.answers["1"]
    assert answer.values[0] == 5.0 and answer.values[-1] == 60.0  # its axis ends there
    assert max(truth.tracker) > 10 * max(truth.follower) > 0
    assert truth.times[-1] == pytest.approx(2.0, abs=0.1)
    assert np.all(np.diff(truth.times) > 0)


def test_a_task_fails_then_passes_and_stays_passed(lab: Lab) -> None:
    do(lab, c.GoToStep(3), c.GoToStep(3))
    assert lab.lessons.step_is("task") and lab.simulation.editor.design.name == "ellipse"
    do(lab, c.Hold(True))
    run(lab, 0.5)
    do(lab, c.Hold(False))
    run(lab, 1.0)
    verdicts = lab.lessons.verdicts["hold"]
    assert not verdicts[0].passed and "0.5 of 1 s" in verdicts[0].words
    assert "hold" not in lab.lessons.notes.tasks
    do(lab, c.Hold(True))
    run(lab, 1.5)
    assert "hold" in lab.lessons.notes.tasks
    do(lab, c.Reset())
    run(lab, 1.0)
    assert "hold" in lab.lessons.notes.tasks


@pytest.mark.parametrize(
    "command", [c.Reset(), c.GoToStep(-1), c.GoToStep(1), c.BeginStepAnew(), c.CloseLesson()]
)
def test_a_task_that_is_done_counts_however_soon_its_run_ends(lab: Lab, command: Command) -> None:
    """The tasks are judged every half second; a run may end at once after its success."""
    for waited in range(0, CHECK_INTERVAL, 7):
        lab.lessons.progress = Progress()
        do(lab, c.OpenLesson(NAME), c.GoToStep(3), c.GoToStep(3))
        run(lab, waited * FRAME)
        assert lab.lessons.step_is("task") and not lab.lessons.notes.tasks
        do(lab, c.Hold(True))
        run(lab, 1.0)
        do(lab, command)
        assert "hold" in lab.lessons.progress.notes[NAME].tasks


@pytest.mark.parametrize("frame", [0.7 / 60, 1 / 60, 1.3 / 60])
def test_pulled_off_let_go_and_back_again(frame: float) -> None:
    """Lesson 1's last task, by the keys that it names, at the paces that a lab has."""
    lab = Lab(loop_cache(), FIVE_BAR, built_in_course()[0])
    do(lab, TakeStep("01-path-or-timetable", 9))
    for _ in range(6):
        do(lab, c.MoveHand(0.005, 0.0))
        run(lab, 0.1)
    run(lab, 1.0)
    do(lab, c.Release())
    for _ in range(round(3.0 / frame)):
        lab.drain()
        lab.advance(frame)
    assert "push-across" in lab.lessons.notes.tasks


def test_the_marks_of_a_passed_task_stay_until_the_next_attempt(lab: Lab) -> None:
    do(lab, c.GoToStep(3), c.GoToStep(3), c.Hold(True))
    run(lab, 2.0)
    assert all(verdict.passed for verdict in lab.lessons.verdicts["hold"])
    do(lab, c.Set("K1", 20), c.Set("K2", 1), c.MoveHand(0.1, 0.1))
    run(lab, 2.0)  # far off
    assert all(verdict.passed for verdict in lab.lessons.verdicts["hold"])
    do(lab, c.Reset())
    run(lab, 1.0)
    assert not any(verdict.passed for verdict in lab.lessons.verdicts["hold"])
    assert "hold" in lab.lessons.notes.tasks


def test_what_is_undone_by_rewinding_passes_no_task(lab: Lab) -> None:
    """Go on from before a hold, and it has not happened."""
    held = Task("held", "Hold back.", (Event("hold"), Event("let_go", times=1)))
    begin = Beginning.now(lab.simulation)
    run(lab, 1.0)
    do(lab, c.Hold(True))
    run(lab, 0.5)
    do(lab, c.LookAt(1.0), c.GoOn())
    run(lab, 0.5)
    assert not judge(held, record_of(lab.simulation, begin), Words())[0].passed
    do(lab, c.Hold(True))
    run(lab, 0.1)
    assert all(verdict.passed for verdict in judge(held, record_of(lab.simulation, begin), Words()))


def test_the_truth_has_every_peak_however_long_ago() -> None:
    """Lesson 3 plays for longer than the lab's past is kept at every frame."""
    lab = Lab(loop_cache(), FIVE_BAR, built_in_course()[0])
    do(lab, TakeStep("03-the-five-bar", 3), c.Predict(), c.PlayStep())
    seen: dict[str, list[float]] = {name: [] for name in lab.simulation.runs}
    while lab.lessons.playing:
        for name, one in lab.simulation.runs.items():
            seen[name].append(float(np.abs(one.shown()["u"]).max()))
        lab.advance(FRAME)
        lab.drain()
    truth = lab.lessons.notes.truths["2"]
    assert truth.times[-1] > RECENT and len(truth.times) <= MOST_POINTS
    for name, curve in ((FOLLOWER, truth.follower), (TRACKER, truth.tracker)):
        for times in ((0.0, 3.0), (3.1, 9.0), (9.1, 12.0), (12.1, 15.0)):
            first, last = (round(time / FRAME) for time in times)
            inside = [
                v for t, v in zip(truth.times, curve, strict=True) if times[0] <= t < times[1]
            ]
            assert max(inside) == pytest.approx(max(seen[name][first:last]), rel=0.02)
        assert max(curve) == pytest.approx(max(seen[name]), abs=1e-4)


def test_hints_come_one_at_a_time_until_there_is_none(lab: Lab) -> None:
    do(lab, c.TakeStep("01-a", 6), c.ShowHint("hold"))
    assert lab.lessons.notes.hints == {"hold": 1}
    do(lab, c.ShowHint("hold"), c.ShowHint("hold"))
    assert lab.lessons.notes.hints == {"hold": 2} and "no further hint" in lab.message
    do(lab, c.GoToStep(-1), c.ShowHint("hold"))
    assert lab.lessons.notes.hints == {"hold": 2} and "no such task" in lab.message


def test_links_act_on_the_lab(lab: Lab) -> None:
    do(lab, c.Act((Action(set={"K3": 100.0}), Action(path="clover"), Action(hold=True))))
    assert lab.simulation.parameters.K3 == 100.0 and lab.simulation.editor.design.name == "clover"
    assert lab.simulation.forces.held
    do(lab, c.Act((Action(set={"K3": 1e9}),)))
    assert lab.simulation.parameters.K3 == 100.0 and "K3" in lab.message


def test_resetting_by_hand_ends_what_is_shown(lab: Lab) -> None:
    do(lab, c.GoToStep(2), c.Predict(), c.PlayStep())
    run(lab, 0.5)
    do(lab, c.Reset())
    run(lab, 0.2)
    assert lab.script is None and not lab.lessons.playing


@pytest.mark.parametrize("command", [c.Reset(), c.ChoosePath("clover"), c.GoOn()])
def test_what_is_given_up_half_way_has_not_been_seen(lab: Lab, command: object) -> None:
    """Resetting, another robot's run, going on from the past: no truth, and not played."""
    do(lab, c.GoToStep(1), c.Predict(times=(0.0, 1.0), values=(0.0, 1.0)), c.GoToStep(1))
    do(lab, c.PlayStep())
    run(lab, 1.0)
    if isinstance(command, c.GoOn):
        do(lab, c.LookAt(0.5))
    do(lab, command)  # type: ignore[arg-type]
    run(lab, 3.0)
    notes = lab.lessons.notes
    done = isinstance(command, c.ChoosePath)  # that one lets the script go on to its end
    assert bool(notes.truths) is bool(notes.played) is done
    assert not lab.lessons.playing


def test_progress_comes_back_from_json(lab: Lab, course: Course) -> None:
    do(lab, c.TakeStep("01-a", 6), c.ShowHint("hold"), c.TakeStep("01-a", 0))
    do(lab, c.GoToStep(1), c.Predict(times=(0.0, 1.0), values=(1.0, 2.0)), c.GoToStep(1))
    do(lab, c.Set("presenting", True))
    kept = msgspec.json.encode(lab.lessons.progress)
    again = LessonRun(course, read_progress(msgspec.json.decode(kept)))
    assert again.progress == lab.lessons.progress
    assert again.index == 2 and again.answer() == lab.lessons.answer()


@pytest.mark.parametrize(
    "data",
    [
        {"lesson": 3},
        {"lesson": "x" * 100},
        {"notes": {"a": {"answers": {"1": {"times": [0, 1], "values": [1]}}}}},
        {"notes": {"a": {"step": -1}}},
        {"surprise": 1},
        {"notes": {"a": {"tasks": {"t": 1e999}}}},
        [],
        None,
    ],
)
def test_invalid_progress_is_refused(data: object) -> None:
    with pytest.raises(ValueError):
        read_progress(data)


def test_a_lesson_that_is_gone_is_not_open(course: Course) -> None:
    assert LessonRun(course, Progress(lesson="99-gone")).lesson is None


@example([(0.0, 0.0), (3.58e-308, 0.0), (2.2e-311, 7.0)])  # no slope is finite here
@given(st.lists(st.tuples(st.floats(-5, 15), st.floats(-100, 100)), min_size=1, max_size=400))
@example([(0.0, 0.0), (1.0, 0.0005)])  # half a thousandth is rounded as an array rounds it
def test_any_stroke_becomes_a_curve_on_its_axes_or_is_refused(
    stroke: list[tuple[float, float]],
) -> None:
    axes = Sketch("?", "distance", seconds=8.0, top=60.0)
    times, values = zip(*stroke, strict=True)
    try:
        curve = sketched(axes, Answer(times=times, values=values))
    except ValueError:
        assert len(set(np.round(np.clip(times, 0, 8), 3))) < 2
        return
    assert np.all(np.diff(curve.times) >= 0) and len(curve.times) <= 200
    assert min(curve.times) >= 0 and max(curve.times) <= 8
    drawn = np.round(np.clip(times, 0, 8), 3)
    assert (curve.times[0], curve.times[-1]) == (drawn.min(), drawn.max())
    assert min(curve.values) >= 0 and max(curve.values) <= 60
    if len(set(drawn)) == len(drawn):
        assert max(curve.values) == np.round(np.clip(values, 0, 60), 3).max()


@pytest.mark.parametrize("robot", ["two_link_arm", "cart_pendulum", "flexible"])
def test_every_task_is_judged_whatever_robot_is_chosen(robot: str) -> None:
    """Another robot has other settings than those that a check names."""
    course, _ = built_in_course()
    lab = Lab(loop_cache(), FIVE_BAR, course)
    began = [Beginning.now(lab.simulation)]
    do(lab, c.ChooseRobot("flexible"))
    began.append(Beginning.now(lab.simulation))
    do(lab, c.ChooseRobot(robot))
    run(lab, 2 * FRAME)
    assert lab.simulation.entry.name == robot
    for begin in began:
        record = record_of(lab.simulation, begin)
        for name in course.lessons:
            for step in course.lesson(name, "en").steps:
                for task in step.tasks():
                    judge(task, record, ENGLISH)
