"""`onpath.robot`: a robot from a file."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path

from onpath.app.common.robot_files import robot_of_file
from onpath.app.common.robot_places import robot_place
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.robots import RobotEntry


def robot(
    file: str | Path,
    *,
    tip: str = "",
    pose: Mapping[str, float] | None = None,
    lock: Mapping[str, float] | None = None,
    armature: float = 0.0,
    density: float | None = None,
    mass: float | None = None,
    packages: Mapping[str, str | Path] | None = None,
) -> RobotEntry:
    """A robot from a URDF or xacro file, or from an MJCF file, for which MuJoCo must be installed.

    It can be given wherever a robot is, such as to `onpath.simulate`, which also takes the name of
    a file that needs no options.
    The joints on the way from the base to the tip move, at most 8; all others are locked. Two
    outputs if the tip can only move in a plane, else three. What the file leaves open is guessed:
    the `guesses` of the robot, and of runs with it.

    Args:
        file: the file; a folder with one robot's file; or a name of the package
            `robot_descriptions`, such as "panda_description", if that is installed.
        tip: the link, or the site of an MJCF file, whose origin is the end-point; "": the likeliest
            one.
        pose: where joints stand at home, and those that are locked, by name, [rad] or [m]. Where
            it names none, a pose is chosen from which the tip can move well in all directions.
        lock: joints on the way to the tip that do not move, and where they stand, [rad] or [m].
        armature: inertia of the motors' rotors as seen at the joints, [kg m²], which a URDF file
            does not name.
        density: of links for which the file has no mass, [kg/m³]; None: 1000.
        mass: of all that moves, instead of a density, [kg].
        packages: folders of packages, by name, for meshes at package://NAME/…; without it, the
            package of the file is the nearest folder above it with a package.xml.

    Raises:
        ValueError: the file is refused, with line and element, or an option does not fit.
        OSError: the file cannot be read.

    Warns:
        UserWarning: what is left out, such as a mesh that is not there; and what is guessed,
            with the option that settles it.

    >>> import onpath
    >>> from onpath.assets import asset_path
    >>> arm = onpath.robot(asset_path("robots/planar_arm.urdf"), tip="tip")
    >>> arm.text.partition(" Largest")[0]
    '3 joints, from planar_arm.urdf. Its tip follows circles of up to 94 mm about home.'
    >>> run = onpath.simulate(arm, hold=(1, 2), duration=2)
    >>> bool(run.distance.max() < 0.01)
    True
    """
    place = robot_place(file)
    folders = {name: Path(folder).expanduser() for name, folder in (packages or {}).items()}
    options = Options(
        tip=tip,
        lock=dict(lock or {}),
        pose=dict(pose or {}),
        armature=armature,
        density=density,
        mass=mass,
        packages={**place.packages, **folders},
    )
    entry, remarks = robot_of_file(place.file, options)
    for remark in remarks:
        warnings.warn(str(remark), UserWarning, stacklevel=2)
    return entry
