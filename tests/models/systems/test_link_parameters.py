"""The combinations of the links' inertial parameters on which a chain's motion depends."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from onpath.models.robot_files.chain import Body, Chain, Joint
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.link_parameters import (
    OF_LINK,
    BaseSet,
    base_set,
    base_system,
    regressor,
    stated_values,
)
from onpath.models.systems.rigid_chain import ChainSource


@st.composite
def chains(draw: st.DrawFn) -> ChainSource:
    """Joints of both kinds, with axes that are parallel, that meet, and that do neither."""
    turns = st.sampled_from([(0, 0, 0), (90, 0, 0), (-90, 0, 0), (0, 90, 0), (30, 40, 50)])
    steps = st.sampled_from([(0, 0, 0), (0.3, 0, 0), (0, 0, 0.2), (0.1, -0.2, 0.3)])
    rng = np.random.default_rng(draw(st.integers(0, 99)))
    bodies = tuple(
        Body(
            name=f"link{i}",
            joint=Joint(f"joint{i}", slides=draw(st.integers(0, 3)) == 0),
            rotation=Rotation.from_euler("xyz", draw(turns), degrees=True).as_matrix(),
            translation=np.array(draw(steps), dtype=float),
            mass=1.0 + rng.random(),
            moment=rng.normal(size=3),
            inertia=np.eye(3) + 0.1 * np.ones((3, 3)),
        )
        for i in range(draw(st.integers(1, 4)))
    )
    chain = Chain(bodies, np.array([0.1, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    axes = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    return ChainSource("chain", "Chain", "", chain, (0.0,) * chain.n, axes)


def torques(source: ChainSource, values: np.ndarray, seed: int) -> tuple[np.ndarray, float]:
    """Torques of some links in a random state, and their scale."""
    rng, slopes = np.random.default_rng(seed), regressor(source.chain)
    state = [rng.normal(size=source.chain.n) for _ in range(3)]
    found = slopes(*state).full()
    return found @ values, float(np.abs(found).sum() * np.abs(values).max())


def hidden_change(base: BaseSet, rng: np.random.Generator) -> np.ndarray:
    """A random change of the links that leaves all base parameters as they are."""
    change = rng.normal(size=len(base.names))
    lead = list(base.leading)
    change[lead] = 0.0
    change[lead] = -(base.sums @ change)
    return change


@settings(deadline=None, max_examples=15)
@given(chains(), st.integers(0, 9999))
def test_only_the_base_parameters_act(source: ChainSource, seed: int) -> None:
    """Links with the same base parameters need the same torques, whatever moves."""
    rng, base = np.random.default_rng(seed), base_set(source)
    links = rng.normal(size=len(base.names))
    own, scale = torques(source, links, seed)
    other, _ = torques(source, links + hidden_change(base, rng), seed)
    assert np.abs(other - own).max() < 1e-9 * scale
    grouped = np.zeros(len(base.names))
    grouped[list(base.leading)] = base.sums @ links
    assert np.abs(torques(source, grouped, seed)[0] - own).max() < 1e-9 * scale


@settings(deadline=None, max_examples=15)
@given(chains(), st.integers(0, 9999))
def test_every_base_parameter_acts(source: ChainSource, seed: int) -> None:
    """None can be left out: other base parameters need other torques in some state."""
    base = base_set(source)
    change = np.zeros(len(base.names))
    lead = list(base.leading)
    change[lead] = np.random.default_rng(seed).normal(size=len(lead))
    apart = [np.abs(torques(source, change, k)[0]).max() for k in range(3)]
    assert max(apart) > 1e-6


@pytest.mark.parametrize("name, count", [("planar_arm", 9), ("seven_axes", 43)])
def test_the_numbers_of_base_parameters_are_known(name: str, count: int) -> None:
    """Izz, mx and my of each link of an arm in an upright plane; 43 of seven axes that meet in a
    shoulder, an elbow and a wrist. Motors' inertias and friction are not counted.
    """
    source = ROBOTS[name].source
    assert source is not None
    base = base_set(source)
    inertial = [each for each in base.base_names if each[0] != "b" and each[:2] != "Ia"]
    assert len(inertial) == count
    assert len(base.names) == len(OF_LINK) * source.chain.n


def test_the_system_of_base_parameters_is_that_of_the_robot() -> None:
    source = ROBOTS["seven_axes"].source
    assert source is not None
    entry, base = ROBOTS["seven_axes"], base_set(source)
    robot = entry.make(entry.parameters())
    rng = np.random.default_rng(3)
    q, v = rng.normal(size=7), rng.normal(size=7)
    plant = robot.plant(entry.parameters())
    mass, bias = robot.system.function("mass", "bias")(q, v, plant)
    values = base.sums @ stated_values(source.chain)
    own_mass, own_bias = base_system(source).function("mass", "bias")(q, v, values)
    a = rng.normal(size=7)
    wanted = mass.full() @ a + bias.full()[:, 0]
    assert own_mass.full() @ a + own_bias.full()[:, 0] == pytest.approx(wanted, abs=1e-9)
