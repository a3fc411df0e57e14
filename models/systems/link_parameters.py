"""The inertial parameters of a chain's links, and the combinations on which its motion depends.

Link j has its mass m_j, first moments mx_j, my_j, mz_j, inertias Ixx_j, Ixy_j, ..., Izz_j about
the origin of its frame (`robot_files/chain.py`: z is the axis of joint j), the inertia Ia_j of its
motor and the viscous friction b_j of its joint. The equations of motion are linear in all of them,

    u = Y(q, v, v') π,

but the columns of Y depend on each other, so that only combinations act, the base parameters. The
columns are taken from the base to the tip. One that depends on those before it, Y_d = Y_b k for
all states, is left out, and its parameter goes to theirs:

    β = π_b + K π_d,   u = Y_b β,   K = R_b⁻¹ R_d,   [Y_b Y_d] = Q [R_b R_d],

with Y at random states below each other. R follows by Householder reflections, and a column
depends on others where its diagonal element vanishes.

Source: Gautier, Numerical calculation of the base inertial parameters of robots, IEEE ICRA 1990;
Khalil and Dombre, Modeling, Identification and Control of Robots, 9.4 and appendix 5.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.robot_files.chain import Body, Chain
from onpath.models.systems.rigid_chain import (
    ChainSource,
    Inertia,
    bias_forces,
    chain_frames,
    chain_inertias,
    mass_matrix,
    potential_energy,
    solved,
    tip_of,
)
from onpath.models.systems.system import MechanicalSystem, mechanical_system

OF_LINK = (
    *("Ixx", "Ixy", "Ixz", "Iyz", "Izz", "mx", "my", "Ia", "b"),
    *("Iyy", "mz", "m"),  # for a joint that turns, these go to the link before it
)
STATES = 8  # random ones for each parameter of a link
DEPENDS = 1e-8  # least distance of a column of length 1 from the space of those before it
NEGLIGIBLE = 1e-9  # share of a column's length in another below which it is rounding


@dataclass(frozen=True, slots=True, eq=False)
class BaseSet:
    """The base parameters of a chain.

    Attributes:
        names: of all parameters π of its links, as "Ixx1".
        leading: the one that names each base parameter, a place in `names`.
        sums: [1 K] with columns in the order of `names`: β = sums π, shape (b, len(names)).
    """

    names: tuple[str, ...]
    leading: tuple[int, ...]
    sums: Array

    @property
    def base_names(self) -> tuple[str, ...]:
        """Names of the base parameters."""
        return tuple(self.names[i] for i in self.leading)

    def terms(self, base: int) -> tuple[tuple[str, float], ...]:
        """The parameters in a base parameter, with their multiples; the leading one is first."""
        row, first = self.sums[base], self.leading[base]
        others = [i for i in np.flatnonzero(row).tolist() if i != first]
        return tuple((self.names[i], float(row[i])) for i in (first, *others))


def link_names(chain: Chain) -> tuple[str, ...]:
    """Names of the parameters of all links."""
    return tuple(f"{name}{i}" for i in range(1, chain.n + 1) for name in OF_LINK)


def stated_values(chain: Chain) -> Array:
    """π as the robot's file has it, in the order of `link_names`."""
    return np.array([_stated(body)[name] for body in chain.bodies for name in OF_LINK])


def _stated(body: Body) -> dict[str, float]:
    values = {"m": body.mass, "Ia": body.joint.armature, "b": body.joint.damping}
    values |= {f"m{axis}": float(x) for axis, x in zip("xyz", body.moment, strict=True)}
    axes = [(i, k) for i in range(3) for k in range(i, 3)]
    return values | {f"I{'xyz'[i]}{'xyz'[k]}": float(body.inertia[i, k]) for i, k in axes}


@lru_cache(maxsize=16)
def scaled_system(source: ChainSource) -> MechanicalSystem:
    """The chain's equations of motion with factors and friction that few numbers tell.

    Its parameters are factors of all masses and inertias and of all weights, a payload, [kg], and
    the viscous friction of each joint, which files rarely know.
    """
    chain = source.chain
    q, v = ca.SX.sym("q", chain.n), ca.SX.sym("v", chain.n)
    names = ("inertia", "weight", "payload", *(f"b{i + 1}" for i in range(chain.n)))
    parameters = ca.SX.sym("parameters", len(names))
    inertia, weight, payload, *viscous = ca.vertsplit(parameters)
    frames = chain_frames(chain, q)
    inertias, weights = (chain_inertias(chain, each, payload) for each in (inertia, weight))
    mass = mass_matrix(chain, frames, inertias, inertia)
    bias = bias_forces(chain, frames, inertias, weights, v) + ca.vertcat(*viscous) * v
    return _system(source, q, v, parameters, names, (mass, bias, potential_energy(frames, weights)))


def link_motion(chain: Chain, q: ca.SX, v: ca.SX, parameters: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """M(q), c(q, v) with friction, and V(q), for given parameters of the links."""
    p = dict(zip(link_names(chain), ca.vertsplit(parameters), strict=True))
    frames, inertias = chain_frames(chain, q), [_inertia(p, i + 1) for i in range(chain.n)]
    rotors = ca.vertcat(*[p[f"Ia{i + 1}"] for i in range(chain.n)])
    viscous = ca.vertcat(*[p[f"b{i + 1}"] for i in range(chain.n)])
    mass = mass_matrix(chain, frames, inertias, ca.SX(0)) + ca.diag(rotors)
    bias = bias_forces(chain, frames, inertias, inertias, v) + viscous * v
    return mass, bias, potential_energy(frames, inertias)


def _inertia(p: dict[str, ca.SX], link: int) -> Inertia:
    moment = ca.vertcat(*[p[f"m{axis}{link}"] for axis in "xyz"])
    rows = [[p[f"I{''.join(sorted(a + b))}{link}"] for b in "xyz"] for a in "xyz"]
    return Inertia(p[f"m{link}"], moment, ca.vertcat(*[ca.horzcat(*row) for row in rows]))


def regressor(chain: Chain) -> ca.Function:
    """The function (q, v, v') -> Y, (n, len(link_names))."""
    q, v, a = (ca.SX.sym(name, chain.n) for name in ("q", "v", "a"))
    parameters = ca.SX.sym("parameters", len(link_names(chain)))
    mass, bias, _ = link_motion(chain, q, v, parameters)
    slopes = ca.jacobian(mass @ a + bias, parameters)
    return ca.Function("regressor", [q, v, a], [ca.densify(slopes)])


@lru_cache(maxsize=16)
def base_set(source: ChainSource) -> BaseSet:
    """The base parameters of a chain; see this module's docstring."""
    from scipy.linalg import qr, solve_triangular  # slow to import

    chain, names = source.chain, link_names(source.chain)
    draw, count = np.random.default_rng(0), STATES * len(OF_LINK)
    states = [draw.uniform(-np.pi, np.pi, (chain.n, count))]
    states += [draw.normal(size=(chain.n, count)) for _ in range(2)]
    columns = regressor(chain).map(count)(*states).full()
    stacked = columns.reshape(chain.n, count, len(names)).reshape(-1, len(names))
    lengths = np.linalg.norm(stacked, axis=0)
    lengths[lengths < NEGLIGIBLE * lengths.max()] = np.inf  # only rounding
    scaled = stacked / lengths
    leading, others = list[int](), list[int]()
    for i in range(len(names)):  # a dependent column changes no later diagonal element
        triangle = np.abs(qr(scaled[:, [*leading, i]], mode="r")[0])
        (leading if triangle[len(leading), len(leading)] > DEPENDS else others).append(i)
    (triangle,) = qr(scaled[:, [*leading, *others]], mode="r")
    b = len(leading)
    shares = solve_triangular(triangle[:b, :b], triangle[:b, b:])
    shares[np.abs(shares) < NEGLIGIBLE] = 0.0
    sums = np.zeros((b, len(names)))
    sums[np.arange(b), leading] = 1.0
    moved = np.where(np.isfinite(lengths[others]), lengths[others], 0.0)
    sums[:, others] = shares * moved / lengths[leading][:, None]
    return BaseSet(names, tuple(leading), sums)


@lru_cache(maxsize=16)
def base_system(source: ChainSource) -> MechanicalSystem:
    """The chain's equations of motion with its base parameters as the only ones."""
    chain, base = source.chain, base_set(source)
    q, v = ca.SX.sym("q", chain.n), ca.SX.sym("v", chain.n)
    parameters = ca.SX.sym("parameters", len(base.leading))
    values = [ca.SX(0)] * len(base.names)
    for i, value in zip(base.leading, ca.vertsplit(parameters), strict=True):
        values[i] = value
    motion = link_motion(chain, q, v, ca.vertcat(*values))
    return _system(source, q, v, parameters, base.base_names, motion)


def _system(
    source: ChainSource,
    q: ca.SX,
    v: ca.SX,
    parameters: ca.SX,
    names: tuple[str, ...],
    motion: tuple[ca.SX, ca.SX, ca.SX],
) -> MechanicalSystem:
    """A system of the chain with M, c and V."""
    mass, bias, energy = motion
    tip = tip_of(source.chain, chain_frames(source.chain, q))
    return mechanical_system(
        name=source.name,
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=names,
        mass=mass,
        bias=bias,
        inputs=source.chain.n,
        output=ca.densify(ca.DM(source.axes) @ tip),
        potential_energy=energy,
        solve=solved,
    )
