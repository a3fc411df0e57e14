"""The registry of control laws: every module of this folder that defines a `LAW`."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules

from onpath.models.control import laws
from onpath.models.control.laws.law import Law, OwnGain
from onpath.models.control.laws.law_error import error_in
from onpath.models.control.laws.own import is_text, own_law, tidy
from onpath.models.control.laws.path_following import LAW as PATH_FOLLOWING
from onpath.models.control.laws.trajectory_tracking import LAW as TRAJECTORY_TRACKING
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
NAMES = (TRAJECTORY_TRACKING.name, PATH_FOLLOWING.name)
"""The two laws of a new lab, which the paper's experiments compare."""
SHARED_GAINS = ("K1", "K2", "K3", "K4", "K5")
OWN_GAINS = gains_of(LAWS.values())
"""The gains of single laws, by name."""
