"""The data of a lesson, into which lessons/parse.py reads a lesson file.

Questions, answers, tasks, hints, needs and goals are Markdown in the file and Markup here.
"""

from __future__ import annotations

from typing import Literal

import msgspec
from markupsafe import Markup

from onpath.lessons.action_schema import Action, Data, RobotName, Script, StepSetup
from onpath.lessons.behaviour.marks import Behaviour
from onpath.lessons.measures.stated import Stated
from onpath.lessons.task_schema import Task

StepKind = Literal["play", "predict", "run", "explain", "task", "quiz"]


class Option(Data, frozen=True):
    """One option of a question.

    Attributes:
        text: as shown.
        answer: the response to a student who chooses it.
        right: whether it is correct.
        key: identifies the option when the lesson has changed; see `lessons.kept.option_keys`.
    """

    text: str
    answer: str
    right: bool = False
    key: str = ""


class WrongNumber(Data, frozen=True):
    """A wrong number that is known, since it comes from a known mistake.

    Attributes:
        number: in the question's unit.
        answer: what is said to those who give it, without the right number.
    """

    number: float
    answer: str


class NumberQuestion(Data, frozen=True):
    """A question whose answer is a number, which is checked.

    Attributes:
        number: the right answer, in `unit`.
        tolerance: largest accepted deviation, in `unit`.
        answer: shown after a right or a second answer.
        wrong: wrong numbers that are answered by name, within the same tolerance.
    """

    question: str
    number: float
    tolerance: float
    answer: str
    unit: str = ""
    wrong: tuple[WrongNumber, ...] = ()

    def accepts(self, given: float) -> bool:
        """Whether a number is right, up to rounding."""
        return self._near(given, self.number)

    def known(self, given: float) -> int | None:
        """The index of the known wrong number that is given, or None."""
        return next((i for i, w in enumerate(self.wrong) if self._near(given, w.number)), None)

    def _near(self, given: float, number: float) -> bool:
        return abs(given - number) <= self.tolerance * (1 + 1e-9)


class SecondTry(Data, frozen=True):
    """What is asked after a wrong choice: its reason, by options, or another number.

    Attributes:
        number, tolerance, unit, answer: as in `NumberQuestion`; None and empty with options.
    """

    question: str
    options: tuple[Option, ...] = ()
    number: float | None = None
    tolerance: float = 0.0
    unit: str = ""
    answer: str = ""

    @property
    def asked(self) -> Quiz | NumberQuestion:
        """The same as a question that stands by itself."""
        if self.number is None:
            return Quiz(self.question, self.options)
        return NumberQuestion(
            question=self.question,
            number=self.number,
            tolerance=self.tolerance,
            answer=self.answer,
            unit=self.unit,
        )

    @property
    def without_words(self) -> tuple[object, ...]:
        """What it judges by, the same in all languages."""
        return self.number, self.tolerance, [option.right for option in self.options]


class Choice(Data, frozen=True, tag="choice", tag_field="kind"):
    """A prediction: one of several options.

    Attributes:
        second: asked after a wrong choice, once the run has been seen.
        ask: for the teacher, what to ask the class before it is seen.
        hidden: words that no earlier text may contain outside a fold.
        reasons: the student may choose one of them.
        why: whether the student is asked for a reason in his or her own words.
    """

    question: str
    options: tuple[Option, ...]
    second: SecondTry | None = None
    ask: str = ""
    reasons: tuple[str, ...] = ()
    why: bool = False
    hidden: tuple[str, ...] = ()


class SketchShape(Data, frozen=True):
    """A kind of curve that students draw, or a feature of one, by what can be seen in it.

    Attributes:
        name: of a kind, completes "12 drew …"; of a feature, what is seen, such as "two peaks".
        peaks: fewest and most peaks, see `lessons.measures.shapes`; None for any number.
        highest: lowest and highest value of its highest point, in the quantity's unit.
        lowest: the same of its lowest point; a bound of 0 asks for a sign.
        at: a time [s], and the lowest and the highest value then; each of these.
        level: two times [s], and the lowest and the highest value between them; each of these.
    """

    name: str
    peaks: tuple[int, int] | None = None
    highest: tuple[float, float] | None = None
    lowest: tuple[float, float] | None = None
    at: tuple[tuple[float, float, float], ...] = ()
    level: tuple[tuple[float, float, float, float], ...] = ()

    @property
    def without_words(self) -> tuple[object, ...]:
        """Its features, the same in all languages."""
        return self.peaks, self.highest, self.lowest, self.at, self.level


class Sketch(Data, frozen=True, tag="sketch", tag_field="kind"):
    """A prediction: a curve over time, drawn by hand.

    Attributes:
        quantity: one of lessons.record.QUANTITIES.
        seconds: length of the time axis, [s].
        top, bottom: limits of the other axis, in the quantity's unit.
        robot: the robot that is predicted; the true curves of both are shown afterwards.
        usual: for the teacher, what students usually draw.
        answer: for the teacher, what the true curve is like, and why.
        ask: for the teacher, what to ask the class before it is seen.
        shapes: by which the curves of a class are grouped; the first that fits is a curve's.
        features: of which a student is told, after the run, whether the drawn curve has them, and
            the true one.
        reasons, why, hidden: as in `Choice`.
    """

    question: str
    quantity: str
    seconds: float
    top: float
    bottom: float = 0.0
    robot: RobotName = "tracker"
    usual: str = ""
    answer: str = ""
    ask: str = ""
    shapes: tuple[SketchShape, ...] = ()
    features: tuple[SketchShape, ...] = ()
    reasons: tuple[str, ...] = ()
    why: bool = False
    hidden: tuple[str, ...] = ()


Prediction = Choice | Sketch


class Page(Data, frozen=True):
    """A page of a lesson, by the number of its step, from 1."""

    lesson: str
    step: int


class Quiz(Data, frozen=True):
    """A question at the end of a lesson, or of the concept test.

    Attributes:
        second: asked after a wrong choice, in place of the same question once more.
        misconception: for the teacher, the false belief that a question of the test targets.
        treated: the page that treats this belief.
        transfer: whether a question of the test is about other bodies than those of the lessons.
        warm_up: the earlier lesson from which it is drawn; such a question counts nothing.
    """

    question: str
    options: tuple[Option, ...]
    second: SecondTry | None = None
    misconception: str = ""
    treated: Page | None = None
    transfer: bool = False
    warm_up: str = ""


class OpenQuestion(Data, frozen=True):
    """A question that is answered in words; the answer is kept, but not marked.

    Attributes:
        answer: a model answer, shown after the student has answered.
    """

    question: str
    answer: str


class WrongFormula(Data, frozen=True):
    """A wrong value of a line of a derivation that is known, since it comes from a known mistake.

    Attributes:
        formula: as in `DerivedLine`.
        answer: what is said to those who give it, without the right one.
    """

    formula: str
    answer: str


class DerivedLine(Data, frozen=True):
    """A line of a derivation.

    Attributes:
        formula: what is right, in the derivation's names and those of earlier lines; see
            `lessons.derivation.typed`.
        tolerance: of a number, in `unit`; 0 if a formula is asked for.
        answer: shown after a right or a second answer.
        name: by which later lines use its value.
        wrong: mistakes that are answered by name.
    """

    question: str
    formula: str
    answer: str
    tolerance: float = 0.0
    unit: str = ""
    name: str = ""
    wrong: tuple[WrongFormula, ...] = ()

    @property
    def without_words(self) -> tuple[object, ...]:
        """What it judges by, the same in all languages."""
        wrong = [each.formula for each in self.wrong]
        return self.formula, self.tolerance, self.name, wrong


class Derivation(Data, frozen=True):
    """A result that the student derives in some lines, each of which is checked.

    Attributes:
        question: what is derived.
        answer: what it says, shown at the end.
        names: that may be typed -> the range in which formulas are compared.
    """

    question: str
    line: tuple[DerivedLine, ...]
    answer: str
    names: dict[str, tuple[float, float]] = msgspec.field(
        default_factory=dict[str, tuple[float, float]]
    )


class LabLink(msgspec.Struct, frozen=True):
    """Words in the text that act on the lab when they are clicked."""

    label: str
    actions: tuple[Action, ...]


class Text(msgspec.Struct, frozen=True):
    """Part of a step's text, as safe HTML, and its lab links, which follow it as buttons.

    Attributes:
        html: may contain the student's numbers, see `lessons.adaptive.own_numbers`.
        when: the answer after which it is shown, see `lessons.adaptive.branches`; empty for any.
    """

    html: Markup
    links: tuple[LabLink, ...] = ()
    when: str = ""


Block = Text | Choice | Sketch | Task | Quiz | NumberQuestion | OpenQuestion | Derivation
KINDS: dict[type[Block], str] = {
    Text: "text",
    Choice: "choice",
    Sketch: "sketch",
    Task: "task",
    Quiz: "quiz",
    NumberQuestion: "number",
    OpenQuestion: "open",
    Derivation: "derivation",
}
"""Names of the kinds of blocks."""


class StepMark(Data, frozen=True):
    """The contents of a block ```step.

    Attributes:
        optional: whether the step may be skipped.
        when: the answer after which the step is shown, as in `Text`; such a step is optional.
    """

    optional: bool = False
    when: str = ""


class Step(msgspec.Struct, frozen=True):
    """One page of a lesson.

    Attributes:
        line: first line in the file.
        setup: state of the lab at the beginning; None for that of the step before.
        script: actions that the lab performs by itself, or None.
        optional: whether it may be skipped; it does not count for the minutes and the end of the
            lesson.
        when: see `StepMark`.
        watch: of a `run` step: what to look at, shown before and during the run; may be empty.
        notes: of a lecture's slide: what the lecturer says and asks; may be empty.
        stated: numbers in its text that a run must confirm.
        behaviours: words in its text that say what the lab does.
    """

    kind: StepKind
    title: str
    line: int
    blocks: tuple[Block, ...]
    setup: StepSetup | None = None
    script: Script | None = None
    optional: bool = False
    when: str = ""
    stated: tuple[Stated, ...] = ()
    behaviours: tuple[Behaviour, ...] = ()
    watch: Markup = Markup()
    notes: Markup = Markup()

    def predictions(self) -> list[Prediction]:
        """The predictions of this step."""
        return [block for block in self.blocks if isinstance(block, Choice | Sketch)]

    def tasks(self) -> list[Task]:
        """The tasks of this step."""
        return [block for block in self.blocks if isinstance(block, Task)]


class Front(Data, frozen=True):
    """The front matter of a lesson, between two lines +++.

    Attributes:
        picture: for the list of lessons, as a data: URL (in the file, its name); may be empty.
        needs: what the student must know, which follows "You need:" on the first page.
        goals: what the student learns, which follows "Afterwards you can:" on the first page.
        misconception: for the teacher, the false belief that the lesson targets.
        takeaway: points to remember, shown at the end of the lesson.
        symbols: quantities that a page shows where a text names them; see `lessons.symbols`.
        minutes: an estimate in earlier files; ignored, see lessons/minutes.py.
    """

    title: str
    summary: str
    picture: str = ""
    minutes: int | None = None
    robot: str = "five_bar"
    needs: str = ""
    goals: str = ""
    misconception: str = ""
    takeaway: tuple[str, ...] = ()
    symbols: tuple[str, ...] = ()


class Lesson(msgspec.Struct, frozen=True):
    """A lesson in one language.

    Attributes:
        name: of its folder.
        language: two letters.
        keys: of the options, the same in all languages; see `lessons.kept.option_keys`.
        version: of the text in its first language, by which an answer says what it answered.
    """

    name: str
    language: str
    front: Front
    steps: tuple[Step, ...]
    keys: dict[str, tuple[str, ...]] = {}
    version: str = ""

    def setup_at(self, index: int) -> StepSetup:
        """The complete setup of a step, independent of how the student got there."""
        setup = StepSetup()
        for step in self.steps[: index + 1]:
            setup = step.setup.after(setup) if step.setup is not None else setup
        return setup

    def laws_shown(self, index: int) -> dict[str, str]:
        """Control laws, as in `Laws.named`, under which the prediction of a step is tested.

        They are those of the next step if it is a `run` step, else those of the step itself.
        """
        after = self.steps[index + 1 : index + 2]
        return self.setup_at(index + (bool(after) and after[0].kind == "run")).laws.named

    def tasks(self) -> list[Task]:
        """The tasks of all steps."""
        return [task for step in self.steps for task in step.tasks()]

    def required_tasks(self) -> list[Task]:
        """The tasks of all steps that are not optional, without those to be found by trying."""
        steps = (step for step in self.steps if not step.optional)
        return [task for step in steps for task in step.tasks() if not task.exploratory]

    def required_steps(self) -> int:
        """Number of the last step that is not optional, from 1."""
        return max((i for i, step in enumerate(self.steps, 1) if not step.optional), default=0)
