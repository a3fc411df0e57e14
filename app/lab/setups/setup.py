"""A lab's set-up as plain data, to be stored, shared and restored.

It holds the differences from a new lab, so a new lab is `Setup()`. Lengths of a path are whole
micrometres and numbers have six digits, so that capturing a restored set-up gives the same one.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import msgspec

from onpath.models.control.laws.expressions import LONGEST
from onpath.models.control.sides import SIDES
from onpath.models.paths.spline_curves import TABLE_POINTS
from onpath.models.systems.catalogue import FIVE_BAR

UNIT = 1e-6  # [m], unit of the numbers of a path
EDITED, DRAWN, DRAWING = "edited", "drawn", "drawing"  # names of paths that are not presets
MOST_LINKS = 512  # of a drawing

Word = Annotated[str, msgspec.Meta(max_length=40, pattern=r"^[A-Za-z0-9_ -]*$")]
LawName = Annotated[str, msgspec.Meta(max_length=LONGEST)]
"""The name of a control law, or a typed law; `checked_laws` reads it."""
LONGEST_WORD = 80
FileWord = Annotated[str, msgspec.Meta(max_length=LONGEST_WORD)]
"""A name that is only shown."""
Values = Annotated[dict[Word, bool | int | float | Word], msgspec.Meta(max_length=100)]
Length = Annotated[int, msgspec.Meta(ge=-1_000_000, le=1_000_000)]
Lengths = Annotated[tuple[Length, ...], msgspec.Meta(max_length=2 * TABLE_POINTS)]
Times = Annotated[int, msgspec.Meta(ge=-1_000_000, le=1_000_000)]
Links = Annotated[tuple[Times, ...], msgspec.Meta(max_length=2 * MOST_LINKS)]


class Path(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Path of a set-up.

    Attributes:
        name: of a preset, or "edited", "drawn" or "drawing".
        closed: whether an edited or drawn path is closed.
        numbers: alternating x and y, [UNIT]: control points of an edited path, coefficients of a
            drawn path in the order of `Curve.series`, of a drawing's control points the second
            differences, the first one beginning at 0; empty for a preset.
        raised: of a drawing, `SplineCurve.raised` in whole 10^-`DECIMALS` rad.
        duration: of a drawing, `SplineCurve.duration` in whole 10^-`DECIMALS` s.
    """

    name: Word = "circle"
    closed: bool = True
    numbers: Lengths = ()
    raised: Links = ()
    duration: Annotated[int, msgspec.Meta(ge=0, le=100_000_000)] = 0


class RobotSetup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One robot's path, and its parameters and settings where they differ from the initial ones.

    Attributes:
        settings: those of `LabSettings` that each robot has for itself.
        file, tip: name of the file of a robot from a file, and its end-point, for whoever has not
            started the lab with it.
    """

    parameters: Values = {}
    path: Path = Path()
    settings: Values = {}
    file: FileWord = ""
    tip: FileWord = ""


class Setup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A whole lab: the current robot, the set-up of each robot, and the lab's own settings.

    Attributes:
        robots: the set-up of each robot, by name; stored as "benches".
        laws: control laws that differ from a new lab's, by side.
        settings: the lab's own settings that differ from a new lab's.
    """

    robot: Word = FIVE_BAR.name
    robots: Annotated[dict[Word, RobotSetup], msgspec.Meta(max_length=100)] = msgspec.field(
        default_factory=dict[str, RobotSetup], name="benches"
    )
    laws: Annotated[dict[Word, LawName], msgspec.Meta(max_length=len(SIDES))] = {}
    settings: Values = {}


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
