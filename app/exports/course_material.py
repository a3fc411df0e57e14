"""The material of the teacher's guide and the worksheets: a lesson's steps with their answers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from onpath.app.exports.report_plot import draw_prediction
from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.action_words import script_words
from onpath.lessons.course import REFERENCE, Course, read_references
from onpath.lessons.minutes import Minutes, optional_minutes, required_minutes, step_minutes
from onpath.lessons.progress import Truth
from onpath.lessons.schema import KINDS, Block, Lesson, Sketch, Step, Text
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Task
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS


@dataclass(frozen=True, slots=True)
class AskedBlock:
    """A prediction, a question of any kind, or a task, with its answer.

    Attributes:
        kind: see `onpath.lessons.schema.KINDS`; not "text".
        key: lesson, step and place in the step; unique in the course.
        step: number of the step, from 1.
        axes: empty axes of a sketch, as an image for a page.
        figure: the same axes with the true curves.
        solution: a sentence for each instant of a task's reference solution.
    """

    kind: str
    key: str
    step: int
    block: Block
    axes: str = ""
    figure: str = ""
    solution: tuple[str, ...] = ()

    @property
    def exploratory(self) -> bool:
        """Whether it is a task to be found by trying, which counts nothing in a grade."""
        return isinstance(self.block, Task) and self.block.exploratory


@dataclass(frozen=True, slots=True)
class TaughtStep:
    """A step of a lesson: its number from 1, its estimated minutes, and what it asks."""

    number: int
    step: Step
    minutes: Minutes
    asked: list[AskedBlock]


@dataclass(frozen=True, slots=True)
class TaughtLesson:
    """A lesson as taught.

    Attributes:
        number: as displayed.
        minutes: sum over the steps that are not optional.
        optional: sum over the optional ones.
    """

    number: str
    lesson: Lesson
    minutes: Minutes
    optional: Minutes
    steps: list[TaughtStep]

    def asked(self, *kinds: str) -> list[AskedBlock]:
        """Everything that is asked, or only some kinds of it."""
        every = [asked for step in self.steps for asked in step.asked]
        return [asked for asked in every if not kinds or asked.kind in kinds]


def taught_lesson(course: Course, folder: Path, name: str, words: Words) -> TaughtLesson:
    """A lesson in the language of `words`, with its reference solutions and true curves.

    Args:
        folder: contains the lessons' own folders.

    Raises:
        ValueError: the reference solutions cannot be read.
    """
    lesson = course.lesson(name, words.language)
    references, problems = read_references(lesson, folder / name / REFERENCE)
    if problems:
        raise ValueError(str(problems[0]))
    solutions = {
        task: tuple(script_words(each.solution, ROBOTS[lesson.front.robot].parameters(), words))
        for task, each in references.items()
    }
    steps = [
        TaughtStep(i + 1, step, step_minutes(step), _asked(lesson, i, solutions, words))
        for i, step in enumerate(lesson.steps)
    ]
    return TaughtLesson(
        number=course.numbers()[name],
        lesson=lesson,
        minutes=required_minutes(lesson),
        optional=optional_minutes(lesson),
        steps=steps,
    )


def _asked(
    lesson: Lesson, index: int, solutions: dict[str, tuple[str, ...]], words: Words
) -> list[AskedBlock]:
    asked: list[AskedBlock] = []
    for block_index, block in enumerate(lesson.steps[index].blocks):
        key = f"{lesson.name}.{index}.{block_index}"
        if isinstance(block, Sketch):
            truth = computed_truth(lesson, index)
            asked.append(
                AskedBlock(
                    kind="sketch",
                    key=key,
                    step=index + 1,
                    block=block,
                    axes=_image(lesson, index, block, None, words),
                    figure=_image(lesson, index, block, truth, words),
                )
            )
        elif not isinstance(block, Text):
            solution = solutions[block.id] if isinstance(block, Task) else ()
            asked.append(
                AskedBlock(
                    kind=KINDS[type(block)],
                    key=key,
                    step=index + 1,
                    block=block,
                    solution=solution,
                )
            )
    return asked


def _image(lesson: Lesson, index: int, block: Sketch, truth: Truth | None, words: Words) -> str:
    names = robot_names(lesson.laws_shown(index), words)
    return draw_prediction(block, None, truth, words, names)
