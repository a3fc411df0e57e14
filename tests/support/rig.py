"""The rigid five-bar with closed loops around it, for the tests of the models."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.delay import LONGEST
from onpath.models.closed_loop.kernel import Kernel, build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.law import PLAN
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Plane
from onpath.models.systems.five_bar import FiveBarLinks
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.system import MechanicalSystem

FOLLOWING, TRACKING = Kind("path_following"), Kind("trajectory_tracking")
DEFAULTS: dict[str, Any] = {
    "K1": 400,
    "K2": 40,
    "K3": 0,
    "tracker_integral": 1,
    "K4": 25,
    "K5": 10,
    "position": 0,
    "target": 0,
    "speed": 2 * np.pi,
    "ramp": 0,
    "speed_limit": 1e3,
    "level_centre": (0, 0),
    "level_weights": (1, 1, 0),
    "level_constant": 0.05**2,
    "plan": np.zeros(PLAN),
    "torque_limit": 1e3,
    "coulomb": 0,
    "hold_ticks": 1,
    "dt": 1e-3,
    "stiction": 0,
    "torque_step": 0,
    "delay_ticks": 0,
    "sensor_noise": 0,
    "seed": 0,
    "encoder_step": 1e-3,
    "encoder_filter": 5e-3,
    "observer_time": 5e-3,
    "hand_active": 0,
    "hand_target": (0, 0),
    "hold_active": 0,
    "hold_anchor": (0, 0),
    "hold_tangent": (0, 1),
    "hold_normal": (0, 0),
    "wall_active": 0,
    "wall_place": (0, 0),
    "wall_normal": (0, 1),
}


@dataclass
class Rig:
    """The rigid five-bar with every kind of closed loop around it, built once."""

    links: FiveBarLinks
    system: MechanicalSystem
    kernels: dict[Kind, Kernel] = field(default_factory=dict[Kind, Kernel])
    loops: dict[Kind, Loop] = field(default_factory=dict[Kind, Loop])

    @property
    def balanced(self) -> Array:
        return self.system.parameter_vector(self.links.lumped())

    @property
    def spoiled(self) -> Array:
        return self.system.parameter_vector(self.links.spoiled(0.6, 0.1).lumped())

    def kernel(self, kind: Kind) -> Kernel:
        if kind not in self.kernels:
            self.kernels[kind] = build_kernel(self.system, Plane(), kind)
        return self.kernels[kind]

    def loop(self, kind: Kind) -> Loop:
        """The loop as the lab runs it."""
        if kind not in self.loops:
            self.loops[kind] = translate_loop(self.kernel(kind))
        return self.loops[kind]

    def settings(self, kind: Kind, **changes: Any) -> Array:
        values = {"plant": self.balanced, "model": self.balanced, **DEFAULTS, **changes}
        values.setdefault("look_ahead", values["dt"] / 2)
        values.setdefault("plane", Plane().numbers)
        own = law_named(kind.law).own_gains
        values = {gain.name: gain.default for gain in own} | values
        return self.kernel(kind).settings.pack(values)

    def state(self, kind: Kind, y: Array, y_rate: Array | None = None, **changes: Any) -> Array:
        """State with the end-point at y, moving with y_rate, and the controller's memory empty."""
        q = RIGID_FIVE_BAR.rest(np.asarray(y, dtype=float))
        v = np.zeros(2) if y_rate is None else np.linalg.solve(jacobian(q), y_rate)
        values: dict[str, Any] = {"q": q, "v": v, "theta": 0, "theta_rate": 0, "theta_ref": 0}
        values |= {"speed_ref": 0, "integral": (0, 0), "u": (0, 0), "phase": 0}
        values |= {"estimate": q, "estimate_rate": v}
        values |= {"encoder": q, "encoder_rate": v, "ticks": 0, "queue": np.zeros(2 * LONGEST)}
        values |= {name: 0 for name, _ in LAWS[kind.law].memory}
        return self.kernel(kind).state.pack({**values, **changes})

    def on_path(self, kind: Kind, curve: Curve, theta: float, rate: float, **changes: Any) -> Array:
        """State on the curve at theta, moving along it."""
        at = np.array(theta)
        start = {"theta": theta, "theta_rate": rate, "theta_ref": theta, **changes}
        return self.state(kind, curve.at(at), rate * curve.at(at, 1), **start)

    def run(
        self, kind: Kind, curve: Curve, state: Array, ticks: int, **changes: Any
    ) -> dict[str, Array]:
        """Run the loop; return the log by name."""
        rows = self.loop(kind).run(state, self.settings(kind, **changes), curve.table(), ticks)[1]
        return self.kernel(kind).log.unpack(rows)


def end_point(q: Array) -> Array:
    """h(q) of the default linkage, by hand, (..., 2) -> (..., 2), [m]. Source: eq. (13)."""
    q1, q2 = q[..., 0], q[..., 1]
    x, z = np.cos(q1) - np.cos(q2), np.sin(q1) - np.sin(q2)
    return 0.2 * np.stack([x - 1, z - 1], axis=-1)


def jacobian(q: Array) -> Array:
    """dh/dq of the default linkage, by hand."""
    return 0.2 * np.array([[-np.sin(q[0]), np.sin(q[1])], [np.cos(q[0]), -np.cos(q[1])]])
