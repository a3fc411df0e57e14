"""`onpath.robot`: a robot from a file."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path

from onpath.app.common.robot_files import robot_of_file
from onpath.app.common.user_files import user_file
from onpath.models.systems.file_chain import Options
from onpath.models.systems.robots import RobotEntry


def robot(
    file: str | Path,
    *,
    tip: str = "",
    pose: Mapping[str, float] | None = None,
    lock: Mapping[str, float] | None = None,
    armature: float = 0.0,
    packages: Mapping[str, str | Path] | None = None,
) -> RobotEntry:
    """A robot from a URDF file, or from an MJCF file, for which MuJoCo must be installed.

    It can be given wherever a robot is, such as to `onpath.simulate`, which also takes the name of
    a file that needs no options.
    The joints on the way from the base to the tip move, at most 8; all others are locked. Two
    outputs if the tip can only move in a plane, else three.

    Args:
        file: the file.
        tip: the link, or the site of an MJCF file, whose origin is the end-point; "": the only
            link at the end of the tree.
        pose: where joints stand at home, and those that are locked, by name, [rad] or [m]. Where
            it names none, a pose is chosen from which the tip can move well in all directions.
        lock: joints on the way to the tip that do not move, and where they stand, [rad] or [m].
        armature: inertia of the motors' rotors as seen at the joints, [kg m²], which a URDF file
            does not name.
        packages: folders of packages, by name, for meshes at package://NAME/…; without it, the
            package of the file is the nearest folder above it with a package.xml.

    Raises:
        ValueError: the file is refused, with line and element, or an option does not fit.
        OSError: the file cannot be read.

    Warns:
        UserWarning: what is left out, such as a mesh that is not there.

    >>> import onpath
    >>> from onpath.assets import asset_path
    >>> arm = onpath.robot(asset_path("robots/planar_arm.urdf"), tip="tip")
    >>> arm.text.partition(" Largest")[0]
    '3 joints, from planar_arm.urdf. Its tip follows circles of up to 100 mm about home.'
    >>> run = onpath.simulate(arm, hold=(1, 2), duration=2)
    >>> bool(run.distance.max() < 0.01)
    True
    """
    options = Options(
        tip=tip,
        lock=dict(lock or {}),
        pose=dict(pose or {}),
        armature=armature,
        packages={name: Path(folder).expanduser() for name, folder in (packages or {}).items()},
    )
    entry, remarks = robot_of_file(user_file(file), options)
    for remark in remarks:
        warnings.warn(str(remark), UserWarning, stacklevel=2)
    return entry
