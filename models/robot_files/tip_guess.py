"""Which link of a robot is its tip, by the names of links and joints and the shape of the tree.

Fingers are not tips, nor are cameras, heads and wheels if there is an arm. A link that is called
like a tool is preferred, then the end of the longest chain, an arm to a leg, the right one to the
left one, and the larger one. `_TipTree.rank` is this order.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from onpath.models.errors import CodedError

MOST_TIPS = 5  # that are suggested
LEAST_JOINTS = 3  # on the way to an arm's tip
PALM_JOINTS = 3  # least number before a link from which fingers branch off
FINGER_JOINTS = 4  # most of a finger
DRIVEN_JOINTS = 8  # most of a finger with those that follow others
HAND_FINGERS = 3  # least number on a hand
ARM, OTHER, LEG, HEAD = range(4)  # limbs, the likeliest to have the tip first
NAMED = 2  # joints that a name of a tool counts for
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")
_JOINED = {
    "tool_center_point": "tcp",
    "toolcenterpoint": "tcp",
    "tool_centre_point": "tcp",
    "end_effector": "effector",
    "endeffector": "effector",
}
TOOLS = (
    *("tool0", "tcp", "ee", "eef", "effector", "flange", "tool", "grasp", "grasping", "pinch"),
    *("attachment", "palm", "hand", "gripper", "tip"),
)
"""Last words of names of tips, best first."""
_GENERAL = {"link", "frame", "body", "site", "base", "right", "left", "r", "l", "center", "point"}
"""Words that say nothing at the end of a name."""
_FINGER_PARTS = ("finger", "thumb", "knuckle", "jaw", "claw", "pinky", "phalan")
_FINGER_WORDS = {"index", "middle", "ring", "little", "pad", "proximal", "distal", "digit"}
_GRIPPERS = {"gripper", "grip"}
_PALMS = {"palm", "hand"}
_TURNS = {"yaw", "pitch", "roll", "rotate", "rotation", "revolute", "wrist"}
_GADGETS = {
    *("camera", "cam", "optical", "imu", "laser", "lidar", "sensor", "led", "accelerometer"),
    *("head", "neck", "eye", "gaze", "display", "screen", "antenna", "wheel", "caster", "rotor"),
    *("propeller", "visual", "collision", "inertia", "inertial", "com", "range", "mirror"),
}
_HEADS = {"head", "neck", "eye", "gaze", "camera", "pan", "tilt", "wheel", "caster", "rotor"}
_LEGS = {
    *("leg", "foot", "feet", "ankle", "knee", "hip", "thigh", "calf", "shin", "shank", "toe"),
    *("sole", "haa", "hfe", "kfe", "lleg", "rleg"),
}
_ARMS = {
    *("arm", "larm", "rarm", "forearm", "upperarm", "lowerarm", "shoulder", "elbow", "wrist"),
    *("hand", "palm", "gripper", "tool"),
}
_LEFT = {"left", "l", "lh", "lf", "fl", "rl", "hl", "bl", "larm", "lleg"}


@dataclass(frozen=True, slots=True)
class TipPlace:
    """A link, or what else can be a tip, in a tree that lists parents before children.

    Attributes:
        name: as in the file.
        parent: number of the place before it; -1 for the root.
        joints: names of the joints between them that can move.
        follows: whether such a joint is moved by another one.
        step: distance between their origins, [m].
    """

    name: str
    parent: int
    joints: tuple[str, ...] = ()
    follows: bool = False
    step: float = 0.0


def suggested_tips(places: Sequence[TipPlace], tip: str) -> tuple[str, ...]:
    """The names that the tip may have, best first, at most `MOST_TIPS`.

    Args:
        tip: the name that was asked for, which is the first one; empty: none was.

    Raises:
        CodedError: no tip was asked for, and nothing moves, or all that moves are fingers.
    """
    tree = _TipTree(places)
    if not tip:
        _check_limbs(tree)
    names = [places[i].name for i in _ranked(tree) if places[i].name]
    found = [tip, *(name for name in names if name != tip)] if tip else names
    return tuple(found[:MOST_TIPS])


def _ranked(tree: _TipTree) -> list[int]:
    """Which places may be the tip, best first, at most `MOST_TIPS`; none if nothing moves.

    If there is only one end, which is no finger, it is the first.
    """
    order = sorted((i for i, k in enumerate(tree.joints) if k), key=tree.rank)
    if len(tree.ends) == 1 and tree.joints[tree.ends[0]] and not tree.fingers[tree.ends[0]]:
        order = [tree.ends[0], *(i for i in order if i != tree.ends[0])]
    limbs, seen = list[int](), set[int]()
    for i in order:
        group = tree.group[i]
        if group not in seen and group not in tree.passed and tree.is_limb(i):
            limbs.append(i)
        seen.add(group)
    found = order[:1] + [i for i in limbs if i not in order[:1]]
    found += [i for i in order if tree.group[i] == tree.group[order[0]] and i not in found]
    return found[:MOST_TIPS]


def _check_limbs(tree: _TipTree) -> None:
    """Check that there may be an arm or a leg."""
    moving = [i for i, count in enumerate(tree.joints) if count]
    if not moving:
        raise CodedError("robot_file.no_joints")
    ends = [i for i in tree.ends if tree.joints[i]]
    root = {word for i, count in enumerate(tree.joints) if not count for word in tree.words[i]}
    on_palm = len(tree.leaving.get(0, [])) >= HAND_FINGERS and bool(root & _PALMS)
    if on_palm or (len(ends) > 1 and all(tree.fingers[i] for i in moving)):
        raise CodedError("robot_file.hand")


def surplus_joints(
    places: Sequence[TipPlace], tip: str, moving: Sequence[str], most: int
) -> list[str]:
    """The joints on the way to a tip that must stay, because no more than `most` can move.

    Those move that are behind the place from which another limb branches off, if there is one and
    these are not too many; else the last ones.

    Args:
        moving: joints on the way.
    """
    if len(moving) <= most:
        return []
    tree, joints = _TipTree(places), list[str]()
    i = next(i for i, place in enumerate(places) if i and place.name == tip)
    while (before := places[i].parent) >= 0:
        joints = [*places[i].joints, *joints]
        if places[i].joints and len(joints) >= LEAST_JOINTS and tree.branches(before):
            break
        i = before
    return [name for name in moving if name not in joints[-most:]]


class _TipTree:
    """What decides on tips, for each place.

    Attributes:
        joints: number of joints from the root.
        group: the first place of those that do not move against it.
        fingers: whether it belongs to a finger.
        passed: groups behind which others move that are not fingers.
        ends: places behind which there is none.
        words: the words of its name.
        leaving: places behind a joint, by the group before it.
    """

    def __init__(self, places: Sequence[TipPlace]) -> None:
        self._places = places
        self.words = [_words(place.name) for place in places]
        self.joints, self.group, self._length = list[int](), list[int](), list[float]()
        self._last = list[tuple[str, ...]]()
        for i, place in enumerate(places):
            j = place.parent
            moved = len(place.joints)
            self.joints.append(moved + (self.joints[j] if j >= 0 else 0))
            self._length.append(place.step + (self._length[j] if j >= 0 else 0.0))
            self.group.append(self.group[j] if j >= 0 and not moved else i)
            before = self._last[j] if j >= 0 else ()
            self._last.append((*before, *place.joints, place.name)[-6:] if moved else before)
        self._height = [0] * len(places)  # joints behind a group, by its first place
        self.leaving = dict[int, list[int]]()
        self.fingers = self._found_fingers()
        self.passed = {
            self.group[place.parent]
            for i, place in enumerate(places)
            if place.joints and place.parent >= 0 and not self.fingers[i]
        }
        self.ends = sorted({*range(len(places))} - {place.parent for place in places})

    def _found_fingers(self) -> list[bool]:
        for i in reversed(range(len(self._places))):
            place = self._places[i]
            if place.joints and place.parent >= 0:
                before = self.group[place.parent]
                self._height[before] = max(self._height[before], self._behind(i))
                self.leaving.setdefault(before, []).append(i)
        fingers = [False] * len(self._places)
        for before, others in self.leaving.items():
            most, depth = max(map(self._behind, others)), self.joints[before]
            if len(others) > 1 and depth >= PALM_JOINTS and most <= min(FINGER_JOINTS, depth - 1):
                for i in others:
                    fingers[i] = True
        for i, place in enumerate(self._places):
            behind = place.parent >= 0 and fingers[place.parent]
            fingers[i] = fingers[i] or behind or self._is_finger(i)
        return fingers

    def _is_finger(self, i: int) -> bool:
        place = self._places[i]
        if place.follows:
            return True
        if self._behind(i) > DRIVEN_JOINTS:  # such as an abdomen in the middle
            return False
        if _like_finger(place.name):
            return True
        words = {word for name in (place.name, *place.joints) for word in _words(name)}
        opens = bool(words & _GRIPPERS) and not words & _TURNS
        return bool(place.joints) and (opens or any(map(_like_finger, place.joints)))

    def is_limb(self, i: int) -> bool:
        """Whether it is at an arm or leg."""
        fingers, gadget, short, limb, *_ = self.rank(i)
        return not fingers and not gadget and limb < HEAD and (not short or self.joints[i] > 1)

    def branches(self, i: int) -> bool:
        """Whether limbs of two joints or more leave the group of a place, at least two of them."""
        leaving = self.leaving.get(self.group[i], [])
        limbs = [k for k in leaving if not self.fingers[k] and self._behind(k) > 1]
        return len(limbs) > 1

    def _behind(self, i: int) -> int:
        """Most joints from the group before a place to an end behind it."""
        return self._height[self.group[i]] + len(self._places[i].joints)

    def rank(self, i: int) -> tuple[float, ...]:
        """What makes a place a bad tip, the most important first: the least one is the best."""
        words, joints = self.words[i], self.joints[i]
        near = {word for name in self._last[i] for word in _words(name)} | {*words}
        kinds = ((HEAD, _HEADS), (LEG, _LEGS), (ARM, _ARMS))
        limb = next((kind for kind, named in kinds if near & named), OTHER)
        tool = _tool(words)
        return (
            self.fingers[i],
            bool({*words} & _GADGETS),
            joints < LEAST_JOINTS,
            limb,
            -joints - (NAMED if tool < len(TOOLS) else 0),
            -joints,
            tool,
            bool(near & _LEFT),
            -round(self._length[i], 6),
            i,
        )


def _words(name: str) -> list[str]:
    """The words of a name in lower case; "tool0" is one."""
    name = name[:128]
    for long, short in _JOINED.items():
        if long in name.lower():
            at = name.lower().index(long)
            name = f"{name[:at]}_{short}_{name[at + len(long) :]}"
    found = [word.lower() for word in _WORD.findall(name)]
    for k in reversed(range(len(found) - 1)):
        if found[k : k + 2] == ["tool", "0"]:
            found[k : k + 2] = ["tool0"]
    return found


def _tool(words: Sequence[str]) -> int:
    """The place in `TOOLS` of the last word that says something; the length if it is not there."""
    said = [word for word in words if not word.isdigit() and word not in _GENERAL]
    return TOOLS.index(said[-1]) if said and said[-1] in TOOLS else len(TOOLS)


def _like_finger(name: str) -> bool:
    """Whether a name is that of a part of a finger."""
    return any(part in name[:128].lower() for part in _FINGER_PARTS) or bool(
        {*_words(name)} & _FINGER_WORDS
    )
