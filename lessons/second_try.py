"""The second try at a choice: an answer with an item of its own, which is the second attempt."""

from __future__ import annotations

from collections.abc import Sequence

from onpath.lessons.given import Given
from onpath.lessons.right import is_right
from onpath.lessons.schema import Choice, NumberQuestion, Quiz, Step

SECOND_TRY = ".second"
"""The end of its item, after the step and the block of the question."""


def second_item(index: int, block_index: int) -> str:
    """The item of the second try at the question in a block of a step."""
    return f"{index}.{block_index}{SECOND_TRY}"


def second_at(steps: Sequence[Step], item: str) -> Quiz | NumberQuestion | None:
    """What an item asks, if it is that of a second try; None if it is not, or there is none."""
    index, _, block = item.removesuffix(SECOND_TRY).partition(".")
    if not (item.endswith(SECOND_TRY) and index.isdecimal() and block.isdecimal()):
        return None
    blocks = steps[int(index)].blocks if int(index) < len(steps) else ()
    asked = blocks[int(block)] if int(block) < len(blocks) else None
    second = asked.second if isinstance(asked, Choice | Quiz) else None
    return None if second is None else second.asked


def is_missed(block: Choice | Quiz, given: Sequence[Given]) -> bool:
    """Whether a question was answered, and never rightly."""
    judged = [is_right(block, each) for each in given if not each.is_skipped]
    return bool(judged) and True not in judged
