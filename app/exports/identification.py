"""The result of an identification as text, as data, and as a figure of its residuals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from onpath.app.exports.figures import ShownFigure
from onpath.lessons.words import ENGLISH
from onpath.models.closed_loop.trajectory import header
from onpath.models.studies.exciting_motion import PlannedMotion
from onpath.models.studies.link_estimate import LinkEstimate, LinkParameter
from onpath.models.studies.log_identification import FileEstimate
from onpath.models.studies.parameter_estimate import MUCH, BaseParameter
from onpath.models.systems.robots import RobotEntry

SETTINGS = "settings"  # name of what `--set @FILE` reads


def identification_data(found: FileEstimate) -> dict[str, Any]:
    """The content of `--json`."""
    result, motion = found.estimate, found.motion
    late = result.delay
    return {
        "robot": found.robot,
        "laws": list(found.laws),
        "seconds": round(found.seconds, 6),
        "angles": "measured" if found.measured else "true",
        "parameters": [_entry(each) for each in result.found],
        "not_excited": list(result.unexcited),
        "unexplained": float(f"{result.unexplained:.3g}"),
        "unexplained_in": {name: float(f"{x:.3g}") for name, x in found.others.items()},
        "torque_late_s": None if late is None else float(f"{late.value:.3g}"),
        "torque_late_interval_s": None if late is None else _interval(late),
        "links": None if found.links is None else [_link(p) for p in found.links.parameters],
        SETTINGS: found.settings,
        "motion": None
        if motion is None
        else {
            "moving": list(motion.moving),
            "tells": list(motion.identified),
            "not": list(motion.left),
        },
    }


def _link(each: LinkParameter) -> dict[str, Any]:
    return {
        "link": each.link,
        "body": each.body,
        "sum": {name: float(f"{share:.6g}") for name, share in each.terms},
        "told": None if each.told is None else _entry(each.told),
        "in_the_file": float(f"{each.stated:.9g}"),
    }


def _entry(each: BaseParameter) -> dict[str, Any]:
    interval = _interval(each)
    return {
        "name": each.name,
        "plus": {name: float(f"{share:.6g}") for name, share in each.others},
        "value": float(f"{each.value:.9g}"),
        "standard_error": None if interval is None else float(f"{each.error:.3g}"),
        "interval": interval,
    }


def _interval(each: BaseParameter) -> list[float] | None:
    if not np.isfinite(each.high):
        return None
    return [float(f"{end:.6g}") for end in (each.low, each.high)]


def identification_text(found: FileEstimate) -> str:
    """The result as text."""
    title, *others = remarks(found)
    rows = [f"{name:24s} {value:>12s}  ± {half}" for name, value, half in parameter_rows(found)]
    links = [] if found.links is None else link_lines(found.links)
    return "\n  ".join([title, *rows, *others, *links])


def link_lines(links: LinkEstimate) -> list[str]:
    """The base parameters of each link; one that is a sum is named after its first term, with R."""
    names = {p.name: p.name + "R" * (len(p.terms) > 1) for p in links.parameters}
    lines = [
        "by link, what any motion could tell of masses m, first moments mx, my, mz and inertias"
        " Ixx, ..., about the joint, whose axis is z, of motors' inertias Ia and viscous friction"
        f" b, beside the robot's file; {100 * links.unexplained:.2g} % of the torque is not"
        " explained by these:"
    ]
    for number, group in groupby(links.parameters, key=lambda p: p.link):
        members = [*group]
        lines.append(f"link {number} ({members[0].body})")
        lines += [f"  {names[p.name]:8s} {_told_of(p, names)}" for p in members]
        sums = [p for p in members if len(p.terms) > 1]
        lines += [f"  {names[p.name]} = {_written(p.terms)}" for p in sums]
    return lines


def _told_of(parameter: LinkParameter, names: Mapping[str, str]) -> str:
    told = parameter.told
    if told is None:
        return "not told by this log"
    others = [(names.get(name, name), share) for name, share in told.others]
    beside = f"   with {_written(others)}" if others else ""
    return f"{told.value:>12.4g}  ± {_half(told):8s} file {parameter.stated:.4g}{beside}"


def _written(terms: Sequence[tuple[str, float]]) -> str:
    """For instance "Izz1 + Ia1 - 0.22 mz3"."""
    parts = list[str]()
    for name, share in terms:
        sign, size = "-" if share < 0 else "+", abs(share)
        parts.append(f"{sign} {name}" if abs(size - 1) < 1e-9 else f"{sign} {size:.3g} {name}")
    return " ".join(parts).removeprefix("+ ")


def parameter_rows(found: FileEstimate) -> list[tuple[str, str, str]]:
    """Name, value and half of the interval of each parameter, and of the torques' delay."""
    rows = [(each.label(), f"{each.value:.6g}", _half(each)) for each in found.estimate.found]
    late = found.estimate.delay
    if late is not None:
        rows.append(("torques logged late by", f"{1e3 * late.value:.3g} ms", _half(late, 1e3)))
    return rows


def _half(each: BaseParameter, scale: float = 1.0) -> str:
    half = scale * (each.high - each.value)
    return f"{half:.2g}" if np.isfinite(half) else "?"


def remarks(found: FileEstimate) -> list[str]:
    """What the rows are of, and then what is to be said of them."""
    result = found.estimate
    under = f" under {', '.join(found.laws)}" if found.laws else ""
    angles = "measured" if found.measured else "true"
    lines = [f"{found.robot}: {found.seconds:.1f} s{under}, from the {angles} angles"]
    if result.delay is None:
        lines.append(
            "the motion does not show whether torques are logged late; none are assumed to be"
        )
    if any(each.others for each in result.found):
        lines.append("the motion cannot distinguish the parameters of a sum")
    if not all(np.isfinite(each.high) for each in result.found):
        why = "too much of the torque is not explained"
        if result.unexplained <= MUCH:
            why = "too little of the motion tells the value"
        lines.append(f"? instead of an interval: {why}")
    if result.unexcited:
        lines.append(f"not excited: {', '.join(result.unexcited)}")
    if found.motion:
        lines.append(_advice(found))
    lines.append(f"{100 * result.unexplained:.2g} % of the torque is not explained")
    lines += [
        f"{100 * share:.2g} % of the torque in {name} is not explained by these values"
        for name, share in found.others.items()
    ]
    lines.append(
        "The true value is within ± with a probability of 95 %, judging by what is not"
        " explained. That leaves out errors that all rows share: wrong geometry, wrong scales of"
        " torques and forces, forces that are not in the file, and terms that the model lacks."
        " Of friction where motors are slow or turn round, nothing is assumed."
    )
    dry = [each for each in result.found if each.is_dry_friction]
    negative = [each.name for each in dry if each.value + 2 * each.error < 0]
    doubts = ["too much of the torque is not explained"] if result.unexplained > MUCH else []
    doubts += [f"dry friction is never negative, but {' and '.join(negative)}"] if negative else []
    lines += [
        f"the values above cannot be trusted, since {each}: is the robot"
        f" {found.robot}, and does every column have the unit in which it is read?"
        for each in doubts
    ]
    return lines


def _advice(found: FileEstimate) -> str:
    """Which motion would identify what this one does not."""
    motion = found.motion
    assert motion is not None
    moving = " and ".join(motion.moving)
    rest = " alone" if len(motion.moving) < len(found.coordinates) else " together"
    left = f"; no motion can distinguish {', '.join(motion.left)}" if motion.left else ""
    return (
        f"a record in which {moving}{rest} swing about here, slowly and quickly at once, would"
        f" also tell {', '.join(motion.identified)}{left}"
    )


def motion_text(entry: RobotEntry, motion: PlannedMotion) -> str:
    """A motion as CSV, with times, coordinates and their rates."""
    robot = entry.make(entry.parameters())
    n, known = robot.system.n, header(robot)
    rows = np.column_stack([motion.t, motion.q, motion.v])
    names = ["t_s", *robot.system.coordinate_names, *known[2 + n : 2 + 2 * n]]
    lines = [",".join(names), *(",".join(f"{x:.9g}" for x in row) for row in rows)]
    return "\n".join([*lines, ""])


def residual_figure(found: FileEstimate) -> ShownFigure:
    """Plot the filtered torque of each coordinate and what the model does not explain of it.

    Records follow each other without a gap.
    """
    result = found.estimate
    figure = ShownFigure(figsize=(10, 2.4 * len(found.coordinates)), layout="constrained")
    axes = figure.subplots(len(found.coordinates), sharex=True, squeeze=False)[:, 0]
    steps = np.diff(result.times)
    usual = float(np.median(steps)) if len(steps) else 0.0
    begin = float(result.times[0])
    times = begin + np.concatenate([[0.0], np.cumsum(np.where(steps > 0, steps, usual))])
    for i, (each, name) in enumerate(zip(axes, found.coordinates, strict=True)):
        each.plot(times, result.torque[:, i], color="#0072b2", label=ENGLISH("residuals.torque"))
        each.plot(times, result.residual[:, i], color="#d55e00", label=ENGLISH("residuals.left"))
        unit = "N" if name.endswith("_m") else "N m"
        each.set_ylabel(f"{name.rpartition('_')[0]}  [{unit}]")
        each.grid(alpha=0.25)
    axes[0].legend(loc="upper right", frameon=False)
    axes[-1].set_xlabel("t  [s]")
    return figure
