"""Fields of the flat vectors of a closed loop: state, settings and log row."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

from onpath.models.closed_loop.delay import LONGEST
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.control import composite_control as composite
from onpath.models.control.laws.law import PLAN, Memory
from onpath.models.control.laws.registry import law_named
from onpath.models.layout import Layout
from onpath.models.systems.system import MechanicalSystem

GAINS = ("K1", "K2", "K3", "K4", "K5")
_layout = lru_cache(maxsize=128)(Layout)  # 3 kB each, the same for all loops of a kind


@dataclass(frozen=True, slots=True)
class LoopLayouts:
    """Layouts of the flat vectors of a closed loop.

    Attributes:
        state, settings, log: of the vectors. The loop takes the leading fields of the state, those
            that it changes; the others stay as they are.
        changed: length of the leading part of the state that the loop changes.
        table_shape: shape of the curve's table.
        law: name of the control law.
        spline: see `Kind`.
    """

    state: Layout
    settings: Layout
    log: Layout
    changed: int
    table_shape: tuple[int, int]
    law: str
    spline: bool = field(default=False, kw_only=True)


def loop_layouts(system: MechanicalSystem, kind: Kind) -> LoopLayouts:
    """The layouts for a robot and a kind of loop.

    Raises:
        ValueError: an unknown law.
    """
    memory = law_named(kind.law).memory
    return LoopLayouts(
        state=state_layout(system, memory),
        settings=settings_layout(system, kind),
        log=log_layout(system),
        changed=kept_layout(system, kind, memory).size,
        table_shape=kind.table_shape,
        law=kind.law,
        spline=kind.spline,
    )


def state_layout(system: MechanicalSystem, memory: Memory = ()) -> Layout:
    """The state that a closed loop carries from tick to tick.

    Args:
        memory: fields that the law adds, `Law.memory`. They come late, so that the fields before
            them have the same positions for all laws.

    Raises:
        ValueError: a field of the memory has the name of another field.
    """
    n, m, p = system.n, system.m, system.p
    before = (
        ("q", n),
        ("v", n),
        ("theta", 1),  # closest point, [rad]
        ("theta_rate", 1),  # its rate, which predicts the next one, [rad/s]
        ("theta_ref", 1),  # reference point of laws that have one, [rad]
        ("speed_ref", 1),  # speed reference, which ramps to the wanted speed, [rad/s]
        ("integral", p),  # of λ, or of the error to the reference point
        ("encoder", system.joints),  # last reading, [rad]
        ("encoder_rate", system.joints),  # measured velocity, [rad/s]
        ("estimate", n),  # of q, before this tick's reading; exact without an observer
        ("estimate_rate", n),  # of v
        *(composite.MEMORY.fields if system.modes else ()),
        ("u", m),  # torque that is held, [N m]
        ("phase", 1),  # ticks since the control law was evaluated
    )
    after = (
        ("ticks", 1),  # of noise so far
        ("queue", LONGEST * m),  # torques to take effect, newest first, [N m]
    )
    layout = _layout((*before, *memory, *after))
    if len(layout.slices) < len(layout.fields):
        names = [name for name, _ in layout.fields]
        twice = next(name for name, _ in memory if names.count(name) > 1)
        raise ValueError(f"a law's memory cannot be named {twice!r}: the loop has that field")
    return layout


def kept_layout(system: MechanicalSystem, kind: Kind, memory: Memory = ()) -> Layout:
    """The leading fields of the state that a loop of this kind reads and changes.

    Other kinds leave the last fields as they are, so that their loops cost nothing there.
    """
    unused = () if kind.delay else ("queue",) if kind.noise else ("ticks", "queue")
    fields = state_layout(system, memory).fields
    return _layout(tuple(each for each in fields if each[0] not in unused))


def settings_layout(system: MechanicalSystem, kind: Kind) -> Layout:
    """Everything that may change between ticks, except for the curve.

    Units as in models/systems/parameters.py; "plant" and "model" are the system's parameters as
    they are and as the controller assumes them. Of the gains of single laws it has those of the
    loop's law, and `Kind.further_gains`. What only a drawing has is last, so that all else has the
    same places for all paths of a figure.
    """
    p, k = system.p, len(system.parameter_names)
    own = {gain.name for gain in law_named(kind.law).own_gains}
    scalars = (*GAINS, "position", "target", "speed", "ramp", "speed_limit", "tracker_integral")
    flexible = (*composite.GAINS, "strain_noise") if system.modes else ()
    realism = ("torque_limit", "coulomb", "encoder_step", "encoder_filter", "hold_ticks", "dt")
    realism += ("observer_time", "stiction", "torque_step", "look_ahead", "delay_ticks")
    realism += ("sensor_noise", "seed")
    return _layout(
        (
            *((name, 1) for name in (*scalars, *sorted(own.union(kind.further_gains)), *flexible)),
            ("plane", 3),  # see `Frame.numbers`
            ("level_centre", 2),
            ("level_weights", 3),
            ("level_constant", 1),
            ("plan", PLAN),  # of `Law.plan`; 0: none
            *((name, 1) for name in realism),
            ("hand_active", 1),
            ("hand_target", p),
            ("hold_active", 1),
            ("hold_anchor", p),
            ("hold_tangent", p),
            ("hold_normal", p),  # second direction of the brake; 0: none
            ("wall_active", 1),
            ("wall_place", p),
            ("wall_normal", p),
            ("plant", k),
            ("model", k),
            *(((name, 1) for name in ("pieces", "duration", "turning")) if kind.spline else ()),
        )
    )


def log_layout(system: MechanicalSystem) -> Layout:
    """One log row: the state at the beginning of a tick, and the torque and force during it."""
    n, m, p = system.n, system.m, system.p
    return _layout(
        (
            ("q", n),
            ("v", n),
            ("y", p),
            ("theta", 1),
            ("theta_rate", 1),
            ("speed", 1),  # along the path, [m/s]
            ("theta_ref", 1),
            ("speed_ref", 1),
            ("xi", p - 1),
            ("xi_rate", p - 1),
            ("u", m),
            ("force", p),
            ("far", 1),  # share of the return from far away in the command, 0 to 1
            ("integral_used", 1),  # share of its bound that the integral takes, 0 to 1
        )
    )
