"""Results of `onpath zero-dynamics`: exponents at rest, and against alpha and number of modes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from onpath.models.control.forecast import LEAST_RANK, growth_rate, zero_dynamics_at
from onpath.models.control.poles import Channel
from onpath.models.control.rank_test import rank_number
from onpath.models.control.settable import changed, specs, with_values
from onpath.models.errors import CodedError
from onpath.models.systems.beam import MOST_MODES, beam_modes
from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.zero_dynamics import HIGHEST_ALPHA, flexible_zero_dynamics, natural_rate

TABLE_ALPHAS = (-1.0, 0.0, 0.5, 0.7, 0.8, 0.9, 1.0)
REACH = 0.1  # [m], half-width of the map of critical alpha
LINES = 13  # of that map, in either direction
SETTABLE = ("plant", "rho", "frequency", "zeta", "b", "d", "centre")
"""Parameters of the internal dynamics besides alpha and modes, which the table varies."""


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """Internal dynamics of the flexible link with the controlled output held constant.

    Attributes:
        parameters: the plant; alpha, modes and payload are ignored.
        at: (y2, y3) of the straight link's tip, [m].
        unit: sqrt(EI / rho) / l^2, [1/s].
        alphas: shape (a,).
        fastest: largest real part for 1 to 6 modes, shape (6, a), [1/s].
        critical: alpha above which it is positive, shape (6,); infinity if it never is.
    """

    parameters: FlexibleParameters
    at: tuple[float, float]
    unit: float
    alphas: np.ndarray
    fastest: np.ndarray
    critical: np.ndarray


def changed_all(assignments: dict[str, str]) -> FlexibleParameters:
    """Return the default parameters with the given values replaced.

    Raises:
        ValueError: a name is unknown or without effect, or a value is bad; the message says
            which.
    """
    parameters: Any = FlexibleParameters()
    for name, text in assignments.items():
        if name in specs(parameters) and name not in SETTABLE:
            hint = f"there are {', '.join(SETTABLE)}"
            raise ValueError(f"the internal dynamics have no setting {name!r}: {hint}")
        parameters = changed(parameters, name, text)
    return parameters


def study(
    parameters: FlexibleParameters,
    at: tuple[float, float],
    alphas: np.ndarray | None = None,
) -> Study:
    """Compute the study for every number of modes.

    Raises:
        ValueError: the tip cannot reach the position.
    """
    alphas = np.array(TABLE_ALPHAS) if alphas is None else alphas
    rows, critical = list[np.ndarray](), list[float]()
    for modes in range(1, MOST_MODES + 1):
        variant = replace(parameters, modes=modes, payload=0.0)
        robot, zero = robot_for(variant), flexible_zero_dynamics(modes, variant.plant)
        q, plant = robot.rest(robot.frame.lift(np.array(at))), robot.plant(variant)
        rows.append(zero.exponents(q, zero.with_alpha(plant, alphas))[:, 0].real)
        critical.append(critical_alpha(variant, at))
    robot = robot_for(parameters)
    values = dict(zip(robot.system.parameter_names, robot.plant(parameters), strict=True))
    unit = natural_rate(values, float(beam_modes(1, 1.0).roots[0]))
    return Study(
        parameters=parameters,
        at=at,
        unit=unit,
        alphas=alphas,
        fastest=np.array(rows),
        critical=np.array(critical),
    )


def critical_alpha(parameters: FlexibleParameters, at: tuple[float, float]) -> float:
    """Alpha above which the internal dynamics are unstable at rest; infinity if they never are."""
    parameters = replace(parameters, payload=0.0)
    robot = robot_for(parameters)
    zero = flexible_zero_dynamics(parameters.modes, parameters.plant)
    q = robot.rest(robot.frame.lift(np.array(at)))
    return zero.critical_alpha(q, robot.plant(parameters), highest(parameters))


def highest(parameters: FlexibleParameters) -> float:
    """Upper limit of the search for alpha; with unit_modes, alpha acts as if multiplied by rho."""
    return HIGHEST_ALPHA / (parameters.rho if parameters.plant == "unit_modes" else 1.0)


def critical_map(parameters: FlexibleParameters) -> tuple[np.ndarray, np.ndarray]:
    """Critical alpha over the path's plane.

    Returns:
        y2 and y3 of the grid lines, (LINES,), [m]; alpha, (LINES, LINES), rows along y3.
    """
    lines = np.linspace(-REACH, REACH, LINES)
    values = [[critical_alpha(parameters, (y2, y3)) for y2 in lines] for y3 in lines]
    return lines, np.array(values)


def as_json(result: Study) -> dict[str, Any]:
    """Data for `--json`: numbers with nine digits, null where nothing is unstable."""
    rows = zip(result.critical, result.fastest, strict=True)
    return {
        "plant": result.parameters.plant,
        "rho_kg_m": result.parameters.rho,
        "zeta_of_every_mode": result.parameters.zeta,
        "at_m": list(result.at),
        "unit_1_s": _nine(result.unit),
        "modes": {
            str(modes): {
                "critical_alpha": _nine(critical),
                "largest_real_part_1_s": {
                    f"{alpha:g}": _nine(value)
                    for alpha, value in zip(result.alphas, fastest, strict=True)
                },
            }
            for modes, (critical, fastest) in enumerate(rows, start=1)
        },
    }


def as_table(result: Study) -> str:
    """The study as a text table."""
    parameters, (y2, y3) = result.parameters, result.at
    lines = [
        f"internal dynamics of the flexible link, output held at y2 = {y2 * 1e3:g} mm,"
        f" y3 = {y3 * 1e3:g} mm",
        f"plant {parameters.plant.replace('_', ' ')}, rho = {parameters.rho:g} kg/m,"
        f" first frequency {parameters.frequency:g} Hz, zeta = {parameters.zeta:g} in every mode",
        f"largest real part of the exponents [1/s]; above 0 the inside is unstable"
        f" (sqrt(EI/rho)/l^2 = {result.unit:.3f} 1/s)",
        "",
        "modes  critical alpha" + "".join(f"{f'alpha={a:g}':>12s}" for a in result.alphas),
    ]
    for modes, (critical, row) in enumerate(zip(result.critical, result.fastest, strict=True), 1):
        limit = f"{critical:.4f}" if math.isfinite(critical) else "none"
        lines.append(f"{modes:5d}  {limit:>14s}" + "".join(f"{value:12.2f}" for value in row))
    return "\n".join(lines)


# Any robot with fewer motors than coordinates


@dataclass(frozen=True, slots=True, eq=False)
class RobotStudy:
    """The zero dynamics of a robot at rest, by the model of its controller.

    Attributes:
        robot: its name.
        at: place of the end-point in the path's plane, [m].
        exponents: [1/s], by decreasing real part.
        rate: their largest real part, [1/s], and 0 if they are neutral.
        alphas: shape (a,); empty for a robot without a parameter alpha.
        fastest: largest real part for each alpha, shape (a,), [1/s].
        critical: alpha above which it is positive; infinity if it never is.
    """

    robot: str
    at: tuple[float, float]
    exponents: np.ndarray
    rate: float
    alphas: np.ndarray
    fastest: np.ndarray
    critical: float


def robot_study(
    entry: RobotEntry, assignments: dict[str, str], at: tuple[float, float]
) -> RobotStudy | str:
    """The study of a robot, or a sentence if it has no zero dynamics.

    Raises:
        ValueError: an unknown parameter or a bad value; the end-point is out of reach; the
            decoupling matrix is singular there, or the robot is not in equilibrium.
    """
    parameters = with_values(entry.parameters(), assignments)
    robot = entry.make(parameters)
    system = robot.core.system
    if system.n == system.m:
        return f"{entry.name} has a motor for each of its coordinates, and no zero dynamics"
    if system.m != system.p:
        return f"{entry.name} has more motors than outputs: its zero dynamics are not computed"
    if not robot.margin(np.array(at)) > 0:
        raise ValueError(f"the end-point is out of reach at ({at[0]:g}, {at[1]:g}) m")
    q = robot.rest(robot.frame.lift(np.array(at)))
    if not rank_number(robot, parameters, q, by_model=True) > LEAST_RANK:
        raise CodedError("forecast.singular")
    rate = growth_rate(robot, parameters, q)
    if rate is None:
        raise CodedError("forecast.no_rest")
    model, zero = robot.model(parameters), zero_dynamics_at(robot, parameters, q)
    alphas, fastest, critical = np.zeros(0), np.zeros(0), math.inf
    if "alpha" in system.parameter_names:
        alphas = np.array(TABLE_ALPHAS)
        fastest = zero.exponents(q, zero.with_alpha(model, alphas))[:, 0].real
        critical = zero.critical_alpha(q, model)
    return RobotStudy(
        robot=entry.name,
        at=at,
        exponents=zero.exponents(q, model)[0],
        rate=rate,
        alphas=alphas,
        fastest=fastest,
        critical=critical,
    )


def robot_json(result: RobotStudy) -> dict[str, Any]:
    """Data for `--json`: numbers with nine digits, null where nothing is unstable or singular."""
    data: dict[str, Any] = {
        "robot": result.robot,
        "at_m": list(result.at),
        "exponents_1_s": [[_nine(x.real), _nine(x.imag)] for x in result.exponents.tolist()],
        "growth_rate_1_s": _nine(result.rate),
    }
    if result.alphas.size:
        rates = zip(result.alphas, result.fastest, strict=True)
        data["critical_alpha"] = _nine(result.critical)
        data["largest_real_part_1_s"] = {f"{alpha:g}": _nine(rate) for alpha, rate in rates}
    return data


def robot_table(result: RobotStudy) -> str:
    """The study of a robot as text."""
    poles = Channel("zero dynamics", result.exponents, stable=False, integral=False)
    y1, y2 = (1e3 * each for each in result.at)
    lines = [
        f"zero dynamics of {result.robot} at rest, end-point held at ({y1:g}, {y2:g}) mm of the"
        f" path's plane",
        f"exponents [1/s]: {poles.pole_words()}",
        _stability(result.rate),
    ]
    if result.alphas.size:
        limit = f"{result.critical:.4f}" if math.isfinite(result.critical) else "none"
        lines += [
            "",
            f"critical alpha: {limit}",
            "largest real part of the exponents [1/s]",
            "".join(f"{f'alpha={alpha:g}':>12s}" for alpha in result.alphas),
            "".join(
                f"{rate:12.2f}" if math.isfinite(rate) else f"{'singular':>12s}"
                for rate in result.fastest
            ),
        ]
    return "\n".join(lines)


def _stability(rate: float) -> str:
    if rate > 0:
        return f"unstable: the internal motion grows tenfold in {math.log(10) / rate:.2g} s"
    if rate == 0:
        return "neutral: the internal motion goes on for ever"
    return f"stable: the internal motion decays to a tenth in {math.log(10) / -rate:.2g} s"


def _nine(value: float) -> float | None:
    return float(f"{value:.9g}") if math.isfinite(value) else None
