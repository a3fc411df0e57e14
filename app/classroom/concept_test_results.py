"""The class's answers to the concept test without names, for the teacher and the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from types import MappingProxyType

from onpath.app.classroom.class_record import Row, Sheet
from onpath.app.classroom.results import Distribution
from onpath.app.common.templates import render
from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    FORMS,
    SITTINGS,
    chosen_in,
    handed_in,
    name_of,
    questions,
    right_in,
    taken,
)
from onpath.lessons.concept_test.estimates import FEWEST, Estimated
from onpath.lessons.concept_test.gain import ClassGain, Forms, class_gain, people
from onpath.lessons.concept_test.items import Item, items
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Lesson, Quiz
from onpath.lessons.words import Words

Students = Sequence[tuple[str, Progress]]
"""Who each student is, by lab code or by what links the labs of a student, and the progress."""


def item_distribution(
    forms: Forms, form: int, index: int, sitting: str, students: Students
) -> Distribution:
    """The class's answers to a question before or after the course; only tests handed in count.

    Args:
        form: of the question, by its index; those who have opened the other one do not count.
        index: of the question.
        sitting: one of `SITTINGS`.
    """
    block, here, handed = question_at(forms[form], index), 0, list[Notes]()
    for _, progress in students:
        here += len(forms) == 1 or taken(progress, sitting) == name_of(sitting, form)
        found = handed_in(progress, sitting)
        handed += [found[1]] if found is not None and found[0] == form else []
    chosen = [chosen_in(forms[form], notes)[index] for notes in handed]
    counts = tuple(chosen.count(option) for option in range(len(block.options)))
    return Distribution(
        counts=counts,
        sketches=(),
        skipped=chosen.count(None),
        waiting=here - len(handed),
        here=here,
        answered=sum(counts),
    )


def gain_view(
    forms: Forms, students: Students, revealed: bool, words: Words, large: bool = False
) -> str:
    """What the class has gained and, if revealed, the share of right answers to each question, and
    how well it tells students apart."""
    known = people(forms, students)
    beliefs = [block.misconception for block in questions(forms[0]).values()]
    found = class_gain(forms, known)
    return render(
        "class/test.html",
        handed=words(
            "test.waiting",
            part=sum(each.before is not None for each in known),
            all=len(known),
            after=sum(each.after is not None for each in known),
        ),
        fewest=FEWEST,
        found=found,
        rows=list(zip(beliefs, found.questions, strict=True)) if revealed else [],
        forms=list(zip(FORMS, items(forms, known), strict=False)) if revealed else [],
        words=words,
        large=large,
    )


def sheets_without_names(
    forms: Forms,
    students: Students,
    code: str,
    linked: Mapping[str, str] = MappingProxyType({}),
) -> list[Sheet]:
    """Sheets of the record: every student who has handed in, without names, the class, and the
    questions; numbers about the class only from `FEWEST` students on.

    A student has the same pseudonym in both tests. It does not reveal who the student is. `word` is
    the hash of a word that the student made up. It is the same in the records of other months, and
    of the student's other labs.

    Args:
        code: the class code.
        linked: hashes of words, by lab code.
    """
    hidden = [
        (sha256(f"{code} {lab}".encode()).hexdigest()[:8], linked.get(lab, ""), progress)
        for lab, progress in students
    ]
    known = people(forms, [(linked.get(lab) or lab, progress) for lab, progress in students])
    columns = "pseudonym", "word", "test", "form", "question", "item", "result", "chosen", "right"
    of_class = ("test", "of", "students", *_ESTIMATE)
    of_items = ("form", "question", "item", "other bodies", "of", "students", *_ESTIMATE)
    return [
        Sheet("Concept test", columns, _test_rows(forms, sorted(hidden, key=lambda each: each[0]))),
        Sheet("Concept test, class", of_class, _class_rows(class_gain(forms, known))),
        Sheet("Concept test, questions", of_items, _item_rows(forms, items(forms, known))),
    ]


_ESTIMATE = ("value", "low", "high")


def _test_rows(forms: Forms, students: Iterable[tuple[str, str, Progress]]) -> Iterator[Row]:
    for pseudonym, word, progress in students:
        for sitting in SITTINGS:
            found = handed_in(progress, sitting)
            if found is None or found[0] >= len(forms):
                continue
            form, notes = found
            test = forms[form]
            asked = zip(test.steps, chosen_in(test, notes), right_in(test, notes), strict=True)
            for number, (step, option, right) in enumerate(asked, 1):
                row = {"pseudonym": pseudonym, "word": word, "test": sitting, "form": FORMS[form]}
                row |= {"question": number, "item": step.title, "right": int(right)}
                if option is None:
                    yield {**row, "result": "open"}
                else:
                    yield {**row, "result": "answered", "chosen": LETTERS[option]}


def _class_rows(found: ClassGain) -> Iterator[Row]:
    values = {
        (BEFORE, "mean [%]"): found.before,
        (AFTER, "mean [%]"): found.after,
        ("", "normalised gain"): found.gain,
    }
    for (name, what), value in values.items():
        yield {"test": name, "of": what, "students": found.students, **_cells(value)}


def _item_rows(forms: Forms, found: Sequence[Sequence[Item]]) -> Iterator[Row]:
    for letter, test, form in zip(FORMS, forms, found, strict=False):
        asked = zip(test.steps, questions(test).values(), form, strict=True)
        for number, (step, block, item) in enumerate(asked, 1):
            row = {"form": letter, "question": number, "item": step.title}
            row |= {"other bodies": int(block.transfer), "students": item.count}
            yield {**row, "of": "right [%]", **_cells(item.difficulty)}
            yield {**row, "of": "discrimination", **_cells(item.discrimination)}


def _cells(estimate: Estimated | None) -> dict[str, float]:
    return {} if estimate is None else {name: getattr(estimate, name) for name in _ESTIMATE}


def question_at(test: Lesson, index: int) -> Quiz:
    """The question of a step of a test."""
    return list(questions(test).values())[index]
