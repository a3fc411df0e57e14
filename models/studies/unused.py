"""Finds the values given to an experiment that have no effect on its motion."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.simulation import FREE, kernel_of, kind_of, settings_vector
from onpath.models.control.laws.own import law_title
from onpath.models.control.settable import changed, specs, value_of
from onpath.models.paths.projection import windowed
from onpath.models.paths.spline_curves import WINDOW
from onpath.models.studies.experiments import Experiment
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters, time_step

SPEED = ("speed", "ramp")
"""Settings of a loop that a speed profile determines."""
FROM_OUTSIDE = ("hand_", "hold_active", "hold_anchor", "hold_tangent", "hold_normal", "wall_")
"""Prefixes of the settings that change during a run."""


def unused_text(experiment: Experiment, laws: Sequence[str], names: Iterable[str]) -> str:
    """A sentence about the values without effect under any of the laws; empty if there are none.

    Args:
        names: as for `unused`.
    """
    found = [unused(experiment, law, names) for law in laws]
    idle = [name for name in found[0] if all(name in each for each in found)]
    titles = ", ".join(map(law_title, laws))
    return f"no effect under {titles}: {', '.join(idle)}" if idle else ""


def unused(experiment: Experiment, law: str, names: Iterable[str]) -> list[str]:
    """The names that make no difference to the motion under a law, whatever their values.

    A value makes a difference if it selects another robot, path or loop, or if the loop's
    coordinates depend on a setting that it changes, in the next tick or in a later one.

    Args:
        names: names of parameters, "profile", "reverse_at" or "clock_offset"; a schedule checks
            its other entries.
    """
    known = {*specs(experiment.parameters), "profile", "reverse_at", "clock_offset"}
    return [name for name in names if name in known and not _matters(experiment, law, name)]


def _matters(experiment: Experiment, law: str, name: str) -> bool:
    parameters = experiment.parameters
    kernel = kernel_of(experiment.robot(), kind_of(law, parameters, experiment.curve()))
    if name == "clock_offset":
        return _reaches_motion(experiment, kernel, (), state="theta_ref")
    if name in ("profile", "reverse_at"):
        return _reaches_motion(experiment, kernel, _places(kernel, SPEED))
    spec = specs(parameters)[name]
    for value in _others(spec, value_of(parameters, name)):
        other = changed(parameters, name, value)
        if _is_another(experiment, dataclasses.replace(experiment, parameters=other), law):
            return True
        if _reaches_motion(experiment, kernel, _changes(experiment, kernel, other)):
            return True
    return False


def _others(spec: Spec, value: Any) -> Iterator[Any]:
    """Other values of a parameter; options next to the present one come first."""
    options = spec.options or (spec.low, spec.high)
    here = options.index(value) if value in options else 0
    yield from sorted(set(options) - {value}, key=lambda other: abs(options.index(other) - here))


def _is_another(one: Experiment, other: Experiment, law: str) -> bool:
    """Whether two experiments have different robots, ticks, paths or loops."""
    paths = one.curve(), other.curve()
    return (
        other.robot() is not one.robot()
        or time_step(other.parameters) != time_step(one.parameters)
        or not np.array_equal(paths[0].coefficients, paths[1].coefficients)
        or kind_of(law, other.parameters, paths[1]) != kind_of(law, one.parameters, paths[0])
    )


def _changes(experiment: Experiment, kernel: Kernel, other: Parameters) -> NDArray[np.int_]:
    """Places of the settings that other parameters change."""
    parameters, robot, curve = experiment.parameters, experiment.robot(), experiment.curve()
    vectors = [settings_vector(robot, kernel, each, curve, FREE) for each in (parameters, other)]
    changed = np.flatnonzero(vectors[0] != vectors[1])
    given, speed = experiment.schedule.profile, _places(kernel, SPEED)
    before, after = (given or profile_of(each) for each in (parameters, other))
    if before is not None:
        changed = np.setdiff1d(changed, speed)
    return changed if before == after else np.append(changed, speed)


def _places(kernel: Kernel, names: Iterable[str]) -> NDArray[np.int_]:
    slices = kernel.settings.slices
    every = np.arange(kernel.settings.size)
    return np.concatenate([every[slices[name]] for name in names])


def _reaches_motion(
    experiment: Experiment, kernel: Kernel, places: Iterable[int], state: str = ""
) -> bool:
    """Whether the coordinates or their rates ever depend on some settings or a field of the state.

    All other settings are numbers, so that the loop lacks whatever they switch off.
    """
    robot, curve = experiment.robot(), experiment.curve()
    settings = ca.SX(settings_vector(robot, kernel, experiment.parameters, curve, FREE))
    asked = ca.SX.sym("asked", kernel.settings.size)
    for name, part in kernel.settings.slices.items():
        if name.startswith(FROM_OUTSIDE):
            settings[part] = ca.SX.sym(name, part.stop - part.start)
    for place in places:
        settings[int(place)] = asked[int(place)]
    before = ca.SX.sym("before", kernel.changed)
    table = ca.reshape(ca.DM(curve.table()), *kernel.table_shape)
    after = _tick(kernel, before, settings, table)
    known = before * _alive(after)  # an integral that is switched off stays 0
    after = _tick(kernel, known, settings, table)
    step = _pattern(after, before)
    reached = np.asarray(_pattern(after, asked).any(axis=1))
    if state:
        reached[kernel.state.slices[state]] = True
    for _ in range(kernel.changed):
        wider = reached | step[:, reached].any(axis=1)
        if np.array_equal(wider, reached):
            break
        reached = wider
    return any(bool(reached[kernel.state.slices[name]].any()) for name in ("q", "v"))


def _tick(kernel: Kernel, before: ca.SX, settings: ca.SX, table: ca.DM) -> ca.SX:
    """The state after a tick, on a spline as if all of its pieces were the first one."""
    basis, *pieces = kernel.basis.call([before, settings])
    if pieces:
        first = ca.SX(table[:, :WINDOW])
        values = windowed([first] * pieces[0].numel(), basis)
    else:
        values = table @ basis
    return kernel.advance.call([before, settings, values])[0]


def _alive(values: ca.SX) -> ca.DM:
    """0 for each value that is 0 whatever the symbols are, else 1."""
    return ca.DM([float(not values[i].is_zero()) for i in range(values.numel())])


def _pattern(values: ca.SX, of: ca.SX) -> NDArray[np.bool_]:
    """Which values depend on which symbols, as a matrix."""
    found = ca.jacobian_sparsity(values, of)
    pattern: NDArray[np.bool_] = np.zeros(found.shape, dtype=bool)
    rows, columns = found.get_triplet()
    pattern[rows, columns] = True
    return pattern
