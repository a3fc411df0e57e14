"""The concept test: questions that a class answers before and after the course.

It is written like a lesson, in the folder `inventory` of a course, with `quiz` steps only. A second
form, with other questions about the same beliefs, is in `inventory-b`. Half of the students answer
the first form before the course and the second one after it, the others the other way round
(`own_test`). Without a second form, everybody answers the same questions twice. Each form is read
as two lessons, `Course.tests`. The answers are shown when the second one has been handed in.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from hashlib import sha256
from itertools import zip_longest

from msgspec.structs import replace

from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Lesson, Quiz, Step, Text

FOLDERS = "inventory", "inventory-b"
"""The folders of the two forms in a course."""
BEFORE, AFTER = SITTINGS = "test-before", "test-after"
"""Names of the two tests in the first form; see `name_of`."""
FORMS = "AB"
"""Names of the forms."""
SUFFIXES = "", "-b"


def name_of(sitting: str, form: int) -> str:
    """The name of a test, before or after the course, in a form given by its index."""
    return sitting + SUFFIXES[form]


def sitting_of(name: str) -> str:
    """Which of `SITTINGS` a test belongs to; the name of a lesson is itself."""
    found = name.removesuffix(SUFFIXES[1])
    return found if found in SITTINGS else name


def form_of(name: str) -> int:
    """The index of a test's form."""
    return int(name != sitting_of(name))


def taken(progress: Progress, sitting: str) -> str:
    """The name of the test that a student has opened before or after the course; empty if none."""
    names = (name_of(sitting, form) for form in range(len(FORMS)))
    return next((name for name in names if name in progress.notes), "")


def own_test(name: str, tests: Collection[str], progress: Progress, first: int) -> str:
    """The test in the form that a student gets; the name of a lesson is itself.

    It is the one that has been opened, or else not that of the other sitting.

    Args:
        name: of either form.
        tests: names of the course's tests.
        first: index of the form that is dealt to the student before the course.
    """
    sitting = sitting_of(name)
    if sitting not in SITTINGS or name_of(sitting, 1) not in tests:
        return sitting
    if opened := taken(progress, sitting):
        return opened
    when = SITTINGS.index(sitting)
    if opened := taken(progress, SITTINGS[1 - when]):
        return name_of(sitting, 1 - form_of(opened))
    return name_of(sitting, first ^ when)


def dealt(who: str) -> int:
    """The form that somebody answers before the course: either one is as likely."""
    return sha256(f"form {who}".encode()).digest()[0] & 1


def dealt_in_class(code: str, number: int) -> int:
    """The form that a student of a class answers before the course.

    Of the first and second one to join, one gets each form, by chance, and so on: half of the
    class each way round.

    Args:
        code: of the class.
        number: serial number of the student, from 1.
    """
    pair, second = divmod(number - 1, 2)
    return dealt(f"{code} {pair}") ^ second


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


def both_sittings(forms: Mapping[int, Mapping[str, Lesson]]) -> dict[str, Mapping[str, Lesson]]:
    """Name of each test -> language -> lesson.

    Args:
        forms: index of each form -> language -> lesson.
    """
    return {
        name: {language: replace(lesson, name=name) for language, lesson in versions.items()}
        for form, versions in forms.items()
        for name in (name_of(sitting, form) for sitting in SITTINGS)
    }


def unlike_forms(first: Lesson, second: Lesson) -> Iterator[tuple[int, str]]:
    """Line and text of each question of the second form that is not about what that of the first
    form is about."""
    for one, other in zip_longest(first.steps, second.steps):
        if one is None or other is None:
            yield 1, f"{len(second.steps)} questions, and {len(first.steps)} in the first form"
            return
        ours, theirs = (
            next(b for b in step.blocks if isinstance(b, Quiz)) for step in (one, other)
        )
        if ours.misconception != theirs.misconception:
            text = f"step {other.title!r}: not the misconception of {one.title!r} in the first form"
            yield other.line, text


def questions(test: Lesson) -> dict[str, Quiz]:
    """The questions of a test by the keys of `Notes.quiz`, in order."""
    return {
        f"{index}.{number}": block
        for index, step in enumerate(test.steps)
        for number, block in enumerate(step.blocks)
        if isinstance(block, Quiz)
    }


def handed_in(progress: Progress, sitting: str) -> tuple[int, Notes] | None:
    """The form that a student has handed in before or after the course, and the notes on it.

    None if nothing has been handed in, or if the questions have changed since.
    """
    name = taken(progress, sitting)
    notes = progress.notes.get(name)
    known = notes is not None and notes.handed_in and not notes.unknown
    return (form_of(name), notes) if notes is not None and known else None


def chosen_in(test: Lesson, notes: Notes) -> list[int | None]:
    """Index of the option chosen in each question; None where none has been."""
    given = [(block, notes.quiz.get(key)) for key, block in questions(test).items()]
    return [at if at is not None and at < len(block.options) else None for block, at in given]


def right_in(test: Lesson, notes: Notes) -> list[bool]:
    """Whether each question has been answered correctly."""
    asked = zip(questions(test).values(), chosen_in(test, notes), strict=True)
    return [at is not None and block.options[at].right for block, at in asked]
