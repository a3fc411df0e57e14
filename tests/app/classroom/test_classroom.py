"""A class without a browser: admission, the teacher's view, and orders to the labs."""

from __future__ import annotations

import threading
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.classroom import class_html as page
from onpath.app.classroom.admission import CODE_LENGTH, LONGEST_NAME, cleaned
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.results import distribution, prediction_at, truth_of
from onpath.app.common.access_codes import ALPHABET, shown
from onpath.app.common.throttle import TRIES, WITHIN, Throttle
from onpath.app.lab import commands as c
from onpath.app.lab.commands import Freeze, TakeSetup, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import Setup
from onpath.app.storage.forget import forget
from onpath.app.storage.records import Records, file_url
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Progress, Truth
from onpath.lessons.schema import Choice, Sketch
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import write_lesson
from tests.support.record import record

LESSON, OTHER = "01-a", "02-b"
HOSTILE = '<img src=x onerror="alert(1)">'


@pytest.fixture
def course(tmp_path: Path) -> Course:
    write_lesson(tmp_path / "course")
    write_lesson(tmp_path / "course", name=OTHER)
    return read_course([tmp_path / "course"])[0]


@dataclass
class Watched:
    """A class whose clock and labs are in the test's hands."""

    course: Course
    now: float = 1000.0
    labs: dict[str, tuple[Lab, bool]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.room = Classroom(lambda: self.now)
        self.attendance = ClassSync(self.room, self.labs.get)

    def student(self, name: str) -> Lab:
        """One more, in the class."""
        code = f"lab {len(self.labs)}"
        lab = Lab(loop_cache(), FIVE_BAR, self.course)
        self.labs[code] = lab, True
        self.room.join(code, self.room.code, name)
        self.check()
        return lab

    def check(self) -> None:
        """As the class's thread does; then a frame of every lab."""
        self.attendance.check()
        for lab, _ in self.labs.values():
            lab.drain()


@pytest.fixture
def klass(course: Course) -> Watched:
    return Watched(course)


# Who may come in.


def test_students_join_with_the_code_and_a_nickname(klass: Watched) -> None:
    room = klass.room
    room.join("lab", f" {room.code.upper()} ", "  Ada\tLovelace ")
    assert [member.name for member in room.members().values()] == ["Ada Lovelace"]
    with pytest.raises(ValueError, match="class code"):
        room.join("other", "nope", "Bob")
    with pytest.raises(ValueError, match="nickname"):
        room.join("other", room.code, " \u200b\n")
    assert room.member("other") is None


def test_two_of_a_name_are_told_apart(klass: Watched) -> None:
    room = klass.room
    names = [room.join(f"lab {i}", room.code, "x" * 40).name for i in range(12)]
    assert len(set(names)) == 12 and all(len(name) <= LONGEST_NAME for name in names)
    assert room.join("lab 3", room.code, "new").number == 4


@given(st.text(max_size=300))
def test_a_nickname_is_short_and_printable(text: str) -> None:
    try:
        name = cleaned(text)
    except ValueError:
        return
    assert 0 < len(name) <= LONGEST_NAME and name.isprintable()
    assert cleaned(name) == name


@pytest.mark.parametrize("name", [HOSTILE, "</td><script>", "\u202egnp.exe", "{0.x}", "&lt;b&gt;"])
def test_a_hostile_nickname_is_only_text(klass: Watched, name: str) -> None:
    klass.student(name)
    shown = page.table(klass.room.members().values(), klass.course, klass.now, ENGLISH)
    assert "<img" not in shown and "<script" not in shown and "\u202e" not in shown
    assert shown.count("<tr") == 2


def test_the_teacher_comes_in_with_the_key_alone(klass: Watched) -> None:
    room = klass.room
    given_pass = room.admit(f" {shown(room.key).upper()}", "lab")
    assert room.is_pass(given_pass) and not room.is_pass(room.key)
    for wrong in (None, "", given_pass[:-1], given_pass + "x", "é", "\udcff"):
        assert not room.is_pass(wrong)
    for wrong in (room.code, "", "é" * 12, "\udcff", "2222-2222-2222"):
        with pytest.raises(ValueError, match="key"):
            room.admit(wrong, f"lab {wrong}")
    room.revoke(given_pass)
    assert not room.is_pass(given_pass)


def test_guessing_is_slow_and_locks_out_nobody_else(klass: Watched) -> None:
    room = klass.room
    for _ in range(TRIES):
        with pytest.raises(ValueError, match="not the teacher's key"):
            room.admit("2222-2222-2222", "thief")
    with pytest.raises(ValueError, match="too many"):
        room.admit(shown(room.key), "thief")
    for typed in [f"wrong {number}" for number in range(TRIES)]:
        with pytest.raises(ValueError, match="class code"):
            room.join("thief", typed, "x")
    for typed in (room.code, "wrong"):
        with pytest.raises(ValueError, match="too many"):
            room.join("thief", typed, "x")
    assert room.admit(shown(room.key), "teacher") and room.join("student", room.code, "x")
    klass.now += WITHIN + 1
    assert room.join("thief", room.code, "x") and room.admit(shown(room.key), "thief")


@pytest.mark.parametrize("wanted", ["class code", "teacher's key"])
def test_a_flood_of_wrong_codes_from_throwaway_labs_locks_nobody_out(
    klass: Watched, wanted: str
) -> None:
    room, answers = klass.room, []

    def guess(tab: int) -> None:
        for number in range(100):
            lab = f"{tab}.{number // TRIES}"
            try:
                if wanted == "class code":
                    room.join(lab, "wrong", "x")
                else:
                    room.admit("2222-2222-2222", lab)
            except ValueError as error:
                answers.append(str(error))

    tabs = [threading.Thread(target=guess, args=(tab,)) for tab in range(20)]
    for tab in tabs:
        tab.start()
    for tab in tabs:
        tab.join()
    assert len(answers) == 2000 and room.members() == {}
    assert room.join("student", room.code, "Ada") and room.admit(shown(room.key), "teacher")


def test_a_class_code_is_not_to_be_guessed_within_a_lesson(klass: Watched) -> None:
    assert len(klass.room.code) == CODE_LENGTH and set(klass.room.code) <= set(ALPHABET)
    guesses = 90 * 1700  # of a lesson; see `app.classroom.admission.Admission`
    assert guesses / len(ALPHABET) ** CODE_LENGTH < 1e-3


def test_attempts_under_way_count_and_only_failures_go_on_counting() -> None:
    now = 0.0
    throttle = Throttle(lambda: now)
    with ExitStack() as under_way:
        for _ in range(TRIES):
            under_way.enter_context(throttle.attempt("tab"))
        with pytest.raises(ValueError, match="too many"), throttle.attempt("tab"):
            raise AssertionError
        with throttle.attempt("other"):
            pass
    for _ in range(TRIES):
        with pytest.raises(OSError), throttle.attempt("tab"):
            raise OSError
    for _ in range(TRIES):
        with pytest.raises(ValueError, match="wrong"), throttle.attempt("tab"):
            raise ValueError("wrong")
    now = WITHIN - 1
    with pytest.raises(ValueError, match="too many"), throttle.attempt("tab"):
        raise AssertionError
    now = WITHIN
    with throttle.attempt("tab"):
        pass


# What reaches the labs.


def test_a_frozen_lab_stands_still_and_refuses_with_a_sentence(klass: Watched) -> None:
    lab = klass.student("Ada")
    outside = Lab(loop_cache(), FIVE_BAR, klass.course)
    do(lab, c.MoveHand(0.01, 0.0))
    klass.room.freeze(True)
    klass.check()
    before = lab.simulation.time
    assert lab.message == ENGLISH("class.frozen") and not lab.simulation.forces.hands
    for command in (
        c.SetRunning(False),
        c.StepOnce(),
        c.Set("K1", 1.0),
        c.MoveHand(0.01, 0.0),
    ):
        lab.show_message("")
        do(lab, command)
        assert lab.message == ENGLISH("class.frozen")
    run(lab, 0.5)
    run(outside, 0.5)
    assert lab.simulation.time == before and outside.simulation.time > 0.4
    assert (
        lab.simulation.running
        and lab.simulation.parameters.K1 != 1.0
        and not lab.simulation.forces.hands
    )
    klass.room.freeze(False)
    klass.check()
    run(lab, 0.5)
    assert lab.simulation.time > before and lab.message == ""


def test_who_joins_is_frozen_too_and_who_leaves_is_let_go(klass: Watched) -> None:
    klass.room.freeze(True)
    first, second = klass.student("Ada"), klass.student("Bob")
    assert first.frozen and second.frozen
    klass.room.leave("lab 0")
    klass.check()
    assert not first.frozen and second.frozen
    assert klass.room.end() == 1
    klass.check()
    assert not second.frozen and klass.room.members() == {} and not klass.room.orders.frozen


def test_a_step_is_opened_for_all_as_if_they_had_come_there(klass: Watched) -> None:
    first, second = klass.student("Ada"), klass.student("Bob")
    do(second, c.OpenLesson(LESSON), c.Set("K1", 7.0))
    klass.room.push(TakeStep(LESSON, 1))
    klass.check()
    for lab in (first, second):
        assert lab.lessons.lesson is not None and lab.lessons.index == 1
        assert lab.simulation.parameters.K1 == 300 and lab.locked  # of the scene before
        assert lab.lessons.answer() is None
        do(lab, c.CloseLesson())
    klass.check()
    assert first.lessons.lesson is None  # once, not again and again
    for wrong in (TakeStep("nope", 0), TakeStep(LESSON, 99), TakeStep(LESSON, -1)):
        klass.room.push(wrong)
        klass.check()
        assert first.lessons.lesson is None
        assert first.message.startswith(("unknown lesson", "there is no step"))


def test_a_setup_is_taken_by_all_even_when_frozen(klass: Watched) -> None:
    own = Lab(loop_cache(), FIVE_BAR, klass.course)
    do(own, c.Set("K2", 33), c.ChoosePath("clover"))
    lab = klass.student("Ada")
    klass.room.freeze(True)
    klass.check()
    klass.room.push(TakeSetup(capture(own.simulation)))
    klass.check()
    assert capture(lab.simulation) == capture(own.simulation)
    assert lab.frozen and lab.message == ENGLISH("class.frozen")


def sent_setup(course: Course) -> Setup:
    """That no step of the lessons has."""
    own = Lab(loop_cache(), FIVE_BAR, course)
    do(own, c.Set("K2", 33), c.ChoosePath("clover"))
    return capture(own.simulation)


@pytest.mark.parametrize("step", range(8))
def test_a_setup_leaves_a_student_in_the_open_step(klass: Watched, step: int) -> None:
    lab, setup = klass.student("Ada"), sent_setup(klass.course)
    do(lab, c.Set("K1", 7.0), c.OpenLesson(LESSON))
    do(lab, *[c.GoToStep(1)] * step)
    run(lab, 0.2)
    waits, before = lab.locked, lab.lessons.progress
    klass.room.push(TakeSetup(setup))
    klass.check()
    assert capture(lab.simulation) == setup and lab.message == ENGLISH("class.setup_in_step")
    assert lab.lessons.progress == before and lab.lessons.index == step
    assert lab.locked == waits and lab.simulation.running == (not waits)
    do(lab, c.GoToStep(1))
    assert lab.lessons.index == min(step + 1, 7)
    do(lab, c.CloseLesson())
    assert lab.simulation.parameters.K1 == 7.0  # the free lab as it was


def test_set_up_again_brings_the_steps_own_setup_back(klass: Watched) -> None:
    lab = klass.student("Ada")
    do(lab, c.OpenLesson(LESSON))
    own = capture(lab.simulation)
    klass.room.push(TakeSetup(sent_setup(klass.course)))
    klass.check()
    assert capture(lab.simulation) != own
    do(lab, c.BeginStepAnew())
    assert capture(lab.simulation) == own and lab.lessons.index == 0


def test_a_setup_ends_what_plays_and_nothing_is_noted_of_it(klass: Watched) -> None:
    lab = klass.student("Ada")
    do(lab, c.OpenLesson(LESSON), *[c.GoToStep(1)] * 2, c.PlayStep())
    run(lab, 0.5)
    assert lab.lessons.playing
    klass.room.push(TakeSetup(sent_setup(klass.course)))
    klass.check()
    run(lab, 2.5)
    assert not lab.lessons.playing and not lab.lessons.has_played()
    assert lab.lessons.notes.truths == {}


def test_a_step_that_is_opened_is_a_step_of_a_lesson(klass: Watched) -> None:
    lab, free = klass.student("Ada"), klass.student("Bob")
    do(lab, c.Set("K1", 7.0), c.OpenLesson(OTHER), *[c.GoToStep(1)] * 6)
    klass.room.push(TakeStep(LESSON, 5))
    klass.check()
    assert lab.message == ENGLISH("class.step_elsewhere")
    assert free.message == ENGLISH("class.step")
    for by, index in ((0, 5), (1, 6), (1, 7), (-1, 6), (-1, 5), (-1, 4)):
        do(lab, c.GoToStep(by))
        assert lab.lessons.progress.lesson == LESSON and lab.lessons.index == index
    do(lab, c.OpenLesson(OTHER))
    assert lab.lessons.index == 6 and lab.simulation.editor.design.name == "ellipse"
    assert set(lab.lessons.notes.answers) == {"1", "3"}
    do(lab, c.CloseLesson())
    assert lab.simulation.parameters.K1 == 7.0


def test_who_joins_later_gets_what_was_sent_last(klass: Watched) -> None:
    klass.room.push(TakeStep(OTHER, 0))
    klass.room.push(TakeStep(LESSON, 1))
    for name in ("Ada", "Bob"):
        late = klass.student(name)
        assert late.lessons.progress.lesson == LESSON and late.lessons.index == 1
        do(late, c.CloseLesson())
        klass.check()
        assert late.lessons.lesson is None  # once
    klass.room.push(TakeSetup(sent_setup(klass.course)))
    assert capture(klass.student("Cid").simulation) == sent_setup(klass.course)


def test_what_stands_ends_when_the_teacher_says_so(klass: Watched) -> None:
    first = klass.student("Ada")
    klass.room.push(TakeStep(LESSON, 1))
    klass.check()
    klass.room.push(None)
    klass.check()
    assert klass.room.orders.push is None and first.lessons.progress.lesson == LESSON
    assert klass.student("Bob").lessons.lesson is None
    klass.room.push(TakeStep(OTHER, 0))
    klass.check()
    assert first.lessons.progress.lesson == OTHER
    klass.room.end()
    klass.check()
    assert klass.student("Cid").lessons.lesson is None


def test_who_reloads_has_what_was_sent_and_goes_on_from_there(klass: Watched) -> None:
    lab = klass.student("Ada")
    klass.labs["lab 0"] = lab, False  # a reload, and just then the teacher sends
    klass.check()
    klass.room.push(TakeStep(LESSON, 1))
    klass.check()
    klass.labs["lab 0"] = lab, True
    klass.check()
    assert lab.lessons.index == 1
    do(lab, c.GoToStep(1))
    klass.labs["lab 0"] = lab, False
    klass.check()
    klass.labs["lab 0"] = lab, True
    klass.check()
    assert lab.lessons.index == 2  # and is not sent back


def test_only_a_teacher_thaws(klass: Watched) -> None:
    lab = klass.student("Ada")
    do(lab, Freeze(True))  # type: ignore[arg-type]
    do(lab, c.SetLanguage("de"), c.Reset())
    assert lab.frozen and lab.words.language == "en"


def test_who_leaves_and_returns_keeps_its_place(klass: Watched) -> None:
    lab = klass.student("Ada")
    klass.room.push(TakeStep(LESSON, 1))
    klass.check()
    klass.check()
    klass.labs["lab 0"] = lab, False
    klass.check()
    away = klass.room.member("lab 0")
    assert away is not None and not away.connected and away.progress.lesson == LESSON
    del klass.labs["lab 0"]  # dropped after a while; kept in the database
    klass.room.freeze(True)
    klass.check()
    again = Lab(loop_cache(), FIVE_BAR, klass.course)
    again.lessons.resume(lab.lessons.progress, None, again)
    klass.labs["lab 0"] = again, True
    klass.check()
    member = klass.room.member("lab 0")
    assert member is not None and member.connected and again.frozen
    assert (member.number, member.name) == (1, "Ada") and again.lessons.index == 1


def test_the_table_knows_who_is_idle_and_who_is_away(klass: Watched) -> None:
    busy, _ = klass.student("Busy"), klass.student("Idle")
    klass.student("Gone")
    klass.now += 180.0
    do(busy, c.SetRunning(False))
    klass.labs["lab 2"] = klass.labs["lab 2"][0], False
    klass.check()
    rows = page.table(klass.room.members().values(), klass.course, klass.now, ENGLISH)
    for name, state in (("Busy", "here"), ("Idle", "idle for 3 min"), ("Gone", "away")):
        row = next(row for row in rows.split("<tr") if name in row)
        assert state in row


# What was predicted.


def answered(*answers: Answer | None, step: int) -> list[Progress]:
    """Students with these answers to one prediction."""
    kept = [{} if answer is None else {str(step): answer} for answer in answers]
    return [Progress(notes={LESSON: notes_with(answers=own)}) for own in kept]


def test_choices_are_counted(course: Course) -> None:
    lesson = course.lesson(LESSON, "en")
    found = prediction_at(lesson, 4)
    assert found is not None and found[0] == 3 and isinstance(found[1], Choice)
    ways = answered(Answer(1), Answer(1), Answer(0), Answer(), Answer(7), None, step=3)
    counted = distribution(found[1], LESSON, "3", [*ways, Progress()])
    assert (counted.counts, counted.skipped, counted.waiting) == ((1, 2), 1, 2)
    hidden = page.prediction_view(found[1], counted, None, False, ENGLISH)
    revealed = page.prediction_view(found[1], counted, None, True, ENGLISH)
    assert "✓" not in hidden and revealed.count("✓") == 1
    assert "width:85.0%" in hidden and "width:42.5%" in hidden


def test_sketches_lie_over_the_truth(course: Course) -> None:
    lesson = course.lesson(LESSON, "en")
    found = prediction_at(lesson, 2)
    assert found is not None and found[0] == 1 and isinstance(found[1], Sketch)
    curve = Answer(times=(0.0, 1.0, 2.0), values=(0.0, 30.0, 1e9))
    ways = answered(curve, curve, None, step=1)
    truth = Truth("distance", (0.0, 2.0), (0.0, 50.0), (0.0, 1.0))
    played = Progress(notes={LESSON: Notes(truths={"1": truth})})
    assert truth_of(LESSON, 1, ways) is None and truth_of(LESSON, 1, [*ways, played]) == truth
    counted = distribution(found[1], LESSON, "1", ways)
    hidden = page.prediction_view(found[1], counted, truth, False, ENGLISH)
    revealed = page.prediction_view(found[1], counted, truth, True, ENGLISH)
    plots = [view.partition("</svg>")[0] for view in (hidden, revealed)]
    assert [plot.count("<polyline") for plot in plots] == [2, 4]
    assert hidden.count("<polyline") == 2 + 2  # each once more, small
    assert "nan" not in revealed and "1000000000" not in revealed


def test_a_step_without_prediction_has_none(course: Course) -> None:
    lesson = course.lesson(LESSON, "en")
    assert prediction_at(lesson, 0) is None and prediction_at(lesson, 5) is None


# What is taken home, and what is forgotten.


def test_the_record_has_a_row_for_each_prediction_and_task(klass: Watched) -> None:
    lab = klass.student("Ada")
    klass.student("Bob")
    do(lab, c.OpenLesson(LESSON), c.GoToStep(1))
    do(lab, c.Predict(times=(0.0, 1.0), values=(1.0, 2.5)))
    klass.check()
    sheets = record(klass.room.members().values(), klass.course)
    rows = sheets["Answers"]
    assert {row["nickname"] for row in rows} == {"Ada"}  # Bob is in the free lab
    found = {(row["kind"], row["step"]): row for row in rows}
    assert found["prediction", 2]["result"] == "answered"
    assert [(row["time"], row["drawn"]) for row in sheets["Sketches"]] == [(0, 1), (1, 2.5)]
    assert found["prediction", 4]["result"] == "open"
    task = next(row for row in rows if row["kind"] == "task")
    assert (task["item"], task["result"], task["right"]) == ("hold", "open", 0)


@pytest.mark.parametrize(
    "name",
    [
        '=HYPERLINK("http://x")',
        "+1",
        "-1",
        "@SUM(A1)",
        " =1",
        "\t=1",
        "|calc",
        "%0",
        'a","=1',
        "a;=1",
    ],
)
def test_a_nickname_like_a_formula_is_text(klass: Watched, name: str) -> None:
    lab = klass.student(name)
    do(lab, c.OpenLesson(LESSON))
    klass.check()
    rows = record(klass.room.members().values(), klass.course)["Answers"]
    assert rows and {row["nickname"] for row in rows} == {cleaned(name)}


def test_everything_that_is_kept_is_deleted(tmp_path: Path) -> None:
    file = tmp_path / "labs.db"
    records = Records(file_url(file))
    for code in ("a" * 12, "b" * 12):
        records.save(code, {"secret": "Ada"})
    records.renew(["a" * 12])
    assert records.delete_all() == 2 and records.delete_all() == 0
    records.save("a" * 12, {"secret": "Ada"})
    records.close()
    (tmp_path / "labs.db.broken-1").write_text("Ada")
    gone = forget(f"sqlite:///{file}")
    assert gone.labs == 1 and [f.name for f in gone.files] == ["labs.db.broken-1"]
    assert not any(b"Ada" in part.read_bytes() for part in tmp_path.iterdir())
