"""Robots from files: what a user asks for, read and checked, as an entry of the catalogue."""

from __future__ import annotations

import hashlib
import math
import re
import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import casadi as ca
import numpy as np

from onpath.assets import asset_path
from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.paths.path_design import USUAL_RADIUS
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.file_chain import FileChain, Options, TipAt
from onpath.models.robot_files.file_reading import read_file
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.whole_chain import FEW
from onpath.models.robot_files.xml_elements import FileFault, file_bytes, root_of, shown
from onpath.models.systems.chain_robot import (
    FASTEST_DECAY,
    MOST_STEPS,
    chain_entry,
    chain_robot,
    output_axes,
)
from onpath.models.systems.drawing import Point
from onpath.models.systems.efforts import stated
from onpath.models.systems.home_pose import (
    RULES,
    ChosenPose,
    chosen_poses,
    length_of,
    reachable_circle,
)
from onpath.models.systems.rigid_chain import (
    ChainSource,
    chain_frames,
    masses_at,
    tip_of,
)
from onpath.models.systems.robots import RobotEntry

POSES = 100  # random ones at which masses and friction are checked
LEAST_CIRCLE = 0.015  # [m], of paths that must be possible
WITHIN = 0.8  # of the largest circle, radius of the predefined one of a small robot
ENOUGH = 0.1  # of a chain's length, radius of circles for which no other pose is tried
LEAST_ROTOR = 1e-5  # [kg m²], of motors whose inertia is guessed
LIGHTEST = 1e-9  # least eigenvalue of M to its largest
LARGEST_ARMATURE = 100.0  # [kg m²]
LARGEST_DENSITY = 25_000.0  # [kg/m³]
LARGEST_MASS = 100_000.0  # [kg]
_STRANGE = re.compile(r"[^a-z0-9]+")


POSES_CHOSEN: Mapping[tuple[str, ...], Message] = {
    ("floor", "ahead"): Message("robot_file.guessed_pose"),
    ("ahead",): Message("robot_file.guessed_pose_floor"),
    ("floor",): Message("robot_file.guessed_pose_ahead"),
    (): Message("robot_file.guessed_pose_floor_ahead"),
}
"""What is said of a chosen pose, by the rules of `chosen_poses` that it keeps."""


@dataclass(frozen=True, slots=True, eq=False)
class RobotFile:
    """A robot from a file.

    Attributes:
        entry: for the catalogue. Its name ends with a digest of the file and the options, so that a
            set-up with it is not taken for another robot's.
        circle: the largest radius of circles about home that it can follow, [m].
        remarks: what has been left out or is unusual.
        tips, places: see `FileChain`.
    """

    entry: RobotEntry
    circle: float
    remarks: tuple[Message, ...]
    tips: tuple[str, ...]
    places: Mapping[str, TipAt]

    @property
    def guesses(self) -> tuple[Guess, ...]:
        """What the file does not say."""
        return self.entry.guesses


def read_robot(file: Path, options: Options) -> RobotFile:
    """Read a robot from a URDF file, a xacro file, or an MJCF file.

    Raises:
        CodedError: something in the file is refused, with its line and element, or the robot cannot
            be simulated, or an option is wrong. The message says what to do.
    """
    _check(options)
    try:
        read, data = read_file(file, options)
    except FileFault as fault:
        raise fault.in_file(file) from None
    stem = _STRANGE.sub("_", file.stem.lower()).strip("_")[:24] or "robot"
    said = (sorted(options.lock.items()), sorted(options.pose.items()), options.armature)
    tip = read.tips[0] if any(guess.kind == "tip" for guess in read.guesses) else options.tip
    weighed = [(key, value) for key in ("density", "mass") if (value := getattr(options, key))]
    key = repr((tip, *said, *weighed)) + read.rests
    digest = hashlib.sha256(data + key.encode()).hexdigest()[:8]
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


def _kept_off(source: ChainSource) -> list[str]:
    """A sentence on limit avoidance, if the robot has it."""
    if not source.redundant or not source.chain.limited:
        return []
    return ["Its joints keep off their stops where others can move instead, while the tip stays."]


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
    density, mass = options.density, options.mass
    if density is not None and not 0 < density <= LARGEST_DENSITY:
        most = f"{LARGEST_DENSITY:g}"
        raise CodedError("robot_file.density_range", value=f"{density:g}", most=most)
    if mass is not None and not 0 < mass <= LARGEST_MASS:
        raise CodedError("robot_file.mass_range", value=f"{mass:g}", most=f"{LARGEST_MASS:g}")


def _made(file: Path, name: str, read: FileChain, pose: Mapping[str, float]) -> RobotFile:
    axes = output_axes(read.chain)
    if read.chain.n < len(axes):
        raise CodedError("robot_file.single" if read.chain.n == 1 else "robot_file.two_across")
    chosen = _homes(read, axes, pose)
    chain, rotors = _with_rotors(read.chain, chosen[0].q)
    source = ChainSource(
        name=name,
        label=shown(file.stem),
        text=f"{chain.n} joints, from {shown(file.name)}.",
        chain=chain,
        home=tuple(chosen[0].q.tolist()),
        axes=axes,
        substeps=_steps(_fastest(_masses(chain, chosen[0].q), chain, 0.0)),
    )
    source, circle, home = _roomy(source, chosen)
    if circle < LEAST_CIRCLE:
        least, found = f"{1e3 * LEAST_CIRCLE:.0f}", f"{1e3 * circle:.0f}"
        raise CodedError("robot_file.circle", least=least, circle=found)
    reach = f"Its tip follows circles of up to {1e3 * circle:.0f} mm about home."
    text = " ".join([source.text, reach, *_kept_off(source), *_limits_of(chain)])
    guesses = (*read.guesses, *_pose_guess(chain, home, pose), *rotors, *_effort_guess(chain))
    radius = USUAL_RADIUS if circle >= USUAL_RADIUS else WITHIN * circle
    entry = chain_entry(replace(source, text=text, guesses=guesses, radius=round(radius, 3)))
    return RobotFile(
        entry=entry,
        circle=circle,
        remarks=read.remarks,
        tips=read.tips,
        places=read.places,
    )


def _homes(read: FileChain, axes: tuple[Point, ...], pose: Mapping[str, float]) -> list[ChosenPose]:
    """Configurations at home, as given, and chosen where nothing is given, best first."""
    chain = read.chain
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
        values = np.linalg.svd(_slope(chain, axes, home), compute_uv=False)
        if not values[-1] > 1e-3 * values[0]:
            raise CodedError("robot_file.singular")
        return [ChosenPose(home, RULES)]
    found = chosen_poses(chain, axes, given)
    lacking = [guess.line for guess in read.guesses if guess.kind == "package"]
    if not found and lacking and chain.n <= FEW:
        raise CodedError("robot_file.no_pose_package", lines=", ".join(lacking))
    if not found:
        raise CodedError("robot_file.no_pose" if not given else "robot_file.singular")
    return found


def _roomy(source: ChainSource, poses: list[ChosenPose]) -> tuple[ChainSource, float, ChosenPose]:
    """The first pose around which circles are large enough, or the one with the largest, [m]."""
    tried = list[tuple[ChainSource, float, ChosenPose]]()
    for pose in poses:
        here = replace(source, home=tuple(pose.q.tolist()))
        tried.append((here, reachable_circle(chain_robot(here)), pose))
        if tried[-1][1] >= ENOUGH * length_of(source.chain):
            break
    return max(tried, key=lambda each: each[1])


def _pose_guess(chain: Chain, home: ChosenPose, pose: Mapping[str, float]) -> Iterator[Guess]:
    """What is said of a pose that is chosen, and of the rules that it does not keep to."""
    free = [i for i, joint in enumerate(chain.joints) if joint.name not in pose]
    if not free:
        return
    message = POSES_CHOSEN[home.kept]
    values = [f"{chain.joints[i].name}={home.q[i]:.4g}" for i in free]
    yield Guess("pose", message, " ".join(f"--pose {shlex.quote(each)}" for each in values))


def _effort_guess(chain: Chain) -> Iterator[Guess]:
    """That motors are unlimited of which the file does not say what they can give."""
    names = [shown(joint.name) for joint in chain.joints if math.isinf(joint.effort)]
    if len(names) == chain.n:
        yield Guess("effort", Message("robot_file.guessed_efforts"))
    elif names:
        message = Message("robot_file.guessed_effort", {"joints": ", ".join(names)})
        yield Guess("effort", message)


def _slope(chain: Chain, axes: tuple[Point, ...], q: Array) -> Array:
    """J = dh/dq, shape (p, n)."""
    symbols = ca.SX.sym("q", chain.n)
    tip = ca.DM(axes) @ tip_of(chain, chain_frames(chain, symbols))
    slope = ca.Function("slope", [symbols], [ca.densify(ca.jacobian(tip, symbols))])
    return np.array(slope(q))


def _with_rotors(chain: Chain, home: Array) -> tuple[Chain, tuple[Guess, ...]]:
    """The chain with motors whose inertia is large enough for friction and light bodies.

    Raises:
        CodedError: no body has a mass or inertia.
    """
    masses = _masses(chain, home)
    steps, light = _steps(_fastest(masses, chain, 0.0)), _too_light(masses, chain, 0.0)
    if not np.isfinite(masses).all() or not np.abs(masses).max() > 0:
        raise CodedError("robot_file.massless", joint=_light(chain, masses))
    if steps <= MOST_STEPS and not light:
        return chain, ()
    armature = LEAST_ROTOR
    while _fastest(masses, chain, armature) > FASTEST_DECAY or _too_light(masses, chain, armature):
        armature *= 1.25
    present = max(joint.armature for joint in chain.joints)
    enough = f"{1.1 * float(f'{present + armature:.1e}'):.2g}"
    if float(enough) > LARGEST_ARMATURE:
        raise CodedError("robot_file.massless", joint=_light(chain, masses))
    bodies = [
        replace(body, joint=replace(body.joint, armature=max(body.joint.armature, float(enough))))
        for body in chain.bodies
    ]
    message = Message("robot_file.guessed_armature", {"armature": enough})
    guess = Guess("inertia", message, f"--armature {enough}")
    return replace(chain, bodies=tuple(bodies)), (guess,)


def _masses(chain: Chain, home: Array) -> Array:
    """M(q) at home and at random configurations, (POSES + 1, n, n)."""
    low, high = (ends.clip(-np.pi, np.pi) for ends in chain.limits)
    share = np.random.default_rng(1).random((POSES, chain.n))
    return masses_at(chain, np.concatenate([home[None], low + share * (high - low)]))


def _steps(decay: float) -> int:
    """Runge-Kutta steps per tick for the fastest decay by friction."""
    return max(1, math.ceil(min(decay / FASTEST_DECAY, 1e9)))


def _fastest(masses: Array, chain: Chain, armature: float) -> float:
    """λ_max(M⁻¹ D) of all configurations, [1/s], by the symmetric D^½ M⁻¹ D^½."""
    damping = np.array([joint.damping for joint in chain.joints])
    return max(_decay(each + armature * np.eye(chain.n), damping) for each in masses)


def _too_light(masses: Array, chain: Chain, armature: float) -> bool:
    """Whether M is not positive definite somewhere, or nearly so."""
    values = np.linalg.eigvalsh(masses + armature * np.eye(chain.n))
    return not bool((values[:, 0] > LIGHTEST * values[:, -1]).all())


def _decay(mass: Array, damping: Array) -> float:
    """λ_max(M⁻¹ D), [1/s]; infinite if M is singular and there is friction."""
    root = np.sqrt(damping)
    if not damping.any():
        return 0.0
    if not np.linalg.eigvalsh(mass)[0] > 0:
        return math.inf
    return float(np.linalg.eigvalsh(root[:, None] * np.linalg.inv(mass) * root)[-1])


def _light(chain: Chain, masses: Array) -> str:
    """The joint that moves the least mass for its scale."""
    return chain.joints[int(np.diagonal(masses, axis1=1, axis2=2).min(axis=0).argmin())].name
