"""The equations of motion of a chain of rigid bodies (`robot_files/chain.py`), from base to tip.

Recursions over the bodies give M(q) and c(q, v):

- the Newton-Euler equations, from the base to the end for motions, and back for forces; weights are
  those of bodies that the base accelerates upward by g;
- composite bodies, from the end to the base: M_ij is the generalized force at joint j for a unit
  acceleration of joint i, which moves all bodies beyond it as one.

Source: Featherstone, Rigid Body Dynamics Algorithms, 5.3 and 6.2.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import msgspec
import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.path_design import USUAL_RADIUS
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.drawing import Point
from onpath.models.systems.rows import Rows
from onpath.models.systems.system import GRAVITY


@dataclass(frozen=True, slots=True, eq=False)
class ChainSource:
    """All that a robot is made from: plain data.

    Attributes:
        name, label, text: see `RobotEntry`.
        chain: its bodies.
        home: its configuration at home, n numbers, [rad] or [m].
        axes: directions of its outputs in the frame of the base, p of them.
        substeps: see `Robot.substeps`.
        guesses: what its file does not say.
        radius: see `Robot.radius`.
    """

    name: str
    label: str
    text: str
    chain: Chain
    home: tuple[float, ...]
    axes: tuple[Point, ...]
    substeps: int = 1
    guesses: tuple[Guess, ...] = ()
    radius: float = USUAL_RADIUS

    @property
    def redundant(self) -> bool:
        """Whether it has more joints than outputs."""
        return self.chain.n > len(self.axes)

    def data(self) -> dict[str, Any]:
        """The source as numbers, texts, lists and mappings by the names of its attributes."""
        return msgspec.to_builtins(self, enc_hook=_listed)

    def is_as(self, other: ChainSource) -> bool:
        """Whether another source makes the same robot, whatever it is called and looks like."""
        return self.mechanics() == other.mechanics()

    def mechanics(self) -> list[Any]:
        """All of the data but names, looks and guesses."""
        chain = msgspec.to_builtins(self.chain, enc_hook=_listed)
        bodies = [{**body, "shapes": ()} for body in chain["bodies"]]
        return [bodies, chain["tip"], chain["facing"], self.home, self.axes, self.substeps]


def source_from(data: dict[str, Any]) -> ChainSource:
    """The inverse of `ChainSource.data`.

    Raises:
        ValueError: something is missing in the data, or of another kind.
    """
    return msgspec.convert(data, ChainSource, dec_hook=lambda _, values: np.array(values))


def _listed(array: Any) -> Any:
    return array.tolist()


@dataclass(frozen=True, slots=True, eq=False)
class ChainFrames:
    """The frames of a chain's bodies, as expressions in q.

    Attributes:
        turns: rotation of each body's frame to that before it, (3, 3).
        steps: its origin in that frame, (3, 1), [m].
        rotations, origins: of each frame in the base's frame, [m].
    """

    turns: list[ca.SX]
    steps: list[ca.SX]
    rotations: list[ca.SX] = field(default_factory=list[ca.SX])
    origins: list[ca.SX] = field(default_factory=list[ca.SX])


AXIS = ca.DM([0, 0, 1])


def chain_frames(chain: Chain, q: ca.SX) -> ChainFrames:
    """Forward kinematics."""
    frames = ChainFrames([], [])
    rotation, origin = ca.SX(ca.DM.eye(3)), ca.SX(3, 1)
    for body, angle in zip(chain.bodies, ca.vertsplit(q), strict=True):
        turn, step = ca.SX(_sparse(body.rotation)), ca.SX(_sparse(body.translation))
        if body.joint.slides:
            step = step + turn @ AXIS * angle
        else:
            c, s = ca.cos(angle), ca.sin(angle)
            turn = ca.horzcat(
                turn[:, 0] * c + turn[:, 1] * s, turn[:, 1] * c - turn[:, 0] * s, turn[:, 2]
            )
        origin = origin + rotation @ step
        rotation = rotation @ turn
        frames.turns.append(turn)
        frames.steps.append(step)
        frames.rotations.append(rotation)
        frames.origins.append(origin)
    return frames


def frame_poses(chain: Chain, q: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Where the frames of the bodies are, in the base's frame.

    Returns:
        Origins, (3, n), [m], and unit quaternions, scalar first, (4, n).
    """
    frames, turn = chain_frames(chain, q), ca.SX(ca.DM([1, 0, 0, 0]))
    turns = list[ca.SX]()
    for body, angle in zip(chain.bodies, ca.vertsplit(q), strict=True):
        turn = _product(turn, ca.SX(_sparse(_quaternion(body.rotation))))
        if not body.joint.slides:
            about = ca.vertcat(ca.cos(angle / 2), 0, 0, ca.sin(angle / 2))
            turn = _product(turn, about)
        turns.append(turn)
    return ca.densify(ca.horzcat(*frames.origins)), ca.densify(ca.horzcat(*turns))


def _product(a: ca.SX, b: ca.SX) -> ca.SX:
    """The product of quaternions: first the rotation b, then a."""
    vector = a[0] * b[1:] + b[0] * a[1:] + ca.cross(a[1:], b[1:])
    return ca.vertcat(a[0] * b[0] - ca.dot(a[1:], b[1:]), vector)


def _quaternion(rotation: Array) -> Array:
    """The unit quaternion of a rotation, scalar first: the eigenvector of Bar-Itzhack's matrix."""
    k = np.zeros((4, 4))
    k[0, 0] = np.trace(rotation)
    k[1:, 1:] = rotation + rotation.T - np.trace(rotation) * np.eye(3)
    k[0, 1:] = k[1:, 0] = [
        rotation[2, 1] - rotation[1, 2],
        rotation[0, 2] - rotation[2, 0],
        rotation[1, 0] - rotation[0, 1],
    ]
    quaternion = np.linalg.eigh(k)[1][:, -1]
    return np.where(np.abs(quaternion) < 1e-12, 0.0, quaternion)


def tip_of(chain: Chain, frames: ChainFrames) -> ca.SX:
    """The end-point in the base's frame, (3, 1), [m]."""
    return frames.origins[-1] + frames.rotations[-1] @ _sparse(chain.tip)


@dataclass(frozen=True, slots=True, eq=False)
class Inertia:
    """Sums of mass about an origin: see the module's docstring."""

    mass: ca.SX
    moment: ca.SX
    inertia: ca.SX

    def __add__(self, other: Inertia) -> Inertia:
        return Inertia(
            self.mass + other.mass, self.moment + other.moment, self.inertia + other.inertia
        )

    def moved(self, turn: ca.SX, step: ca.SX) -> Inertia:
        """The same sums in another frame, in which this one lies at `step`, turned by `turn`.

        m c' = E m c + m p,   I' = E I Eᵀ - [p] [E m c] - [E m c] [p] - m [p] [p]
        """
        moment, cross = turn @ self.moment, ca.skew(step)
        across = cross @ ca.skew(moment)
        inertia = turn @ self.inertia @ turn.T - across - across.T - self.mass * (cross @ cross)
        return Inertia(self.mass, moment + self.mass * step, ca.tril2symm(ca.tril(inertia)))


def chain_inertias(chain: Chain, factor: ca.SX, payload: ca.SX) -> list[Inertia]:
    """The sums of mass of each body times a factor, with a payload at the end-point, [kg]."""
    bodies = [
        Inertia(factor * body.mass, factor * _sparse(body.moment), factor * _sparse(body.inertia))
        for body in chain.bodies
    ]
    tip = _sparse(chain.tip)
    spread = -ca.skew(tip) @ ca.skew(tip)
    bodies[-1] = bodies[-1] + Inertia(payload, payload * tip, payload * spread)
    return bodies


def mass_matrix(chain: Chain, frames: ChainFrames, inertias: list[Inertia], factor: ca.SX) -> ca.SX:
    """M(q) by composite bodies, with the armatures times a factor on its diagonal, (n, n)."""
    n = chain.n
    mass = ca.SX(ca.DM.zeros(n, n))
    beyond: Inertia | None = None
    for i in reversed(range(n)):
        here = inertias[i] if beyond is None else inertias[i] + beyond
        joint = chain.joints[i]
        if joint.slides:
            force, torque = here.mass * AXIS, ca.cross(here.moment, ca.SX(AXIS))
        else:
            force, torque = ca.cross(ca.SX(AXIS), here.moment), here.inertia[:, 2]
        mass[i, i] = (force if joint.slides else torque)[2] + factor * joint.armature
        for j in reversed(range(i)):
            force = frames.turns[j + 1] @ force
            torque = frames.turns[j + 1] @ torque + ca.cross(frames.steps[j + 1], force)
            mass[i, j] = mass[j, i] = (force if chain.joints[j].slides else torque)[2]
        beyond = here.moved(frames.turns[i], frames.steps[i])
    return mass


def masses_at(chain: Chain, rows: Array) -> Array:
    """M at configurations, (k, n) -> (k, n, n)."""
    q, one = ca.SX.sym("q", chain.n), ca.SX(1)
    inertias = chain_inertias(chain, one, ca.SX(0))
    mass = mass_matrix(chain, chain_frames(chain, q), inertias, one)
    return Rows([q], ca.vec(mass))(rows).reshape(-1, chain.n, chain.n)


def bias_forces(
    chain: Chain, frames: ChainFrames, inertias: list[Inertia], weights: list[Inertia], v: ca.SX
) -> ca.SX:
    """Coriolis, centrifugal and gravity forces c(q, v) by Newton and Euler, (n, 1).

    Args:
        inertias: sums of mass that resist acceleration.
        weights: sums of mass that gravity pulls; the same ones, unless a model has an error.
    """
    moving = turning = spinning = ca.SX(3, 1)
    upward = ca.SX(AXIS) * GRAVITY
    forces, torques = list[ca.SX](), list[ca.SX]()
    for i, rate in enumerate(ca.vertsplit(v)):
        back, step = frames.turns[i].T, frames.steps[i]
        moving = back @ (
            moving + ca.cross(spinning, step) + ca.cross(turning, ca.cross(turning, step))
        )
        turning, spinning, upward = back @ turning, back @ spinning, back @ upward
        if chain.joints[i].slides:
            moving = moving + 2 * ca.cross(turning, AXIS * rate)
        else:
            spinning = spinning + ca.cross(turning, AXIS * rate)
            turning = turning + AXIS * rate
        body, weight = inertias[i], weights[i]
        forces.append(
            body.mass * moving
            + weight.mass * upward
            + ca.cross(spinning, body.moment)
            + ca.cross(turning, ca.cross(turning, body.moment))
        )
        torques.append(
            body.inertia @ spinning
            + ca.cross(turning, body.inertia @ turning)
            + ca.cross(body.moment, moving)
            + ca.cross(weight.moment, upward)
        )
    result = ca.SX(chain.n, 1)
    for i in reversed(range(chain.n)):
        result[i] = (forces[i] if chain.joints[i].slides else torques[i])[2]
        if i:
            force = frames.turns[i] @ forces[i]
            forces[i - 1] = forces[i - 1] + force
            torques[i - 1] = (
                torques[i - 1] + frames.turns[i] @ torques[i] + ca.cross(frames.steps[i], force)
            )
    return ca.densify(result)


def potential_energy(frames: ChainFrames, weights: list[Inertia]) -> ca.SX:
    """V(q) = g Σ m z over the bodies, (1, 1), [J]."""
    total = ca.SX(0)
    for body, rotation, origin in zip(weights, frames.rotations, frames.origins, strict=True):
        total += body.mass * origin[2] + rotation[2, :] @ body.moment
    return GRAVITY * total


def solved(matrix: ca.SX, rhs: ca.SX) -> ca.SX:
    """A⁻¹ R of a symmetric positive definite matrix by A = L D Lᵀ, (n, n), (n, k) -> (n, k)."""
    n, rows = matrix.size1(), ca.vertsplit(ca.SX(rhs))
    lower, pivots = ca.SX(ca.DM.eye(n)), list[ca.SX]()
    for j in range(n):
        weighted = [lower[j, k] * pivots[k] for k in range(j)]
        pivots.append(matrix[j, j] - sum((lower[j, k] * weighted[k] for k in range(j)), ca.SX(0)))
        for i in range(j + 1, n):
            rest = sum((lower[i, k] * weighted[k] for k in range(j)), ca.SX(0))
            lower[i, j] = (matrix[i, j] - rest) / pivots[j]
    for i in range(n):
        for k in range(i):
            rows[i] = rows[i] - lower[i, k] * rows[k]
    rows = [row / pivot for row, pivot in zip(rows, pivots, strict=True)]
    for i in reversed(range(n)):
        for k in range(i + 1, n):
            rows[i] = rows[i] - lower[k, i] * rows[k]
    return ca.vertcat(*rows)


def _sparse(values: Array) -> ca.DM:
    """Numbers whose zeros are structural, so that products with them cost nothing."""
    return ca.sparsify(ca.DM(np.asarray(values)))
