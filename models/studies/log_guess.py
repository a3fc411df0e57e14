"""Guesses which columns of a log are the quantities of a robot, and their units, from their names.

Names as controllers and recorders write them are known: q1_deg, "Joint 1 [rad]", position.0,
effort_3, time (ms), and those with the joints of the robot's file, as elbow/position. A guess is
meant to be shown, and changed where it is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from onpath.models.studies.record_file import quantities, units_of
from onpath.models.systems.robots import Robot

SAME = {
    "t": ("t", "time", "timestamp", "stamp", "zeit", "secs", "seconds"),
    "q": ("q", "position", "positions", "pos", "angle", "joint", "axis", "achse", "winkel"),
    "tau": ("tau", "torque", "torques", "effort", "moment", "drehmoment", "u"),
    "force": ("force", "wrench", "f", "kraft"),
}
"""Words that mean the time, an angle, a torque and a force, before their number."""
BEFORE = ("actual", "measured", "msr", "ist", "joint", "joints", "states", "state")
"""Words that may stand before these."""
DEGREES = {"°": "deg", "degree": "deg", "degrees": "deg", "grad": "deg", "radians": "rad"}


@dataclass(frozen=True, slots=True)
class GuessedColumns:
    """Columns and units of a log.

    Attributes:
        columns: name of each quantity's column that was found.
        units: of those whose names state one that is not that of the SI.
    """

    columns: Mapping[str, str]
    units: Mapping[str, str]


def guessed_columns(robot: Robot, names: Sequence[str]) -> GuessedColumns:
    """What the columns with these names may be.

    Columns without names, whose numbers are as many as those of time, coordinates and torques, are
    in this order.
    """
    known = quantities(robot)
    motion = [name for name in known if not name.startswith("force")]
    if [*names] == [str(i) for i in range(1, len(motion) + 1)]:
        return GuessedColumns(dict(zip(motion, names, strict=True)), {})
    joints = [joint.name for joint in robot.chain.joints] if robot.chain else []
    parts = {name: _parts(_numbered(name, joints)) for name in names}
    found = dict[str, str]()
    for kind, members in groupby(known, key=lambda q: q.rstrip("0123456789")):
        found |= _of_kind(kind, [*members], known, parts)
    stated = {
        q: unit
        for q, name in found.items()
        if (unit := parts[name][2]) in (possible := units_of(known[q])) and possible[unit] != 1
    }
    return GuessedColumns({q: found[q] for q in known if q in found}, stated)


def _of_kind(
    kind: str,
    wanted: Sequence[str],
    known: Mapping[str, str],
    parts: Mapping[str, tuple[str, str, str]],
) -> dict[str, str]:
    """The columns of all quantities of a kind, or none."""
    for exact in ({q: known[q] for q in wanted}, {q: q for q in wanted}):
        if all(name in parts for name in exact.values()):
            return exact
    words, family = SAME.get(kind, (kind,)), dict[int, str]()
    for name, (word, number, _) in parts.items():
        if word in words:
            family.setdefault(int(number or 0), name)
    numbers = sorted(family)
    if not family or not _counts(numbers, len(wanted)):
        return {}
    return {q: family[n] for q, n in zip(wanted, numbers, strict=True)}


def _counts(numbers: Sequence[int], count: int) -> bool:
    """Whether numbers count so many columns, from 0 or 1 on, or any one column."""
    first = numbers[0]
    return len(numbers) == count and (count == 1 or numbers == [*range(first, first + count)])


def _numbered(name: str, joints: Sequence[str]) -> str:
    """A column's name with a joint's number instead of its name in the robot's file."""
    found = max((each for each in joints if each in name), key=len, default="")
    if not found:
        return name
    number = f" {1 + joints.index(found)} "
    return f"q {number}" if name == found else name.replace(found, number)


def _parts(name: str) -> tuple[str, str, str]:
    """The word that tells the kind, its number, and the unit of a name, each perhaps empty."""
    words = re.findall(r"[^\W\d_]+|\d+|°", name)
    units = {unit.lower(): unit for kind in ("s", "rad", "m", "Nm", "N") for unit in units_of(kind)}
    unit = ""
    if len(words) > 1 and not words[-1].isdigit():
        last = words[-1].lower()
        unit = DEGREES.get(last, units.get(last, ""))
        words = words[:-1] if unit else words
    numbers = [word for word in words if word.isdigit()]
    texts = [word.lower() for word in words if not word.isdigit()]
    kinds = [word for word in texts if word not in BEFORE] or texts
    return kinds[-1] if kinds else "", numbers[-1] if numbers else "", unit
