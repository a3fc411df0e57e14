"""Where the closed loop's poles lie, for each channel of the normal form, sampled as it is.

After linearization each channel is a double integrator under a PID or a speed loop, with the
control held over the sampling interval; so its poles follow from the gains and the rate alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters, time_step

Complex = NDArray[np.complex128]
LEAST_DECAY = 1e-3  # [1/s]; what takes longer than a quarter of an hour does not die out
NO_OVERSHOOT = 0.995  # damping beyond which a pair of poles counts as two equal real ones


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """One channel's poles.

    Attributes:
        name: "across" or "along".
        poles: in continuous time (the logarithm of the sampled ones over the interval), [1/s].
        stable: whether all of them decay; a speed loop's free position does not count.
    """

    name: str
    poles: Complex
    stable: bool

    def behaviour(self) -> Message:
        """How an error dies out, for a user."""
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
        """The poles to three digits, each pair once, or as two equal ones without overshoot."""
        rounded = [p.real + 0j if _damping(p) > NO_OVERSHOOT else p for p in self.poles.tolist()]
        return ", ".join(_pole_words(p) for p in rounded if p.imag >= -1e-9)


def _damping(pole: complex) -> float:
    return float(-pole.real / abs(pole)) if pole else 0.0


def _pole_words(pole: complex) -> str:
    if abs(pole.imag) < 1e-6 * max(1.0, abs(pole)):
        return f"{pole.real:.3g}"
    return f"{pole.real:.3g} ± {pole.imag:.3g}i"


def channels(parameters: Parameters) -> tuple[Channel, Channel]:
    """The transversal and the tangential channel. Source: eqs. (17)-(19)."""
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
    roots = _sampled(interval, ahead, gains, kept)
    decay = np.log(np.abs(roots) + 1e-300) / interval
    stable = bool(np.all(decay < -LEAST_DECAY))
    telling = roots[np.argsort(np.abs(roots))][1:]  # the first forgets the held acceleration
    poles: Complex = np.asarray(np.log(telling + 1e-300) / interval, dtype=np.complex128)
    return Channel(name, poles, stable)


def _sampled(t: float, h: float, gains: tuple[float, float, float], kept: str) -> Complex:
    """Eigenvalues of a double integrator, its acceleration held over t, under -gains.

    The controller looks h ahead, as models/closed_loop/kernel.py does. The state is position x,
    velocity v, integral i and the acceleration a held so far, of which only those in `kept` matter.
    """
    seen = np.array([[1, h, 0, h**2 / 2], [0, 1, 0, h], [0, 0, 1, 0]])
    after = np.array([[1, t, 0, 0], [0, 1, 0, 0], t * seen[0] + seen[2], np.zeros(4)])
    after -= np.outer([t**2 / 2, t, 0, 1], np.array(gains) @ seen)
    some = ["xvia".index(name) for name in kept]
    return np.linalg.eigvals(after[np.ix_(some, some)]).astype(np.complex128)
