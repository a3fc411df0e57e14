"""The channels of any control law, if its closed loop along the path has poles.

A law of the registry declares whether it is `linear`, or what its `channels` are at a place. The
commands of a typed law are linearized about the motion on the path at the wanted speed. Its poles
are constant if the commands depend on ξ, ξ', ∫ξ dt, θ' and the wanted speed only; if they depend on
the place or on the time, it has none.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws.law_error import law_error
from onpath.models.control.laws.own import formulas_of, is_text
from onpath.models.control.laws.references import LEAST_GAIN
from onpath.models.control.laws.registry import SHARED_GAINS, law_named
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel, channel, channels
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters

MOTION = ("xi", "dxi", "int_xi", "dtheta", "speed")
"""The quantities on which the commands of a law with poles may depend, besides the gains."""
STEP, ASIDE = 1e-6, np.array([0.01, 0.1, 0.01, 1.0, 0.5])
"""Steps of the tests for smoothness and for linearity, in SI units."""
LARGEST_BEND = 1e-3
"""Largest deviation from a line, as a share of the slope, or of 1."""


def channels_of(
    law: str, parameters: Parameters, place: Place | None = None
) -> tuple[Channel, Channel] | Message:
    """The channels of a law across and along the path, or the reason why it has none.

    Args:
        law: a name of the registry, or a typed law. An error in its code is a reason, too.
        place: of the robot, for laws whose poles vary along the path.

    Raises:
        ValueError: there is no such law.
    """
    if is_text(law):
        return _of_typed(law, parameters)
    entry = law_named(law)
    if entry.linear:
        return channels(parameters)
    if entry.channels is None or place is None:
        return Message("behaviour.no_poles")
    try:
        return entry.channels(parameters, place)
    except Exception as error:
        return law_error(law, error, entry.channels).message


def _of_typed(text: str, parameters: Parameters) -> tuple[Channel, Channel] | Message:
    """From the slopes of the commands: across = -k1 ξ - k2 ξ' - k3 ∫ξ dt, along = -k5 θ' + …

    If one command depends on the other channel's states, but not both, the poles stay the same.
    """
    formulas = formulas_of(text)
    gains = {name: getattr(parameters, name) for name in SHARED_GAINS}
    if {*formulas.targets} != {"across", "along"} or {*formulas.names} - {*MOTION, *gains}:
        return Message("behaviour.not_constant")
    x = ca.SX.sym("x", len(MOTION))
    values = dict(zip(MOTION, ca.vertsplit(x), strict=True))
    values |= {name: ca.SX(gain) for name, gain in gains.items()}
    found = formulas({name: values[name] for name in formulas.names})
    commands = ca.vertcat(found["across"], found["along"])
    law = ca.Function("law", [x], [commands, ca.jacobian(commands, x)])
    speed = parameters.speed if parameters.task == "speed" else 0.0
    slopes = _slopes(law, np.array([0.0, 0.0, 0.0, speed, speed]))
    if slopes is None:
        return Message("behaviour.not_smooth")
    across, along = -slopes
    if across[3] and along[:3].any():
        return Message("behaviour.coupled")
    k1, k2, k3 = across[:3].tolist()
    k4 = 0.0
    if parameters.task == "position":  # there the wanted speed is K4/K5 (θ_ref - θ), see `rate_at`
        k4 = -float(along[4]) * parameters.K4 / max(parameters.K5, LEAST_GAIN)
    return (
        channel("across", parameters, (k1, k2, k3), "xvia" if k3 else "xva"),
        channel("along", parameters, (k4, float(along[3]), 0.0), "xva" if k4 else "va"),
    )


def _slopes(law: ca.Function, on_path: Array) -> Array | None:
    """The slopes of the commands on the path, (2, 5); None if the law is not smooth or leaves it.

    A law that does not command 0 leaves the motion, but has the same slopes there if it is linear.
    """

    def at(x: Array) -> tuple[Array, Array]:
        commands, slopes = law(x)
        return commands.full().ravel(), ca.densify(slopes).full()

    commands, slopes = at(on_path)
    if not np.isfinite(slopes).all():
        return None
    bend = LARGEST_BEND * np.maximum(1.0, np.abs(slopes).max())
    for step in STEP * np.vstack([np.eye(len(on_path)), -np.eye(len(on_path))]):
        if not (np.abs(at(on_path + step)[0] - commands - slopes @ step) <= bend * STEP).all():
            return None
    stays = np.abs(commands).max() <= bend * STEP
    if not stays and not (np.abs(at(on_path + ASIDE)[1] - slopes) <= bend).all():
        return None
    return slopes
