"""The concept test: questions that a class answers before and after the course.

It is written like a lesson, in the folder `inventory` of a course, with `quiz` steps only, and is
read as two lessons with the same questions, `Course.tests`. The answers are shown when the second
one has been handed in.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from msgspec.structs import replace

from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Lesson, Quiz, Step, Text

FOLDER = "inventory"
"""The folder of the test in a course."""
BEFORE, AFTER = TESTS = "test-before", "test-after"
"""Names of the two tests."""


def lacks_of_test(steps: Sequence[Step]) -> Iterator[str]:
    """Problems of the test as a whole: every step asks one question, and does nothing else."""
    if not steps:
        yield "the test has no step `# quiz: …`"
    for step in steps:
        where = f"step {step.title!r} at line {step.line}"
        asked = [block for block in step.blocks if not isinstance(block, Text)]
        if step.kind != "quiz" or len(asked) != 1 or not isinstance(asked[0], Quiz):
            yield f"{where}: in a test it is a `quiz` with one question"
        elif step.optional or step.script is not None:
            yield f"{where}: a test has no optional steps and no scripts"


def both_tests(versions: Mapping[str, Lesson]) -> dict[str, Mapping[str, Lesson]]:
    """Name of each test -> language -> lesson.

    Args:
        versions: language -> the test; empty if there is none.
    """
    if not versions:
        return {}
    return {
        name: {language: replace(lesson, name=name) for language, lesson in versions.items()}
        for name in TESTS
    }


def questions(test: Lesson) -> dict[str, Quiz]:
    """The questions of a test by the keys of `Notes.quiz`, in order."""
    return {
        f"{index}.{number}": block
        for index, step in enumerate(test.steps)
        for number, block in enumerate(step.blocks)
        if isinstance(block, Quiz)
    }


def notes_of(progress: Progress, name: str) -> Notes | None:
    """A student's notes on a test that has been handed in.

    None if it has not been handed in, or if the questions have changed since.
    """
    notes = progress.notes.get(name)
    return notes if notes is not None and notes.handed_in and not notes.unknown else None


def chosen_in(test: Lesson, notes: Notes) -> list[int | None]:
    """Index of the option chosen in each question; None where none has been."""
    given = [(block, notes.quiz.get(key)) for key, block in questions(test).items()]
    return [at if at is not None and at < len(block.options) else None for block, at in given]


def right_in(test: Lesson, notes: Notes) -> list[bool]:
    """Whether each question has been answered correctly."""
    asked = zip(questions(test).values(), chosen_in(test, notes), strict=True)
    return [at is not None and block.options[at].right for block, at in asked]
