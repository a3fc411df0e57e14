"""Keys of options, by which a kept choice is identified when the lesson has changed.

The key of an option is given by the author, or else made from its text in the lesson's first
language (English if there is one). Options can thus be reordered, and translations reworded.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from onpath.lessons.schema import Choice, Quiz, Sketch, Step
from onpath.lessons.second_try import second_at, second_item

Keys = dict[str, tuple[str, ...]]
"""Key of the notes -> keys of the options there, in the author's order."""


def keys_of(steps: Sequence[Step]) -> Keys:
    """Keys of the options of predictions and quizzes, of reasons, and of the axes of sketches."""
    keys = Keys()
    for index, step in enumerate(steps):
        for prediction in step.predictions()[:1]:
            keys[str(index)] = _asked(prediction)
            keys[why_key(str(index))] = tuple(map(fingerprint, prediction.reasons))
        for number, block in enumerate(step.blocks):
            if isinstance(block, Quiz):
                keys[f"{index}.{number}"] = tuple(option.key for option in block.options)
            second = second_at(steps, second_item(index, number))
            if isinstance(second, Quiz):
                keys[second_item(index, number)] = tuple(option.key for option in second.options)
    return keys


def fingerprint(text: str) -> str:
    """A short name of a text, the same in every process."""
    return hashlib.sha256(" ".join(text.split()).encode()).hexdigest()[:12]


def why_key(key: str) -> str:
    """The key under which the reason for an answer is marked."""
    return f"{key} why"


def second_key(key: str) -> str:
    """The key under which the answer after a discussion is marked."""
    return f"{key} second"


def _asked(prediction: Choice | Sketch) -> tuple[str, ...]:
    if isinstance(prediction, Choice):
        return tuple(option.key for option in prediction.options)
    axes = prediction.quantity, prediction.robot, f"{prediction.seconds:g}"
    return (fingerprint(" ".join(axes)),)
