"""Event-based tracking: the reference point is where the robot is, not where a clock says."""

from __future__ import annotations

from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.references import rate_at, tracking_error
from onpath.models.control.laws.trajectory_tracking import pid


def event_based(view: View) -> ControlAction:
    """Commanded y'' of tracking, (p, 1), [m/s²], with the closest point as the reference point.

        y'' = σ''(θ) ω² - K2 (y' - σ'(θ) ω) - K1 (y - σ(θ)) - K3 ∫(y - σ(θ)) dt

    θ is the parameter of the point closest to y, and ω the wanted rate (`rate_at`), whatever the
    actual rate is: while the robot is held, the law feeds forward the curvature of a motion that
    does not take place.

    Source: Tarn, Xi and Bejczy, Path-based approach to integrated planning and control, [3].
    """
    error, error_rate, feedforward = tracking_error(
        view.closest, view.frame, view.y, view.y_rate, rate_at(view)
    )
    return ControlAction(
        pid(view, error, error_rate, feedforward), error=error, theta_ref=view.output.theta
    )


LAW = Law(
    name="event_based",
    label="Event-based",
    text="Tracks the closest point at the wanted rate, as if it were the point of a clock.",
    source="Tarn, Xi and Bejczy, Path-based planning and control, reference [3]",
    command=event_based,
    good="It takes up the wanted speed sooner than all others that have no timetable.",
    limits="Held back, it still asks for the acceleration of a speed that it does not have, and"
    " leaves the curve.",
    objection="Its authors would let a planner choose the speed along the path, which is"
    " given here.",
)
