"""Robots from files: what a user asks for, read and checked, as an entry of the catalogue."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import casadi as ca
import numpy as np

from onpath.assets import asset_path
from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.systems.chain_robot import (
    FASTEST_DECAY,
    MOST_STEPS,
    chain_entry,
    chain_robot,
    chain_system,
    output_axes,
)
from onpath.models.systems.drawing import Point
from onpath.models.systems.efforts import stated
from onpath.models.systems.file_chain import FileChain, Options
from onpath.models.systems.guesses import Guess
from onpath.models.systems.home_pose import chosen_pose, reachable_circle
from onpath.models.systems.mjcf_file import read_mjcf
from onpath.models.systems.rigid_chain import Chain, ChainSource, chain_frames, tip_of
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.rows import Rows
from onpath.models.systems.urdf_file import read_urdf
from onpath.models.systems.xml_elements import FileFault, file_bytes, root_of

POSES = 100  # random ones at which masses and friction are checked
LEAST_CIRCLE = 0.05  # [m], of paths that must be possible
LARGEST_ARMATURE = 100.0  # [kg m²]
_STRANGE = re.compile(r"[^a-z0-9]+")


@dataclass(frozen=True, slots=True, eq=False)
class RobotFile:
    """A robot from a file.

    Attributes:
        entry: for the catalogue. Its name ends with a digest of the file and the options, so that a
            set-up with it is not taken for another robot's.
        circle: the largest radius of circles about home that it can follow, [m].
        remarks: what has been left out or is unusual.
        guesses: what the file does not say.
        tips: see `FileChain.tips`.
    """

    entry: RobotEntry
    circle: float
    remarks: tuple[Message, ...]
    guesses: tuple[Guess, ...]
    tips: tuple[str, ...]


def read_robot(file: Path, options: Options) -> RobotFile:
    """Read a robot from a URDF file, or from an MJCF file.

    Raises:
        CodedError: something in the file is refused, with its line and element, or the robot cannot
            be simulated, or an option is wrong. The message says what to do.
    """
    _check(options)
    data = file_bytes(file)
    try:
        root = root_of(data)
        if root.tag == "mujoco":
            read = read_mjcf(file, root, options)
        else:
            read = read_urdf(file, root, options)
    except FileFault as fault:
        raise fault.in_file(file) from None
    stem = _STRANGE.sub("_", file.stem.lower()).strip("_")[:24] or "robot"
    said = (sorted(options.lock.items()), sorted(options.pose.items()), options.armature)
    tip = read.tips[0] if any(guess.kind == "tip" for guess in read.guesses) else options.tip
    weighed = [(key, value) for key in ("density", "mass") if (value := getattr(options, key))]
    key = repr((tip, *said, *weighed)).encode()
    digest = hashlib.sha256(data + key).hexdigest()[:8]
    return _made(file, f"{stem}_{digest}", read, {**read.home, **options.pose})


def packaged_robot(name: str, label: str, text: str, pose: Mapping[str, float]) -> RobotEntry:
    """A robot from a file of this package, whose tests check what `read_robot` checks.

    Args:
        name: of the URDF file in `assets/robots`, in the catalogue, and of the picture in `assets`.
        label, text: see `RobotEntry`.
        pose: at home, for all joints, [rad] or [m].
    """
    file = asset_path(f"robots/{name}.urdf")
    chain = read_urdf(file, root_of(file_bytes(file)), Options()).chain
    text = " ".join([text, *_limits_of(chain)])
    home = tuple(pose[joint.name] for joint in chain.joints)
    axes = output_axes(chain)
    source = ChainSource(name=name, label=label, text=text, chain=chain, home=home, axes=axes)
    return replace(chain_entry(source), picture=f"{name}.webp")


def _limits_of(chain: Chain) -> list[str]:
    """A sentence with the torque limits that the file states, if it states any."""
    limits = stated(chain)
    return [] if limits is None else [str(limits)]


def _check(options: Options) -> None:
    numbers = {**options.lock, **options.pose}
    for name, value in numbers.items():
        if not math.isfinite(value) or abs(value) > 1e3:
            raise CodedError("robot_file.pose", joint=name, value=f"{value:g}")
    if not 0 <= options.armature <= LARGEST_ARMATURE:
        most = f"{LARGEST_ARMATURE:g}"
        raise CodedError("robot_file.armature", value=f"{options.armature:g}", most=most)


def _made(file: Path, name: str, read: FileChain, pose: Mapping[str, float]) -> RobotFile:
    chain, axes = read.chain, output_axes(read.chain)
    if chain.n < len(axes):
        raise CodedError("robot_file.few_joints", count=chain.n, needed=len(axes))
    home = _home(chain, axes, pose)
    source = ChainSource(
        name=name,
        label=file.stem[:40],
        text=f"{chain.n} joints, from {file.name}.",
        chain=chain,
        home=tuple(home.tolist()),
        axes=axes,
        guesses=read.guesses,
    )
    source = replace(source, substeps=_substeps(source))
    circle = reachable_circle(chain_robot(source))
    if circle < LEAST_CIRCLE:
        least, found = f"{1e3 * LEAST_CIRCLE:.0f}", f"{1e3 * circle:.0f}"
        raise CodedError("robot_file.circle", least=least, circle=found)
    reach = f"Its tip follows circles of up to {1e3 * circle:.0f} mm about home."
    text = " ".join([source.text, reach, *_limits_of(chain)])
    entry = chain_entry(replace(source, text=text))
    return RobotFile(
        entry=entry,
        circle=circle,
        remarks=read.remarks,
        guesses=read.guesses,
        tips=read.tips,
    )


def _home(chain: Chain, axes: tuple[Point, ...], pose: Mapping[str, float]) -> Array:
    """The configuration at home: as given, and chosen where nothing is given, shape (n,)."""
    given = {joint.name: pose[joint.name] for joint in chain.joints if joint.name in pose}
    for joint in chain.joints:
        value = given.get(joint.name, joint.low)
        if not joint.low <= value <= joint.high:
            low, high = f"{joint.low:.3g}", f"{joint.high:.3g}"
            raise CodedError(
                "robot_file.pose_outside",
                joint=joint.name,
                value=f"{value:.3g}",
                low=low,
                high=high,
            )
    if len(given) == chain.n:
        home = np.array([given[joint.name] for joint in chain.joints])
    else:
        home = chosen_pose(chain, axes, given)
    if not np.isfinite(home).all():
        raise CodedError("robot_file.no_pose")
    values = np.linalg.svd(_slope(chain, axes, home), compute_uv=False)
    if not values[-1] > 1e-3 * values[0]:
        raise CodedError("robot_file.singular")
    return home


def _slope(chain: Chain, axes: tuple[Point, ...], q: Array) -> Array:
    """J = dh/dq, shape (p, n)."""
    symbols = ca.SX.sym("q", chain.n)
    tip = ca.DM(axes) @ tip_of(chain, chain_frames(chain, symbols))
    slope = ca.Function("slope", [symbols], [ca.densify(ca.jacobian(tip, symbols))])
    return np.array(slope(q))


def _substeps(source: ChainSource) -> int:
    """Runge-Kutta steps per tick, for the fastest decay by friction, λ_max(M⁻¹ D).

    Raises:
        CodedError: the mass matrix is not positive definite somewhere, or no step can follow the
            decay; the message names an armature that is large enough.
    """
    chain, system = source.chain, chain_system(source)
    low, high = (ends.clip(-np.pi, np.pi) for ends in chain.limits)
    share = np.random.default_rng(1).random((POSES, chain.n))
    q = np.concatenate([[source.home], low + share * (high - low)])
    numbers = np.array([1.0, 0.0, 0.0] + [0.0] * (system.parameters.numel() - 3))
    found = Rows([system.q, system.parameters], ca.vec(system.mass))(q, numbers)
    masses = found.reshape(-1, chain.n, chain.n)
    least = np.linalg.eigvalsh(np.nan_to_num(masses))
    if not (np.isfinite(masses).all() and (least[:, 0] > 1e-9 * least[:, -1]).all()):
        raise CodedError("robot_file.massless", joint=_light(chain, masses))
    damping = np.array([joint.damping for joint in chain.joints])

    def fastest(armature: float) -> float:
        return max(_decay(each + armature * np.eye(chain.n), damping) for each in masses)

    steps = max(1, math.ceil(fastest(0.0) / FASTEST_DECAY))
    if steps <= MOST_STEPS:
        return steps
    armature = 1e-4
    while fastest(armature) > FASTEST_DECAY:
        armature *= 1.25
    present = max(joint.armature for joint in chain.joints)
    digits = f"{present + armature:.1e}"
    enough = f"{float(digits) * 1.1:.2g}"
    raise CodedError("robot_file.damping", decay=f"{fastest(0.0):.0f}", armature=enough)


def _decay(mass: Array, damping: Array) -> float:
    """λ_max(M⁻¹ D), [1/s], by the symmetric D^½ M⁻¹ D^½."""
    root = np.sqrt(damping)
    return float(np.linalg.eigvalsh(root[:, None] * np.linalg.inv(mass) * root)[-1])


def _light(chain: Chain, masses: Array) -> str:
    """The joint that moves the least mass for its scale."""
    return chain.joints[int(np.diagonal(masses, axis1=1, axis2=2).min(axis=0).argmin())].name
