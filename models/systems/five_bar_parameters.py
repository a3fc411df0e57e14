"""The parameters of the rigid five-bar: model errors, removed counterweights, payload."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.models.systems.parameter_specs import model_error, number, unknown_payload
from onpath.models.systems.parameters import Parameters


@dataclass(frozen=True, slots=True)
class FiveBarParameters(Parameters):
    """Parameters of the rigid five-bar: model errors, removed counterweights, payload."""

    error_M11: float = model_error(
        "Inertia error, motor 1",
        "the controller's M11, the inertia at motor 1, is off by this",
        symbol="M₁₁",
    )
    error_M22: float = model_error(
        "Inertia error, motor 2",
        "the controller's M22, the inertia at motor 2, is off by this",
        symbol="M₂₂",
    )
    error_b1: float = model_error(
        "Friction error, motor 1",
        "the controller's b1, the friction of motor 1, is off by this",
        on=50.0,
        symbol="b₁",
    )
    error_b2: float = model_error(
        "Friction error, motor 2",
        "the controller's b2, the friction of motor 2, is off by this",
        on=50.0,
        symbol="b₂",
    )
    counterweights_removed: float = number(
        0.0,
        "%",
        (0, 100, 5),
        "counterweights taken off; the controller does not know",
        group="realism",
        label="Counterweights off",
        on=50.0,
    )
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)
