"""What can be plotted over time under the stage: one row for each quantity, with one time axis."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache

from msgspec import Struct
from msgspec.structs import replace

from onpath.lessons.words import Words
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.guessed_numbers import with_mark

MOST_LINES = 3  # of one robot in a row
XI = ("xi", "xi_rate")
"""Fields whose unit is another one with a level set."""
ALWAYS = ("distance", "theta", "theta_ref", "y", "force")
"""Fields that every frame of the data channel has; see app/channel/data_frame.py."""
TORQUE = "N m"  # unit of a motor that turns
AREA = 100.0  # a level set is 100 mm² where the distance to a circle of 50 mm is 1 mm

Fields = tuple[tuple[str, int], ...]
"""Names of the stored fields and their sizes; see plot_samples.py."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlotRow:
    """A quantity that can be plotted.

    Attributes:
        name: identifier in the catalogue of messages and in lessons.
        field: of a sample.
        scale: factor from SI to displayed units.
        finest: what the data channel rounds to, in displayed units.
        least: the range that the axis has at least, so that a ripple of a micrometre does not fill
            it.
        floats: whether the axis needs not contain zero; only the size of `least` counts then.
        symbols: names of the field's components; empty: a single line is named after its robot.
        beside: a field whose line stands beside this one, and the key of its name.
    """

    name: str
    field: str
    scale: float
    finest: float
    least: tuple[float, float]
    symbols: tuple[str, ...] = ()
    floats: bool = False
    beside: tuple[str, str] | None = None


class RowLine(Struct, frozen=True):
    """A line of each robot in a row: a number of a field.

    Attributes:
        at: index in the field.
        name: if that of the robot is not enough, else empty.
    """

    field: str
    at: int
    name: str


class RowData(Struct, frozen=True, kw_only=True):
    """A quantity that can be plotted over time, for a page.

    Attributes:
        menu: what it is called where one chooses it.
        label: what it is called at its axis.
        scale: factor from SI to the unit.
        least: the range that its axis has at least; if it `floats`, the size of this range,
            wherever.
    """

    name: str
    menu: str
    label: str
    unit: str
    scale: float
    least: tuple[float, float]
    floats: bool
    lines: tuple[RowLine, ...]


ROWS = (
    PlotRow(name="distance", field="distance", scale=1e3, finest=0.01, least=(0.0, 5.0)),
    PlotRow(name="speed", field="speed", scale=1e3, finest=0.1, least=(0.0, 10.0)),
    PlotRow(
        name="torques",
        field="u",
        scale=1.0,
        finest=1e-4,
        least=(-0.01, 0.01),
        symbols=("u₁", "u₂", "u₃"),
    ),
    PlotRow(
        name="across", field="xi", scale=1e3, finest=0.01, least=(-1.0, 1.0), symbols=("ξ₁", "ξ₃")
    ),
    PlotRow(
        name="across_rate",
        field="xi_rate",
        scale=1e3,
        finest=0.1,
        least=(-10.0, 10.0),
        symbols=("ξ₂", "ξ₄"),
    ),
    PlotRow(
        name="place",
        field="theta",
        scale=1.0,
        finest=1e-3,
        least=(0.0, 0.2),
        floats=True,
        beside=("theta_ref", "plots.theta_ref"),
    ),
    PlotRow(name="rate", field="theta_rate", scale=1.0, finest=1e-3, least=(-0.1, 0.1)),
    PlotRow(
        name="modes",
        field="modes",
        scale=1e3,
        finest=1e-4,
        least=(-0.01, 0.01),
        symbols=("f₁", "f₂", "f₃"),
    ),
    PlotRow(name="deflection", field="deflection", scale=1e3, finest=1e-4, least=(-0.01, 0.01)),
    PlotRow(name="energy", field="internal_energy", scale=1e3, finest=1e-4, least=(0.0, 0.005)),
    PlotRow(
        name="force",
        field="force",
        scale=1.0,
        finest=0.01,
        least=(-0.1, 0.1),
        symbols=("F₁", "F₂", "F₃"),
    ),
)
ASKED = tuple(row.field for row in ROWS if row.field not in ALWAYS)
"""Fields that a page may ask for besides `ALWAYS`."""
_OF_FIELD = {row.field: row for row in ROWS}


def motor_row(motors: Collection[str]) -> str:
    """What the row of the motors is called, by their units: "torques", "forces" or "mixed"."""
    if TORQUE not in motors:
        return "forces"
    return "mixed" if len(set(motors)) > 1 else "torques"


def rounding(field: str, is_level_set: bool) -> float:
    """How many units of the data channel an SI unit of a field has."""
    row = _OF_FIELD[field]
    return (row.scale**2 if is_level_set and field in XI else row.scale) / row.finest


def row_data(
    fields: Fields,
    is_level_set: bool,
    words: Words,
    guesses: Sequence[Guess] = (),
    motors: Sequence[str] = (TORQUE,),
) -> list[RowData]:
    """The rows that a robot can have, for a page.

    Args:
        fields: that are stored of the robot.
        is_level_set: whether ξ₁ is an area, [m²], instead of a distance.
        guesses: about the robot; rows that rest on them are marked.
        motors: their units, see `MechanicalSystem.motor_units`.
    """
    plain = _rows(fields, is_level_set, words, frozenset(motors))
    if not guesses:
        return plain
    names = {row.name: "tau" if row.field == "u" else row.field for row in ROWS}
    return [
        replace(row, label=with_mark(row.label, guesses, names[row.name], words.language))
        for row in plain
    ]


@lru_cache(maxsize=64)
def _rows(
    fields: Fields, is_level_set: bool, words: Words, motors: frozenset[str]
) -> list[RowData]:
    sizes = dict(fields)
    rows = [
        _data(row, min(sizes[row.field], MOST_LINES), is_level_set and row.field in XI, words)
        for row in ROWS
        if row.field in sizes
    ]
    kind = motor_row(motors)
    if kind == "torques":
        return rows
    label, unit = _title(words(f"axis.{kind}"))
    pushed = {"menu": words(f"plot.{kind}"), "label": label, "unit": unit}
    return [replace(row, **pushed) if row.name == "torques" else row for row in rows]


def _data(row: PlotRow, size: int, is_area: bool, words: Words) -> RowData:
    if is_area:  # only the first line: the others have another unit
        size = 1
    kind = "-level_set" if is_area else "-space" if row.field in XI and size > 1 else ""
    label, unit = _title(words(f"axis.{row.name}{kind}"))
    symbols: Sequence[str] = row.symbols[:size] if size > 1 else ("",)
    lines = [RowLine(row.field, i, name) for i, name in enumerate(symbols)]
    if row.beside is not None:
        field, key = row.beside
        lines.append(RowLine(field, 0, words(key)))
    low, high = row.least
    return RowData(
        name=row.name,
        menu=words(f"plot.{row.name}"),
        label=label,
        unit=unit,
        scale=row.scale**2 if is_area else row.scale,
        least=(AREA * low, AREA * high) if is_area else (low, high),
        floats=row.floats,
        lines=tuple(lines),
    )


def _title(axis: str) -> tuple[str, str]:
    """Label and unit of an axis. The label begins with a capital letter, unless with a symbol."""
    label, unit = axis.removesuffix("]").rsplit(" [", 1)
    return label[0].upper() + label[1:] if label[0].isascii() else label, unit
