"""Evaluates the checks of a task against the record of a run. Pure functions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import singledispatch

import msgspec
import numpy as np

from onpath.lessons.action_schema import RobotName, Value
from onpath.lessons.labels import event_label, setting_label, value_label
from onpath.lessons.measures.responses import (
    UNITS,
    latest_stretch,
    overshoot,
    settling_time,
    unit_of,
)
from onpath.lessons.record import Happening, Mask, Record
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import (
    Better,
    Bound,
    Check,
    Compare,
    Event,
    Once,
    Only,
    Order,
    Setting,
    Stat,
    Task,
    Window,
)
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.laws.own import OWN, short_name
from onpath.models.control.settable import values_of
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.path_design import presets
from onpath.models.systems.parameters import Parameters

TINY = 1e-9  # smallest divisor of a ratio
INSTANT = 1e-6  # [s], tolerance of durations, shorter than any tick


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a check is satisfied, and a sentence with the measured and the required value.

    Attributes:
        share: of the time that it must last, from 0 to 1; None if it has no duration.
        begun: whether anything has been done in this run that it could judge.
        broken: when it was missed for good in this run, [s]; None if it was not.
    """

    passed: bool
    words: str
    share: float | None = None
    begun: bool = True
    broken: float | None = None


def judge(task: Task, record: Record, words: Words) -> list[Verdict]:
    """The verdicts on the checks of a task; the task is passed when all of them are.

    A check without words, such as an `Only` that holds, is left out.
    """
    begun = any(event.run == record.run for event in record.happenings)
    verdicts = [verdict(check, record, words) for check in task.check]
    return [replace(each, begun=begun) for each in verdicts if each.words]


def way_of(task: Task, record: Record) -> int:
    """The number of the way in which a task is passed, from 1; 0 if it has none that holds."""
    ways = enumerate(task.way, 1)
    return next((i for i, way in ways if verdict(way.when, record, ENGLISH).passed), 0)


@singledispatch
def verdict(check: Check, record: Record, words: Words) -> Verdict:
    """Whether a check is satisfied by what has happened.

    Raises:
        TypeError: the kind of check is unknown.
    """
    raise TypeError(f"no such check: {check!r}")


@verdict.register
def _(check: Bound, record: Record, words: Words) -> Verdict:
    robots = robot_names(record.laws, words)
    if record.stopped(check.robot):
        return Verdict(False, words("check.stopped", robot=robots[check.robot]))
    chosen = record.chosen(check.robot, check)
    enough, seconds, share = _seconds(check, record, chosen, words)
    names = bound_words(check, robots, words)
    value = statistic(record, check.robot, check.quantity, check.stat, chosen)
    if value is None:
        return Verdict(False, words("check.nothing", **names, seconds=seconds), share)
    shown = _rounded(value, check.below, check.above, words)
    text, broken = words("check.bound", **names, value=shown) + seconds, _broken(check, record)
    if broken is not None:
        text += words("check.broken", time=words.written(f"{broken:.1f}"))
    passed = enough and _within(value, check.below, check.above)
    return Verdict(passed, text, share, broken=broken)


@verdict.register
def _(check: Compare, record: Record, words: Words) -> Verdict:
    robots = robot_names(record.laws, words)
    smaller: RobotName = "follower" if check.larger == "tracker" else "tracker"
    if record.stopped(smaller):
        return Verdict(False, words("check.stopped", robot=robots[smaller]))
    chosen = record.chosen(check.larger, check)
    both = [
        statistic(record, robot, check.quantity, check.stat, record.chosen(robot, check))
        for robot in (check.larger, smaller)
    ]
    enough, seconds, share = _seconds(check, record, chosen, words)
    names = compare_words(check, robots, words)
    large, small = both
    if large is None or small is None:
        names |= {"robot": robots[check.larger], "wanted": f"{names['wanted']}×"}
        return Verdict(False, words("check.nothing", **names, seconds=seconds), share)
    ratio = large / max(small, TINY)
    shown = _rounded(ratio, None, check.ratio, words) if ratio < 1000 else ">1000"
    text = words("check.compare", **names, ratio=shown)
    return Verdict(enough and ratio >= check.ratio, text + seconds, share)


@verdict.register
def _(check: Better, record: Record, words: Words) -> Verdict:
    robots = robot_names(record.laws, words)
    if record.stopped(check.robot):
        return Verdict(False, words("check.stopped", robot=robots[check.robot]))
    chosen = record.chosen(check.robot, check)
    enough, seconds, share = _seconds(check, record, chosen, words)
    value = statistic(record, check.robot, check.quantity, check.stat, chosen)
    before = record.before.get(check)
    limit = None if before is None else check.share * before
    passed = enough and value is not None and limit is not None and value < limit
    unit = unit_of(check.stat, check.quantity)
    text = words(
        "check.better",
        robot=robots[check.robot],
        stat=stat_words(check.stat, check.quantity, words),
        during=words(f"during.{check.during}"),
        value="–" if value is None else f"{_rounded(value, limit, None, words)} {unit}",
        before="–" if before is None else f"{_rounded(before, None, None, words)} {unit}",
    )
    return Verdict(passed, text + seconds, share)


def measured(check: Better | Once, record: Record) -> float | None:
    """The statistic of a check in a run; None if it was too short for that."""
    chosen = record.chosen(check.robot, check)
    if record.stopped(check.robot) or record.seconds(chosen) < check.least - INSTANT:
        return None
    return statistic(record, check.robot, check.quantity, check.stat, chosen)


@verdict.register
def _(check: Once, record: Record, words: Words) -> Verdict:
    setting = Setting(name=check.name, equals=check.equals)
    robots = robot_names(record.laws, words)
    kept, now = record.before.get(check), None
    if kept is None and verdict(setting, record, words).passed:
        now = statistic(
            record, check.robot, check.quantity, check.stat, record.chosen(check.robot, check)
        )
    shown = now if kept is None else kept
    names = bound_words(check, robots, words)
    text = words(
        "check.once",
        **names,
        value="–" if shown is None else _rounded(shown, check.below, check.above, words),
        setting=setting_label(check.name, record.parameters, words),
        equals=value_label(check.name, check.equals, words),
        least=words.number(check.least),
    )
    return Verdict(kept is not None, text)


def keeps(check: Once, record: Record) -> float | None:
    """The value that meets the bound while the setting is as required; None if there is none."""
    if not verdict(Setting(name=check.name, equals=check.equals), record, ENGLISH).passed:
        return None
    value = measured(check, record)
    return value if value is not None and _within(value, check.below, check.above) else None


@verdict.register
def _(check: Only, record: Record, words: Words) -> Verdict:
    others = [name for name in record.changed() if name not in check.names]
    if not others:
        return Verdict(True, "")
    labels = (setting_label(name, record.parameters, words) for name in others)
    return Verdict(False, words("check.only", others=", ".join(labels)))


@verdict.register
def _(check: Event, record: Record, words: Words) -> Verdict:
    have = 0
    undone = [event_named(text) for text in check.since]
    for event in record.happenings:
        if any(happens(event, each) for each in undone):
            have = 0
        have += happens(event, check)
    text = words(
        "check.event",
        event=event_words(check, record.parameters, words),
        have=min(have, check.times),
        need=check.times,
    )
    return Verdict(have >= check.times, text)


@verdict.register
def _(check: Order, record: Record, words: Words) -> Verdict:
    wanted = [event_named(text) for text in check.events]
    found = 0
    for event in record.happenings:
        if found < len(wanted) and happens(event, wanted[found]):
            found += 1
    marked = [
        ("✓ " if i < found else "") + event_words(event, record.parameters, words)
        for i, event in enumerate(wanted)
    ]
    return Verdict(found == len(wanted), words("check.order", events=" → ".join(marked)))


@verdict.register
def _(check: Setting, record: Record, words: Words) -> Verdict:
    values: dict[str, object] = {"path": record.path, "robot": record.robot}
    values["path"] = record.path if record.path in presets() else OWN
    values |= {**DEFAULT_LAWS, **{side: short_name(law) for side, law in record.laws.items()}}
    values = values_of(record.parameters) | values
    value = record.length() if check.name == "length" else values.get(check.name)
    equals, wanted = setting_wanted(check, words)
    if equals is not None:
        passed = _same(value, equals)
    else:
        passed = isinstance(value, int | float) and _within(value, check.below, check.above)
    name = setting_label(check.name, record.parameters, words)
    shown = value_label(check.name, value, words)
    return Verdict(passed, words("check.setting", name=name, value=shown, wanted=wanted))


def statistic(
    record: Record, robot: RobotName, quantity: str, stat: Stat, chosen: Mask
) -> float | None:
    """A statistic of a quantity over the chosen instants; None if it is undefined.

    Args:
        robot, quantity: which column of the record.
        stat: "max", "min", "mean", "rms", "final" (the last value), or "settling" or "overshoot" of
            the last uninterrupted part, see lessons/measures/responses.py.
        chosen: shape (n,); from `Record.chosen`.
    """
    values = record.values[robot].get(quantity)
    if values is None or not chosen.any():
        return None
    if stat in UNITS:
        chosen = latest_stretch(chosen)
        if stat == "settling":
            return settling_time(record.times[chosen], values[chosen])
        return overshoot(values[chosen])
    values = values[chosen]
    if stat == "rms":
        return float(np.sqrt(np.mean(values**2)))
    if stat == "final":
        return float(values[-1])
    return float({"max": np.max, "min": np.min, "mean": np.mean}[stat](values))


def _rounded(value: float, below: float | None, above: float | None, words: Words) -> str:
    """The number with just enough digits to stay on its side of the bounds.

    Three digits, and at most two decimals, unless rounding would turn a missed bound into a met one
    or vice versa, or a bound is so small that two decimals would hide the distance to it.
    """
    least = min((abs(bound) for bound in (below, above) if bound), default=1.0)
    decimals = max(2, 2 - math.floor(math.log10(least)))
    short = f"{round(value, decimals) + 0.0:.{decimals}f}" if abs(value) < 1 else f"{value:.3g}"
    holds = _within(value, below, above)
    for shown in (short, *(f"{value:.{digits}g}" for digits in range(3, 17))):
        if _within(float(shown), below, above) == holds:
            return words.written(shown)
    return words.written(f"{value!r}")


def _within(value: float, below: float | None, above: float | None) -> bool:
    """Whether above <= value <= below; None means no bound."""
    return (below is None or value <= below) and (above is None or value >= above)


def _same(value: object, wanted: object) -> bool:
    """Whether a setting has the wanted value; numbers are compared to 0.1 %."""
    if isinstance(value, float) and isinstance(wanted, int | float):
        return bool(np.isclose(value, wanted, rtol=1e-3, atol=1e-6))
    return str(value) == str(wanted)


def event_named(text: str) -> Event:
    """The event named by `hold`, or by `set:K1`."""
    event, _, name = text.partition(":")
    return msgspec.convert({"kind": "event", "event": event, "name": name}, Event)


def happens(event: Happening, wanted: Event) -> bool:
    """Whether an event counts as the wanted one."""
    return event.name == wanted.event and wanted.name in ("", event.detail)


def _broken(check: Bound, record: Record) -> float | None:
    """When a value was beyond a bound on the largest or smallest one, which no later one mends."""
    bound = {"max": check.below, "min": check.above}.get(check.stat)
    if bound is None or check.last > 0:
        return None
    values = record.values[check.robot][check.quantity]
    beyond = record.chosen(check.robot, check) & (
        values > bound if check.stat == "max" else values < bound
    )
    return float(record.times[beyond.argmax()]) if beyond.any() else None


def _seconds(check: Window, record: Record, chosen: Mask, words: Words) -> tuple[bool, str, float]:
    """Whether the chosen instants last long enough, the words for it, and the share that they last.

    The shown duration is rounded down, so that it never looks sufficient when it is not.
    """
    have, need, point = record.seconds(chosen), words.number(check.least), words("report.point")
    enough = have >= check.least - INSTANT
    shown = words.written(f"{math.floor(10 * have) / 10:.1f}")
    if enough:
        shown = need if point in need else f"{need}{point}0"
    share = 1.0 if enough else math.floor(100 * have / check.least) / 100
    return enough, words("check.seconds", have=shown, need=need), share


def bound_words(check: Bound, robots: Mapping[RobotName, str], words: Words) -> dict[str, str]:
    """The words for a bound, apart from the measured value.

    Args:
        robots: displayed names.
    """
    unit = unit_of(check.stat, check.quantity)
    return {
        "robot": robots[check.robot],
        "stat": stat_words(check.stat, check.quantity, words),
        "during": words(f"during.{check.during}"),
        "wanted": range_words(check.below, check.above, unit, words),
        "unit": unit,
    }


def compare_words(check: Compare, robots: Mapping[RobotName, str], words: Words) -> dict[str, str]:
    """The words for a comparison, apart from the measured ratio; see `bound_words`."""
    return {
        "larger": robots[check.larger],
        "stat": stat_words(check.stat, check.quantity, words),
        "during": words(f"during.{check.during}"),
        "wanted": words.number(check.ratio),
    }


def setting_wanted(check: Setting, words: Words) -> tuple[Value | None, str]:
    """The value that a setting should have, None if only its bounds matter; and that in words."""
    if check.equals is None:
        unit = "mm" if check.name == "length" else ""
        return None, range_words(check.below, check.above, unit, words)
    return check.equals, words("check.equals", value=value_label(check.name, check.equals, words))


def stat_words(stat: Stat, quantity: str, words: Words) -> str:
    """A statistic of a quantity, in words."""
    return words(f"stat.{stat}", quantity=words(f"quantity.{quantity}"))


def range_words(below: float | None, above: float | None, unit: str, words: Words) -> str:
    """The range between two bounds, at least one of which is given, in words."""
    limits = [
        words(f"check.{side}", limit=words.written(f"{limit:g}"), unit=unit).rstrip()
        for side, limit in (("above", above), ("below", below))
        if limit is not None
    ]
    return limits[0] if len(limits) == 1 else words("check.and", first=limits[0], second=limits[1])


def event_words(check: Event, parameters: Parameters, words: Words) -> str:
    """What has to happen, in words."""
    key = f"event.{check.event}"
    if check.name:
        text = words(key, detail=event_label(check.event, check.name, parameters, words))
    else:
        text = words.get(f"{key}_any", "") or words(key)
    if not check.since:
        return text
    before = [event_words(event_named(text), parameters, words) for text in check.since]
    return words("check.since", event=text, events=", ".join(before))
