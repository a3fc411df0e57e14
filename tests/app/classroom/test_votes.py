"""The votes of a class: which answers count, and that nothing tells what is right meanwhile."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.class_messages import Lead
from onpath.app.channel.messages import encoded
from onpath.app.classroom.class_html import DOTS, dots_view
from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import NOTHING_DONE, Classroom
from onpath.app.classroom.results import Asked, asked_at, distribution
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.classroom.teaching.teacher_orders import COUNT_DOWN, TeacherOrders
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_state import LessonState, Sent
from onpath.app.lab.snapshots.page_snapshot import LessonSnapshot
from onpath.app.view.lesson_message import lesson_message
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Choice, NumberQuestion, Quiz
from onpath.lessons.votes import Vote, vote_on
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import LESSON as TEXT
from tests.support.lesson_texts import write_lesson
from tests.support.record import MADE

LESSON, CHOICE, RUN, QUIZ, NUMBER = "01-a", 3, 4, 7, 8  # indices of steps
NUMBERS = """
# explain: How much

```number
question = "How many?"
number = 4.0
tolerance = 0.5
unit = "mm"
answer = "Four."
```

# explain: The end

Well done.
"""


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder: Path = tmp_path_factory.mktemp("course")
    told = TEXT.replace('answer = "A"', 'answer = "For a."')
    told = told.replace('answer = "B"', 'answer = "For b."')
    write_lesson(folder, told + NUMBERS)
    found, problems = read_course([folder])
    assert not problems
    return found


class Clock:
    """Seconds since 1970, as a test wants them."""

    time = 1000.0

    def __call__(self) -> float:
        return self.time


def student(course: Course, clock: Clock, step: int = CHOICE) -> LessonState:
    """Progress without a lab, in a step."""
    notes = {LESSON: Notes(step=step, seen=step + 1)}
    return LessonState(course, Progress(lesson=LESSON, notes=notes), clock=clock)


# What counts, against an oracle that keeps a list of everything.

MOVES = st.one_of(
    st.tuples(st.just("answer"), st.integers(0, 2), st.integers(0, 1)),
    st.tuples(st.just("close"), st.sampled_from([0.0, COUNT_DOWN])),
    st.sampled_from([("open",), ("again",), ("store",)]),
    st.tuples(st.just("wait"), st.sampled_from([0.5, 4.0, 6.0])),
)


@given(st.lists(MOVES, max_size=25))
def test_the_first_answer_in_time_counts_whatever_comes_later(
    course: Course, moves: list[tuple[Any, ...]]
) -> None:
    clock = Clock()
    room = Classroom(clock, now=clock)
    students = [student(course, clock) for _ in range(3)]
    room.push(TakeStep(LESSON, CHOICE), [str(CHOICE)])
    heard: list[list[tuple[float, int]]] = [[] for _ in students]  # of this round
    closes, again = float("inf"), False
    for move in moves:
        clock.time += 0.1
        match move:
            case "answer", who, option:
                students[who].note_answer(Answer(option=option))
                heard[who].append((clock.time, option))
            case "close", wait if clock.time <= closes:
                room.close(room.open_votes, wait)
                closes = clock.time + wait
            case ("open",):
                room.open_again(filter(None, [vote_on(room.votes, LESSON, str(CHOICE), again)]))
                closes = float("inf")
            case ("again",):
                room.push(TakeStep(LESSON, CHOICE, again=True), [str(CHOICE)])
                for each in students:
                    each.ask_again()
                heard, closes, again = [[] for _ in students], float("inf"), True
            case ("store",):
                stored = to_stored(room.state, 0.0)
                room.restore(from_stored(stored, lambda _: NOTHING_DONE, 0.0))
            case _:
                clock.time += move[-1] if move[0] == "wait" else 0.0
    first = [[option for time, option in each if time <= closes][:1] for each in heard]
    counts = [first.count([option]) for option in (0, 1)]
    block: Any = course.lesson(LESSON, "en").steps[CHOICE].predictions()[0]
    vote = vote_on(room.votes, LESSON, str(CHOICE), again)
    ways = [each.progress for each in students]
    found = distribution(block, LESSON, str(CHOICE), ways, again=again, vote=vote)
    assert found.counts == tuple(counts)
    assert found.late == sum(bool(e) and all(time > closes for time, _ in e) for e in heard)


def test_an_answer_that_comes_again_counts_once_and_goes_to_its_own_step(course: Course) -> None:
    clock = Clock()
    run = student(course, clock, step=0)  # the teacher has moved on
    sent = Sent(LESSON, CHOICE, "k1")
    for option in (1, 0):  # the same key, so it is the same answer
        run.note_answer(Answer(option=option), sent)
    run.answer_quiz(0, 1, Sent(LESSON, QUIZ, "k2"))
    run.answer_quiz(0, 1, Sent(LESSON, QUIZ, "k2"))
    run.note_answer(Answer(option=0), replace(sent, key="k3"))  # a change
    notes = run.progress.notes[LESSON]
    assert notes.answers == {str(CHOICE): Answer(option=1)} and notes.quiz == {f"{QUIZ}.0": 1}
    assert [each.key for each in notes.given] == ["k2", "k1", "k3"]
    assert set(run.sent) == {"k1", "k2", "k3"}


def test_an_answer_that_cannot_be_taken_is_not_awaited(course: Course) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.Predict(option=7, lesson=LESSON, step=CHOICE, key="bad"))
    do(lab, c.AnswerQuiz(block=0, option=0, lesson="gone", step=0, key="gone"))
    assert lab.lessons.sent == ("bad", "gone") and not lab.lessons.progress.notes


def test_a_stopped_lab_takes_answers_and_nothing_else(course: Course) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, TakeStep(LESSON, CHOICE), c.Freeze(True), c.Predict(option=1), c.GoToStep(1))
    assert lab.lessons.answer() == Answer(option=1) and lab.lessons.index == CHOICE


# While a vote is open, nothing tells what is right.


def told(course: Course, step: int, progress: Progress, votes: tuple[Vote, ...]) -> str:
    """Everything that a page is told of a step, and the report."""
    shown = LessonSnapshot(1, progress, playing=False, verdicts={}, truth=None, votes=votes)
    view = LessonView(course, ENGLISH, shown)
    message = encoded(lesson_message(view, FIVE_BAR.make(FIVE_BAR.parameters())))
    state = LessonState(course, progress)
    state.set_votes(votes)
    made = report(LessonState(course, state.told), "", MADE)
    return message.decode() + made.decode()


def betrays(block: Asked, text: str) -> bool:
    """Whether a text has the answer to a question."""
    if isinstance(block, Quiz | Choice):
        return any(f">{option.answer}<" in text for option in block.options) or '"right"' in text
    return isinstance(block, NumberQuestion) and (block.answer in text or '"tolerance"' in text)


@pytest.mark.parametrize("step", [CHOICE, QUIZ, NUMBER])
def test_neither_page_nor_report_tells_what_is_right_before_the_vote_is_closed(
    course: Course, step: int
) -> None:
    clock = Clock()
    run = student(course, clock, step)
    ((item, block),) = asked_at(course.lesson(LESSON, "en"), step).items()
    if step == CHOICE:
        run.note_answer(Answer(option=0))
    elif step == QUIZ:
        run.answer_quiz(0, 1)
    else:
        run.answer_number(0, 3.0)
    open_now = (Vote(LESSON, item, step),)
    assert not betrays(block, told(course, step, run.progress, open_now))
    if step != CHOICE:  # a prediction is judged by its run
        assert betrays(block, told(course, step, run.progress, ()))


def test_nobody_goes_on_or_lets_it_run_before_the_vote_is_closed(course: Course) -> None:
    room = Classroom(lambda: 0.0, now=Clock())
    lab = Lab(loop_cache(), FIVE_BAR, course)
    room.join("lab", room.code, "Ada")
    sync = ClassSync(room, {"lab": (lab, True)}.get)
    room.push(TakeStep(LESSON, CHOICE), [str(CHOICE)])
    sync.check()
    do(lab, c.Predict(option=0))
    for command in (c.GoToStep(1), c.SetRunning(True), c.FinishLesson(), c.PlayStep()):
        do(lab, command)
        assert lab.message == ENGLISH("class.vote_is_open"), command
        assert lab.lessons.index == CHOICE and not lab.simulation.running
    room.close(room.open_votes)
    room.now.time += 1.0  # type: ignore[attr-defined]
    sync.check()
    do(lab, c.GoToStep(1))
    assert lab.lessons.index == RUN
    room.leave("lab")
    sync.check()
    do(lab)
    assert lab.lessons.votes == ()


def test_who_answers_too_late_is_told_so_and_who_changes_an_answer_is_not(course: Course) -> None:
    room = Classroom(lambda: 0.0, now=Clock())
    labs = {name: Lab(loop_cache(), FIVE_BAR, course) for name in ("ada", "ben")}
    sync = ClassSync(room, lambda code: (labs[code], True))
    for name, lab in labs.items():
        room.join(name, room.code, name)
        lab.lessons.clock = room.now
    room.push(TakeStep(LESSON, CHOICE), [str(CHOICE)])
    sync.check()
    do(labs["ada"], c.Predict(option=0))
    room.close(room.open_votes)
    room.now.time += 1.0  # type: ignore[attr-defined]
    for lab in labs.values():
        do(lab, c.Predict(option=1))
    sync.check()
    for lab in labs.values():
        do(lab)
    late = ENGLISH("class.came_late")
    assert [lab.message == late for lab in labs.values()] == [False, True]


# The teacher's page.


class Lecture:
    """A class with its teacher's orders, without pages."""

    def __init__(self, course: Course) -> None:
        self.clock = Clock()
        self.room = Classroom(self.clock, now=self.clock)
        self.classroom, self.chosen = self.room, TeacherChoices()
        self.course, self.labs = course, dict[str, LessonState]()
        teaching: Any = self
        self.orders = TeacherOrders(course, teaching, lambda _: None, lambda *_: None)
        self.answers = ClassAnswers(course, ENGLISH, teaching)

    def progress(self) -> Progress:
        return Progress()

    def come(self, name: str, step: int = CHOICE) -> LessonState:
        self.room.join(name, self.room.code, name)
        self.labs[name] = student(self.course, self.clock, step)
        return self.labs[name]

    def view(self) -> str:
        for name, state in self.labs.items():
            self.room.note(name, progress=state.progress)
        return self.answers.view(False)

    def lead(self, do: Any) -> None:
        self.view()
        self.orders.lead(Lead(do))

    def send(self, step: int) -> None:
        self.orders.set("class.step", float(step))
        self.lead("send_step")


def line(**numbers: int) -> str:
    return ENGLISH("class.given", **numbers)


def test_showing_the_answers_closes_the_vote_after_a_count_down(course: Course) -> None:
    lecture = Lecture(course)
    ada, ben = lecture.come("Ada"), lecture.come("Ben")
    lecture.send(CHOICE)
    ada.note_answer(Answer(option=0))
    lecture.orders.set("class.shown", True)
    assert ENGLISH("class.closes", seconds=5) in lecture.view()
    assert "background:" not in lecture.view()  # no bars yet
    lecture.clock.time += COUNT_DOWN + 0.1
    ben.note_answer(Answer(option=1))
    view = lecture.view()
    assert "background:" in view and ENGLISH("class.closed") in view
    assert line(given=1, here=2, away=0) in view and ENGLISH("class.late", count=1) in view
    lecture.lead("open_votes")
    view = lecture.view()
    assert "background:" not in view and line(given=2, here=2, away=0) in view


def test_when_all_who_are_here_have_answered_there_is_no_count_down(course: Course) -> None:
    lecture = Lecture(course)
    ada, _ = lecture.come("Ada"), lecture.come("Ben")
    lecture.room.note("Ben", connected=False)
    lecture.send(CHOICE)
    ada.note_answer(Answer(option=0))
    view = lecture.view()
    assert line(given=1, here=1, away=1) in view
    lecture.lead("close_votes")
    lecture.clock.time += 0.01
    assert not lecture.room.open_votes and ENGLISH("class.closed") in lecture.view()


def test_a_quiz_and_a_number_are_shown_as_predictions_are(course: Course) -> None:
    lecture = Lecture(course)
    ada, ben = lecture.come("Ada", QUIZ), lecture.come("Ben", QUIZ)
    lecture.send(QUIZ)
    ada.answer_quiz(0, 0)
    ada.answer_quiz(0, 1)  # the first one counts
    ben.answer_quiz(0, 0)
    lecture.view()
    lecture.orders.set("class.revealed", True)
    lecture.clock.time += 0.01
    view = lecture.view()
    assert "<b>2</b>" in view and "<b>0</b>" in view and "a ✓" in view
    lecture.send(NUMBER)
    ada.answer_number(0, 4.2, Sent(LESSON, NUMBER, ""))
    ben.answer_number(0, -1.0, Sent(LESSON, NUMBER, ""))
    assert "4.2" not in lecture.view()
    lecture.orders.set("class.revealed", True)
    lecture.clock.time += COUNT_DOWN + 0.1
    view = lecture.view()
    assert "4.2 mm ✓" in view and "−1 mm" in view and "−1 mm ✓" not in view


def test_a_teacher_has_the_class_deleted_sooner_but_not_later_than_it_may_be_kept(
    course: Course,
) -> None:
    lecture = Lecture(course)
    room = lecture.room
    assert room.days == 0  # it is not stored
    room.most_days = 7
    for wanted, days in ((2.0, 2), (30.0, 2), (0.0, 2), (7.0, 7)):
        lecture.orders.set("class.days", wanted)
        assert room.days == days
    room.keep_for(2)
    room.restore(from_stored(to_stored(room.state, 0.0), lambda _: NOTHING_DONE, 0.0))
    assert room.days == 2
    room.most_days = 1  # the server was started with another bound
    assert room.days == 1


def test_who_is_set_aside_is_neither_counted_nor_lost_and_is_back_on_coming(
    course: Course,
) -> None:
    lecture = Lecture(course)
    lab = Lab(loop_cache(), FIVE_BAR, course)
    for name in ("Ada", "Ben", "Cem"):
        lecture.room.join(name, lecture.room.code, name)
    here = {"Ada"}
    find = lambda code: (lab, code in here)  # noqa: E731
    sync = ClassSync(lecture.room, find)
    sync.check()
    lecture.lead("set_aside")
    assert lecture.chosen.told == ENGLISH("class.set_aside_told", count=2)
    assert list(lecture.room.present()) == ["Ada"] and len(lecture.room.members()) == 3
    stored = to_stored(lecture.room.state, 0.0)
    lecture.room.restore(from_stored(stored, lambda _: NOTHING_DONE, 0.0))
    assert list(lecture.room.present()) == ["Ada"]
    here.add("Cem")
    sync.check()
    assert list(lecture.room.present()) == ["Ada", "Cem"]


@given(st.lists(st.sampled_from(list(DOTS)), min_size=1))
def test_an_answer_is_called_other_only_beside_right_ones(states: list[Any]) -> None:
    told = dots_view(states, ENGLISH)
    assert ("otherwise" in told) == ({"answered", "right"} <= {*states})
    assert ("not yet" in told) == ("here" in states and {*states} != {"here"})


@given(st.lists(st.sampled_from([None, 0, 1]), min_size=1, max_size=20))
@settings(max_examples=20, deadline=None)
def test_dots_and_proposal_follow_from_the_answers(
    course: Course, options: list[int | None]
) -> None:
    lecture = Lecture(course)
    for number, _ in enumerate(options):
        lecture.come(f"S{number}")
    lecture.send(CHOICE)
    for state, option in zip(lecture.labs.values(), options, strict=True):
        if option is not None:
            state.note_answer(Answer(option=option))
    lecture.view()
    assert lecture.answers.proposal() == ""  # while the vote is open
    lecture.lead("close_votes")
    lecture.clock.time += COUNT_DOWN + 0.1
    block = course.lesson(LESSON, "en").steps[CHOICE].predictions()[0]
    assert isinstance(block, Choice)
    given = [option for option in options if option is not None]
    right = sum(block.options[option].right for option in given)
    wrong, silent = len(given) - right, len(options) - len(given)
    counts = (
        ("not yet", silent) if given else ("here", silent),
        (("answered otherwise", wrong) if right else ("answered", wrong)),
        ("right", right),
    )
    told = re.findall(r"●</span> (.+?)</span>", lecture.answers.dots())
    assert told == [f"{count} {words}" for words, count in counts if count]
    assert lecture.answers.dots().count("border-radius:50%") == len(options)
    found = r'value="(\d+)".*?<bdi>(\w+)</bdi>.*?</span> (\w+)'
    cells = re.findall(found, lecture.answers.grid(), re.DOTALL)
    states = [
        "here" if option is None else "right" if block.options[option].right else "answered"
        for option in options
    ]
    assert [(int(number), name) for number, name, _ in cells] == [
        (at + 1, f"S{at}") for at in range(len(options))
    ]
    assert [state for *_, state in cells] == [ENGLISH(f"class.cell_{each}") for each in states]
    share = right / max(len(given), 1)
    wanted = "explain" if share < 0.3 else "discuss" if share <= 0.7 else "go_on"
    told = ENGLISH(f"class.proposal_{wanted}", percent=round(100 * share))
    assert lecture.answers.proposal() == (told if given else "")
    lecture.lead("ask_again")
    assert f" {len(options)} here<" in lecture.answers.dots()
    lecture.lead("close_votes")
    lecture.clock.time += COUNT_DOWN + 0.1
    assert lecture.answers.proposal() == ""  # nobody has answered again
