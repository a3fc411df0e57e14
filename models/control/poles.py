"""Poles of the linearized closed loop, including the sampling and the computing delay.

After exact linearization every channel of the normal form (17) is a double integrator under the
laws (18) or (19). Its poles are computed for an acceleration that is held over the sampling
interval, so they follow from the gains, the control rate and the delay alone. What a robot holds is
torque: over the interval, friction and the other terms that the model cancels keep changing. At 50
and 100 Hz the largest K2 of the five-bar is therefore 1 to 3 % larger than by the poles, and 3 to
7 % with a look-ahead of half an interval.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters, look_ahead_time

Complex = NDArray[np.complex128]
LEAST_DECAY = 1e-3  # [1/s]; slower decay (time constant above 1000 s) does not count as stable
NO_OSCILLATION = 0.995  # damping ratio from which a pair counts as two equal real poles


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """The poles of one channel.

    Attributes:
        name: "across" (ξ) or "along" (η2).
        poles: s = ln(z) / T for the eigenvalues z of the sampled system with interval T, [1/s].
        stable: whether all of them decay. The position of a speed loop is not part of the channel.
        integral: whether the channel has integral action.
        at: θ at which these are the poles, if they vary along the path, [rad].
        message: the behaviour of the channel, if its poles do not tell it.
    """

    name: str
    poles: Complex
    stable: bool
    integral: bool
    at: float | None = None
    message: Message | None = None

    def behaviour(self) -> Message:
        """Stability, settling time (4 / |Re s| of the slowest pole) and damping, for a user.

        The damping ratio is that of the least damped poles. With integral action an
        initial error overshoots: the integral is 0 at the start and at the end, so that the error
        must change its sign.
        """
        if self.message is not None:
            return self.message
        if not self.stable:
            return self._unstable()
        settles, damping = 4 / float(-self.poles.real.max()), min(map(_damping, self.poles))
        if damping >= NO_OSCILLATION and self.integral:
            kind = Message("behaviour.no_oscillation")
        elif damping >= NO_OSCILLATION:
            kind = Message("behaviour.no_overshoot")
        else:
            kind = Message("behaviour.damping", {"damping": f"{damping:.2f}"})
        return Message("behaviour.settles", {"seconds": f"{settles:.2g}", "kind": kind})

    def _unstable(self) -> Message:
        growth = float(self.poles.real.max())
        if growth > LEAST_DECAY:
            return Message("behaviour.unstable", {"seconds": f"{1 / growth:.2g}"})
        lasting = self.poles[self.poles.real > -LEAST_DECAY]
        swings = np.abs(lasting.imag).max() > LEAST_DECAY
        return Message("behaviour.swings" if swings else "behaviour.not_stable")

    def pole_words(self) -> str:
        """The poles with three digits; a conjugate pair is written once, as a ± bi."""
        rounded = [p.real + 0j if _damping(p) >= NO_OSCILLATION else p for p in self.poles.tolist()]
        return ", ".join(_pole_words(p) for p in rounded if p.imag >= -1e-9)


def _damping(pole: complex | np.complex128) -> float:
    """Damping ratio -Re s / |s|."""
    return float(-pole.real / abs(pole)) if pole else 0.0


def _pole_words(pole: complex) -> str:
    if abs(pole.imag) < 1e-6 * max(1.0, abs(pole)):
        return f"{pole.real:.3g}"
    return f"{pole.real:.3g} ± {pole.imag:.3g}i"


def channels(parameters: Parameters) -> tuple[Channel, Channel]:
    """The transversal and the tangential channel of path following.

    Across: gains K1, K2, K3. Along: K5 for the speed task, K4 and K5 for the position task.

    Source: eqs. (17)-(19).
    """
    k1, k2, k3 = parameters.K1, parameters.K2, parameters.K3
    gains, kept = (0.0, parameters.K5, 0.0), "va"
    if parameters.task == "position":
        gains, kept = (parameters.K4, parameters.K5, 0.0), "xva"
    across = channel("across", parameters, (k1, k2, k3), "xvia" if k3 else "xva")
    return across, channel("along", parameters, gains, kept)


def channel(
    name: str, parameters: Parameters, gains: tuple[float, float, float], kept: str
) -> Channel:
    """One channel under PID control, with the sampling and the delay of the parameters.

    Args:
        gains: (k1, k2, k3).
        kept: the states of `_sampled` that the channel has, a subset of "xvia"; "a" stands for all
            a_j.
    """
    times = 1 / parameters.control_rate, look_ahead_time(parameters), parameters.delay
    return _channel(name, times, gains, kept)


@lru_cache(maxsize=256)
def _channel(
    name: str, times: tuple[float, float, float], gains: tuple[float, float, float], kept: str
) -> Channel:
    """One channel from its times, gains and states; see `channel`."""
    states = [i for i in range(4 + int(times[2])) if "xvia"[min(i, 3)] in kept]
    matrix = _sampled(*times, gains)[np.ix_(states, states)]
    return _from_matrix(name, times[0], matrix, len(kept) - 1, "i" in kept)


def turning_channel(
    name: str, parameters: Parameters, gains: tuple[float, float, float], turn: Array, at: float
) -> Channel:
    """The channel across the path, if its integral is kept in axes that do not turn.

    The axes A = (T, N), or (T, n1, n2), turn as A' = A Ω. In these axes the integral of the error
    across the path obeys I' = (0, e) - Ω I, so that it also has a component along T, and the
    directions across are coupled.

    Args:
        gains: (k1, k2, k3).
        turn: Ω, (2, 2) or (3, 3), [rad/s].
        at: θ of this place, [rad]; NaN if Ω is the same everywhere.
    """
    from scipy.linalg import block_diag, expm  # slow to import; see app/server/warm_up.py

    t, directions = 1 / parameters.control_rate, len(turn) - 1
    one = _sampled(t, look_ahead_time(parameters), parameters.delay, gains)
    matrix: Array = np.asarray(block_diag(np.ones((1, 1)), *[one] * directions), dtype=float)
    sums = [0, *(1 + len(one) * i + 2 for i in range(directions))]
    matrix[sums] = np.asarray(expm(-t * turn)) @ matrix[sums]
    found = _from_matrix(name, t, matrix, 1 + 3 * directions, integral=True)
    return found if np.isnan(at) else replace(found, at=at)


def _from_matrix(name: str, t: float, matrix: Array, count: int, integral: bool) -> Channel:
    """The channel of a sampled system: its `count` slowest poles.

    Args:
        t: sampling interval, [s].
        count: number of its states, without pending accelerations.
    """
    roots: Complex = np.linalg.eigvals(matrix).astype(np.complex128)
    decay = np.log(np.abs(roots) + 1e-300) / t
    stable = bool(np.all(decay < -LEAST_DECAY))
    slow = _slowest(roots, count)
    poles: Complex = np.asarray(np.log(slow + 1e-300) / t, dtype=np.complex128)
    return Channel(name, poles, stable, integral)


def _slowest(roots: Complex, count: int) -> Complex:
    """The largest `count` eigenvalues, and one more if it is the conjugate of the last, rising."""
    rising = roots[np.argsort(np.abs(roots), kind="stable")]
    if count < len(rising):
        pair = rising[-count - 1 : -count + 1 or None]
        count += bool(abs(pair[0].imag) > 0 and np.isclose(pair[0], pair[1].conj(), rtol=1e-9))
    return rising[-count:]


def _sampled(t: float, h: float, delay: float, gains: tuple[float, float, float]) -> Array:
    """The matrix of a sampled double integrator under PID control with look-ahead and delay.

    State: position x, velocity v, integral i, and the accelerations a_1 to a_{l+1} commanded one to
    l + 1 intervals ago, with delay = l + f, 0 <= f < 1. The last one still acts, up to the time f t
    of the interval, and then a_l, which is the present command u if l = 0. The controller predicts
    h ahead (models/closed_loop/sensing.py), without knowledge of the delay:

        x̂ = x + h v + h²/2 a_{l+1},   v̂ = v + h a_{l+1},   u = -k1 x̂ - k2 v̂ - k3 i,
        x⁺ = x + t v + f (1 - f/2) t² a_{l+1} + (1 - f)² t²/2 a_l,   i⁺ = i + t x̂,
        v⁺ = v + f t a_{l+1} + (1 - f) t a_l,   a_1⁺ = u,   a_{j+1}⁺ = a_j.

    Args:
        t: sampling interval, [s].
        h: look-ahead, [s].
        delay: in sampling intervals.
        gains: (k1, k2, k3).

    Source: Åström and Wittenmark, Computer-Controlled Systems, 3.2, for systems with time delay.
    """
    whole = int(delay)
    f, size = delay - whole, 4 + whole
    unit = np.eye(size)  # x, v, i, a_1 ... a_{l+1}
    oldest = unit[-1]
    predicted = unit[0] + h * unit[1] + h**2 / 2 * oldest, unit[1] + h * oldest, unit[2]
    command = -np.array(gains) @ np.stack(predicted)
    moved = np.vstack([command, unit[3:]])  # a_0, the present command, to a_{l+1}
    early, late = moved[whole + 1], moved[whole]
    return np.vstack(
        [
            unit[0] + t * unit[1] + t**2 * (f * (1 - f / 2) * early + (1 - f) ** 2 / 2 * late),
            unit[1] + t * (f * early + (1 - f) * late),
            unit[2] + t * predicted[0],
            moved[:-1],
        ]
    )
