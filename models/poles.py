"""Where the closed loop's poles lie, for each channel of the normal form, sampled as it is.

After linearization each channel is a double integrator under a PID or a speed loop, with the
control held over the sampling interval; so its poles follow from the gains and the rate alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.parameters import Parameters
from models.system import Array


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """One channel's poles.

    Attributes:
        name: "across" or "along".
        poles: in continuous time (the logarithm of the sampled ones over the interval), [1/s].
        stable: whether all of them decay; a speed loop's free position does not count.
    """

    name: str
    poles: Array
    stable: bool

    def words(self) -> str:
        """How it behaves, in a sentence."""
        if not self.stable:
            growth = float(self.poles.real.max())
            if growth > 1e-6:
                return f"unstable: an error grows by e every {1 / growth:.2g} s"
            return "not stable: an error never dies out"
        slowest = self.poles[self.poles.real.argmax()]
        damping = float(-slowest.real / abs(slowest))
        settles = 4 / float(-slowest.real)
        kind = "no overshoot" if damping > 0.995 else f"damping {damping:.2f}"
        return f"settles in {settles:.2g} s, {kind}"


def channels(parameters: Parameters) -> tuple[Channel, Channel]:
    """The transversal and the tangential channel. Source: eqs. (17)-(19)."""
    interval = 1 / parameters.control_rate
    feedback = [parameters.K1, parameters.K2]
    if parameters.K3:
        feedback.append(parameters.K3)
    across = _channel("across", _sampled(interval, np.array(feedback)), interval)
    if parameters.task == "position":
        along = _sampled(interval, np.array([parameters.K4, parameters.K5]))
    else:
        along = np.array([1 - parameters.K5 * interval])
    return across, _channel("along", along, interval)


def _channel(name: str, roots: Array, interval: float) -> Channel:
    poles = np.log(roots.astype(complex) + 1e-300) / interval
    return Channel(name, poles, bool(np.all(np.abs(roots) < 1 - 1e-9)))


def _sampled(interval: float, gains: Array) -> Array:
    """Eigenvalues of a held double integrator under -K1 x - K2 x' (- K3 integral of x)."""
    t = interval
    a = np.array([[1, t, 0], [0, 1, 0], [t, 0, 1.0]])[: len(gains), : len(gains)]
    b = np.array([t**2 / 2, t, 0.0])[: len(gains)]
    return np.linalg.eigvals(a - np.outer(b, gains))
