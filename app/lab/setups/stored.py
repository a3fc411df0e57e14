"""Set-ups as plain data.

The data name the version of the defaults from which they differ, so that data of an earlier version
keep their meaning.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Any, TypeVar

import msgspec

from onpath.app.lab.setups.former import DEFAULTS, as_of_today, brought_up
from onpath.app.lab.setups.plan import is_absent, planned
from onpath.app.lab.setups.setup import Setup, plain
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.control.sides import checked_laws
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import FORMER_NAMES

T = TypeVar("T")


class StoredSetup(Setup, frozen=True, forbid_unknown_fields=True):
    """A set-up as data: `defaults` is the version of the defaults that it differs from."""

    defaults: Annotated[int, msgspec.Meta(ge=1, le=DEFAULTS)] = 1


def to_data(setup: Setup) -> dict[str, Any]:
    """Convert a set-up to JSON data, without default values."""
    return {"defaults": DEFAULTS, **plain(setup)}


def from_data(data: Any) -> Setup:
    """Inverse of `to_data`, for untrusted data.

    Raises:
        ValueError: it is not a valid set-up.
    """
    stored = msgspec.convert(as_of_today(data), StoredSetup)
    others = {name for name in stored.robots if is_absent(name)} - {stored.robot}
    stored = msgspec.structs.replace(stored, robots=_without(stored.robots, others))
    robots = brought_up(stored.robots, stored.defaults)
    fields: dict[str, Any] = {name: getattr(stored, name) for name in Setup.__struct_fields__}
    setup = Setup(**{**fields, "robots": robots})
    entry = planned(setup)[setup.robot].entry
    return msgspec.structs.replace(setup, laws=checked_laws(setup.laws, entry))


def without_absent_laws(data: Any) -> tuple[Any, tuple[str, ...]]:
    """A stored set-up without laws that no longer exist and their gains, and the names of both.

    The data need not be valid otherwise.
    """
    try:
        stored = msgspec.convert(as_of_today(data), StoredSetup)
    except msgspec.ValidationError:
        return data, ()
    known = {name for entry in tuple(ROBOTS.values()) for name in specs(entry.parameters)}
    known |= FORMER_NAMES.keys()
    gains = {n for robot in stored.robots.values() for n in robot.parameters if n not in known}
    chosen = stored.laws.items()
    absent = {side: law for side, law in chosen if not is_text(law) and law not in LAWS}
    robots = {
        name: msgspec.structs.replace(robot, parameters=_without(robot.parameters, gains))
        for name, robot in stored.robots.items()
    }
    laws = _without(stored.laws, absent)
    remaining = msgspec.structs.replace(stored, robots=robots, laws=laws)
    return msgspec.to_builtins(remaining), (*sorted({*absent.values()}), *sorted(gains))


def without_absent_robots(data: Any) -> tuple[Any, tuple[str, ...]]:
    """A stored set-up without robots from files that this process was not given, and their names.

    If its current robot is absent, it is a new lab's. The data need not be valid otherwise.
    """
    try:
        stored = msgspec.convert(as_of_today(data), StoredSetup)
    except msgspec.ValidationError:
        return data, ()
    absent = {name for name in (stored.robot, *stored.robots) if is_absent(name)}
    changes: dict[str, Any] = {"robots": _without(stored.robots, absent)}
    if stored.robot in absent:
        changes |= {"robot": Setup().robot, "laws": {}}
    return msgspec.to_builtins(msgspec.structs.replace(stored, **changes)), (*sorted(absent),)


def _without(values: Mapping[str, T], names: Collection[str]) -> dict[str, T]:
    return {name: value for name, value in values.items() if name not in names}
