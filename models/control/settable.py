"""Everything a user may set by name: the parameters of a robot, and the gains of single laws."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any, TypeVar

from onpath.models.control.laws.law import OwnGain
from onpath.models.control.laws.registry import OWN_GAINS
from onpath.models.systems.parameter_specs import Spec, checked, unknown_name
from onpath.models.systems.parameters import Parameters, declared

P = TypeVar("P", bound=Parameters)


def specs(kind: type[Parameters] | Parameters) -> Mapping[str, Spec]:
    """Name -> declaration of everything that can be set; the gains of single laws come last."""
    return _specs(kind if isinstance(kind, type) else type(kind), tuple(OWN_GAINS.values()))


@lru_cache(maxsize=64)
def _specs(kind: type[Parameters], own: tuple[OwnGain, ...]) -> Mapping[str, Spec]:
    return MappingProxyType({**declared(kind), **{gain.name: gain.spec for gain in own}})


def value_of(parameters: Parameters, name: str) -> Any:
    """The value that a name of `specs` has."""
    gain = OWN_GAINS.get(name)
    return getattr(parameters, name) if gain is None else gain.of(parameters)


def values_of(parameters: Parameters) -> dict[str, Any]:
    """The values of all names of `specs`."""
    return {name: value_of(parameters, name) for name in specs(parameters)}


def parameters_from(kind: type[P], values: Mapping[str, Any]) -> P:
    """Inverse of `values_of`; the values are not checked again."""
    shared = {name: value for name, value in values.items() if name not in OWN_GAINS}
    gains = {name: value for name, value in values.items() if name in OWN_GAINS}
    return kind(**shared, own_gains=_kept(gains))


def changed(parameters: P, name: str, value: Any) -> P:
    """The parameters with one value changed; the same object if it has that value already.

    Raises:
        ValueError: unknown name or bad value.
    """
    known = specs(parameters)
    if name not in known:
        raise unknown_name(name, list(known))
    value = checked(known[name], name, value)
    if value_of(parameters, name) == value:
        return parameters
    if name in OWN_GAINS:
        gains = _kept({**dict(parameters.own_gains), name: value})
        return dataclasses.replace(parameters, own_gains=gains)
    return dataclasses.replace(parameters, **{name: value})


def with_values(parameters: P, values: Mapping[str, Any]) -> P:
    """The parameters with several values changed.

    Raises:
        ValueError: unknown name or bad value.
    """
    for name, value in values.items():
        parameters = changed(parameters, name, value)
    return parameters


def _kept(gains: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """`LawParameters.own_gains` in a normal form: equal gains give equal tuples."""
    return tuple(sorted(each for each in gains.items() if each[1] != OWN_GAINS[each[0]].default))
