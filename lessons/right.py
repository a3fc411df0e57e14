"""Whether an answer is right."""

from __future__ import annotations

from onpath.lessons.derivation.judged import judged
from onpath.lessons.given import Given
from onpath.lessons.schema import Block, Choice, Derivation, NumberQuestion, Quiz


def is_right(block: Block, given: Given) -> bool | None:
    """Whether an answer to a prediction or a question is right; None where that is not judged: a
    drawn curve, an answer in own words, and one that was skipped.
    """
    if isinstance(block, NumberQuestion):
        return given.number is not None and block.accepts(given.number)
    if isinstance(block, Derivation):
        return all(state.good for state in judged(block, given.text))
    option = None if given.answer is None else given.answer.option
    if not isinstance(block, Choice | Quiz) or option is None:
        return None
    return block.options[option].right if option < len(block.options) else None
