"""Steps and texts that are shown for some answers only: `when = "wrong"`.

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
        for place in range(len(blocks) - 1, -1, -1):
            asked = blocks[place]
            if isinstance(asked, Choice):
                return str(at), asked
            if isinstance(asked, Quiz | NumberQuestion):
                return f"{at}.{place}", asked
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
    """The question above a text and the answers for which the text is shown, for a page's script.

    An answer is the number of an option, or -1 for a skipped prediction; of a question whose answer
    is a number, it is 1 if right, else 0. None: there is no such question.
    """
    found = question_before(steps, index, block)
    if found is None:
        return None
    key, asked = found
    if isinstance(asked, NumberQuestion):
        return key, [value for value, said in enumerate(("wrong", "right")) if when == said]
    if when == "skipped":
        return key, [-1]
    options = enumerate(asked.options)
    return key, [i for i, o in options if when in ("right" if o.right else "wrong", o.key)]


def faults_of_when(steps: Sequence[Step]) -> Iterator[tuple[int, str, str]]:
    """Line of the step, condition and fault of each condition of a lesson that has one."""
    for index, step in enumerate(steps):
        conditions = [(0, step.when)]
        conditions += [(i, b.when) for i, b in enumerate(step.blocks) if isinstance(b, Text)]
        for block, when in conditions:
            if when and (fault := _fault(when, question_before(steps, index, block))):
                yield step.line, when, f"when {when!r}: {fault}"


def _fault(when: str, found: tuple[str, Judged] | None) -> str:
    if found is None:
        return "no question with a right answer is above it"
    asked = found[1]
    keys = () if isinstance(asked, NumberQuestion) else tuple(o.key for o in asked.options if o.key)
    if when in (*OUTCOMES, *keys):
        return ""
    near = get_close_matches(when, (*OUTCOMES, *keys), 1)
    hint = f"did you mean {near[0]}? " if near else ""
    return (
        f"{hint}It is one of {', '.join(OUTCOMES)}, or the key of an option of the question above"
    )


def _outcomes(key: str, asked: Judged, notes: Notes) -> tuple[str, ...]:
    """What can be said of the answer to a question; nothing before there is one."""
    own = second_key(key) if key in notes.asked_again else key
    if own in notes.unknown:
        return ()
    if isinstance(asked, NumberQuestion):
        given = notes.numbers.get(key)
        return () if given is None else ("right" if asked.accepts(given) else "wrong",)
    chosen = notes.quiz.get(key)
    if isinstance(asked, Choice):
        answer = (notes.second if key in notes.asked_again else notes.answers).get(key)
        chosen = None if answer is None else answer.option
        if answer is not None and chosen is None:
            return ("skipped",)
    if chosen is None or chosen not in range(len(asked.options)):
        return ()
    option = asked.options[chosen]
    return "right" if option.right else "wrong", option.key
