"""Faults of predictions, questions, and tasks with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from onpath.lessons.derivation.judged import MOST_LINES, is_same, points_of, value_of
from onpath.lessons.derivation.typed import NAME, NUMPY
from onpath.lessons.measures.responses import WITH_SIGN
from onpath.lessons.measures.stated import zero_faults
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import (
    Choice,
    Derivation,
    NumberQuestion,
    Option,
    Prediction,
    Quiz,
    Sketch,
    SketchShape,
)
from onpath.lessons.task_schema import (
    Better,
    Bound,
    Check,
    Compare,
    Event,
    Once,
    Only,
    Order,
    Setting,
    Task,
)
from onpath.lessons.vocabulary.kinds import kind_faults
from onpath.lessons.vocabulary.names import EVENTS, HIGHEST, LONGEST, one_of
from onpath.models.control.laws.own import OWN
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.control.sides import SIDES
from onpath.models.errors import CodedError
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS, RobotEntry


def prediction_faults(prediction: Prediction) -> Iterator[str]:
    """The faults of a prediction."""
    if prediction.reasons and prediction.why:
        yield "why = true: reasons are given, so own words are not asked for"
    if len(prediction.reasons) == 1 or not all(map(str.strip, prediction.reasons)):
        yield "reasons: two or more are needed, none of them empty"
    if not all(map(str.strip, prediction.hidden)):
        yield "hidden: an empty word hides nothing"
    if isinstance(prediction, Sketch):
        yield from one_of(prediction.quantity, QUANTITIES, "quantity")
        if not 0 < prediction.seconds <= LONGEST:
            yield f"seconds = {prediction.seconds:g}: between 0 and {LONGEST:g}"
        low, high = prediction.bottom, prediction.top
        if not -HIGHEST <= low < high <= HIGHEST:
            yield f"top = {high:g} must be above bottom = {low:g}, both within ±{HIGHEST:g}"
        for shape in (*prediction.shapes, *prediction.features):
            yield from _shape_faults(shape, prediction)
    else:
        yield from choice_faults(prediction)


def _shape_faults(shape: SketchShape, sketch: Sketch) -> Iterator[str]:
    if not shape.name.strip() or not any(shape.without_words):
        yield f"shape {shape.name!r}: it needs a name, and a feature"
    ranges = [*filter(None, (shape.peaks, shape.highest, shape.lowest))]
    ranges += [(low, high) for *_, low, high in (*shape.at, *shape.level)]
    if any(low > high for low, high in ranges):
        yield f"shape {shape.name!r}: each range is from less to more"
    times = [*((time, time) for time, *_ in shape.at), *(each[:2] for each in shape.level)]
    if any(not 0 <= first <= last <= sketch.seconds for first, last in times):
        yield f"shape {shape.name!r}: a time is within the {sketch.seconds:g} s of the axis"


def number_faults(question: NumberQuestion) -> Iterator[str]:
    """The faults of a question whose answer is a number."""
    if not abs(question.number) <= HIGHEST:
        yield f"number = {question.number:g}: within ±{HIGHEST:g}"
    if not 0 < question.tolerance <= HIGHEST:
        yield f"tolerance = {question.tolerance:g}: above 0, and at most {HIGHEST:g}"
    else:
        yield from zero_faults(question.number, question.tolerance)
    numbers = [question.number, *(each.number for each in question.wrong)]
    for i, number in enumerate(numbers[1:], 1):
        if any(abs(number - other) <= 2 * question.tolerance for other in numbers[:i]):
            yield f"wrong number {number:g}: within twice the tolerance of another one"


def derivation_faults(block: Derivation) -> Iterator[str]:
    """The faults of a derivation: of its names, and of each formula."""
    if not 1 <= len(block.line) <= MOST_LINES:
        yield f"{len(block.line)} lines: between 1 and {MOST_LINES}"
    for name in (*block.names, *filter(None, (line.name for line in block.line))):
        if not NAME.fullmatch(name) or name in (*NUMPY, "pi"):
            yield f"name {name!r}: letters and digits, and no function's name"
            return
    if any(low >= high for low, high in block.names.values()):
        yield "names: each has a range, from less to more"
        return
    values = points_of(block)
    for line in block.line:
        if line.name in values:
            yield f"name {line.name!r}: another line or name has it"
        try:
            right, *wrong = (
                value_of(formula, values)
                for formula in (line.formula, *(each.formula for each in line.wrong))
            )
        except CodedError as error:
            yield f"formula: {error}"
            return
        if not all(
            np.isfinite(each).all() and np.abs(each).max() <= HIGHEST for each in (right, *wrong)
        ):
            yield f"formula {line.formula!r}: a value, or a wrong one, is not within ±{HIGHEST:g}"
        if line.tolerance < 0 or is_same(0 * right, right, line.tolerance):
            yield f"tolerance = {line.tolerance:g}: 0 would be accepted, or nothing"
        for each, value in zip(line.wrong, wrong, strict=True):
            if is_same(value, right, 2 * line.tolerance):
                yield f"wrong formula {each.formula!r}: it is the right one"
        values |= {line.name: right} if line.name else {}


def choice_faults(block: Choice | Quiz) -> Iterator[str]:
    """The faults of a choice: of its options, and of its second try."""
    yield from option_faults(block.options)
    second = block.second
    if second is None:
        return
    if (second.number is None) != bool(second.options) or not second.question.strip():
        yield "second: it has a question, and either options or a number"
    elif second.number is None:
        yield from (f"second: {fault}" for fault in option_faults(second.options))
        if second.answer or second.unit or second.tolerance:
            yield "second: each option has its answer; tolerance, unit and answer are a number's"
    elif not second.answer.strip():
        yield "second: a number has an answer"
    asked = second.asked
    if isinstance(asked, NumberQuestion):
        yield from (f"second: {fault}" for fault in number_faults(asked))
    if " ".join(second.question.split()) == " ".join(block.question.split()):
        yield "second: it asks for the reason or for another number, not the same once more"


def option_faults(options: Sequence[Option]) -> Iterator[str]:
    """The faults of a question's options."""
    right = sum(option.right for option in options)
    if len(options) < 2 or right != 1:
        yield f"{len(options)} options, {right} right: two or more are needed, one of them right"
    texts = [" ".join(option.text.split()) for option in options]
    for text in dict.fromkeys(text for text in texts if texts.count(text) > 1):
        yield f"two options have the text {text!r}"


def task_faults(task: Task, robot: str) -> Iterator[str]:
    """The faults of a task."""
    if not task.id.replace("-", "").isalnum():
        yield f"id {task.id!r}: letters, digits and hyphens"
    if all(isinstance(check, Only) for check in task.check):
        yield f"task {task.id!r} has no check"
    if task.best:
        yield from one_of(task.best, QUANTITIES, "quantity")
    for check in task.evaluated:
        yield from _check_faults(check, ROBOTS.get(robot))


def _check_faults(check: Check, entry: RobotEntry | None) -> Iterator[str]:
    if isinstance(check, Bound | Compare | Better):
        yield from one_of(check.quantity, QUANTITIES, "quantity")
        if check.stat == "overshoot" and check.quantity not in WITH_SIGN:
            yield f"overshoot of {check.quantity}: it has no sign, only {', '.join(WITH_SIGN)} have"
        if 0 < check.last < check.least:
            yield f"least = {check.least:g}: of the last {check.last:g} s there are never so many"
    if isinstance(check, Better) and not 0 < check.share <= 1:
        yield f"share = {check.share:g}: above 0, and at most 1"
    if isinstance(check, Bound | Setting):
        equals = check.equals if isinstance(check, Setting) else None
        yield from _limit_faults(check.below, check.above, equals)
    yield from _name_faults(check, entry)


def _limit_faults(below: float | None, above: float | None, equals: object) -> Iterator[str]:
    """The faults of the limits of a check."""
    if below is None and above is None and equals is None:
        yield "a check needs below or above"
    elif below is not None and above is not None and above > below:
        yield f"above = {above:g} and below = {below:g}: no number is both"
    elif isinstance(equals, int | float) and not (
        (below is None or equals <= below) and (above is None or equals >= above)
    ):
        yield f"equals = {equals:g} is not within below and above"


def _name_faults(check: Check, entry: RobotEntry | None) -> Iterator[str]:
    """The unknown names in a check."""
    parameters = None if entry is None else specs(entry.parameters)
    if isinstance(check, Setting | Once) and check.equals is not None:
        values = {"path": [*presets(), OWN], **{side: [*LAWS, OWN] for side in SIDES}}
        if check.name in values:
            yield from one_of(str(check.equals), values[check.name], check.name)
        elif parameters is not None and check.name in parameters:
            yield from kind_faults(check.name, check.equals, parameters[check.name])
    if isinstance(check, Setting | Once | Only) and parameters is not None:
        others = ("path", "robot", *SIDES)
        others = (*others, "start", "wall") if isinstance(check, Only) else (*others, "length")
        for name in check.names if isinstance(check, Only) else (check.name,):
            yield from one_of(name, [*parameters, *others], "parameter")
    events = ()
    if isinstance(check, Order | Event | Once):
        events = check.events if isinstance(check, Order) else check.since
    for event in events:
        yield from one_of(event.partition(":")[0], EVENTS, "event")
    named = [(event.partition(":")[0], event.partition(":")[2]) for event in events]
    if isinstance(check, Event):
        named.append((check.event, check.name))
    known = {"law": [*LAWS, OWN], "set": parameters, "path": presets(), "robot": ROBOTS}
    for event, name in named:
        if name and (names := known.get(event)) is not None:
            yield from one_of(name, names, "parameter" if event == "set" else event)
