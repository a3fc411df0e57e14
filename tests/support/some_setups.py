"""Random set-ups such as students create."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from onpath.app.lab.setups.capture import capture_path, kept
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.models.closed_loop.lab_settings import settings_kept
from onpath.models.control.settable import specs, value_of
from onpath.models.paths.drawing_design import drawn, from_curve
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.paths.spline_fit import spline_through
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Spec

CALM = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow], max_examples=20)
PRESETS = presets()
FOLLOWABLE = sorted(PRESETS)


def wave(shape: float, phase: float, closed: bool) -> PathDesign:
    """A path such as a user might draw freehand."""
    t = np.linspace(-1, 1, 60)
    if closed:
        radius = 0.05 + 0.01 * shape * np.cos(2 * np.pi * t + phase)
        return drawn(radius[:, None] * np.column_stack([np.cos(np.pi * t), np.sin(np.pi * t)]))
    return drawn(np.column_stack([0.06 * t, 0.02 * shape * np.sin(2 * t + phase)]))


def word(seed: int) -> PathDesign:
    """A drawing of some strokes, which may have been bent."""
    rng = np.random.default_rng(seed)
    places = 0.03 * np.arange(rng.integers(1, 4))
    strokes = [rng.uniform(-0.03, 0.03, (4, 2)) + (place, 0) for place in places - places.mean()]
    design = from_curve(spline_through(strokes))
    index = int(rng.integers(2 * len(design.points)))
    if index >= len(design.points):
        return design
    return design.moved(index, design.points[index] + rng.uniform(-0.004, 0.004, 2))


def _edited(name: str, index: int, dx: float, dy: float) -> PathDesign:
    design = PRESETS[name]
    index %= len(design.points)
    return design.moved(index, design.points[index] + [dx, dy])


_UNIT = st.floats(-1, 1)
_MILLIMETRES = st.floats(-0.004, 0.004)
_NAMES = st.sampled_from(FOLLOWABLE)
designs = st.one_of(
    _NAMES.map(PRESETS.__getitem__),
    st.builds(_edited, _NAMES, st.integers(0, 23), _MILLIMETRES, _MILLIMETRES),
    st.builds(wave, _UNIT, st.floats(0, 6), st.booleans()),
    st.builds(word, st.integers(0, 10**6)),
)


def _value(spec: Spec) -> st.SearchStrategy[Any]:
    if spec.options:
        return st.sampled_from(spec.options)
    return st.floats(spec.low, spec.high).map(lambda x: kept(spec, x))


def _own(of_robot: bool) -> st.SearchStrategy[dict[str, Any]]:
    """Values of the lab's own settings that differ from a new lab's."""
    known = {n: s for n, s in settings_kept("code", of_robot).items() if "start" not in n}
    values = {n: _value(s.spec).filter(lambda v, s=s: v != s.default) for n, s in known.items()}
    return st.fixed_dictionaries({}, optional=values)


@st.composite
def sides(draw: st.DrawFn, robot: str) -> RobotSetup:
    """A set-up of one robot, as `capture` makes it."""
    lab = ROBOTS[robot].parameters()
    some = draw(st.lists(st.sampled_from(list(specs(lab).items())), max_size=6))
    values = {name: draw(_value(spec)) for name, spec in some}
    own = {name: value for name, value in values.items() if value != value_of(lab, name)}
    return RobotSetup(own, capture_path(draw(designs), PRESETS), draw(_own(of_robot=True)))


@st.composite
def setups(draw: st.DrawFn) -> Setup:
    """A set-up of a lab, as `capture` makes it."""
    names = draw(st.lists(st.sampled_from(list(ROBOTS)), unique=True, max_size=2))
    found = {name: draw(sides(name)) for name in sorted(names)}
    return Setup(
        robot=draw(st.sampled_from(list(ROBOTS))),
        robots={name: robot for name, robot in found.items() if robot != RobotSetup()},
        settings=draw(_own(of_robot=False)),
    )
