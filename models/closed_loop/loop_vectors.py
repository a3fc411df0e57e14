"""What the flat vectors of a closed loop hold: its state, its settings, its log rows."""

from __future__ import annotations

from onpath.models.control import composite_control as composite
from onpath.models.layout import Layout
from onpath.models.systems.system import MechanicalSystem

GAINS = ("K1", "K2", "K3", "K4", "K5")


def state_layout(system: MechanicalSystem) -> Layout:
    """What one robot carries from tick to tick, the same for both controllers."""
    n, m, p = system.n, system.m, system.p
    return Layout(
        (
            ("q", n),
            ("v", n),
            ("theta", 1),  # closest point
            ("theta_rate", 1),  # predicts the next one
            ("theta_ref", 1),  # the tracker's reference point
            ("integral", p),  # of xi, or of the tracking error
            ("encoder", m),  # last reading
            ("encoder_rate", m),  # filtered velocity
            *(composite.MEMORY.fields if n > m else ()),
            ("u", m),  # torque being held
            ("phase", 1),  # ticks since the controller acted
        )
    )


def settings_layout(system: MechanicalSystem) -> Layout:
    """All that may change between ticks, but for the curve's coefficients."""
    p, k = system.p, len(system.parameter_names)
    scalars = (*GAINS, "position", "target", "speed")
    flexible = tuple(composite.GAINS) if system.n > system.m else ()
    realism = ("torque_limit", "coulomb", "encoder_step", "encoder_filter", "hold_ticks", "dt")
    return Layout(
        (
            *((name, 1) for name in (*scalars, *flexible)),
            ("level_centre", 2),
            ("level_weights", 2),
            ("level_constant", 1),
            *((name, 1) for name in realism),
            ("hand_active", 1),
            ("hand_target", p),
            ("hold_active", 1),
            ("hold_anchor", p),
            ("hold_tangent", p),
            ("plant", k),
            ("model", k),
        )
    )


def log_layout(system: MechanicalSystem) -> Layout:
    """One row: the instant a tick begins, and the torque and force during it."""
    n, m, p = system.n, system.m, system.p
    return Layout(
        (
            ("q", n),
            ("v", n),
            ("y", p),
            ("theta", 1),
            ("theta_rate", 1),
            ("speed", 1),  # along the path, [m/s]
            ("theta_ref", 1),
            ("xi", p - 1),
            ("xi_rate", p - 1),
            ("u", m),
            ("force", p),
        )
    )
