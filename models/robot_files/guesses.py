"""What is guessed about a robot where its file says nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from onpath.models.errors import Message

GuessKind = Literal["tip", "pose", "mass", "inertia", "effort", "lock", "package"]


@dataclass(frozen=True, slots=True)
class Guess:
    """Something that a robot's file does not say, or says wrongly.

    Attributes:
        kind: what is guessed. Masses and inertias decide on weights, torques and couplings, efforts
            on limits, the tip on all that is said of the end-point, the pose on where runs start.
        message: what was guessed, in a sentence.
        line: what to type to settle it, such as "--tip tool0"; empty where nothing helps.
    """

    kind: GuessKind
    message: Message
    line: str = ""
