"""The parameters of the rigid five-bar: model errors, removed counterweights, payload."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.models.systems.parameter_specs import number
from onpath.models.systems.parameters import Parameters


@dataclass(frozen=True, slots=True)
class FiveBarParameters(Parameters):
    """Parameters of the rigid five-bar: model errors, removed counterweights, payload."""

    error_M11: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's M11 is off by this",
        group="realism",
        label="M11 wrong",
        on=30.0,
    )
    error_M22: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's M22 is off by this",
        group="realism",
        label="M22 wrong",
        on=30.0,
    )
    error_b1: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's b1 is off by this",
        group="realism",
        label="b1 wrong",
        on=50.0,
    )
    error_b2: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's b2 is off by this",
        group="realism",
        label="b2 wrong",
        on=50.0,
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
    payload: float = number(
        0.0,
        "kg",
        (0, 0.3, 0.01),
        "mass at the end-point; the controller does not know",
        group="realism",
        label="Payload",
        on=0.1,
    )
