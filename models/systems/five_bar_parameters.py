"""The parameters of the rigid five-bar: model errors, removed counterweights, payload."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.models.systems.parameter_specs import model_error, number, unknown_payload
from onpath.models.systems.parameters import Parameters


@dataclass(frozen=True, slots=True)
class FiveBarParameters(Parameters):
    """Parameters of the rigid five-bar: model errors, removed counterweights, payload."""

    error_M11: float = model_error("M11 wrong", "the controller's M11 is off by this")
    error_M22: float = model_error("M22 wrong", "the controller's M22 is off by this")
    error_b1: float = model_error("b1 wrong", "the controller's b1 is off by this", on=50.0)
    error_b2: float = model_error("b2 wrong", "the controller's b2 is off by this", on=50.0)
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
