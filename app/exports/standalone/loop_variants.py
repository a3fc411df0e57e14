"""The loops of a figure on whose page parameters change that need another loop.

A variant is a kind of loop that some values of such parameters need. All variants of a law share
the layouts of state and settings, so that a run goes on under another one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.simulation import check_level_set
from onpath.models.control.settable import specs, value_of, with_values
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters, time_step


@dataclass(frozen=True)
class Variants:
    """The loops of all values of the parameters that need different ones.

    Attributes:
        names: of these parameters.
        keys: the class of each parameter's value, in the order of `names` and joined by commas ->
            number of the variant; 0 is that of the figure's own parameters. The class of a number
            is 0 or 1, "off" or "on"; that of a choice the index of the option.
        parameters: with which each variant is made.
    """

    names: tuple[str, ...]
    keys: Mapping[str, int]
    parameters: tuple[Parameters, ...]


def variants_of(figure: FigureChoice) -> Variants:
    """The variants of a figure's loops."""
    known = specs(figure.parameters)
    classes = {name: _classes(known[name]) for name in figure.changing}
    names = tuple(name for name in classes if _matters(figure, name, classes))
    own = figure.parameters
    kinds, found, keys = [_kinds(figure, own)], [own], dict[str, int]()
    for some in product(*(enumerate(classes[name]) for name in names)):
        values = dict(zip(names, (value for _, value in some), strict=True))
        parameters = with_values(own, values)
        if not _can_go_on(figure, parameters):
            continue
        needed = _kinds(figure, parameters)
        if needed not in kinds:
            kinds.append(needed)
            found.append(parameters)
        keys[",".join(str(number) for number, _ in some)] = kinds.index(needed)
    return Variants(names=names, keys=keys, parameters=tuple(found))


def loops_of(figure: FigureChoice, curve: Curve) -> dict[str, Kernel]:
    """The loops of all laws and variants on a path, as the page calls them."""
    loops = dict[str, Kernel]()
    for variant, parameters in enumerate(variants_of(figure).parameters):
        changed = replace(figure, parameters=parameters)
        for law, name in enumerate(figure.every_law):
            loops[loop_name(law, variant)] = changed.kernel(name, curve)
    return loops


def loop_name(law: int, variant: int) -> str:
    """The name of a loop, before that of the path's kind."""
    return f"loop{law}v{variant}" if variant else f"loop{law}"


def _classes(spec: Spec) -> tuple[Any, ...]:
    """A value of each class."""
    if spec.options:
        return spec.options
    return (0.0, spec.high) if spec.low <= 0 <= spec.high else (spec.high,)


def _matters(figure: FigureChoice, name: str, classes: Mapping[str, tuple[Any, ...]]) -> bool:
    """Whether a parameter's value decides which loop is needed, alone or with others."""
    every = {other: values[-1] for other, values in classes.items() if other != name}
    bases = [figure.parameters, *_possible(figure, every)]
    return any(
        len({_kinds(figure, each) for value in classes[name] for each in _with(base, name, value)})
        > 1
        for base in bases
    )


def _possible(figure: FigureChoice, values: Mapping[str, Any]) -> Iterator[Parameters]:
    """The figure's parameters with as many of these values as are possible together."""
    parameters = figure.parameters
    for name, value in values.items():
        for after in _with(parameters, name, value):
            parameters = after if _can_go_on(figure, after) else parameters
    yield parameters


def _with(parameters: Parameters, name: str, value: Any) -> Iterator[Parameters]:
    if value_of(parameters, name) == value:
        yield parameters
        return
    yield with_values(parameters, {name: value})


def _kinds(figure: FigureChoice, parameters: Parameters) -> tuple[Any, ...]:
    """The robot's equations, and the kinds of the loops of all laws on all paths."""
    changed = replace(figure, parameters=parameters)
    kinds = (
        changed.kind(law, curve) for curve in figure.paths.values() for law in figure.every_law
    )
    return changed.machine.core, *kinds


def _can_go_on(figure: FigureChoice, parameters: Parameters) -> bool:
    """Whether a run goes on with other parameters: the same robot, ticks and paths."""
    try:
        for curve in figure.paths.values():
            check_level_set(parameters, curve)
    except ValueError:
        return False
    return goes_on(figure, figure.parameters, parameters)


def goes_on(figure: FigureChoice, before: Parameters, after: Parameters) -> bool:
    """Whether robots that run with some parameters go on with others."""
    return figure.entry.keeps_states(before, after) and time_step(before) == time_step(after)
