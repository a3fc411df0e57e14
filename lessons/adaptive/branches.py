"""Steps and texts that are shown only after certain answers: `when = "wrong"`.

They follow the latest question above them that has a right answer: a prediction by choice, a quiz,
or a question whose answer is a number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import get_close_matches

from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.progress import Notes
from onpath.lessons.schema import Choice, NumberQuestion, Quiz, Step, Text

OUTCOMES = ("right", "wrong", "skipped")
Judged = Choice | Quiz | NumberQuestion


def question_before(steps: Sequence[Step], index: int, block: int = 0) -> tuple[str, Judged] | None:
    """The latest question above a block of a step, with its key in the notes; None without one."""
    for at in range(index, -1, -1):
        blocks = steps[at].blocks[:block] if at == index else steps[at].blocks
        for block_index in range(len(blocks) - 1, -1, -1):
            question = blocks[block_index]
            if isinstance(question, Choice):
                return str(at), question
            if isinstance(question, Quiz | NumberQuestion):
                return f"{at}.{block_index}", question
    return None


def is_shown(when: str, steps: Sequence[Step], notes: Notes, index: int, block: int = 0) -> bool:
    """Whether a step, or a text that is a block of it, is shown to a student.

    Args:
        when: see `Text.when`.
        notes: the student's answers in this lesson.
    """
    found = question_before(steps, index, block)
    return not when or (found is not None and when in _outcomes(*found, notes))


def answers_meant(
    when: str, steps: Sequence[Step], index: int, block: int
) -> tuple[str, list[int]] | None:
    """The question above a text and the answers for which the text is shown, for JavaScript.

    An answer is the number of an option, or -1 for a skipped prediction; of a question whose answer
    is a number, it is 1 if right, else 0. None: there is no such question.
    """
    found = question_before(steps, index, block)
    if found is None:
        return None
    key, question = found
    if isinstance(question, NumberQuestion):
        return key, [value for value, outcome in enumerate(("wrong", "right")) if when == outcome]
    if when == "skipped":
        return key, [-1]
    options = enumerate(question.options)
    return key, [i for i, o in options if when in ("right" if o.right else "wrong", o.key)]


def faults_of_when(steps: Sequence[Step]) -> Iterator[tuple[int, str, str]]:
    """For each faulty condition of a lesson: the line of its step, the condition and the fault."""
    for index, step in enumerate(steps):
        conditions = [(0, step.when)]
        conditions += [(i, b.when) for i, b in enumerate(step.blocks) if isinstance(b, Text)]
        for block, when in conditions:
            if when and (fault := _fault(when, question_before(steps, index, block))):
                yield step.line, when, f"when {when!r}: {fault}"


def _fault(when: str, found: tuple[str, Judged] | None) -> str:
    if found is None:
        return "no question with a right answer is above it"
    question = found[1]
    keys = (
        ()
        if isinstance(question, NumberQuestion)
        else tuple(o.key for o in question.options if o.key)
    )
    if when in (*OUTCOMES, *keys):
        return ""
    near = get_close_matches(when, (*OUTCOMES, *keys), 1)
    hint = f"did you mean {near[0]}? " if near else ""
    return (
        f"{hint}It is one of {', '.join(OUTCOMES)}, or the key of an option of the question above"
    )


def _outcomes(key: str, question: Judged, notes: Notes) -> tuple[str, ...]:
    """The conditions that the answer to a question meets; none before it is answered."""
    answer_key = second_key(key) if key in notes.asked_again else key
    if answer_key in notes.unknown:
        return ()
    if isinstance(question, NumberQuestion):
        given = notes.numbers.get(key)
        return () if given is None else ("right" if question.accepts(given) else "wrong",)
    chosen = notes.quiz.get(key)
    if isinstance(question, Choice):
        answer = (notes.second if key in notes.asked_again else notes.answers).get(key)
        chosen = None if answer is None else answer.option
        if answer is not None and chosen is None:
            return ("skipped",)
    if chosen is None or chosen not in range(len(question.options)):
        return ()
    option = question.options[chosen]
    return "right" if option.right else "wrong", option.key
