"""All names that a lesson may use, as Markdown."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import Any, get_args

from onpath.lessons.record import PLOTS, QUANTITIES
from onpath.lessons.symbols import SYMBOLS
from onpath.lessons.task_schema import During, Stat
from onpath.lessons.vocabulary.names import CONTROLS, DRAWINGS, EVENTS
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS, step_specs
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import value_of
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Spec


def names_markdown() -> str:
    """The lists and tables of all names."""
    words = Words()
    lists: dict[str, Iterable[tuple[str, str]]] = {
        "robots": ((name, entry.label) for name, entry in ROBOTS.items()),
        "paths": ((name, "") for name in presets()),
        "laws": ((name, law.label) for name, law in LAWS.items()),
        "plots": ((name, words(f"plot.{name}")) for name in PLOTS),
        "drawings, for `show`": ((name, "") for name in DRAWINGS),
        "symbols": ((name, words(f"symbol.{name}")) for name in SYMBOLS),
        "controls": ((name, "") for name in CONTROLS),
        "quantities": ((name, f"[{unit}]") for name, unit in QUANTITIES.items()),
        "stat": ((name, "") for name in get_args(Stat)),
        "during": ((name, "") for name in get_args(During)),
        "events": ((name, "") for name in EVENTS),
    }
    lines = [f"- **{what}**: {', '.join(map(_listed, names))}" for what, names in lists.items()]
    heads = ["| parameter | | unit | values | in a new lab |", "|---|---|---|---|---|"]
    return "\n".join([*lines, "", *heads, *_parameter_rows()]) + "\n"


def _listed(each: tuple[str, str]) -> str:
    name, label = each
    return f"`{name}` {label}".rstrip()


def _parameter_rows() -> Iterator[str]:
    """A row for each parameter, or several if it differs between robots."""
    found = defaultdict[tuple[str, ...], list[str]](list)
    for robot, entry in ROBOTS.items():
        for name, spec in step_specs(entry.parameters).items():
            own, parameters = SETTINGS.get(name), entry.parameters()
            default = _value(own.default if own else value_of(parameters, name))
            found[name, spec.label, spec.unit, _values(spec), default].append(robot)
    for (name, label, unit, values, default), robots in found.items():
        where = "" if len(robots) == len(ROBOTS) else f" ({', '.join(robots)})"
        yield f"| `{name}`{where} | {label} | {unit} | {values} | {default} |"


def _values(spec: Spec) -> str:
    if spec.options:
        return ", ".join(f"`{option}`" for option in spec.options)
    return f"{spec.low:g} to {spec.high:g}"


def _value(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
