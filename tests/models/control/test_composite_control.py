"""Laws of composite control: exact where it promises it, and better than alpha = 0.5 as a whole."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.control import composite_control as composite
from onpath.models.control.laws.law import Clock, Gains, PathReference, View
from onpath.models.control.laws.path_following import path_following
from onpath.models.control.linearization import linearization
from onpath.models.control.virtual_output import VirtualOutput, virtual_output
from onpath.models.paths.curves import circle, nearest
from onpath.models.paths.frames import SlantedPlane
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.flexible_five_bar import HOME, RIGID, flexible_five_bar
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.flexible_robot import flexible_five_bar_robot

LINKS, BEAM, FRAME, RADIUS = load_links(), beam_modes(3, 0.5), SlantedPlane(), 0.05
SYSTEM = flexible_five_bar(3)
DT = 1e-3
START = np.array([np.pi / 2, np.pi - 0.12, 0.0])  # 10 mm off the path
GAINS = Gains(*[ca.SX(k) for k in (400.0, 40.0, 0.0, 25.0, 5.0)])
CHAIN = sum(size for _, size in composite.MEMORY.fields)


def numbers(**changes: float) -> Array:
    return SYSTEM.parameter_vector(LINKS.lumped(0.5) | changes)


def turned(**changes: float) -> composite.CompositeGains:
    """The default gains but for some, by their short names."""
    values = {name.removeprefix("tip_"): value for name, value in composite.GAINS.items()}
    return composite.CompositeGains(**{k: ca.SX(v) for k, v in (values | changes).items()})


def coordinates(y: ca.SX, y_rate: ca.SX) -> VirtualOutput:
    """Along and across the ellipse (23), whose projection is known."""
    untyped: Any = ca
    theta = untyped.atan2(y[2], y[1])
    sigma = RADIUS * ca.vertcat(ca.cos(theta), ca.sin(theta))
    first = ca.vertcat(-sigma[1], sigma[0])
    return virtual_output(LocalCurve(theta, sigma, first, -sigma, -first), FRAME, None, y, y_rate)


def moved(q: ca.SX, v: ca.SX, u: ca.SX, force: ca.SX) -> ca.SX:
    """(q, v) a tick later, by two Runge-Kutta steps with u and the force at the tip held."""
    model, h = ca.SX(numbers()), DT / 2
    pushed = ca.Function(
        "pushed", [SYSTEM.q, SYSTEM.parameters], [ca.jacobian(SYSTEM.output, SYSTEM.q)]
    )
    tau = pushed(q, model).T @ force + ca.vertcat(u, ca.SX.zeros(SYSTEM.n - RIGID))
    inputs = [SYSTEM.q, SYSTEM.v, SYSTEM.tau, SYSTEM.parameters]
    slope = ca.Function("slope", inputs, [ca.vertcat(SYSTEM.v, SYSTEM.acceleration)])

    def rate(x: ca.SX) -> ca.SX:
        return slope(x[: SYSTEM.n], x[SYSTEM.n :], tau, model)

    x = ca.vertcat(q, v)
    for _ in range(2):
        k1 = rate(x)
        k2 = rate(x + h / 2 * k1)
        k3 = rate(x + h / 2 * k2)
        x = x + h / 6 * (k1 + 2 * (k2 + k3) + rate(x + h * k3))
    return x


def following(q: ca.SX, v: ca.SX, output: VirtualOutput, speed: ca.SX) -> ca.SX:
    """Commanded y'' of path following at a speed."""
    zero, none = ca.SX(0), ca.SX.zeros(3)
    task = PathReference(zero, zero, speed, ca.SX(1e3), zero)
    clock = Clock(
        theta=zero,
        task=task,
        closed=True,
        dt=ca.SX(DT),
        interval=ca.SX(DT),
        ahead=ca.SX(DT / 2),
        memory={},
        plan=none,
    )
    ellipse = LocalCurve(zero, none, ca.SX(ca.vertcat(1, 0, 0)), none, none)
    view = View(
        system=SYSTEM,
        q=q,
        v=v,
        model=none,
        frame=output.frame,
        y=none,
        y_rate=none,
        output=output,
        closest=ellipse,
        drawing=False,
        reference=None,
        task=task,
        clock=clock,
        gains=GAINS,
        own_gains={},
        integral=none,
        lag=ca.SX(DT),
        measured=(q, v),
        held=none,
    )
    command = path_following(view).acceleration
    assert command is not None
    return command


@lru_cache
def tick(controlled: str, alpha: float, changes: tuple[tuple[str, float], ...]) -> ca.Function:
    """((q, v, memory), speed, force on the tip) -> (after, theta): a plain loop at 1 kHz."""
    x, speed, force = ca.SX.sym("x", 2 * SYSTEM.n + CHAIN), ca.SX.sym("speed"), ca.SX.sym("F", 3)
    q, v, model = x[: SYSTEM.n], x[SYSTEM.n : 2 * SYSTEM.n], ca.SX(numbers(alpha=alpha))
    chain = x[2 * SYSTEM.n :]
    memory = {name: chain[where] for name, where in composite.MEMORY.slices.items()}
    if controlled == "composite":
        now = composite.compensation(SYSTEM, q, v, model, memory, turned(**dict(changes)))
        output = coordinates(now.y, now.y_rate)
        command = following(q, v, output, composite.wanted_speed(now, output, GAINS.k5))
        rate = composite.rates(now, speed, command)
        u = composite.torques(now, rate, command)
        chain = chain + DT * composite.MEMORY.join(rate)
    else:
        output = coordinates(*SYSTEM.with_rate(SYSTEM.controlled_output)(q, v, model))
        command = following(q, v, output, speed)
        u = linearization(SYSTEM, q, v, model, command)
    after = ca.vertcat(moved(q, v, u, force), chain)
    return ca.Function("tick", [x, speed, force], [ca.cse(after), output.theta])


Leg = tuple[int, float, tuple[float, float, float]]  # ticks, speed, force on the tip
FREE = (0.0, 0.0, 0.0)


@lru_cache
def run(
    controlled: str,
    joints: tuple[float, ...],
    legs: tuple[Leg, ...],
    alpha: float = 0.5,
    **changes: float,
) -> tuple[Array, Array]:
    """Configurations and velocities (ticks, 2n) from rest, and theta (ticks,)."""
    step: Any = tick(controlled, alpha, tuple(sorted(changes.items())))
    x, states, thetas = np.zeros(2 * SYSTEM.n + CHAIN), list[Array](), list[Array]()
    x[:RIGID] = joints
    for ticks, speed, force in legs:
        after, theta = step.mapaccum(ticks)(x, speed, np.array(force))
        states.append(np.array(after).T)
        thetas.append(np.array(theta).ravel())
        x = states[-1][-1]
    return np.vstack(states)[:, : 2 * SYSTEM.n], np.unwrap(np.concatenate(thetas))


def distance(states: Array) -> Array:
    """Of the actual tip to the ellipse, (ticks,), [m]."""
    curve = circle(RADIUS)
    tips = flexible_five_bar_robot().endpoint(states[:, : SYSTEM.n])
    return nearest(lambda theta: FRAME.lift(curve.at(theta)), curve.sample(256), tips)[1]


def vibration(states: Array) -> Array:
    """Square root of the modes' energy, (ticks,)."""
    f, f_rate = states[:, RIGID : SYSTEM.n], states[:, SYSTEM.n + RIGID :]
    omega = 2 * np.pi * LINKS.frequency * BEAM.overtones
    return np.sqrt(LINKS.rho / 2 * (f_rate**2 + (omega * f) ** 2).sum(1))


# What is exact ------------------------------------------------------------------------------------


def test_the_shifted_output_has_the_commanded_acceleration_whatever_the_beam_does() -> None:
    """y_c'' along the motion that the torques cause, the memory moving as it says."""
    q, v, command = (ca.SX.sym(name, k) for name, k in (("q", 6), ("v", 6), ("a", 3)))
    chain, model = ca.SX.sym("chain", CHAIN), ca.SX(numbers())
    memory = {name: chain[where] for name, where in composite.MEMORY.slices.items()}
    now = composite.compensation(SYSTEM, q, v, model, memory, turned())
    rate = composite.rates(now, ca.SX(2.0), command)
    slope = ca.Function(
        "slope", [SYSTEM.q, SYSTEM.v, SYSTEM.parameters], [SYSTEM.drift, SYSTEM.input_gain]
    )
    drift, gain = slope(q, v, model)
    v_rate = drift + gain @ composite.torques(now, rate, command)
    chain_rate = composite.MEMORY.join(rate)
    along = ca.jtimes(now.y_rate, ca.vertcat(q, v, chain), ca.vertcat(v, v_rate, chain_rate))
    both = ca.Function("both", [q, v, chain, command], [now.y_rate, along])
    first = ca.jtimes(now.y, ca.vertcat(q, chain), ca.vertcat(v, chain_rate))
    consistent = ca.Function("consistent", [q, v, chain, command], [first])
    for seed in range(8):
        rng = np.random.default_rng(seed)
        at = rng.normal(size=(2, 6)) * np.array([0.3, 0.3, 0.5, 0.02, 0.005, 0.002])
        at[0, :RIGID] += HOME
        history, wanted = rng.normal(size=CHAIN) * 0.1, rng.normal(size=3)
        y_rate, y_acceleration = (np.array(part).ravel() for part in both(*at, history, wanted))
        assert y_acceleration == pytest.approx(wanted, abs=1e-9)
        moving = np.array(consistent(*at, history, wanted)).ravel()
        assert y_rate == pytest.approx(moving, abs=1e-12)


@pytest.mark.parametrize("damping", [0.1, 0.3])
def test_absorber_and_first_mode_have_the_damping_asked_for(damping: float) -> None:
    """m'' = a of the waist alone, at home, the rest of the law at rest."""
    chain, f, model = ca.SX.sym("chain", CHAIN), ca.SX.sym("f", 2), ca.SX(numbers(zeta=0.0))
    memory = {name: chain[where] for name, where in composite.MEMORY.slices.items()}
    q = ca.vertcat(ca.DM(HOME), f[0], 0, 0)
    now = composite.compensation(SYSTEM, q, ca.SX.zeros(6), model, memory, turned(damping=damping))
    m_rate, m_acceleration = ca.vertsplit(
        composite.rates(now, ca.SX(0), ca.SX.zeros(3))["absorber"]
    )
    omega = 2 * np.pi * LINKS.frequency
    per_demand = float(BEAM.moment[0]) / LINKS.beam
    f_acceleration = -(omega**2) * f[0] - per_demand * m_acceleration
    x = ca.vertcat(memory["absorber"], f)
    slope = ca.vertcat(m_rate, m_acceleration, f[1], f_acceleration)
    matrix = ca.Function("matrix", [ca.vertcat(chain, f)], [ca.jacobian(slope, x)])(0).full()
    # a double pair of poles is found to the square root of rounding
    expected = omega * complex(-damping, np.sqrt(1 - damping**2))
    poles = np.linalg.eigvals(matrix)
    assert np.abs(poles[poles.imag > 0] - expected).max() < 1e-5 * omega
    assert poles.size == 4 and np.all(poles.imag != 0)


# The whole ----------------------------------------------------------------------------------------

TASK = ((3000, 2.0, FREE), (3000, -2.0, FREE))


def rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.thorough
def test_the_tip_itself_stays_on_the_path() -> None:
    states, theta = run("composite", tuple(START), TASK)
    redefined, _ = run("redefined", tuple(START), TASK)
    off, off_before = distance(states)[2000:], distance(redefined)[2000:]
    assert rms(off) < 1e-4 and off.max() < 2e-4
    assert rms(off) < 0.2 * rms(off_before)
    assert (theta[-1] - theta[-101]) / 0.1 == pytest.approx(-2.0, rel=0.01)


@pytest.mark.thorough
def test_it_is_prediction_that_does_it() -> None:
    """Without, the rigid link would be on the path and the tip as far off as it bends."""
    states, _ = run("composite", tuple(START), TASK)
    blind, _ = run("composite", tuple(START), TASK, prediction=0.01)
    assert rms(distance(states)[2000:]) < 0.2 * rms(distance(blind)[2000:])


PULL = ((300, 0.0, FREE), (500, 0.0, (0.0, 0.1, 0.0)), (5000, 0.0, FREE))
LOWEST = (HOME[0], HOME[1] - 0.1, 0.0)


def fading(states: Array) -> float:
    """Time after the pull until the vibration has fallen to a tenth for good, [s]."""
    left = vibration(states)[800:]
    return float(np.flatnonzero(left > 0.1 * left[:100].max())[-1] * DT)


@pytest.mark.thorough
def test_vibration_after_a_pull_dies_out_sooner_than_by_the_structure_alone() -> None:
    """alpha = 0 holds the joints still: the beam is left to its own damping."""
    damped, _ = run("composite", LOWEST, PULL)
    alone, _ = run("redefined", LOWEST, PULL, alpha=0.0)
    assert fading(damped) < fading(alone) / 5
    assert distance(damped)[-1000:].max() < 1e-5


def test_progress_gives_way_to_a_tip_that_is_held_back() -> None:
    pulled = ((1500, 2.0, FREE), (500, 2.0, (0.0, -0.1, 0.0)))
    _, free = run("composite", LOWEST, pulled, yielding=0.0)
    _, gives = run("composite", LOWEST, pulled)
    assert free[1500] == pytest.approx(gives[1500], abs=0.02)
    assert abs(gives[-1] - free[-1]) > 0.05
