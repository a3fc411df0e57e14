"""How a user wants a robot's file to be read, what is read, and how links become bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.systems.rigid_chain import Body, Chain, Joint, Shape

MOST_JOINTS = 8  # that move on the way to the tip
EXACT = 1e-10  # entries of rotations this near to 0 and ±1 are set to them: files round angles


@dataclass(frozen=True, slots=True, eq=False)
class Options:
    """How to read a robot's file.

    Attributes:
        tip: link whose origin is the end-point; empty: the only link without a further one.
        lock: joints on the way to the tip that do not move, and where they stand, [rad] or [m].
        pose: where joints stand at home; those not on the way to the tip stay there, [rad] or [m].
        armature: inertia of the motors' rotors, which a file may leave out, as seen at the joints,
            [kg m²].
        packages: folders of packages, for the addresses of meshes.
    """

    tip: str = ""
    lock: Mapping[str, float] = field(default_factory=dict[str, float])
    pose: Mapping[str, float] = field(default_factory=dict[str, float])
    armature: float = 0.0
    packages: Mapping[str, Path] = field(default_factory=dict[str, Path])


@dataclass(frozen=True, slots=True, eq=False)
class FileChain:
    """What is read from a file.

    Attributes:
        chain: the moving bodies, from the base to the tip.
        home: where joints stand at home, if the file says so, [rad] or [m].
        remarks: what has been left out or is unusual.
    """

    chain: Chain
    home: Mapping[str, float]
    remarks: tuple[Message, ...]


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


def many_joints(names: Sequence[str]) -> Message:
    """The reason why a file is refused in which these joints move on the way to the tip."""
    return Message("robot_file.joints", {"most": MOST_JOINTS, "names": ", ".join(names)})


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
