"""The parameters of the flexible five-bar: beam, output, composite control, model errors."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.models.paths.frames import SlantedPlane
from onpath.models.systems.beam import MOST_MODES
from onpath.models.systems.flexible_five_bar import PLANTS
from onpath.models.systems.parameter_specs import (
    MM,
    Need,
    choice,
    model_error,
    number,
    unknown_payload,
    wanted_speed,
)
from onpath.models.systems.parameters import Parameters

PLANE = SlantedPlane()  # of the default path


@dataclass(frozen=True, slots=True)
class FlexibleParameters(Parameters):
    """Parameters of the flexible five-bar.

    `modes`, `plant`, the path's plane and whether there is a payload select the robot.
    """

    K3: float = number(
        0.0,
        "1/s³",
        (0, 8000, 50),
        "removes a lasting offset (integral)",
        group="gains",
        label="K3 across",
        symbol="K₃",
        scale="log",
    )
    K5: float = number(
        5.0,
        "1/s",
        (0, 100, 0.5),
        "how hard the speed along the path is held",
        group="gains",
        label="K5 along",
        symbol="K₅",
        scale="log",
    )
    speed: float = wanted_speed(2.0, (-10, 10, 0.1))
    alpha: float = number(
        0.5,
        "",
        (-1, 1, 0.01),
        "share of the deflection that the controller sees: 1 the tip, 0 the straight link",
        group="basic",
        label="α",
        symbol="α",
        needs=(Need("output", ("redefined",)),),
    )
    output: str = choice(
        "composite",  # the only one that is stable under every pull
        ("redefined", "composite"),
        "what the controller puts on the path: y with a share of the deflection, or the tip itself",
        group="basic",
        label="Output",
        compiles=True,
    )
    tip_damping: float = number(
        0.3,
        "",
        (0.02, 0.7, 0.01),
        "damping ratio that the waist gives the beam",
        group="gains",
        label="Tip damping",
        needs=(Need("output", ("composite",)),),
    )
    tip_prediction: float = number(
        1.2,
        "ω₁",
        (0.3, 2, 0.1),
        "how quickly the deflection is foreseen",
        group="gains",
        label="Tip prediction",
        needs=(Need("output", ("composite",)),),
    )
    tip_shaping: float = number(
        0.25,
        "ω₁",
        (0.05, 2, 0.05),
        "how quickly the wanted speed may change",
        group="gains",
        label="Speed shaping",
        needs=(Need("output", ("composite",)),),
    )
    tip_yielding: float = number(
        100.0,
        "1/s²",
        (0, 200, 5),
        "how much progress gives way to a tip held back",
        group="gains",
        label="Yielding",
        needs=(Need("output", ("composite",)),),
    )
    b: float = number(
        PLANE.b,
        "",
        (-0.5, 0.5, 0.05),
        "slope of the plane y1 = b y2 + d of the path, eq. (23); a circle in y2 and y3 is an"
        " ellipse in it",
        group="path",
        label="b",
        symbol="b",
    )
    d: float = number(
        PLANE.d,
        "m",
        (0.3, 0.7, 0.01),
        "distance of that plane from the waist, at y2 = 0",
        group="path",
        label="d",
        symbol="d",
        shown_in=MM,
    )
    centre: float = number(
        PLANE.centre,
        "m",
        (-0.2, 0.2, 0.01),
        "height y3 of the path's centre",
        group="path",
        label="Centre y3",
        symbol="y₃",
        shown_in=MM,
    )
    plant: str = choice(
        "lagrangian",
        PLANTS,
        "Lagrange's equations, or (20)-(21) read with ∫φ² = 1: odd units, no joint friction; the"
        " run begins anew",
        group="robot",
        label="Plant",
        compiles=True,
    )
    modes: int = choice(
        3,
        tuple(range(1, MOST_MODES + 1)),
        "how many modes of the beam are simulated; the run begins anew",
        group="robot",
        label="Modes",
        compiles=True,
    )
    rho: float = number(
        0.2,
        "kg/m",
        (0.05, 1, 0.01),
        "mass of the beam per metre",
        group="robot",
        label="ρ",
        symbol="ρ",
    )
    frequency: float = number(
        4.0,
        "Hz",
        (1, 10, 0.1),
        "first frequency of the clamped beam",
        group="robot",
        label="First frequency",
    )
    zeta: float = number(
        0.01,
        "",
        (0, 0.2, 0.005),
        "damping ratio of every mode",
        group="robot",
        label="Damping ζ",
        symbol="ζ",
    )
    strain_noise: float = number(
        0.0,
        "m",
        (0, 0.005, 0.0001),
        "standard deviation of the deflection of the tip as the strain gauges measure it",
        group="realism",
        label="Strain gauge noise",
        shown_in=MM,
        compiles=True,
        on=0.0005,
    )
    payload: float = unknown_payload((0, 0.1, 0.005), on=0.02, compiles=True)
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
    error_J0: float = model_error(
        "Inertia error, waist", "the controller's waist inertia J0 is off by this", symbol="J₀"
    )
    error_rho: float = model_error(
        "Mass error, link",
        "the controller's ρ, the mass per length of the link, is off by this",
        symbol="ρ",
    )
    error_omega1: float = model_error(
        "Frequency error", "the controller's first frequency is off by this", on=10.0, symbol="ω₁"
    )
