"""A lab's set-up as plain data, to be stored, shared and restored.

It holds the differences from a new lab, so a new lab is `Setup()`. Lengths of a path are whole
micrometres and numbers have six digits, so that capturing a restored set-up gives the same one.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import msgspec

from onpath.models.closed_loop.obstacles import ALONG
from onpath.models.control.laws.expressions import LONGEST
from onpath.models.control.sides import SIDES
from onpath.models.paths.curves import TERMS
from onpath.models.paths.path_design import MOST_POINTS
from onpath.models.systems.catalogue import FIVE_BAR

EXAGGERATIONS = (1.0, 20.0)  # minimum and maximum
RATES = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0)  # simulated seconds per second
UNIT = 1e-6  # [m]
EDITED, DRAWN = "edited", "drawn"  # names of paths that are not presets

Word = Annotated[str, msgspec.Meta(max_length=40, pattern=r"^[A-Za-z0-9_ -]*$")]
LawName = Annotated[str, msgspec.Meta(max_length=LONGEST)]
"""The name of a control law, or a typed law; `checked_laws` reads it."""
Length = Annotated[int, msgspec.Meta(ge=-1_000_000, le=1_000_000)]
Lengths = Annotated[tuple[Length, ...], msgspec.Meta(max_length=2 * max(TERMS, MOST_POINTS))]


class Path(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Path of a set-up.

    Attributes:
        name: of a preset, or "edited" or "drawn".
        closed: whether an edited or drawn path is closed.
        numbers: alternating x and y, [UNIT]: control points of an edited path, coefficients of a
            drawn path in the order of `Curve.series`; empty for a preset.
    """

    name: Word = "circle"
    closed: bool = True
    numbers: Lengths = ()


class RobotSetup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One robot's path, and its parameters where they differ from the initial ones.

    Attributes:
        start: where and how its runs start: the numbers of `Start` that are not 0, by name.
        wall: z1, z2 and angle of a wall in its way; empty if there is none.
    """

    parameters: Annotated[dict[Word, int | float | Word], msgspec.Meta(max_length=100)] = {}
    path: Path = Path()
    start: Annotated[dict[Word, float], msgspec.Meta(max_length=10)] = {}
    wall: Annotated[tuple[float, ...], msgspec.Meta(max_length=3)] = ()


class Setup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A whole lab: the current robot, the set-up of each robot, and the lab's switches.

    Attributes:
        robots: the set-up of each robot, by name; stored as "benches".
        laws: control laws that differ from a new lab's, by side.
        hold: direction in which brakes act.
    """

    robot: Word = FIVE_BAR.name
    robots: Annotated[dict[Word, RobotSetup], msgspec.Meta(max_length=100)] = msgspec.field(
        default_factory=dict[str, RobotSetup], name="benches"
    )
    rate: float = 1.0
    copy: bool = True
    exaggeration: float = 1.0
    laws: Annotated[dict[Word, LawName], msgspec.Meta(max_length=len(SIDES))] = {}
    hold: Word = ALONG


def plain(value: Any) -> Any:
    """A set-up or a part of it as JSON data, without default values."""
    if isinstance(value, msgspec.Struct):
        new = type(value)()
        names = zip(value.__struct_encode_fields__, value.__struct_fields__, strict=True)
        fields = {stored: (getattr(value, name), getattr(new, name)) for stored, name in names}
        return {stored: plain(now) for stored, (now, default) in fields.items() if now != default}
    if isinstance(value, Mapping):
        return {name: plain(item) for name, item in value.items()}
    return list(value) if isinstance(value, tuple) else value
