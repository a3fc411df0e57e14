"""Pictures of the runs of a lesson, for browsers without scripts and for print."""

from __future__ import annotations

import base64
import math
from dataclasses import dataclass

from onpath.app.exports.report_plot import draw_prediction
from onpath.app.lab.dry_runs.course_check import lab_at, play
from onpath.app.lab.lesson_record import Beginning, Trace
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Lesson, Sketch
from onpath.lessons.sides import robot_names
from onpath.lessons.words import Words

ROUND = (1.0, 2.0, 5.0, 10.0)  # upper ends of an axis, times a power of ten


@dataclass(frozen=True, slots=True)
class RunPicture:
    """A picture of a run.

    Attributes:
        svg: content of the file.
        text: description of the picture.
    """

    svg: bytes
    text: str


def shown_sketch(lesson: Lesson, index: int) -> Sketch | None:
    """The sketch with which a run is compared, from its own step or the one before."""
    for step in (lesson.steps[index], *lesson.steps[max(index - 1, 0) : index]):
        for prediction in step.predictions():
            if isinstance(prediction, Sketch):
                return prediction
    return None


def run_truth(lesson: Lesson, index: int, loop_cache: LoopCache) -> Truth | None:
    """The result of a step's script; None if it has none."""
    step, sketch = lesson.steps[index], shown_sketch(lesson, index)
    if step.script is None:
        return None
    lab = lab_at(lesson, step, loop_cache)
    trace = Trace(sketch.quantity if sketch else "distance", Beginning.now(lab.simulation))
    for _ in play(lab, step.script):
        trace.follow(lab.simulation)
    return trace.truth()


def run_picture(lesson: Lesson, index: int, truth: Truth, words: Words) -> RunPicture:
    """The picture of a run, on the axes of its prediction if that is a sketch."""
    step, sketch = lesson.steps[index], shown_sketch(lesson, index)
    assert step.script is not None
    if sketch is None:
        most = max(map(abs, (*truth.tracker, *truth.follower)), default=1.0)
        sketch = Sketch("", truth.quantity, step.script.until, _top(most))
    names = robot_names(lesson.setup_at(index).laws.named, words)
    uri = draw_prediction(sketch, None, truth, words, names)
    peaks = [
        f"{names[robot]} {words.number(max(getattr(truth, robot), key=abs), 3)}"
        for robot in ("tracker", "follower")
    ]
    text = words(
        "site.picture",
        quantity=words(f"quantity.{truth.quantity}"),
        unit=QUANTITIES[truth.quantity],
        seconds=words.number(sketch.seconds),
        peaks=", ".join(peaks),
    )
    return RunPicture(base64.b64decode(uri.partition(",")[2]), text)


def _top(most: float) -> float:
    power = 10.0 ** math.floor(math.log10(max(most, 0.1)))
    return next(each * power for each in ROUND if each * power >= most)
