"""The numbers that parameters of a figure's page set in the settings of its loops.

Most parameters are one number of the settings. For others, such as the controller's rate, a table
has the numbers of each value, so that a page contains no formula for them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.loop_variants import goes_on
from onpath.models.arrays import Array
from onpath.models.control.settable import changed, specs, value_of, with_values
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters

MOST = 300
"""Rows of a table."""
Used = Mapping[str, tuple[Any, ...]]
"""Name -> values that actions give to it."""


class Unsupported(ValueError):
    """A page without a server cannot do this, because it would need other loops or numbers."""


@dataclass(frozen=True, slots=True)
class SettingTable:
    """The numbers that some parameters set together.

    Attributes:
        names: of the parameters.
        values: their values in each row.
        indices: of the numbers in the settings.
        numbers: for each row, one for each index.
    """

    names: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]
    indices: tuple[int, ...]
    numbers: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class SettingNumbers:
    """Where the parameters act that change on a page.

    Attributes:
        indices: name -> index of its value in the settings, of those that are one number.
        tables: of the others.
    """

    indices: Mapping[str, int]
    tables: tuple[SettingTable, ...]

    @property
    def names(self) -> set[str]:
        """Of all these parameters."""
        return {*self.indices, *(name for table in self.tables for name in table.names)}


def setting_numbers(figure: FigureChoice, used: Used) -> SettingNumbers:
    """Where the changing parameters act; those whose numbers would be too many are left out.

    Parameters whose numbers depend on each other have a table of the values that actions give them.
    """
    every = dict.fromkeys((*figure.sliders, *figure.changing))
    names = [name for name in every if name not in figure.remade]
    indices, tables, rest = dict[str, int](), list[SettingTable](), list[str]()
    for name in names:
        if (index := _single(figure, name)) is not None:
            indices[name] = index
        elif (table := _steady(figure, (name,), [page_values(figure, name, used)])) is not None:
            tables.append(table)
        else:
            rest.append(name)
    own = [[value_of(figure.parameters, name), *used.get(name, ())] for name in rest]
    if rest and (table := _steady(figure, rest, own)) is not None:
        tables.append(table)
    return SettingNumbers(indices, tuple(tables))


def page_values(figure: FigureChoice, name: str, used: Used) -> tuple[Any, ...]:
    """The values that a parameter can have on the page: those with which a run goes on."""
    spec, own = specs(figure.parameters)[name], figure.parameters
    if spec.options:
        return tuple(x for x in spec.options if goes_on(figure, own, changed(own, name, x)))
    steps = round((spec.high - spec.low) / spec.step)
    grid = (round(spec.low + i * spec.step, 9) for i in range(steps + 1))
    return tuple(sorted({*grid, *used.get(name, ())}))


def _single(figure: FigureChoice, name: str) -> int | None:
    """The index of a number that is one of the settings; None if it is more or something else."""
    spec, own = specs(figure.parameters)[name], figure.parameters
    kernel = figure.kernel(figure.laws[0], next(iter(figure.paths.values())))
    where = kernel.settings.slices.get(name)
    if spec.options or where is None:
        return None
    for law, curve in _loops(figure):
        wanted = figure.settings(law, curve)
        for value in (spec.low, 0.0, spec.high):
            if spec.low <= value <= spec.high:
                wanted[where] = value
                after = changed(own, name, value)
                if not np.array_equal(wanted, _settings(figure, law, curve, after)):
                    return None
    return where.start


def _steady(
    figure: FigureChoice, names: Sequence[str], values: Sequence[Sequence[Any]]
) -> SettingTable | None:
    """The table of some parameters; None if it is long, or depends on anything else."""
    rows = list(dict.fromkeys(product(*values)))
    if len(rows) > MOST:
        return None
    found: SettingTable | None = None
    for base in _bases(figure, names):
        after = [with_values(base, dict(zip(names, row, strict=True))) for row in rows]
        for law, curve in _loops(figure):
            vectors = np.array([_settings(figure, law, curve, each) for each in after])
            indices = np.flatnonzero((vectors != vectors[0]).any(axis=0))
            table = SettingTable(
                names=tuple(names),
                values=tuple(rows),
                indices=tuple(indices.tolist()),
                numbers=tuple(tuple(row) for row in vectors[:, indices].tolist()),
            )
            if found not in (None, table):
                return None
            found = table
    return found


def _bases(figure: FigureChoice, names: Iterable[str]) -> Iterator[Parameters]:
    """The figure's parameters, and with the others at one end and at the other."""
    known, own = specs(figure.parameters), figure.parameters
    yield own
    for end in (0, -1):
        parameters = own
        for other in figure.changing:
            if other not in names:
                spec = known[other]
                values = spec.options or (spec.low, spec.high)
                after = changed(parameters, other, values[end])
                parameters = after if goes_on(figure, parameters, after) else parameters
        yield parameters


def _loops(figure: FigureChoice) -> Iterator[tuple[str, Curve]]:
    for law in figure.every_law:
        for curve in figure.paths.values():
            yield law, curve


def _settings(figure: FigureChoice, law: str, curve: Curve, parameters: Parameters) -> Array:
    return replace(figure, parameters=parameters).settings(law, curve)
