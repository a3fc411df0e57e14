"""Path following with a disturbance observer in place of the integral."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel, channel, channels
from onpath.models.systems.parameters import Parameters

RATE = own_gain(
    "observer_rate",
    40.0,
    "1/s",
    (0, 100, 1),
    "how quickly the observer finds a lasting force; 0: it looks for none",
    label="Observer's rate",
)
BOUND = own_gain(
    "observer_bound",
    4.0,  # K1 ρ, the bound of every law's integral, with the default K1
    "m/s²",
    (0, 60, 0.5),
    "largest acceleration that opposes the observer's estimate",
    label="Observer's bound",
)
MODEL, STARTED = "observer_model", "observer_started"


def disturbance_observer(view: View) -> ControlAction:
    """Commanded y'', (p, 1), [m/s²]: (18) with an estimate d of the disturbance for its integral.

    In the path's frame the robot is a double integrator with a disturbance w, λ'' = v_perp + w. The
    observer compares λ' with the rate p of a model, p' = v_perp + d:

        d = L (λ' - p),   so that   d' = L (w - d),
        v_perp = -K1 λ - K2 λ' - sat(d),   |sat(d)| <= a.

    While |d| <= a, this is (18) with the gains

        K1 + L K2,   K2 + L,   L K1

    in the place of K1, K2 and K3, and the poles are -L and those of K1 and K2. Beyond, d still
    follows w at the rate L, because the model has the bounded command: it does not wind up, and the
    robot pushes on for no longer than about 1/L after a hand has let go. A force of more than a m
    moves the robot off as it would a spring K1.

    The state is r = p + K2 λ, so that K2 λ', which the controller only predicts, need not be
    integrated:

        d = L (λ' + K2 λ - r),   r' = -K1 λ + d - sat(d).

    In the first two evaluations d is 0: the first λ' is predicted without the torque to come.

    L is `observer_rate`, a `observer_bound`. Along the path, (19) acts as in path following.

    By default a is K1 ρ, the bound of the integral of (18) with the default gains. On the rigid
    five-bar, held aside at θ = 0 for 3 s by a hand 3 to 40 mm outside of the circle, it is within
    0.5 mm of the path at most 0.21 s after the release, and path following after 0.78 to 1.13 s,
    with the default gains of both. With a sensor noise of 0.001 rad it is 0.044 mm rms off, and path
    following 0.038 mm, and its torque changes by twice as much from tick to tick.

    Source: Ohnishi, Shibata and Murakami, Motion control for advanced mechatronics, IEEE/ASME
    Transactions on Mechatronics 1 (1996), 56-67; here in the coordinates of eq. (10).
    """
    output, gains, memory = view.output, view.gains, view.clock.memory
    rate, size = view.own_gains[RATE.name], output.xi.numel()
    now = output.xi_rate + gains.k2 * output.xi
    kept = ca.if_else(memory[STARTED] >= 1, memory[MODEL][:size], now)
    disturbance = rate * (now - kept)
    found = ca.sqrt(ca.dot(disturbance, disturbance))
    most = view.own_gains[BOUND.name] * output.xi_per_metre
    opposed = disturbance * ca.if_else(found > most, most / found, 1)
    across = -gains.k1 * output.xi - gains.k2 * output.xi_rate - opposed
    kept += view.clock.interval * (disturbance - opposed - gains.k1 * output.xi)
    action = followed(view, tangential(view), across, direction=output.acceleration_per_along)
    padded = ca.vertcat(kept, ca.SX.zeros(2 - size, 1))
    return replace(
        action, error=None, memory={MODEL: padded, STARTED: ca.fmin(memory[STARTED] + 0.5, 1)}
    )


def observer_channels(parameters: Parameters, _place: Place) -> tuple[Channel, Channel]:
    """The channels of (18) with the gains that the observer amounts to, within its bound."""
    k1, k2, rate = parameters.K1, parameters.K2, RATE.of(parameters)
    gains, kept = (k1 + rate * k2, k2 + rate, rate * k1), "xvia" if rate else "xva"
    return channel("across", parameters, gains, kept), channels(parameters)[1]


LAW = Law(
    name="disturbance_observer",
    label="Disturbance observer",
    text="Path following that estimates the force across the curve and opposes it up to a bound.",
    source="Ohnishi, Shibata and Murakami, Motion control for advanced mechatronics",
    command=disturbance_observer,
    aim="theta",
    gains=("K1", "K2", "K4", "K5"),
    own_gains=(RATE, BOUND),
    memory=((MODEL, 2), (STARTED, 1)),
    channels=observer_channels,
    good="After a long pull it is back on the curve sooner than path following, because it forgets"
    " the force at once.",
    limits="A force beyond its bound moves it off as it would a spring, and with noisy sensors its"
    " torques vary more than those of path following.",
    objection="Its authors would use an observer along the path, too, and a filter of"
    " higher order.",
)
