"""The planar five-bar linkage with rigid links: a parallelogram with both motors at the base.

Link 3 stays parallel to link 1 and link 4 to link 2, so that the two base angles are coordinates.
The equations of motion (Spong and Vidyasagar 6.4.1) are

    M11 q1'' + M12 cos(q2 - q1) q2'' - M12 sin(q2 - q1) q2'² + G1 cos q1 + b1 q1' = τ1,
    M22 q2'' + M12 cos(q2 - q1) q1'' + M12 sin(q2 - q1) q1'² + G2 cos q2 + b2 q2' = τ2.

The paper's robot, eqs. (12)-(13), is balanced and decoupled: M12 = G1 = G2 = 0.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from onpath.assets import asset_path
from onpath.models.systems.system import GRAVITY, MechanicalSystem, mechanical_system

HOME = np.array([np.pi / 2, np.pi])


@dataclass(frozen=True, slots=True)
class Link:
    """One link of the linkage.

    Attributes:
        length: [m].
        mass: [kg].
        centre_of_mass: distance from the joint, along the link, [m].
        inertia: about the centre of mass, [kg m²].
    """

    length: float
    mass: float
    centre_of_mass: float
    inertia: float


@dataclass(frozen=True, slots=True)
class FiveBarLinks:
    """Links and joint friction of a five-bar."""

    link1: Link
    link2: Link
    link3: Link
    link4: Link
    viscous1: float  # b1, [N m s]
    viscous2: float  # b2, [N m s]

    def spoiled(self, removed: float, payload: float) -> FiveBarLinks:
        """The linkage with some counterweights removed and with a mass at the end-point.

        Args:
            removed: fraction of the counterweights' moments that is removed, 0 to 1.
            payload: mass at the end-point, [kg].
        """
        total = self.link4.mass + payload
        centre = (self.link4.mass * self.link4.centre_of_mass + payload * self.link4.length) / total
        inertia = (
            self.link4.inertia
            + self.link4.mass * (self.link4.centre_of_mass - centre) ** 2
            + payload * (self.link4.length - centre) ** 2
        )
        kept = 1.0 - removed
        return replace(
            self,
            link1=replace(self.link1, centre_of_mass=self.link1.centre_of_mass * kept),
            link2=replace(self.link2, centre_of_mass=self.link2.centre_of_mass * kept),
            link4=Link(self.link4.length, total, centre, inertia),
        )

    def lumped(self) -> dict[str, float]:
        """The parameters of the equations of motion by name (SI).

        With lengths l, masses m, centres of mass c and inertias I of the links:

            M11 = I1 + m1 c1² + I3 + m3 c3² + m4 l1²,   G1 = g (m1 c1 + m3 c3 + m4 l1),
            M22 = I2 + m2 c2² + I4 + m4 c4² + m3 l2²,   G2 = g (m2 c2 + m3 l2 - m4 c4),
            M12 = l2 m3 c3 - l1 m4 c4.

        Source: Spong and Vidyasagar 6.4.1.
        """
        one, two, three, four = self.link1, self.link2, self.link3, self.link4
        moment3 = three.mass * three.centre_of_mass
        moment4 = four.mass * four.centre_of_mass
        return {
            "M11": one.inertia
            + one.mass * one.centre_of_mass**2
            + three.inertia
            + three.mass * three.centre_of_mass**2
            + four.mass * one.length**2,
            "M22": two.inertia
            + two.mass * two.centre_of_mass**2
            + four.inertia
            + four.mass * four.centre_of_mass**2
            + three.mass * two.length**2,
            "M12": two.length * moment3 - one.length * moment4,
            "G1": GRAVITY * (one.mass * one.centre_of_mass + moment3 + four.mass * one.length),
            "G2": GRAVITY * (two.mass * two.centre_of_mass + three.mass * two.length - moment4),
            "b1": self.viscous1,
            "b2": self.viscous2,
            "l1": one.length,
            "l4": four.length,
        }


def load_links() -> FiveBarLinks:
    """The illustrative linkage of assets/five_bar.toml, which is balanced and decoupled."""
    data = tomllib.loads(asset_path("five_bar.toml").read_text("utf-8"))
    links = {name: Link(**data[name]) for name in ("link1", "link2", "link3", "link4")}
    return FiveBarLinks(**links, **data["friction"])


def five_bar() -> MechanicalSystem:
    """The five-bar's equations of motion, with parameters named as in `FiveBarLinks.lumped`.

    Source: eqs. (12)-(13); Spong and Vidyasagar 6.4.1 for the coupling and gravity terms.
    """
    names = ("M11", "M22", "M12", "G1", "G2", "b1", "b2", "l1", "l4")
    parameters = ca.SX.sym("parameters", len(names))
    p = dict(zip(names, ca.vertsplit(parameters), strict=True))
    q, v = ca.SX.sym("q", 2), ca.SX.sym("v", 2)
    c1, s1, c2, s2 = ca.cos(q[0]), ca.sin(q[0]), ca.cos(q[1]), ca.sin(q[1])
    coupling = p["M12"] * (c1 * c2 + s1 * s2)  # M12 cos(q2 - q1)
    turning = p["M12"] * (s2 * c1 - c2 * s1)  # M12 sin(q2 - q1)
    bias = ca.vertcat(
        p["G1"] * c1 + p["b1"] * v[0] - turning * v[1] ** 2,
        p["G2"] * c2 + p["b2"] * v[1] + turning * v[0] ** 2,
    )
    tip = ca.vertcat(p["l1"] * c1 - p["l4"] * c2, p["l1"] * s1 - p["l4"] * s2)
    return mechanical_system(
        name="five_bar",
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=names,
        mass=ca.blockcat([[p["M11"], coupling], [coupling, p["M22"]]]),
        bias=bias,
        inputs=2,
        output=tip - ca.vertcat(p["l4"], p["l1"]),
        potential_energy=p["G1"] * s1 + p["G2"] * s2,
        solve=_solve_symmetric,
    )


def _solve_symmetric(mass: ca.SX, rhs: ca.SX) -> ca.SX:
    """M⁻¹ R of a symmetric 2 x 2 matrix by elimination; both calls share 1 / M11."""
    inverse, b = 1 / mass[0, 0], mass[0, 1]
    part = inverse * b
    second = (rhs[1, :] - part * rhs[0, :]) / (mass[1, 1] - part * b)
    return ca.vertcat(inverse * (rhs[0, :] - b * second), second)


def inverse_kinematics(y: ca.SX, l1: float, l4: float) -> ca.SX:
    """Joint angles of the elbow-up pose with the end-point at y, (2, 1) -> (2, 1), [rad].

    The home pose is q = (π/2, π); NaN out of reach.

    Args:
        y: end-point, [m].
        l1, l4: link lengths, [m].

    Source: inverse of eq. (13).
    """
    x, z = y[0] + l4, y[1] + l1
    reach = ca.sqrt(x**2 + z**2)
    q1 = ca.atan2(z, x) + ca.acos((l1**2 + reach**2 - l4**2) / (2 * l1 * reach))
    q2 = ca.atan2(l1 * ca.sin(q1) - z, l1 * ca.cos(q1) - x)
    return ca.vertcat(q1, q2 - 2 * np.pi * ca.floor(q2 / (2 * np.pi)))


def skeleton(q: ca.SX, l1: float, l2: float, l4: float) -> tuple[ca.SX, ca.SX]:
    """Links and bearings in the robot's frame (x right, y away, z up, base pivot at the origin).

    Args:
        q: joint angles, at least 2, CasADi symbols or numbers, [rad].
        l1, l2, l4: link lengths, [m].

    Returns:
        bars, shape (3, 8): begin and end of links 1 to 4 as columns, [m]. joints, shape (3, 4):
        base, link 1-4, link 2-3, link 3-4, [m].
    """
    one, two = (ca.vertcat(ca.cos(q[i]), 0, ca.sin(q[i])) for i in range(2))
    base, a, b, tip = 0 * one, l1 * one, l2 * two, l1 * one - l4 * two
    c = a + b
    return ca.horzcat(base, a, base, b, b, c, c, tip), ca.horzcat(base, a, b, c)
