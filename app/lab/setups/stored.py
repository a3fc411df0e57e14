"""Stored set-ups, brought up to the present: former defaults, and paths that are refused today."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, TypeVar

import msgspec

from onpath.app.lab.setups.former_defaults import former_defaults
from onpath.app.lab.setups.plan import planned
from onpath.app.lab.setups.setup import Path, RobotSetup, Setup, StoredSetup
from onpath.models.closed_loop.start import ON_PATH
from onpath.models.control.benches import checked_laws
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS

T = TypeVar("T")


def from_data(data: Any) -> Setup:
    """Inverse of `to_data`, for untrusted data.

    Raises:
        ValueError: it is not a valid set-up.
    """
    stored = msgspec.convert(data, StoredSetup)
    robots = _brought_up(stored.robots, stored.defaults)
    own: dict[str, Any] = {name: getattr(stored, name) for name in Setup.__struct_fields__}
    setup = Setup(**{**own, "robots": robots})
    entry = planned(setup, presets())[setup.robot].entry
    return msgspec.structs.replace(setup, laws=checked_laws(setup.laws, entry))


def without_absent_laws(data: Any) -> tuple[Any, tuple[str, ...]]:
    """A kept set-up without the laws that are not here any more and their gains, and their names.

    The data need not be valid otherwise.
    """
    try:
        stored = msgspec.convert(data, StoredSetup)
    except msgspec.ValidationError:
        return data, ()
    known = {name for entry in ROBOTS.values() for name in specs(entry.parameters)}
    gains = {n for robot in stored.robots.values() for n in robot.parameters if n not in known}
    absent = {b: law for b, law in stored.laws.items() if not is_text(law) and law not in LAWS}
    robots = {
        name: msgspec.structs.replace(robot, parameters=_without(robot.parameters, gains))
        for name, robot in stored.robots.items()
    }
    laws = _without(stored.laws, absent)
    found = msgspec.structs.replace(stored, robots=robots, laws=laws)
    return msgspec.to_builtins(found), (*sorted({*absent.values()}), *sorted(gains))


def _without(values: Mapping[str, T], names: Collection[str]) -> dict[str, T]:
    return {name: value for name, value in values.items() if name not in names}


def _brought_up(robots: Mapping[str, RobotSetup], version: int) -> dict[str, RobotSetup]:
    """The same set-ups of robots, as differences from the present defaults.

    Args:
        version: of the defaults that they differ from.
    """
    found = dict(robots)
    for name in ROBOTS:
        if former := former_defaults(name, version):
            robot = robots.get(name, RobotSetup())
            own = {**former, **robot.parameters}
            found[name] = msgspec.structs.replace(robot, parameters=own)
    return found


def with_paths_of_today(setup: Setup) -> tuple[Setup, tuple[Message, ...]]:
    """A kept set-up with the circle in place of every path that is refused today, and why it is.

    A path that was accepted when it was kept may be refused now. A start that is not possible, too,
    is replaced by that of a new lab.

    Raises:
        ValueError: the set-up is impossible for another reason.
    """
    robots, told = dict(setup.robots), tuple[Message, ...]()
    for name, wanted in planned(setup, presets()).items():
        if reasons := wanted.path_faults:
            kept = robots.get(name, RobotSetup())
            robots[name] = msgspec.structs.replace(kept, path=Path(), start={})
            told = (*told, *reasons)
        elif wanted.start != ON_PATH:
            try:
                wanted.check_start()
            except ValueError:
                robots[name] = msgspec.structs.replace(robots[name], start={})
    return msgspec.structs.replace(setup, robots=robots), told
