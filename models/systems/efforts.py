"""The largest torques that a robot's file states for its motors, and runs that ask for more."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.robot_files.chain import Chain, Joint
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.robots import Robot


def stated(chain: Chain) -> Message | None:
    """The limits in the order of the joints; None if the file states none."""
    if all(math.isinf(joint.effort) for joint in chain.joints):
        return None
    limits = ", ".join(_limit(joint) for joint in chain.joints)
    return Message("efforts.stated", {"limits": limits})


@lru_cache(maxsize=64)
def efforts(robot: Robot) -> Array | None:
    """The largest torque or force of each motor, infinite where the file states none, (m,).

    None if the robot is not from a file, or its file states no limit.
    """
    if robot.chain is None or stated(robot.chain) is None:
        return None
    return np.array([joint.effort for joint in robot.chain.joints])


def exceeded(robot: Robot, largest: Array) -> Message | None:
    """Which motor exceeds its limit most; None if none does.

    Args:
        largest: size of the torque or force of each motor in a run, shape (m,), [N m] or [N].
    """
    limits = efforts(robot)
    if limits is None or robot.chain is None or not (largest > limits).any():
        return None
    worst = int((largest / limits).argmax())
    joint, most = robot.chain.joints[worst], float(largest[worst])
    gave = f"{most:.0f}" if most >= 100 else f"{most:.3g}"
    return Message(
        "efforts.exceeded",
        {"joint": shown(joint.name), "gave": f"{gave} {joint.unit}", "limit": _limit(joint)},
    )


def _limit(joint: Joint) -> str:
    return "—" if math.isinf(joint.effort) else f"{joint.effort:g} {joint.unit}"
