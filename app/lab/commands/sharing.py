"""Commands that make and use share codes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import msgspec
from typing_extensions import override

from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.share_code import LONGEST_TEXT, decode, encode


@dataclass(frozen=True, slots=True)
class Share(Command):
    """Make a share code of the lab's current set-up."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.shared = encode(capture(lab.simulation))


@dataclass(frozen=True, slots=True)
class UseShared(Command):
    """Set the lab up from a share code."""

    text: Annotated[str, msgspec.Meta(max_length=LONGEST_TEXT)]

    @override
    def apply(self, lab: Lab) -> None:
        lab.set_up(decode(self.text))
        lab.remark(lab.words("say.set_up"))
