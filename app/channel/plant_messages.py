"""What a page is told of a plant in the place of a robot, and what it sends if it drives."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct


class PlantMessage(Struct, frozen=True, kw_only=True):
    """What is known of the plant.

    Attributes:
        phase: "off" before the start; "starting" until its controller listens; "waiting" for its
            first measurement; "running"; "ended".
        text: the same in a sentence, and why it has ended.
        late: how late its torques were; empty before there are any.
        live: whether it can be stopped.
        ready: whether it can be started.
        at_fault: its torque after the end, "zero", "hold" or "damp".
    """

    phase: Literal["off", "starting", "waiting", "running", "ended"]
    text: str
    late: str
    live: bool
    ready: bool
    at_fault: str


class DrivePlant(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="drive"):
    """From the page that drives a plant: start it, stop it, or only a sign of life.

    Attributes:
        at_fault: the torque after the end, of a start.
    """

    what: Literal["start", "stop", "beat"]
    at_fault: Literal["zero", "hold", "damp"] = "zero"
