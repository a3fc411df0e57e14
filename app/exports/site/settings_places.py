"""The numbers that a parameter sets in a figure's settings."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping

import numpy as np

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.lessons.action_schema import Value
from onpath.models.closed_loop.simulation import check_level_set
from onpath.models.control.settable import changed, specs, value_of, with_values
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters, time_step

Writes = list[tuple[int, float]]
"""Places in the settings, and the numbers that belong there."""


class Unsupported(ValueError):
    """A page without a server cannot do this, because it would need other loops or numbers."""


def writes(figure: FigureChoice, values: Mapping[str, Value], before: Parameters) -> Writes:
    """The numbers to write into the settings to give some parameters other values.

    Args:
        before: the parameters before the change.

    Raises:
        Unsupported: another loop would be needed, or different numbers for the sides or paths.
    """
    after = with_values(before, values)
    per_side = [_writes(figure, law, values, before, after) for law in figure.laws]
    if any(each != per_side[0] for each in per_side):
        raise Unsupported(f"{', '.join(values)}: another number for each side")
    return per_side[0]


def _writes(
    figure: FigureChoice,
    law: str,
    values: Mapping[str, Value],
    before: Parameters,
    after: Parameters,
) -> Writes:
    curves = list(figure.paths.values())
    found = set[int]()
    for name in values:
        for other in _others(before, name):
            for curve in curves:
                if _goes_on(figure, law, curve, before, other):
                    found |= _differing(figure, law, curve, after, other, name)
    result: Writes = []
    for curve in curves:
        if not _goes_on(figure, law, curve, before, after):
            raise Unsupported(f"{', '.join(values)}: another loop")
        old, new = (figure.settings(law, curve, each) for each in (before, after))
        found |= set(np.flatnonzero(old != new).tolist())
    for place in sorted(found):
        numbers = {float(figure.settings(law, curve, after)[place]) for curve in curves}
        if len(numbers) > 1:
            raise Unsupported(f"{', '.join(values)}: another number for each path")
        result.append((place, numbers.pop()))
    return result


def _others(parameters: Parameters, name: str) -> Iterator[Parameters]:
    """The parameters with the least and the largest value of one, or with each of its options."""
    spec = specs(parameters)[name]
    for value in spec.options or (spec.low, spec.high):
        yield changed(parameters, name, value)


def _differing(
    figure: FigureChoice, law: str, curve: Curve, after: Parameters, other: Parameters, name: str
) -> set[int]:
    """Places that depend on one parameter, whatever its previous value."""
    swapped = changed(after, name, value_of(other, name))
    if not _goes_on(figure, law, curve, after, swapped):
        return set()
    old, new = (figure.settings(law, curve, each) for each in (after, swapped))
    return set(np.flatnonzero(old != new).tolist())


def _goes_on(
    figure: FigureChoice, law: str, curve: Curve, before: Parameters, after: Parameters
) -> bool:
    """Whether the same loop and the same first state serve both."""
    old, new = (dataclasses.replace(figure, parameters=each) for each in (before, after))
    try:
        check_level_set(after, curve)
        return (
            old.kind(law, curve) == new.kind(law, curve)
            and time_step(before) == time_step(after)
            and np.array_equal(old.start(law, curve), new.start(law, curve))
        )
    except ValueError:
        return False
