"""The robots there are: names, parameters, and which instance serves which parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.parameters import FiveBarParameters, Parameters
from onpath.models.systems.robots import Robot, rigid_five_bar


@dataclass(frozen=True, slots=True)
class RobotEntry:
    """One robot to choose.

    Attributes:
        name: as on the command line and in files.
        label: as shown.
        text: a sentence about it.
        picture: name of an asset.
        parameters: the type of its parameters, with the defaults of the experiments.
        lab: what the lab starts with.
        make: the instance for some parameters; structural ones select it, others do not matter.
    """

    name: str
    label: str
    text: str
    picture: str
    parameters: type[Parameters]
    lab: Parameters
    make: Callable[[Parameters], Robot]


FIVE_BAR = RobotEntry(
    name="five_bar",
    label="Five-bar linkage",
    text="Two motors, rigid links, a pen in a vertical plane.",
    picture="five_bar.png",
    parameters=FiveBarParameters,
    lab=FiveBarParameters(),
    make=lambda _: rigid_five_bar(),
)

FLEXIBLE = RobotEntry(
    name="flexible",
    label="Five-bar with a flexible link",
    text="Three motors, a last link that bends: the tip is not where the motors put it.",
    picture="flexible_five_bar.png",
    parameters=FlexibleParameters,
    lab=FlexibleParameters(law="composite"),  # the only one that survives every pull at the tip
    make=robot_for,
)

ROBOTS: dict[str, RobotEntry] = {entry.name: entry for entry in (FIVE_BAR, FLEXIBLE)}
