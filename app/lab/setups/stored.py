"""Set-ups as plain data.

Data name the version of the defaults that they differ from, so that those of an earlier version
keep their meaning.
"""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

from onpath.app.lab.setups.former import DEFAULTS, brought_up
from onpath.app.lab.setups.plan import planned
from onpath.app.lab.setups.setup import Setup, plain
from onpath.models.control.benches import checked_laws
from onpath.models.paths.path_design import presets


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
    stored = msgspec.convert(data, StoredSetup)
    robots = brought_up(stored.robots, stored.defaults)
    own: dict[str, Any] = {name: getattr(stored, name) for name in Setup.__struct_fields__}
    setup = Setup(**{**own, "robots": robots})
    entry = planned(setup, presets())[setup.robot].entry
    return msgspec.structs.replace(setup, laws=checked_laws(setup.laws, entry))
