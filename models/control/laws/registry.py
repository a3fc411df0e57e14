"""The registry of control laws: every module of this folder that defines a `LAW`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules

from onpath.models.control import laws
from onpath.models.control.laws.law import Law, OwnGain
from onpath.models.control.laws.law_error import error_in
from onpath.models.control.laws.own import is_text, own_law, tidy
from onpath.models.control.laws.path_following import LAW as PATH_FOLLOWING
from onpath.models.control.laws.trajectory_tracking import LAW as TRAJECTORY_TRACKING
from onpath.models.errors import CodedError
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import checked, unknown_name
from onpath.models.systems.parameters import declared


def found_laws() -> dict[str, Law]:
    """The laws of the modules of `models/control/laws`, by name.

    Trajectory tracking and path following come first, then the others in the order of the modules'
    names.

    Raises:
        ValueError: two laws have the same name, or a module has an error.
    """
    found = {law.name: law for law in (TRAJECTORY_TRACKING, PATH_FOLLOWING)}
    for module in iter_modules(laws.__path__, f"{laws.__name__}."):
        if module.name == __name__:
            continue
        law = _law_of(module.name)
        if law is None or found.get(law.name) is law:
            continue
        if law.name in found:
            raise ValueError(f"{module.name}: there is another law named {law.name!r}")
        found[law.name] = law
    return found


def _law_of(module: str) -> Law | None:
    try:
        return getattr(import_module(module), "LAW", None)
    except Exception as error:
        spec = find_spec(module)
        file = spec.origin if spec and spec.origin else module
        raise error_in(module.rpartition(".")[2], error, file) from error


def law_named(name: str) -> Law:
    """The law of this name, or the typed law of this text; see models/control/laws/own.py.

    Raises:
        ValueError: there is no such law.
    """
    if is_text(name):
        return own_law(name)
    if name not in LAWS:
        raise unknown_name(name, list(LAWS), "law")
    return LAWS[name]


def add_law(law: Law, name: str = "") -> Law:
    """Add a custom law, which its name then finds; a second law of a name gets a number.

    In a lab, call it before the server listens: pages expect that the laws stay the same.

    Args:
        name: the name that another process has given it.

    Returns:
        The law, with the name that it has got.

    Raises:
        CodedError: a law of OnPath has this name.
        ValueError: a gain has the name of another, or a bad one.
    """
    base, number = law.name, 1
    if base in _FOUND or is_text(base):
        raise CodedError("error.law_same_name", law=base)
    law = replace(law, name=name or base)
    # The source tells no laws apart: one whose file uses it itself is added without it at first.
    while not name and replace(_ADDED.get(law.name, law), source=law.source) != law:
        number += 1
        law = replace(law, name=f"{base}_{number}")
    versions = {base, *_versions(base)}
    others = [each for each in LAWS.values() if each.name not in versions]
    taken = {gain.name for other in others for gain in other.own_gains}
    if twice := taken & {gain.name for gain in law.own_gains}:
        raise ValueError(f"{law.name}: its gain {min(twice)!r} is one of another law, too")
    OWN_GAINS.update(gains_of([law]))
    LAWS[law.name] = _ADDED[law.name] = law
    return law


def _versions(base: str) -> list[str]:
    """Names of the further laws that have been added under a name."""
    return [name for name in LAWS if re.fullmatch(re.escape(base) + r"_\d+", name)]


def law_name(text: str) -> str:
    """The name of a law that a user wants: one of the registry, or a typed law on one line.

    Raises:
        ValueError: there is no such law.
    """
    name = law_named(text).name
    if is_text(name):
        name = own_law(tidy(name)).name  # which may be longer than the text
    return name


def gains_of(laws: Iterable[Law]) -> dict[str, OwnGain]:
    """The own gains of laws, by name.

    Raises:
        ValueError: a name that is not valid or is already in use.
    """
    found = dict[str, OwnGain]()
    for law in laws:
        for gain in law.own_gains:
            robots = [r.name for r in ROBOTS.values() if gain.name in declared(r.parameters)]
            if robots or gain.name in found:
                others = robots or ["another law"]
                raise ValueError(f"{law.name}: its gain {gain.name!r} is one of {others[0]}, too")
            if not gain.name.isidentifier():
                raise ValueError(f"{law.name}: {gain.name!r} cannot be the name of a gain")
            checked(gain.spec, gain.name, gain.default)
            found[gain.name] = gain
    return dict(sorted(found.items()))


LAWS = found_laws()
_FOUND = frozenset(LAWS)
_ADDED = dict[str, Law]()  # all laws ever added: a name means one law, since loops are kept by it
NAMES = (TRAJECTORY_TRACKING.name, PATH_FOLLOWING.name)
"""The two laws of a new lab, which the paper's experiments compare."""
SHARED_GAINS = ("K1", "K2", "K3", "K4", "K5")
OWN_GAINS = gains_of(LAWS.values())
"""The gains of single laws, by name."""
