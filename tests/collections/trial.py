"""One robot's trial: it draws a circle of a tenth of its length, and is held back for a while."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.robot_files.file_chain import Options
from onpath.models.studies.experiments import on_path, run
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.home_pose import length_of
from onpath.models.systems.robot_file import RobotFile, read_robot

SHARE = 0.1  # of the robot's length, the circle's radius
SPEED = 2.0  # [rad/s]
DURATION, HELD, LET_GO = 6.0, 2.0, 4.0  # [s]
SETTLED = 1.0  # [s] after it is let go, from which it counts as free again
FREE = 2e-3  # [m], most by which the follower may be off its path while it is free
TORN = 2.0  # the tracker is farther off than the follower by this factor while they are held
FOLLOWER, TRACKER = "path_following", "trajectory_tracking"


@dataclass(frozen=True)
class Verdict:
    """What became of a file.

    Attributes:
        verdict: "runs", "refused", or what went wrong.
        detail: why the file is refused.
        joints: that move its tip.
        reach: its length from the first joint, [m].
        circle: the largest circle about home, [m].
        room: least distance of each joint from a stop, in % of its travel; "" without limits.
        free, held, torn: largest distance from the path, [mm]: of the follower while it is free and
            while it is held, and of the tracker while it is held.
        guesses: kinds of what was guessed.
    """

    verdict: str
    detail: str = ""
    joints: int = 0
    reach: float = 0.0
    circle: float = 0.0
    room: tuple[str, ...] = ()
    free: float = 0.0
    held: float = 0.0
    torn: float = 0.0
    guesses: tuple[str, ...] = ()


def verdict_of(file: Path, options: Options | None = None) -> Verdict:
    """Read a file with nothing but its name, and run its robot."""
    try:
        read = read_robot(file, options or Options())
    except CodedError as error:
        return Verdict("refused", str(error))
    return _run(read)


def _run(read: RobotFile) -> Verdict:
    entry = read.entry
    assert entry.source is not None
    chain = entry.source.chain
    length = length_of(chain)
    radius = SHARE * length
    faults = list[str]()
    if read.circle < radius:
        faults.append(f"circles of up to {1e3 * read.circle:.0f} mm")
    experiment = on_path(entry, entry.parameters(), circle(min(radius, read.circle)))
    experiment = experiment.with_values(
        {"duration": DURATION, "hold_from": HELD, "hold_to": LET_GO, "speed": SPEED}
    )
    follower, tracker = (run(experiment, law) for law in (FOLLOWER, TRACKER))
    for name, moved in (("follower", follower), ("tracker", tracker)):
        if moved.stopped_at is not None:
            faults.append(f"{name} stopped: {moved.reason}")
    room = np.array([_room(moved, *chain.limits) for moved in (follower, tracker)]).min(axis=0)
    beyond = exceeded(experiment.robot(), np.abs(follower.fields["u"]).max(axis=0, initial=0.0))
    if beyond is not None:
        faults.append(str(beyond))
    free, held, torn = _distances(follower, tracker)
    if free > FREE:
        faults.append(f"{1e3 * free:.1f} mm off while free")
    if torn < TORN * held:
        faults.append("tracker not torn off")
    return Verdict(
        verdict="; ".join(faults) or "runs",
        joints=chain.n,
        reach=length,
        circle=read.circle,
        room=tuple("" if math.isnan(each) else f"{100 * each:.0f}" for each in room),
        free=1e3 * free,
        held=1e3 * held,
        torn=1e3 * torn,
        guesses=tuple(dict.fromkeys(guess.kind for guess in read.guesses)),
    )


def _room(moved: Trajectory, low: Array, high: Array) -> Array:
    """The least distance of each joint from a stop, as a share of its travel, or NaN."""
    q, width = moved.fields["q"], high - low
    limited = np.isfinite(width)
    room = np.full(len(width), np.nan)
    nearest = np.minimum(q - low, high - q)[:, limited]
    room[limited] = nearest.min(axis=0, initial=np.inf) / width[limited]
    return room


def _distances(follower: Trajectory, tracker: Trajectory) -> tuple[float, float, float]:
    """Of the follower while it is free and held, and of the tracker while it is held, [m]."""
    times = np.arange(len(follower.distance)) * DURATION / round(1000 * DURATION)
    free = ~follower.held & ((times < HELD) | (times > LET_GO + SETTLED))
    away, held, torn = (
        float(moved.distance[when].max(initial=0.0))
        for moved, when in ((follower, free), (follower, follower.held), (tracker, tracker.held))
    )
    return away, held, torn
