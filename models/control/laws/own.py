"""Typed laws: formulas that a user types.

A law names what it commands, in the names of `VIEW`:

    across = -K1*xi - K2*dxi - K3*int_xi        λ'' = v_perp of (18), [m/s²]
    along = -K5*(dtheta - speed)                θ'' = v_par of (19), [rad/s²]

or the torques of all motors, `u1 = …`, `u2 = …`, [N m]. In space (p = 3) `across2` is the
acceleration along the second normal; without it, that is -K1 xi2 - K2 dxi2 - K3 int_xi2.

A law's text is its name: every function that takes the name of a law takes a text as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, reduce

import casadi as ca

from onpath.models.control.laws.expressions import LARGEST_NUMBER, Formulas, read
from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.path_following import followed
from onpath.models.control.laws.references import (
    clock_ahead,
    clock_rate,
    rate_at,
    tracking_error,
)
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import MINUS

MOST_KEPT = 256  # laws whose formulas are kept: two for each lab of a large class
OWN = "own"  # name of typed laws where the text does not matter
LABEL = "Own law"
PATH_FOLLOWING = "across = -K1*xi - K2*dxi - K3*int_xi; along = -K5*(dtheta - speed)"
"""The law with which a user begins: path following, eqs. (18) and (19), in the speed task."""

TIME = "own_time"


@dataclass(frozen=True, slots=True)
class NamedValue:
    """The meaning of a name in a law, or of the names of several components.

    Attributes:
        names: the catalogues have the meaning under the first of them, `law-own-<name>`.
        meaning: in English.
        unit: for distances across the path in metres; a level set has its own unit.
    """

    names: tuple[str, ...]
    meaning: str
    unit: str


MEANINGS = (
    NamedValue(("xi",), "distance from the path, positive on its left", "m"),
    NamedValue(("dxi",), "rate of xi", "m/s"),
    NamedValue(("theta",), "parameter of the closest point of the path", "rad"),
    NamedValue(("dtheta",), "rate of theta: the speed along the path", "rad/s"),
    NamedValue(("e1", "e2"), "error: from the point that runs by the clock to the end-point", "m"),
    NamedValue(("de1", "de2"), "rate of the error", "m/s"),
    NamedValue(("y1", "y2"), "position of the end-point", "m"),
    NamedValue(("v1", "v2"), "velocity of the end-point", "m/s"),
    NamedValue(("t",), "time since the law was chosen", "s"),
    NamedValue(("theta_r",), "parameter of the point that runs by the clock", "rad"),
    NamedValue(("speed",), "wanted speed along the path", "rad/s"),
    NamedValue(
        ("int_xi",),
        "integral of xi; it stops at a torque limit, and K3 int_xi is limited",
        "m s",
    ),
    NamedValue(
        ("K1", "K2", "K3", "K4", "K5"), "the gains as they are set", "1/s², 1/s, 1/s³, 1/s², 1/s"
    ),
)
"""The names of a law, in the order in which a user is shown them."""
SPACE_MEANINGS = (
    NamedValue(("xi2",), "second distance from the path", "m"),
    NamedValue(("dxi2",), "rate of xi2", "m/s"),
    NamedValue(("int_xi2",), "integral of xi2", "m s"),
    NamedValue(("e3",), "third component of the error", "m"),
    NamedValue(("de3",), "its rate", "m/s"),
    NamedValue(("y3",), "third coordinate of the end-point", "m"),
    NamedValue(("v3",), "third component of its velocity", "m/s"),
)
"""Additional names in space."""
VIEW = tuple(name for value in MEANINGS for name in value.names)
SPACE = tuple(name for value in SPACE_MEANINGS for name in value.names)
ERRORS = frozenset(("e1", "e2", "e3", "de1", "de2", "de3"))
TARGETS = ("across", "along", "across2", "u1", "u2", "u3")


def is_text(name: str) -> bool:
    """Whether the name of a law is the text of one."""
    return "=" in name


def short_name(name: str) -> str:
    """A law's name, or `OWN` in place of a text."""
    return OWN if is_text(name) else name


def law_title(name: str) -> str:
    """A law's name as English words, or its text."""
    return name if is_text(name) else name.replace("_", " ")


@lru_cache(MOST_KEPT)
def own_law(text: str) -> Law:
    """The law that a text describes.

    Raises:
        ValueError: the text describes no law; see `expressions.read`.
    """
    formulas = formulas_of(text)
    names = frozenset(formulas.names)
    motors = sum(target.startswith("u") for target in formulas.targets)
    return Law(
        name=text,
        label=LABEL,
        text=text,
        source="typed",
        command=lambda view: _command(formulas, view),
        reference=clock_ahead if names & ERRORS else None,
        aim="theta_ref" if names & (ERRORS | {"theta_r"}) else "theta",
        gains=tuple(name for name in formulas.names if name.startswith("K")),
        memory=((TIME, 1),),
        motors=motors or None,
        spatial=not names.isdisjoint(SPACE) or "across2" in formulas.targets,
        commands_acceleration=motors == 0,
        always_integrates="int_xi" in names or "int_xi2" in names,
    )


@lru_cache(MOST_KEPT)
def formulas_of(text: str) -> Formulas:
    """The formulas of a typed law.

    Raises:
        ValueError: see `own_law`.
    """
    formulas = read(text, (*VIEW, *SPACE), TARGETS)
    _check_targets(formulas.targets)
    return formulas


def tidy(text: str) -> str:
    """The same law on one line, without blanks at the ends of its lines, with plain minus signs."""
    lines = (line.strip() for line in text.replace(MINUS, "-").replace("\n", ";").split(";"))
    return "; ".join(line for line in lines if line)


def _check_targets(given: tuple[str, ...]) -> None:
    """Refuse a law with incomplete commands, or with both accelerations and torques."""
    torques = [target for target in given if target.startswith("u")]
    if not torques:
        wanted = ["across", "along"]
    elif len(torques) < len(given):
        raise CodedError("error.law_mixed")
    else:
        wanted = [f"u{i + 1}" for i in range(max(int(torque[1:]) for torque in torques))]
    missing = [target for target in wanted if target not in given]
    if missing:
        raise CodedError("error.law_without_line", name=missing[0])


def _command(formulas: Formulas, view: View) -> ControlAction:
    """The command of the formulas; none in a tick in which a number is not finite or is huge.

    After such a tick the reference point is NaN, so that the run stops as diverged.
    """
    values, clock, error = _values(view), view.clock, ca.vertcat(view.output.xi, 0)
    results = formulas(values)
    valid = reduce(ca.fmin, [ca.fabs(result) < LARGEST_NUMBER for result in results.values()])
    results = {name: ca.if_else(valid, result, 0) for name, result in results.items()}
    theta_ref = clock.theta + clock.dt * clock_rate(clock)
    theta_ref = ca.if_else(valid, theta_ref, ca.SX(float("nan")))
    memory = {TIME: clock.memory[TIME] + clock.interval}
    if "along" not in results:
        torque = ca.vertcat(*(results[name] for name in sorted(results)))
        return ControlAction(torque=torque, error=error, theta_ref=theta_ref, memory=memory)
    across = ca.vertcat(results["across"], *_second_normal(view, values, results))
    direction = view.output.acceleration_per_along
    action = followed(view, results["along"], across, direction)
    return replace(action, theta_ref=theta_ref, memory=memory)


def _second_normal(
    view: View, values: Mapping[str, ca.SX], results: Mapping[str, ca.SX]
) -> list[ca.SX]:
    """The acceleration along the second normal, if there is one."""
    if view.frame.p == 2:
        return []
    gains = view.gains
    given = -gains.k1 * values["xi2"] - gains.k2 * values["dxi2"] - gains.k3 * values["int_xi2"]
    return [results.get("across2", given)]


def _values(view: View) -> dict[str, ca.SX]:
    """The values of the names.

    Components are numbered from 1; the first one of `xi`, `dxi` and `int_xi` has no number.
    """
    output, clock, gains = view.output, view.clock, view.gains
    values = {
        "theta": output.theta,
        "dtheta": output.theta_rate,
        "t": clock.memory[TIME] + clock.ahead,
        "theta_r": clock_ahead(clock),
        "speed": ca.fmin(ca.fmax(rate_at(view), -view.task.limit), view.task.limit),
        **{
            f"K{i + 1}": k for i, k in enumerate((gains.k1, gains.k2, gains.k3, gains.k4, gains.k5))
        },
    }
    integral = view.integral[: view.frame.p - 1]
    for name, parts in (("xi", output.xi), ("dxi", output.xi_rate), ("int_xi", integral)):
        values |= {f"{name}{i + 1 if i else ''}": parts[i] for i in range(view.frame.p - 1)}
    vectors = {"y": view.y, "v": view.y_rate}
    if view.reference is not None:
        vectors["e"], vectors["de"], _ = tracking_error(
            view.reference, view.frame, view.y, view.y_rate, clock_rate(clock)
        )
    for name, vector in vectors.items():
        values |= {f"{name}{i + 1}": vector[i] for i in range(view.frame.p)}
    return values
