"""A lab of which one robot is a plant elsewhere: what is known of it, and what may be set."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from onpath.models.control.settable import specs
from onpath.models.control.sides import RIGHT
from onpath.models.errors import Message

SIDE = RIGHT
"""The side in whose place the plant stands."""
Phase = Literal["off", "starting", "waiting", "running", "ended"]
GROUPS = ("gains", "task")
OTHER_CONTROLLER = ("across", "tracker_integral", "task", "speed_profile", "profile_period")
"""Settings of these groups that need another controller."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantState:
    """What a page shows of a plant elsewhere.

    Attributes:
        phase: "off" before the start; "starting" until its controller listens; "waiting" for the
            first measurement; "running"; "ended" until the next start.
        address: where the controller listens for it.
        laws: that can act on it.
        at_fault: its torque after the end.
        cause: why it has ended.
        sends: whether it still sends, after the end.
        late, latest: how late a torque was at most, in the last second and since the start, [s].
        answered: measurements that got a torque.
    """

    phase: Phase = "off"
    address: str
    laws: tuple[str, ...]
    at_fault: str
    cause: Message | None = None
    sends: bool = False
    late: float = 0.0
    latest: float = 0.0
    answered: int = 0

    @property
    def is_live(self) -> bool:
        """Whether a controller drives it, or is about to."""
        return self.phase in ("starting", "waiting", "running")

    @property
    def can_start(self) -> bool:
        """Whether it can be started."""
        return not self.is_live and not self.sends


def settable(name: str, parameters: Any) -> bool:
    """Whether a setting can be changed while a robot is a plant elsewhere.

    Args:
        parameters: of the robot, or their class.
    """
    if name == "presenting":
        return True
    spec = specs(parameters).get(name)
    return spec is not None and spec.group in GROUPS and name not in OTHER_CONTROLLER
