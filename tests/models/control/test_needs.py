"""What a setting needs in order to act, and whether it needs another loop, is what is declared."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import changed, specs, values_of, with_values
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import Experiment, experiments
from onpath.models.studies.unused import unused
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Need, Spec
from onpath.models.systems.parameters import Parameters

SOME = ("path_following", "trajectory_tracking")
STRUCTURE = ("path", "robot")
"""Groups of parameters that make another robot or path."""


def values(name: str, spec: Spec) -> st.SearchStrategy[Any]:
    """The values of a setting that decide on others: options, off and on."""
    if spec.options:
        return st.sampled_from(spec.options)
    return st.sampled_from([spec.low if name == "observer_time" else 0.0, spec.on])


@st.composite
def trials(draw: st.DrawFn, robot: str) -> tuple[Experiment, str]:
    """An experiment with drawn settings, and a law for it."""
    entry = ROBOTS[robot]
    deciding = {
        name: values(name, spec)
        for name, spec in specs(entry.parameters).items()
        if (spec.options or spec.on is not None)
        and spec.group not in STRUCTURE
        and name != "across"  # not every path allows it
    }
    given = draw(st.fixed_dictionaries({}, optional=deciding))
    first = next(iter(experiments(robot).values()))
    experiment = dataclasses.replace(first, parameters=with_values(entry.parameters(), given))
    laws = [name for name, law in LAWS.items() if law.suits(experiment.robot().system)]
    return experiment, draw(st.sampled_from(laws))


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "flexible"])
@settings(max_examples=6, deadline=None)
@given(data=st.data())
def test_a_setting_whose_needs_are_not_met_changes_no_motion(
    robot: str, data: st.DataObject
) -> None:
    """So a page may hide it; `unused` asks the compiled loop's own graph."""
    experiment, law = data.draw(trials(robot))
    now = values_of(experiment.parameters) | dict.fromkeys(SIDES, law)
    known = specs(experiment.parameters).items()
    idle = [name for name, spec in known if not all(need.met(now) for need in spec.needs)]
    assert unused(experiment, law, idle) == idle


def fulfilled(need: Need, parameters: Parameters) -> Parameters:
    """Parameters that meet a need, as near as possible to the given ones."""
    spec = specs(parameters)[need.name]
    value = need.of[0] if need.of else spec.on or spec.high
    return changed(parameters, need.name, value)


def conditional(robot: str) -> list[str]:
    return [name for name, spec in specs(ROBOTS[robot].parameters).items() if spec.needs]


@pytest.mark.parametrize("name", conditional("five_bar"))
def test_a_setting_whose_needs_are_met_acts_under_some_law(name: str) -> None:
    first = next(iter(experiments("five_bar").values()))
    parameters = ROBOTS["five_bar"].parameters()
    for need in specs(parameters)[name].needs:
        parameters = fulfilled(need, parameters)
    experiment = dataclasses.replace(first, parameters=parameters)
    assert any(not unused(experiment, law, [name]) for law in SOME)


@pytest.mark.parametrize("robot", ROBOTS)
def test_what_compiles_another_loop_is_declared(robot: str) -> None:
    entry, known = ROBOTS[robot], specs(ROBOTS[robot].parameters)
    curve, wrong = presets()["ellipse"].curve, list[str]()
    for name, spec in known.items():
        parameters = entry.parameters()
        for need in spec.needs:
            parameters = fulfilled(need, parameters)
        kinds, robots = set[Any](), set[Any]()
        for value in spec.options or (spec.low, spec.high, spec.on or spec.high):
            other = changed(parameters, name, value)
            robots.add(entry.make(other).core)
            kinds |= {kind_of(law, other, curve) for law in SOME}
        if spec.compiles != (len(kinds) > len(SOME) or len(robots) > 1):
            wrong.append(name)
    assert wrong == []


def test_every_need_names_a_setting_and_values_that_it_can_have() -> None:
    lab = {name: setting.spec for name, setting in SETTINGS.items()}
    every = [specs(entry.parameters) for entry in ROBOTS.values()]
    known = lab | {name: spec for each in every for name, spec in each.items()}
    needs = [need for spec in known.values() for need in spec.needs]
    while needs:
        need = needs.pop()
        needs += need.instead
        if need.name in SIDES:
            assert set(need.of) <= set(LAWS)
        else:
            options = known[need.name].options
            assert set(need.of) <= set(options) if options else need.of in ((), (0.0,))
