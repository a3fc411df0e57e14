"""When and why a run has diverged, and what caused it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.forecast import forecast
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.expressions import LARGEST_NUMBER
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.path_following import NEAR_TURN
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.parameters import Parameters, declared, time_step
from onpath.models.systems.robots import NOT_FINITE, Robot

MOST = f"{LARGEST_NUMBER:g}"
TYPED_LAW = Message("stop.typed_law", {"most": MOST})
BEFORE = 0.1  # [s] before a fault in which its cause is looked for
OFTEN = 0.5  # least share of that time with the motors at their limit
WRONG = 0.01  # relative difference of a parameter of the controller's model that counts as wrong
PULLED = 1.0  # [N]
AWAY = 0.5  # share of the smallest radius on the way, from which on an error is not small
BETWEEN = 64  # points on that way, from the robot's point to the reference point


def not_finite(law: str) -> Message:
    """The reason why a state that is not finite stops a run under this law."""
    if is_text(law):
        return TYPED_LAW
    origin = law_named(law).origin
    if origin is None:
        return NOT_FINITE
    file, line = Path(origin[0]).name, str(origin[1])
    return Message("stop.own_law", {"law": law, "most": MOST, "file": file, "line": line})


def fault_in(
    robot: Robot, log: Layout, law: str, rows: Array, parameters: Parameters
) -> tuple[int, Message] | None:
    """The first row in which a run has diverged, and the reason; None if it has not diverged.

    Args:
        log: layout of the rows.
        law: name of the control law. One of the user's own shows by the reference point that its
            numbers were not finite; see models/control/laws/own.py.
        rows: of the log, shape (ticks, log.size).
    """
    fields = log.unpack(rows)
    fault = robot.fault(fields["q"], fields["v"], parameters)
    bad = np.isnan(fields["theta_ref"][:, 0])
    if bad.any() and (fault is None or bad.argmax() < fault[0]):
        return int(bad.argmax()), not_finite(law)
    return fault


def explained(
    reason: Message,
    robot: Robot,
    log: Layout,
    law: str,
    rows: Array,
    parameters: Parameters,
    curve: Curve,
) -> Message:
    """The reason why a run has diverged, with likely causes and remedies, if any are known.

    Args:
        reason: of the fault, from `fault_in`.
        log: layout of the rows.
        law: name of the control law.
        rows: of the log until the fault, shape (ticks, log.size); those of the last 0.1 s count.
        curve: the path.
    """
    causes = _causes(robot, log, law, rows, parameters, curve)
    if not causes or reason.code in (TYPED_LAW.code, "stop.own_law"):
        return reason
    return Message("stop.because", {"reason": reason, "causes": tuple(causes)})


def _causes(
    robot: Robot, log: Layout, law: str, rows: Array, parameters: Parameters, curve: Curve
) -> list[Message]:
    """Possible causes, the most certain first."""
    causes, entry = list[Message](), ROBOTS.get(robot.name)
    if entry is not None and (caution := entry.caution(parameters)) is not None:
        causes.append(caution)
    channels = channels_of(law, parameters)
    if not isinstance(channels, Message):
        across, along = channels
        causes += [Message("cause.poles_across")] * (not across.stable)
        causes += [Message("cause.poles_along")] * (not along.stable)
    causes += _foreseen_at(robot, log, law, rows, parameters)
    last = rows[-max(1, round(BEFORE / time_step(parameters))) :]
    last = last[np.isfinite(last).all(1)]
    if len(last):
        causes += _large_error(law, log.unpack(last), curve)
        causes += _seen(robot, log.unpack(last), parameters, curve, known=bool(causes))
    plant, model = robot.plant(parameters), robot.model(parameters)
    if (np.abs(plant - model) > WRONG * np.abs(plant)).any():
        causes.append(Message("cause.model"))
    return causes


def foreseen(robot: Robot, law: str, q: Array, parameters: Parameters) -> tuple[Message, ...]:
    """The forecast as the cause of a stop, if there is one; see `forecast`.

    None for a flexible link, whose reasons mention its zero dynamics.

    Args:
        q: configuration at rest, shape (n,).
    """
    found = None if robot.system.modes else forecast(robot, law, parameters, q)
    return () if found is None else (found,)


def _foreseen_at(
    robot: Robot, log: Layout, law: str, rows: Array, parameters: Parameters
) -> tuple[Message, ...]:
    """The forecast for the robot at rest where the rows begin, or at home if there are no rows."""
    if robot.system.n == robot.system.m:
        return ()
    try:
        q = robot.rest(log.unpack(rows)["y"][0] if len(rows) else np.zeros(robot.system.p))
    except ValueError:  # out of reach
        return ()
    return foreseen(robot, law, q, parameters)


def _large_error(law: str, last: dict[str, Array], curve: Curve) -> list[Message]:
    """That the reference point was far away, if the law is meant for small errors."""
    if not law_named(law).small_errors:
        return []
    reference, theta = last["theta_ref"][:, 0], last["theta"][:, 0]
    away = np.abs(curve.arc(reference) - curve.arc(theta))
    at = int(away.argmax())
    way: Array = np.linspace(float(theta[at]), float(reference[at]), BETWEEN)
    bend = np.abs(curve.curvature(way)).max()
    if away[at] * bend < AWAY:
        return []
    return [Message("cause.small_errors", {"away": f"{1e3 * away[at]:.0f}"})]


def _seen(
    robot: Robot, last: dict[str, Array], parameters: Parameters, curve: Curve, known: bool
) -> list[Message]:
    """Causes that show in the last rows before the fault.

    Args:
        known: whether the settings alone explain it.
    """
    causes, limit = list[Message](), parameters.torque_limit
    share = np.abs(last["u"]) / np.array(robot.system.strength)
    unit = declared(type(parameters))["torque_limit"].unit
    if limit > 0 and (share.max(1) >= 0.999 * limit).mean() > OFTEN:
        causes.append(Message("cause.limit", {"limit": f"{limit:g}", "unit": unit}))
    if (force := np.linalg.norm(last["force"], axis=1).max()) > PULLED:
        causes.append(Message("cause.force", {"force": f"{force:.0f}"}))
    if limit == 0 and (more := exceeded(robot, np.abs(last["u"]).max(axis=0))) is not None:
        causes.append(more)
    least = 0 if isinstance(curve, SplineCurve) else 1  # as in `far_from_path`
    bends = np.maximum(curve.turning(last["theta"][:, 0]), least)
    turned = np.abs(bends * last["theta_rate"][:, 0]).max() / parameters.control_rate
    if last["far"].max() > 0 and not known:
        fast = Message("cause.turned", {"turned": f"{turned:.2g}"})
        causes.append(fast if turned > NEAR_TURN else Message("cause.far"))
    return causes
