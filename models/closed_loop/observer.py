"""An observer: velocities from the controller's model, which the readings of the sensors correct.

In every tick the model carries the estimate (q̂, v̂) on under the torque that acts, after limits and
delay, with the integrator of the plant. At each evaluation of the control law, readings r of all
coordinates correct it:

    q̂⁺ = q̂ + (1 - ρ²) e,   v̂⁺ = v̂ + (1 - ρ)² e / T,   e = r - q̂,   ρ = exp(-T / observer_time),

with T the control interval, so that both poles of the error are at ρ. With an exact model and
exact readings e = 0, and the estimate is the true state, to rounding. Forces that the model does
not have, such as a hand's or dry friction, make v̂ wrong by up to 2 `observer_time` times the
acceleration that they cause. The estimate is a measurement only: no law commands a torque against
these forces by it.

Source: Franklin, Powell and Workman, Digital Control of Dynamic Systems, 8.2.4 (current estimator).
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.plant_tick import move
from onpath.models.layout import Fields
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem


def corrected(state: Fields, settings: Fields, reading: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The estimate of q and v in this tick, each (n, 1); between evaluations without correction.

    Args:
        reading: of all coordinates, (n, 1).
    """
    q, v = state["estimate"], state["estimate_rate"]
    interval = settings["dt"] * settings["hold_ticks"]
    rho = ca.exp(-interval / settings["observer_time"])
    error = (state["phase"] < 0.5) * (reading - q)
    return q + (1 - rho**2) * error, v + (1 - rho) ** 2 / interval * error


def carried_on(
    system: MechanicalSystem,
    kind: Kind,
    settings: Fields,
    estimate: tuple[ca.SX, ca.SX],
    torques: tuple[tuple[ca.SX, ca.SX], ...],
    plant: tuple[int, forces.Grip],
) -> Fields:
    """The estimate for the next tick, by the controller's model.

    Args:
        estimate: q and v in this tick, each (n, 1).
        torques, plant: as for `plant_tick.move`.
    """
    ideal = replace(kind, free=True, stiction=False)
    modelled = {**settings, "plant": settings["model"]}
    q, v = estimate
    now = {"q": q, "v": v}
    _, _, later = move(system, ideal, now, modelled, torques, plant)
    return {"estimate": later["q"], "estimate_rate": later["v"]}
