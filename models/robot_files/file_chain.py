"""How a user wants a robot's file to be read, what is read, and how links become bodies."""

from __future__ import annotations

import math
import shlex
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Argument, CodedError, Message
from onpath.models.robot_files.chain import Body, Chain, Joint, Shape
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.xml_elements import shown

MOST_JOINTS = 8  # that move on the way to the tip
MOST_NAMES = 8  # of links or joints in a message
DIGITS = 6  # of guessed numbers, so that they are the same with other versions of libraries
EXACT = 1e-10  # entries of rotations this near to 0 and ±1 are set to them: files round angles


@dataclass(frozen=True, slots=True, eq=False)
class Options:
    """How to read a robot's file.

    Attributes:
        tip: link whose origin is the end-point; empty: it is guessed if there are several.
        lock: joints on the way to the tip that do not move, and where they stand, [rad] or [m].
        pose: where joints stand at home; those not on the way to the tip stay there, [rad] or [m].
        armature: inertia of the motors' rotors, which a file may leave out, as seen at the joints,
            [kg m²].
        packages: folders of packages, for the addresses of meshes.
        density: of the shapes whose mass is guessed, [kg/m³]; None: `file_masses.DENSITY`.
        mass: of all that moves, to which guessed masses are scaled, [kg]; None: not known.
    """

    tip: str = ""
    lock: Mapping[str, float] = field(default_factory=dict[str, float])
    pose: Mapping[str, float] = field(default_factory=dict[str, float])
    armature: float = 0.0
    packages: Mapping[str, Path] = field(default_factory=dict[str, Path])
    density: float | None = None
    mass: float | None = None


@dataclass(frozen=True, slots=True)
class TipAt:
    """Where a link or site is that may be the tip.

    Attributes:
        body: of the chain that it moves with, counted from 1; 0: the base.
        place: in the frame of that body, [m].
    """

    body: int
    place: tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class FileChain:
    """What is read from a file.

    Attributes:
        chain: the moving bodies, from the base to the tip.
        home: where joints stand at home, if the file says so, [rad] or [m].
        remarks: what has been left out or is unusual.
        guesses: what the file does not say.
        tips: links that may be the tip, best first, at most five; the chosen one is the first.
        places: where their origins are.
        rests: what the motion depends on besides the file and the options, as text.
    """

    chain: Chain
    home: Mapping[str, float]
    remarks: tuple[Message, ...]
    guesses: tuple[Guess, ...]
    tips: tuple[str, ...]
    places: Mapping[str, TipAt]
    rests: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class RigidTransform:
    """A frame in another one: x' = R x + p.

    Attributes:
        rotation: R, shape (3, 3).
        translation: p, shape (3,), [m].
    """

    rotation: Array = field(default_factory=lambda: np.eye(3))
    translation: Array = field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, other: RigidTransform) -> RigidTransform:
        turned = self.rotation @ other.translation
        return RigidTransform(exact(self.rotation @ other.rotation), self.translation + turned)


@dataclass(slots=True, eq=False)
class Group:
    """Links that do not move against each other: sums of mass about their common frame."""

    name: str
    joint: Joint | None = None
    place: RigidTransform = field(default_factory=RigidTransform)
    mass: float = 0.0
    moment: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    shapes: list[Shape] = field(default_factory=list[Shape])

    def add(self, mass: float, centre: Array, inertia: Array) -> None:
        """Add a body by its mass, its centre of mass, and the inertia about that."""
        cross = skew(centre)
        self.mass += mass
        self.moment = self.moment + mass * centre
        self.inertia = self.inertia + inertia - mass * cross @ cross

    def body(self) -> Body:
        """The body of a moving group."""
        assert self.joint is not None
        return Body(
            name=self.name,
            joint=self.joint,
            rotation=self.place.rotation,
            translation=self.place.translation,
            mass=self.mass,
            moment=self.moment,
            inertia=self.inertia,
            shapes=tuple(self.shapes),
        )


def check_joints(options: Options, joints: Collection[str]) -> None:
    """Check that options name joints of the file.

    Raises:
        CodedError: there is no such joint.
    """
    for name in (*options.lock, *options.pose):
        if name not in joints:
            raise CodedError("robot_file.no_joint", joint=shown(name), names=", ".join(joints))


def locked_guesses(
    held: Mapping[str, str], off: Iterable[str], options: Options
) -> Iterator[Guess]:
    """The guesses that joints stay where they are, one for each reason.

    Args:
        held: joints on the way to the tip -> code of the message that says why they stay.
        off: joints off the way to the tip.
    """
    for code in dict.fromkeys(held.values()):
        yield locked_guess(code, [name for name in held if held[name] == code], options.pose)
    unsaid = [name for name in off if name not in {*options.lock, *options.pose}]
    if unsaid:
        yield locked_guess("robot_file.guessed_off", unsaid, {})


def locked_guess(code: str, joints: Sequence[str], values: Mapping[str, float]) -> Guess:
    """The guess that joints stay where they are.

    Args:
        code: of its message, which names the joints.
        values: where they stay, [rad] or [m]; 0 if it is not said.
    """
    line = " ".join(
        f"--lock {shlex.quote(f'{name}={values.get(name, 0.0):.6g}')}" for name in joints
    )
    message = Message(code, some_names(joints))
    return Guess("lock", message, line if len(joints) <= MOST_NAMES else "")


def some_names(names: Sequence[str]) -> dict[str, Argument]:
    """The first names, and how many more there are, as the argument of a message."""
    first, more = ", ".join(map(shown, names[:MOST_NAMES])), len(names) - MOST_NAMES
    if more <= 0:
        return {"names": first}
    return {"names": Message("robot_file.and_more", {"names": first, "more": more})}


def guessed_tip(tip: str) -> Guess:
    """The guess that a link is the tip."""
    message = Message("robot_file.guessed_tip", {"tip": shown(tip)})
    return Guess("tip", message, f"--tip {shlex.quote(tip)}")


def turn(axis: Array, angle: float) -> Array:
    """The rotation about an axis by an angle: Rodrigues' formula, shape (3, 3)."""
    cross = skew(axis)
    return exact(np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)


def aligned(axis: Array) -> Array:
    """A rotation that turns z to an axis, shape (3, 3)."""
    z, k = np.array([0.0, 0.0, 1.0]), int(np.argmax(np.abs(axis)))
    if abs(axis[k]) > 1 - EXACT and k < 2:  # a permutation, which is exact
        other: Array = np.eye(3)[(k + 1) % 3]
        third: Array = np.cross(axis, other)
        return np.stack([other, third, axis], axis=1).round()
    across, along = np.cross(z, axis), float(axis[2])
    sine = float(np.linalg.norm(across))
    if sine < EXACT:
        return np.diag([1.0, 1.0, 1.0] if along > 0 else [1.0, -1.0, -1.0])
    return turn(across / sine, math.atan2(sine, along))


def skew(r: Array) -> Array:
    """[r] with [r] s = r x s, shape (3, 3)."""
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def exact(rotation: Array) -> Array:
    """A rotation whose entries near 0 and ±1 are exact."""
    rounded: Array = rotation.round()
    near = np.abs(rotation - rounded) < EXACT
    found: Array = np.where(near, rounded, rotation)
    return found


def rounded(values: Array | float) -> Array:
    """Numbers with `DIGITS` digits of the largest one."""
    largest = float(np.abs(values).max())
    if not largest > 0:
        return np.asarray(values, dtype=float)
    decimals = DIGITS - 1 - int(np.floor(np.log10(largest)))
    return np.round(values, decimals)


def tip_at(body: int, place: Array) -> TipAt:
    """`TipAt` of a place as an array."""
    x, y, z = (float(each) for each in place)
    return TipAt(body, (x, y, z))
