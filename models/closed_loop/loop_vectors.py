"""Fields of the flat vectors of a closed loop: state, settings and log row."""

from __future__ import annotations

from onpath.models.control import composite_control as composite
from onpath.models.layout import Layout
from onpath.models.systems.system import MechanicalSystem

GAINS = ("K1", "K2", "K3", "K4", "K5")


def state_layout(system: MechanicalSystem) -> Layout:
    """The state that a closed loop carries from tick to tick, the same for both control laws."""
    n, m, p = system.n, system.m, system.p
    return Layout(
        (
            ("q", n),
            ("v", n),
            ("theta", 1),  # closest point, [rad]
            ("theta_rate", 1),  # its rate, which predicts the next one, [rad/s]
            ("theta_ref", 1),  # reference point of trajectory tracking, [rad]
            ("integral", p),  # of λ, or of the tracking error
            ("encoder", m),  # last reading, [rad]
            ("encoder_rate", m),  # filtered velocity, [rad/s]
            *(composite.MEMORY.fields if n > m else ()),
            ("u", m),  # torque that is held, [N m]
            ("phase", 1),  # ticks since the control law was evaluated
        )
    )


def settings_layout(system: MechanicalSystem) -> Layout:
    """Everything that may change between ticks, except for the curve.

    Units as in models/systems/parameters.py; "plant" and "model" are the system's parameters as
    they are and as the controller assumes them.
    """
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
    """One log row: the state at the beginning of a tick, and the torque and force during it."""
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
