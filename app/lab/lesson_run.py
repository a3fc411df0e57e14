"""A student's way through the lessons: which step, what was predicted, which tasks are passed.

No viser in it. Only the simulation thread calls it; app/lab/apply_lesson.py brings it the commands.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from onpath.app.lab.lesson_record import Beginning, Trace, record_of
from onpath.app.lab.lesson_scene import set_up
from onpath.app.lab.script_player import ScriptPlayer, perform
from onpath.app.lab.setup import Setup, capture, restore
from onpath.app.lab.sketches import sketched
from onpath.lessons.checks import Verdict, judge, statistic
from onpath.lessons.course import Course
from onpath.lessons.place import CoursePlace
from onpath.lessons.progress import Answer, Progress, Truth
from onpath.lessons.record import Record
from onpath.lessons.schema import Action, Prediction, Quiz, Sketch, Task, Window
from onpath.lessons.words import Words

if TYPE_CHECKING:
    from onpath.app.lab.session import Session

CHECK_INTERVAL = 30  # frames between looks at the tasks


class LessonRun(CoursePlace):
    """The lessons as one student goes through them.

    Attributes:
        version: changes whenever the page must be drawn anew.
        verdicts: on the checks of the open step's tasks, by task.
        before: the lab as it was before any lesson was open.
    """

    def __init__(self, course: Course, progress: Progress | None = None) -> None:
        progress = progress or Progress()
        super().__init__(course, progress, Words(progress.language))
        self.version = 0
        self.verdicts: dict[str, list[Verdict]] = {}
        self._begin = Beginning(0, 0.0)
        self._frames = 0
        self._player: ScriptPlayer | None = None  # of what the step shows
        self._trace: Trace | None = None  # of what is played
        self._passed: dict[str, int] = {}  # the run in which a task was passed
        self.before: Setup | None = None

    @property
    def playing(self) -> bool:
        """Whether the lab does by itself what the step shows."""
        return self._player is not None

    # What is asked

    def open(self, name: str, session: Session) -> None:
        """Open a lesson where it was left.

        Raises:
            ValueError: there is no such lesson.
        """
        self.open_at(name, self.left_at(name), session)

    def open_at(self, name: str, index: int, session: Session) -> None:
        """Open a step of a lesson, from anywhere, with the lab as that step expects to find it.

        Raises:
            ValueError: there is no such lesson or step.
        """
        if name not in self.course.lessons:
            raise ValueError(f"no lesson {name!r}: there are {', '.join(self.course.lessons)}")
        lesson = self.course.lesson(name, self.progress.language)
        if index not in range(len(lesson.steps)):
            raise ValueError(f"no step {index + 1} in this lesson: it has {len(lesson.steps)}")
        before = capture(session) if self.lesson is None else self.before
        set_up(session, lesson, index)
        self.progress, self.before = replace(self.progress, lesson=name), before
        self._arrive(index, session)

    def resume(self, progress: Progress, before: Setup | None, session: Session) -> None:
        """Go on as it was kept, in a lab that is as it was left."""
        self.progress, self.before = progress, before
        self.words = Words(progress.language)
        self.version += 1
        if self.lesson is not None:
            self._arrive(self.index, session)

    def take(self, setup: Setup, session: Session) -> None:
        """Set the lab up otherwise; the open step stays, `begin_anew` brings its own set-up back.

        Raises:
            ValueError: see `restore`; then all is as it was.
        """
        restore(session, setup)
        self._begin_again(session, running=True)
        self.version += 1

    def close(self, session: Session) -> None:
        """No lesson is open; the lab is as it was before."""
        self.progress = replace(self.progress, lesson="")
        self._begin_again(session, running=session.running)
        if self.before is not None:
            restore(session, self.before)
            session.running = True
        self.version += 1

    def go(self, by: int, session: Session) -> None:
        """Another step; on the way on, a prediction that is not made is skipped.

        Where the lab then shows what was asked, only the prediction is skipped.
        """
        lesson = self.lesson
        if lesson is None:
            return
        target = min(max(self.index + by, 0), len(lesson.steps) - 1)
        if by > 0 and self.waits:
            self._note_answer(Answer())
            if self.step_is("run"):
                self._lock(session)
                return
        self._go(target, session)

    def begin_anew(self, session: Session) -> None:
        """Set the lab up again for the open step."""
        if self.lesson is not None:
            self._go(self.index, session)

    def predict(self, answer: Answer, session: Session) -> None:
        """Commit to a prediction.

        Raises:
            ValueError: there is none to make, or this is no answer to it.
        """
        found = self.prediction()
        if found is None:
            raise ValueError(self.words("lesson.nothing_to_predict"))
        _, prediction = found
        if isinstance(prediction, Sketch):
            answer = sketched(prediction, answer)
        elif answer.option is not None and answer.option >= len(prediction.options):
            raise ValueError(self.words("lesson.no_such_option"))
        self._note_answer(answer)
        self._lock(session)
        self.version += 1

    def play(self, session: Session) -> None:
        """Let the lab do what the step shows, set up as the step wants it."""
        lesson, step, found = self.lesson, self.step, self.prediction()
        if lesson is None or step is None or step.script is None:
            return
        if session.locked:
            raise ValueError(session.locked)
        rate = session.rate
        set_up(session, lesson, self.index)
        session.rate = rate  # may be slow motion; what happens is the same
        self._begin = Beginning.now(session)
        self._trace = Trace(quantity_of(found[1]), self._begin) if found else None
        self._player = session.script = ScriptPlayer(step.script)
        session.running = True
        self.version += 1

    def act(self, actions: tuple[Action, ...], session: Session) -> None:
        """What a link in the text does."""
        for action in actions:
            if session.locked and action.run:
                raise ValueError(session.locked)
            perform(action, session)

    def hint(self, task: str) -> None:
        """One hint more."""
        shown = self.notes.hints.get(task, 0) + 1
        self._note(hints={**self.notes.hints, task: shown})

    def answer_quiz(self, block: int, option: int) -> None:
        """Choose an option of the quiz that is the open step's block.

        Raises:
            ValueError: there is no such quiz or option.
        """
        step = self.step
        quiz = step.blocks[block] if step and block in range(len(step.blocks)) else None
        if not isinstance(quiz, Quiz) or option not in range(len(quiz.options)):
            raise ValueError(self.words("lesson.no_such_option"))
        self._note(quiz={**self.notes.quiz, f"{self.index}.{block}": option})

    def set_language(self, language: str) -> None:
        """Of texts and interface."""
        self.words = Words(language)
        self.progress = replace(self.progress, language=self.words.language)
        self.version += 1

    def set_presenting(self, on: bool) -> None:
        """Large type, or not."""
        self.progress = replace(self.progress, presenting=on)
        self.version += 1

    # What happens

    def follow(self, session: Session) -> None:
        """Look at the tasks now and then, and at the end of what a step shows; every frame."""
        self._frames += 1
        if self._player is not None and session.script is not self._player:
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
            self._note(tasks={**self.notes.tasks, task.id: round(value, 3)})

    def _go(self, index: int, session: Session) -> None:
        lesson = self.lesson
        assert lesson is not None
        set_up(session, lesson, index)
        self._arrive(index, session)

    def _arrive(self, index: int, session: Session) -> None:
        """A step begins, in a lab that is set up."""
        lesson = self.lesson
        assert lesson is not None
        self._note(step=index, seen=max(self.notes.seen, index + 1))
        self._begin_again(session, lesson.scene_at(index).running)

    def _begin_again(self, session: Session, running: bool) -> None:
        """Nothing is shown, has been done or can be undone from now on."""
        session.script, session.put_aside, session.running = None, None, running
        self._player = self._trace = None
        self.verdicts, self._passed = {}, {}
        self._begin = Beginning.now(session)
        self._lock(session)

    def _lock(self, session: Session) -> None:
        """Time stands still until a prediction has been made or skipped."""
        session.locked = self.words("lesson.locked") if self.waits else ""
        if self.waits:
            session.running = False

    def _note_truth(self, session: Session) -> None:
        found, truths = self.prediction(), self.notes.truths
        if found is not None and self._trace is not None:
            self._trace.follow(session)
            truths = {**truths, found[0]: self._trace.truth()}
        played = tuple(dict.fromkeys((*self.notes.played, str(self.index))))
        self._note(truths=truths, played=played)

    def _note_answer(self, answer: Answer) -> None:
        found = self.prediction()
        assert found is not None
        self._note(answers={**self.notes.answers, found[0]: answer})

    def _note(self, **changes: Any) -> None:
        notes = {**self.progress.notes, self.progress.lesson: replace(self.notes, **changes)}
        self.progress = replace(self.progress, notes=notes)
        self.version += 1


def quantity_of(prediction: Prediction) -> str:
    """What a prediction is about."""
    return prediction.quantity if isinstance(prediction, Sketch) else "distance"
