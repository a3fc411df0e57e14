"""Poles of the linearized closed loop, including the sampling.

After exact linearization every channel of the normal form (17) is a double integrator under the
laws (18) or (19), with the control held over the sampling interval. Its poles therefore follow from
the gains and the control rate alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters, time_step

Complex = NDArray[np.complex128]
LEAST_DECAY = 1e-3  # [1/s]; slower decay (time constant above 1000 s) does not count as stable
NO_OVERSHOOT = 0.995  # damping ratio above which a pair counts as two equal real poles


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """The poles of one channel.

    Attributes:
        name: "across" (ξ) or "along" (η2).
        poles: s = ln(z) / T for the eigenvalues z of the sampled system with interval T, [1/s].
        stable: whether all of them decay. The position of a speed loop is not part of the channel.
    """

    name: str
    poles: Complex
    stable: bool

    def behaviour(self) -> Message:
        """Stability, settling time (4 / |Re s|) and damping ratio, for a user."""
        if not self.stable:
            growth = float(self.poles.real.max())
            if growth > 1e-6:
                return Message("behaviour.unstable", {"seconds": f"{1 / growth:.2g}"})
            return Message("behaviour.not_stable")
        slowest = self.poles[self.poles.real.argmax()]
        damping = _damping(slowest)
        settles = 4 / float(-slowest.real)
        if damping > NO_OVERSHOOT:
            kind = Message("behaviour.no_overshoot")
        else:
            kind = Message("behaviour.damping", {"damping": f"{damping:.2f}"})
        return Message("behaviour.settles", {"seconds": f"{settles:.2g}", "kind": kind})

    def pole_words(self) -> str:
        """The poles with three digits; a conjugate pair is written once, as a ± bi."""
        rounded = [p.real + 0j if _damping(p) > NO_OVERSHOOT else p for p in self.poles.tolist()]
        return ", ".join(_pole_words(p) for p in rounded if p.imag >= -1e-9)


def _damping(pole: complex) -> float:
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
    interval = 1 / parameters.control_rate
    ahead = time_step(parameters) / 2
    k1, k2, k3 = parameters.K1, parameters.K2, parameters.K3
    across = (k1, k2, k3), "xvia" if k3 else "xva"
    along = (0.0, parameters.K5, 0.0), "va"
    if parameters.task == "position":
        along = (parameters.K4, parameters.K5, 0.0), "xva"
    return _channel("across", interval, ahead, *across), _channel("along", interval, ahead, *along)


@lru_cache(maxsize=256)
def _channel(
    name: str, interval: float, ahead: float, gains: tuple[float, float, float], kept: str
) -> Channel:
    """One channel from sampling interval [s], look-ahead [s], gains and states; see `_sampled`."""
    roots = _sampled(interval, ahead, gains, kept)
    decay = np.log(np.abs(roots) + 1e-300) / interval
    stable = bool(np.all(decay < -LEAST_DECAY))
    slow = roots[np.argsort(np.abs(roots))][1:]  # without the one of the held acceleration
    poles: Complex = np.asarray(np.log(slow + 1e-300) / interval, dtype=np.complex128)
    return Channel(name, poles, stable)


def _sampled(t: float, h: float, gains: tuple[float, float, float], kept: str) -> Complex:
    """Eigenvalues of a sampled double integrator under PID control with look-ahead.

    State: position x, velocity v, integral i and the acceleration a held until now. The controller
    predicts h ahead (models/closed_loop/kernel.py), and its command u is held over the interval t:

        x̂ = x + h v + h²/2 a,   v̂ = v + h a,   u = -k1 x̂ - k2 v̂ - k3 i,
        x⁺ = x + t v + t²/2 u,   v⁺ = v + t u,   i⁺ = i + t x̂,   a⁺ = u.

    Args:
        t: sampling interval, [s].
        h: look-ahead, [s].
        gains: (k1, k2, k3).
        kept: the states that the channel has, a subset of "xvia".
    """
    predicted = np.array([[1, h, 0, h**2 / 2], [0, 1, 0, h], [0, 0, 1, 0]])
    after = np.array([[1, t, 0, 0], [0, 1, 0, 0], t * predicted[0] + predicted[2], np.zeros(4)])
    after -= np.outer([t**2 / 2, t, 0, 1], np.array(gains) @ predicted)
    states = ["xvia".index(name) for name in kept]
    return np.linalg.eigvals(after[np.ix_(states, states)]).astype(np.complex128)
