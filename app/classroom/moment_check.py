"""A received state of a lab, with everything in it checked."""

from __future__ import annotations

import msgspec
import numpy as np

from onpath.app.classroom.moment import Moment, laws_of, parameters_of, wall_of
from onpath.app.lab.plot_samples import places
from onpath.models.closed_loop.loop_vectors import state_layout
from onpath.models.control.benches import BENCHES, checked_laws
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.paths.curves import terms_of
from onpath.models.systems.catalogue import ROBOTS


def read_moment(text: str) -> Moment:
    """The state in JSON, validated.

    Raises:
        ValueError: it is not a valid state of a known robot.
    """
    moment = msgspec.json.decode(text, type=Moment)
    if moment.robot not in ROBOTS:
        raise ValueError(f"no robot {moment.robot!r}")
    entry = ROBOTS[moment.robot]
    robot = entry.make(parameters_of(moment))
    samples = places(robot)
    for line in (moment.path.target, moment.path.before):
        if line is not None:
            in_space = robot.frame.space is not None and len(line.terms) == 3 * terms_of(
                line.closed
            )
            _numbers(line.terms, (3 if in_space else 2) * terms_of(line.closed))
    for numbers in (moment.path.points, moment.path.marks):
        _numbers(numbers, 2 * (len(numbers) // 2))
    if checked_laws(laws_of(moment), entry) != laws_of(moment):
        raise ValueError("a typed law is on one line")
    for each, law in zip(moment.robots, laws_of(moment).values(), strict=True):
        _numbers(each.state, state_layout(robot.system, law_named(law).memory).size)
        _numbers(each.sample, len(samples))
        for pull in (each.hand, each.anchor, each.tangent, each.normal):
            _numbers(pull, robot.system.p if pull else 0)
        if each.diverged is not None:
            _sayable(each.diverged.reason())
        if bool(each.anchor) != bool(each.tangent) or (each.normal and not each.anchor):
            raise ValueError("half a brake")
    if moment.wall:
        _numbers(moment.wall, 3)
        wall_of(moment)
    most = [each.max_distance for each in moment.robots]
    _numbers((moment.time, moment.achieved, *most), 4)
    if not {*moment.held, moment.grabbed} <= {*BENCHES, None}:
        raise ValueError("somebody else is held")
    return moment


def _numbers(numbers: tuple[float, ...], size: int) -> None:
    if len(numbers) != size or not np.isfinite(numbers).all():
        raise ValueError(f"expected {size} finite numbers, got {len(numbers)}")


def _sayable(message: Message) -> None:
    try:
        str(message)
    except KeyError:
        raise ValueError(f"no message {message.code!r} with these arguments") from None
