"""Plays the lessons' steps on a student's lab and evaluates the student's tasks.

Independent of viser. Called by the simulation thread only, from `app.lab.commands.lessons`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from msgspec.structs import replace

from onpath.app.lab.answers import kept_answer
from onpath.app.lab.lesson_record import Beginning, Trace
from onpath.app.lab.lesson_state import UNSENT, LessonState, Sent
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.former import with_paths_of_today
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.step_setup import setup_of
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.task_judge import TaskJudge
from onpath.lessons.checks import Verdict
from onpath.lessons.concept_test.on_route import first_step
from onpath.lessons.course import Course
from onpath.lessons.given import Answer
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.schema import Lesson, Prediction, Sketch
from onpath.lessons.words import Words
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name

CHECK_INTERVAL = 30  # frames between evaluations of the tasks


class LessonLab(Protocol):
    """The part of a lab that lessons use.

    Attributes:
        simulation: the simulated lab.
        script: player of the running script, or None.
    """

    simulation: Simulation
    script: ScriptPlayer[Any] | None

    def set_up(self, setup: Setup) -> None:
        """Apply a set-up; raises ValueError if it is impossible, and leaves the lab unchanged."""
        ...


@dataclass(frozen=True, slots=True)
class Demonstration:
    """The demonstration of a step while it is played.

    Attributes:
        player: of its script.
        trace: of the predicted quantity, or None.
        rate: simulated seconds per second before, if it changes them; otherwise None.
    """

    player: ScriptPlayer[Any]
    trace: Trace | None
    rate: float | None

    def truth(self, simulation: Simulation) -> Truth | None:
        """The curve of the predicted quantity until now, if there is one."""
        if self.trace is None:
            return None
        self.trace.follow(simulation)
        return self.trace.truth()


class LessonRun(LessonState):
    """One student's progress through the lessons, on a lab.

    Attributes:
        before: set-up of the lab before a lesson was opened.
    """

    def __init__(self, course: Course, progress: Progress | None = None) -> None:
        super().__init__(course, progress)
        self._judge = TaskJudge(Beginning(0, 0.0))
        self._frames = 0
        self._demonstration: Demonstration | None = None
        self.before: Setup | None = None

    @property
    def playing(self) -> bool:
        """Whether the lab is playing the step's demonstration."""
        return self._demonstration is not None

    @property
    def verdicts(self) -> dict[str, list[Verdict]]:
        """On the checks of the open step's tasks, by task."""
        return self._judge.verdicts

    @property
    def rate_before(self) -> float:
        """Simulated seconds per second before a demonstration that changes them; 1 without one."""
        played = self._demonstration
        return 1.0 if played is None or played.rate is None else played.rate

    # Requests

    def open(self, name: str, lab: LessonLab) -> None:
        """Open a lesson at the step that was open last.

        Raises:
            ValueError: there is no such lesson.
        """
        name = self.own(name)
        self.check_within(name, self.left_at(name))
        self.open_at(name, self.left_at(name), lab)
        self.progress = replace(self.progress, route="")

    def follow_route(self, name: str, lab: LessonLab) -> None:
        """Open the first step of a route, and follow it from stop to stop.

        Raises:
            ValueError: there is no such route.
        """
        if name not in self.course.routes:
            raise unknown_name(name, list(self.course.routes), "route")
        lesson, index = first_step(self.course.routes[name], self.course, self.progress)
        self.check_within(lesson, index)
        self.open_at(lesson, index, lab, route=name)

    def open_at(self, name: str, index: int, lab: LessonLab, route: str = "") -> None:
        """Open a step of a lesson, and set the lab up for it; a test in the student's own form.

        Args:
            route: the route to follow from now on; if empty, the present one stays.

        Raises:
            ValueError: there is no such lesson or step.
        """
        name = self.own(name)
        if not self.course.has(name):
            raise unknown_name(name, list(self.course.lessons), "lesson")
        lesson = self.course.lesson(name, self.progress.language)
        if index not in range(len(lesson.steps)):
            raise CodedError("error.no_step", step=index + 1, steps=len(lesson.steps))
        before = capture(lab.simulation) if self.lesson is None else self.before
        self._set_up(lab, lesson, index)
        route = route if route in self.course.routes else self.progress.route
        self.progress = replace(self.progress, lesson=name, route=route, ended=False)
        self.before = before
        self._arrive(index, lab)

    def resume(self, progress: Progress, before: Setup | None, lab: LessonLab) -> None:
        """Restore saved progress, in a lab that has been restored."""
        self.progress, self.before = of_today(self.course, progress), before
        self.words = Words(progress.language)
        self.version += 1
        if self.lesson is not None:
            self._arrive(self.index, lab)

    def take(self, setup: Setup, lab: LessonLab) -> None:
        """Change the lab's set-up within the open step; `begin_anew` restores the step's own.

        Raises:
            ValueError: see `restore`; nothing is changed.
        """
        lab.set_up(setup)
        self._begin_again(lab, running=True)
        self.version += 1

    def close(self, lab: LessonLab) -> None:
        """Close the lesson and restore the lab as it was before.

        Raises:
            ValueError: the teacher keeps the student within some steps.
        """
        self.check_within("", 0)
        self.judge(lab.simulation)
        self.progress = replace(self.progress, lesson="", route="", ended=False)
        self._begin_again(lab, running=lab.simulation.running)
        if self.before is not None:
            lab.set_up(with_paths_of_today(self.before)[0])
            lab.simulation.editor.forget_edits()  # of the lesson
            lab.simulation.running = True
        self.version += 1

    def finish(self) -> None:
        """Show the end of the open lesson, which belongs to its last step; a test is handed in."""
        if self.lesson is not None:
            if not self.may_go(1):
                self.check_within(self.lesson.name, len(self.lesson.steps))
            self.check_within(self.lesson.name, len(self.lesson.steps) - 1)
            self.note(**({"handed_in": True} if self.is_test else {}))
            self.progress = replace(self.progress, ended=True)
            self.version += 1

    def go(self, by: int, lab: LessonLab) -> None:
        """Go to another step; a pending prediction is skipped when going forward.

        If the step then demonstrates the answer, only the prediction is skipped. After the last
        step comes the end, and before the end the last step. A test ends only by being handed in.
        """
        lesson = self.lesson
        if lesson is None or (self.is_test and (self.ended or (by > 0 and self.at_end))):
            return
        if self.ended or (by > 0 and self.at_end and not self.waits):
            self.finish() if by > 0 else self._go(self.index, lab)
            return
        name, target = self.beside(by)
        stays = by > 0 and self.waits and self.step_is("run")
        if not stays:
            self.check_within(name, target)
        if by > 0 and self.waits:
            self.note_answer(Answer())
        if stays:
            self._lock(lab.simulation)
            return
        if name == lesson.name:
            self._go(target, lab)
        else:
            self.open_at(name, target, lab)

    def begin_anew(self, lab: LessonLab) -> None:
        """Set the lab up for the open step again."""
        if self.lesson is not None:
            self._go(self.index, lab)

    def predict(self, answer: Answer, simulation: Simulation, sent: Sent = UNSENT) -> None:
        """Submit a prediction.

        Raises:
            ValueError: nothing is to be predicted, or the answer is invalid.
        """
        self.note_answer(kept_answer(self.predicted(sent)[2], answer), sent)
        self._lock(simulation)
        self.version += 1

    def play(self, player: ScriptPlayer[Any], lab: LessonLab) -> None:
        """Play the open step's demonstration, with the lab set up for the step.

        Args:
            player: of the step's script.

        Raises:
            ValueError: a prediction must be made first.
        """
        lesson, found, simulation = self.lesson, self.prediction(), lab.simulation
        if lesson is None:
            return
        self.check_unlocked()
        played = self._demonstration
        rate = simulation.settings.rate if played is None or played.rate is None else played.rate
        self._set_up(lab, lesson, self.index)
        simulation.set(rate=rate)  # may be slow motion; the result is the same
        self._judge.begin = Beginning.now(simulation)
        lab.script, script = player, lesson.steps[self.index].script
        self._demonstration = Demonstration(
            player=player,
            trace=Trace(quantity_of(found[1]), self._judge.begin) if found else None,
            rate=rate if script and any(action.rate for action in script.do) else None,
        )
        simulation.running = True
        self.version += 1

    # Updates

    def follow(self, lab: LessonLab) -> None:
        """Evaluate the tasks periodically and detect a demonstration's end; call in every frame."""
        self._frames += 1
        simulation, played = lab.simulation, self._demonstration
        if played is not None and lab.script is not played.player:
            self._demonstration = None
            if played.rate is not None:
                simulation.set(rate=played.rate)
            if played.player.finished:
                self._note_truth(played.truth(simulation))
            self.version += 1
        if self._frames % CHECK_INTERVAL:
            return
        if self._demonstration is not None and self._demonstration.trace is not None:
            self._demonstration.trace.follow(simulation)
        self.judge(simulation)

    def judge(self, simulation: Simulation) -> None:
        """Evaluate the tasks now; also before a run ends, with which its record is lost."""
        if self.step is not None and self.step.tasks():
            for task, value, way in self._judge.follow(simulation, self.step.tasks(), self.words):
                self.note_passed(task.id, value, way)

    def truth(self, simulation: Simulation) -> Truth | None:
        """The actual curve of the predicted quantity, from now or from the last demonstration."""
        found, played = self.prediction(), self._demonstration
        if found is None:
            return None
        if played is None or played.trace is None:
            return self.notes.truths.get(found[0])
        return played.truth(simulation)

    def _go(self, index: int, lab: LessonLab) -> None:
        lesson = self.lesson
        assert lesson is not None
        self._set_up(lab, lesson, index)
        self.progress = replace(self.progress, ended=False)
        self._arrive(index, lab)

    def _set_up(self, lab: LessonLab, lesson: Lesson, index: int) -> None:
        """Set the lab up for a step, which ends the run of the open one."""
        self.judge(lab.simulation)
        lab.set_up(setup_of(lesson, index))
        lab.simulation.editor.select(None)

    def _arrive(self, index: int, lab: LessonLab) -> None:
        """Begin a step, in a lab that is set up."""
        lesson = self.lesson
        assert lesson is not None
        if self.notes.handed_in:
            self.progress = replace(self.progress, ended=True)
        self.note(step=index, seen=max(self.notes.seen, index + 1))
        lab.simulation.editor.forget_edits()  # an undo would bring the path of another step back
        self._begin_again(lab, lesson.setup_at(index).running)

    def _begin_again(self, lab: LessonLab, running: bool) -> None:
        """Reset demonstration, tasks and undo for the step."""
        simulation = lab.simulation
        lab.script, simulation.undo_timeline, simulation.running = None, None, running
        self._demonstration = None
        self._judge = TaskJudge(Beginning.now(simulation))
        self._lock(simulation)

    def _lock(self, simulation: Simulation) -> None:
        """Stop time while it must not run."""
        if self.locked is not None:
            simulation.running = False

    def _note_truth(self, truth: Truth | None) -> None:
        """Note that the open step's demonstration has been played, and what it showed."""
        found, truths = self.prediction(), self.notes.truths
        if found is not None and truth is not None:
            truths = {**truths, found[0]: truth}
        played = tuple(dict.fromkeys((*self.notes.played, str(self.index))))
        self.note(truths=truths, played=played)


def quantity_of(prediction: Prediction) -> str:
    """The predicted quantity."""
    return prediction.quantity if isinstance(prediction, Sketch) else "distance"
