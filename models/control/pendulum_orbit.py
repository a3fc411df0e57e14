"""A periodic motion of a cart with a pendulum, and feedback gains that make it attractive.

    S cos φ x'' + J φ'' + g S sin φ + p φ' = 0,

the pendulum's equation of models/systems/cart_pendulum.py, has no motor in it; x'' is the input.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.systems.system import GRAVITY

ORDER = 4  # of the trigonometric polynomials of the plan
STEPS = 128  # of the gains, per period
PERIODS = 12  # of the Riccati equation
LENGTHS = 2.25  # a / (J / |S|): 1.5 times the length of a rod
FAR, FAST = 0.01, 0.1  # e [m] and e' [m/s] that count as much as all of the energy
STRONG = 2.0  # w that counts as much, [m/s²]


@dataclass(frozen=True, slots=True)
class Pendulum:
    """The numbers S [kg m], J [kg m²] and p [N m s] of its equation, of which S has a sign."""

    moment: float
    inertia: float
    friction: float

    @property
    def reach(self) -> float:
        """a of the constraint x = X(φ) = a sin φ, [m]."""
        return LENGTHS * self.inertia / abs(self.moment)

    @property
    def rate(self) -> float:
        """ω0 of small motions with the constraint, [rad/s]."""
        still = self.inertia + self.moment * self.reach
        return float(np.sqrt(GRAVITY * self.moment / still))

    def slope(self, state: Array) -> Array:
        """(φ', φ'') with the constraint and without friction, for (φ, φ')."""
        phi, rate = state
        inertia = self.inertia + self.moment * self.reach * np.cos(phi) ** 2
        half = -self.moment * self.reach * np.cos(phi) * np.sin(phi)
        return np.array([rate, -(half * rate**2 + GRAVITY * self.moment * np.sin(phi)) / inertia])


@lru_cache(maxsize=64)
def orbit_plan(pendulum: Pendulum, swing: float) -> Array:
    """Coefficients of k1, k2, k3 and e_r over the phase ψ, four times 2 ORDER + 1 numbers.

    With x = a sin φ + e and α(φ) = J + S a cos² φ, the pendulum's equation is

        α φ'' + α'(φ) φ'² / 2 + g S sin φ + p φ' + S cos φ e'' = 0,

    so that E = ½ α φ'² + g S (1 - cos φ) obeys E' = -p φ'² - S cos φ φ' e''. With

        e'' = w - p φ' / (S cos φ)

    friction drops out, E' = -S cos φ φ' w, and e moves periodically while w = 0, as e_r: e_r' =
    -(p / S) artanh(sin φ). Transverse to the orbit with the energy E* of the amplitude `swing` are

        I = E - E*,   e - e_r,   e' - e_r'.

    Linearized about the orbit they obey I' = b(t) w and e'' = w, b = -S cos φ φ'. The feedback
    w = -k(t) · (I, e - e_r, e' - e_r') is that of the periodic Riccati equation, solved backwards
    in time from 0. The phase is ψ = atan2(-φ' / ω0, φ).

    Args:
        swing: amplitude of φ, [rad].
    """
    phi, rate, step = _motion(pendulum, swing)
    moment, friction = pendulum.moment, pendulum.friction
    drive = -moment * np.cos(phi) * rate
    energy = abs(GRAVITY * moment * (1 - np.cos(swing)))
    gains = _periodic_gains(drive, step, energy)
    slope = -friction / moment * np.arctanh(np.sin(phi))
    drift = np.cumsum(slope + np.roll(slope, 1)) * step / 2
    psi = np.arctan2(-rate / pendulum.rate, phi)
    harmonics = np.outer(psi, np.arange(1, ORDER + 1))
    functions = np.column_stack([np.ones(STEPS), np.cos(harmonics), np.sin(harmonics)])
    wanted = np.column_stack([gains, drift - drift.mean()])
    return np.asarray(np.linalg.lstsq(functions, wanted, rcond=None)[0], dtype=float).T.ravel()


def _motion(pendulum: Pendulum, swing: float) -> tuple[Array, Array, float]:
    """φ and φ' at `STEPS` instants of a period, and the time between them, [s]."""
    from scipy.integrate import solve_ivp  # slow to import

    def moving(_time: float, state: Array) -> Array:
        return pendulum.slope(state)

    def down(_time: float, state: Array) -> float:
        return float(state[0])

    options: Any = {"rtol": 1e-10, "atol": 1e-12}
    begin, long = np.array([swing, 0.0]), 2 * np.pi / pendulum.rate
    fall = solve_ivp(moving, (0, long), begin, events=down, **options)
    assert fall.t_events is not None
    period = 4 * float(fall.t_events[0][0])
    instants = np.arange(STEPS) * period / STEPS
    phi, rate = solve_ivp(moving, (0, period), begin, t_eval=instants, **options).y
    return phi, rate, period / STEPS


def _periodic_gains(drive: Array, step: float, energy: float) -> Array:
    """k at each instant, (STEPS, 3), for w that is held over a step; from a sum of squares.

    Each of I / E*, e / `FAR`, e' / `FAST` and w / `STRONG` counts by its square.
    """
    weights = np.diag(np.array([energy, FAR, FAST]) ** -2.0) * step
    effort, found = STRONG**-2.0 * step, np.zeros((STEPS, 3))
    moved = np.eye(3)
    moved[1, 2] = step
    value = np.zeros((3, 3))
    for _ in range(PERIODS):
        for i in reversed(range(STEPS)):
            middle = (drive[i] + drive[(i + 1) % STEPS]) / 2
            held = np.array([middle * step, step**2 / 2, step])
            pull = held @ value
            found[i] = pull @ moved / (effort + pull @ held)
            left = moved - np.outer(held, found[i])
            value = weights + moved.T @ value @ left
            value = (value + value.T) / 2
    return found
