"""Plays the lessons' steps on a student's lab and judges what is done there.

No viser in it. Only the simulation thread calls it, by the commands in `app.lab.commands.lessons`.
"""

from __future__ import annotations

from typing import Any, Protocol

from msgspec.structs import replace

from onpath.app.lab.lesson_record import Beginning, Trace, record_of
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.lab.session import Session
from onpath.app.lab.setup import Path, RobotSetup, Setup, capture
from onpath.app.lab.sketches import sketched
from onpath.lessons.checks import Verdict, judge, statistic
from onpath.lessons.course import Course
from onpath.lessons.progress import Answer, Progress, Truth
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson, Prediction, Sketch, Task, Window
from onpath.lessons.words import Words
from onpath.models.errors import CodedError
from onpath.models.systems.parameters import unknown_name

CHECK_INTERVAL = 30  # frames between looks at the tasks


class LessonLab(Protocol):
    """What a lesson needs of a lab.

    Attributes:
        session: the simulated lab.
        script: what is being done by itself, or None.
    """

    session: Session
    script: ScriptPlayer[Any] | None

    def set_up(self, setup: Setup) -> None:
        """Set the lab up; raises ValueError if it is impossible, and then all is as it was."""
        ...


class LessonRun(LessonState):
    """The lessons as one student goes through them on a lab.

    Attributes:
        verdicts: on the checks of the open step's tasks, by task.
        before: the lab as it was before any lesson was open.
    """

    def __init__(self, course: Course, progress: Progress | None = None) -> None:
        super().__init__(course, progress)
        self.verdicts: dict[str, list[Verdict]] = {}
        self._begin = Beginning(0, 0.0)
        self._frames = 0
        self._player: ScriptPlayer[Any] | None = None  # of what the step shows
        self._trace: Trace | None = None  # of what is played
        self._passed: dict[str, int] = {}  # the run in which a task was passed
        self.before: Setup | None = None

    @property
    def playing(self) -> bool:
        """Whether the lab does by itself what the step shows."""
        return self._player is not None

    # What is asked

    def open(self, name: str, lab: LessonLab) -> None:
        """Open a lesson where it was left.

        Raises:
            ValueError: there is no such lesson.
        """
        self.open_at(name, self.left_at(name), lab)

    def open_at(self, name: str, index: int, lab: LessonLab) -> None:
        """Open a step of a lesson, from anywhere, with the lab as that step expects to find it.

        Raises:
            ValueError: there is no such lesson or step.
        """
        if name not in self.course.lessons:
            raise unknown_name(name, list(self.course.lessons), "lesson")
        lesson = self.course.lesson(name, self.progress.language)
        if index not in range(len(lesson.steps)):
            raise CodedError("error.no_step", step=index + 1, steps=len(lesson.steps))
        before = capture(lab.session) if self.lesson is None else self.before
        _set_up(lab, lesson, index)
        self.progress, self.before = replace(self.progress, lesson=name), before
        self._arrive(index, lab)

    def resume(self, progress: Progress, before: Setup | None, lab: LessonLab) -> None:
        """Go on as it was kept, in a lab that is as it was left."""
        self.progress, self.before = progress, before
        self.words = Words(progress.language)
        self.version += 1
        if self.lesson is not None:
            self._arrive(self.index, lab)

    def take(self, setup: Setup, lab: LessonLab) -> None:
        """Set the lab up otherwise; the open step stays, `begin_anew` brings its own set-up back.

        Raises:
            ValueError: see `restore`; then all is as it was.
        """
        lab.set_up(setup)
        self._begin_again(lab, running=True)
        self.version += 1

    def close(self, lab: LessonLab) -> None:
        """No lesson is open; the lab is as it was before."""
        self.progress = replace(self.progress, lesson="")
        self._begin_again(lab, running=lab.session.running)
        if self.before is not None:
            lab.set_up(self.before)
            lab.session.running = True
        self.version += 1

    def go(self, by: int, lab: LessonLab) -> None:
        """Another step; on the way on, a prediction that is not made is skipped.

        Where the lab then shows what was asked, only the prediction is skipped.
        """
        lesson = self.lesson
        if lesson is None:
            return
        target = min(max(self.index + by, 0), len(lesson.steps) - 1)
        if by > 0 and self.waits:
            self.note_answer(Answer())
            if self.step_is("run"):
                self._lock(lab.session)
                return
        self._go(target, lab)

    def begin_anew(self, lab: LessonLab) -> None:
        """Set the lab up again for the open step."""
        if self.lesson is not None:
            self._go(self.index, lab)

    def predict(self, answer: Answer, session: Session) -> None:
        """Commit to a prediction.

        Raises:
            ValueError: there is none to make, or this is no answer to it.
        """
        found = self.prediction()
        if found is None:
            raise CodedError("lesson.nothing_to_predict")
        _, prediction = found
        if isinstance(prediction, Sketch):
            answer = sketched(prediction, answer)
        elif answer.option is not None and answer.option >= len(prediction.options):
            raise CodedError("lesson.no_such_option")
        self.note_answer(answer)
        self._lock(session)
        self.version += 1

    def play(self, player: ScriptPlayer[Any], lab: LessonLab) -> None:
        """Let the lab do what the open step shows, set up as the step wants it.

        Args:
            player: of the step's script.

        Raises:
            ValueError: a prediction is to be made first.
        """
        lesson, found, session = self.lesson, self.prediction(), lab.session
        if lesson is None:
            return
        if self.locked:
            raise ValueError(self.locked)
        rate = session.rate
        _set_up(lab, lesson, self.index)
        session.rate = rate  # may be slow motion; what happens is the same
        self._begin = Beginning.now(session)
        self._trace = Trace(quantity_of(found[1]), self._begin) if found else None
        self._player = lab.script = player
        session.running = True
        self.version += 1

    # What happens

    def follow(self, lab: LessonLab) -> None:
        """Look at the tasks now and then, and at the end of what a step shows; every frame."""
        self._frames += 1
        session = lab.session
        if self._player is not None and lab.script is not self._player:
            ended, self._player = self._player, None
            if ended.finished:
                self._note_truth(session)
            self.version += 1
        if self._frames % CHECK_INTERVAL:
            return
        if self._player is not None and self._trace is not None:
            self._trace.follow(session)
        if self.step is not None and self.step.tasks():
            self._judge(session, self.step.tasks())

    def truth(self, session: Session) -> Truth | None:
        """What has happened of the predicted quantity: now, or when the step was last played."""
        found = self.prediction()
        if found is None or self._player is None or self._trace is None:
            return None if found is None else self.notes.truths.get(found[0])
        self._trace.follow(session)
        return self._trace.truth()

    def _judge(self, session: Session, tasks: list[Task]) -> None:
        record = record_of(session, self._begin)
        for task in tasks:
            verdicts = judge(task, record, self.words)
            passed = all(verdict.passed for verdict in verdicts)
            if passed or self._passed.get(task.id) != record.run:
                self.verdicts[task.id] = verdicts
            if passed:
                self._passed[task.id] = record.run
                self._pass(task, record)

    def _pass(self, task: Task, record: Record) -> None:
        best = self.notes.tasks.get(task.id)
        value = 0.0
        if task.best:
            chosen = record.chosen("follower", Window())
            value = statistic(record, "follower", task.best, "max", chosen) or 0.0
        if best is None or value < best:
            self.note(tasks={**self.notes.tasks, task.id: round(value, 3)})

    def _go(self, index: int, lab: LessonLab) -> None:
        lesson = self.lesson
        assert lesson is not None
        _set_up(lab, lesson, index)
        self._arrive(index, lab)

    def _arrive(self, index: int, lab: LessonLab) -> None:
        """A step begins, in a lab that is set up."""
        lesson = self.lesson
        assert lesson is not None
        self.note(step=index, seen=max(self.notes.seen, index + 1))
        self._begin_again(lab, lesson.scene_at(index).running)

    def _begin_again(self, lab: LessonLab, running: bool) -> None:
        """Nothing is shown, has been done or can be undone from now on."""
        session = lab.session
        lab.script, session.put_aside, session.running = None, None, running
        self._player = self._trace = None
        self.verdicts, self._passed = {}, {}
        self._begin = Beginning.now(session)
        self._lock(session)

    def _lock(self, session: Session) -> None:
        """Time stands still until a prediction has been made or skipped."""
        if self.waits:
            session.running = False

    def _note_truth(self, session: Session) -> None:
        found, truths = self.prediction(), self.notes.truths
        if found is not None and self._trace is not None:
            self._trace.follow(session)
            truths = {**truths, found[0]: self._trace.truth()}
        played = tuple(dict.fromkeys((*self.notes.played, str(self.index))))
        self.note(truths=truths, played=played)


def setup_of(lesson: Lesson, index: int, exaggeration: float = 1.0) -> Setup:
    """A step's set-up: of the lesson alone, not of what was done in the lab before.

    Args:
        index: of the step.
        exaggeration: how many times larger a deflection is drawn, as in the lab before.
    """
    scene = lesson.scene_at(index)
    robot, path = scene.robot or lesson.front.robot, Path(scene.path or Path().name)
    own = {robot: RobotSetup(dict(scene.set), path)}
    return Setup(robot, own, exaggeration=exaggeration)


def _set_up(lab: LessonLab, lesson: Lesson, index: int) -> None:
    """Both robots at the start, everything as the step wants it but how large it is drawn."""
    lab.set_up(setup_of(lesson, index, lab.session.exaggeration))
    lab.session.editor.select(None)


def quantity_of(prediction: Prediction) -> str:
    """What a prediction is about."""
    return prediction.quantity if isinstance(prediction, Sketch) else "distance"
