"""The poles that a page finds are those of the lab."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.control.poles import channels
from onpath.models.control.settable import with_values
from onpath.models.errors import Message
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.parameters import Parameters, look_ahead_time
from tests.support.node_page import NodePage, needs_node

pytestmark = needs_node
GAINS = st.floats(0, 1000)
NAMES = ("K1", "K2", "K3", "K4", "K5")


@pytest.fixture(scope="module")
def page() -> Iterator[NodePage]:
    page = NodePage()
    yield page
    page.close()


def motions(page: NodePage, parameters: Parameters) -> list[dict[str, Any]]:
    """What the page finds, across and along the path."""
    numbers = {
        "interval": 1 / parameters.control_rate,
        "ahead": look_ahead_time(parameters),
        "delay": parameters.delay,
        "position": parameters.task == "position",
    }
    gains = [getattr(parameters, name) for name in NAMES]
    return page.evaluate("given => motions(...given)", [numbers, gains])


@settings(max_examples=100)
@given(
    st.fixed_dictionaries(
        {
            "K1": GAINS,
            "K2": st.floats(0, 100),
            "K3": st.sampled_from([0.0, 50.0, 3000.0]),
            "K4": st.floats(0, 50),
            "K5": st.floats(0, 40),
            "task": st.sampled_from(["speed", "position"]),
            "control_rate": st.sampled_from([100, 200, 1000]),
            "delay": st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0]),
            "look_ahead": st.sampled_from(["half_tick", "half_interval"]),
        }
    )
)
def test_poles_are_those_of_the_lab(page: NodePage, values: dict[str, Any]) -> None:
    parameters = with_values(FiveBarParameters(), values)
    for channel, found in zip(channels(parameters), motions(page, parameters), strict=True):
        poles = np.sort([real for real, _ in found["poles"]])
        expected = np.sort(channel.poles.real)
        scale = max(1.0, float(np.abs(expected).max()))
        np.testing.assert_allclose(poles / scale, expected / scale, atol=1e-4)
        if np.abs(expected + 1e-3).min() < 1e-5 or abs(found["damping"] - 0.995) < 1e-3:
            continue  # rounding decides
        told = channel.behaviour()
        kind = told.arguments.get("kind", told)
        assert isinstance(kind, Message)
        assert f"behaviour.{found['behaviour']}" == kind.code
        if "seconds" in told.arguments:
            assert float(str(told.arguments["seconds"])) == pytest.approx(
                found["seconds"], rel=0.06
            )


def test_the_poles_of_a_new_lab_are_the_double_ones_of_the_text(page: NodePage) -> None:
    parameters = replace(FiveBarParameters(), K1=400.0, K2=40.0, K3=0.0)
    across, _ = motions(page, parameters)
    assert across["damping"] > 0.995
    np.testing.assert_allclose([real for real, _ in across["poles"]], -20, rtol=0.02)
