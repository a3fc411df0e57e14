"""Makes a chain of what a file says of its bodies, with what is guessed: masses, and its end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.file_chain import Group, Options, RigidTransform, rounded
from onpath.models.robot_files.file_masses import INSTALL, LinkMass, add_masses
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.hull_process import LIBRARY, hulls_of
from onpath.models.robot_files.xml_elements import shown

FEW = 3  # joints, up to which the tip may be the far end of what is drawn
ON_AXIS = 1e-6  # [m]


def whole_chain(
    *,
    groups: Sequence[Group],
    links: Sequence[Sequence[LinkMass]],
    tip: RigidTransform,
    name: str,
    options: Options,
) -> tuple[Chain, tuple[Guess, ...], str]:
    """The chain, what is guessed of it, and the guessed numbers: all it rests on besides the file.

    Args:
        groups: the base, and the moving bodies, without masses yet.
        links: those of each group.
        tip: in the frame of the last group.
        name: of the tip.

    Raises:
        CodedError: `options.mass` is less than the masses that the file states.
    """
    end, unread = _far_end(groups, tip)
    at = tip.translation if end is None else end
    masses = add_masses(groups, links, at, options)
    chain = Chain(
        bodies=tuple(group.body() for group in groups[1:]),
        tip=at,
        facing=tip.rotation[:, 2],
        base=tuple(groups[0].shapes),
    )
    if end is None:
        lacking = Guess("package", Message("robot_file.unread_end", {"tip": shown(name)}), INSTALL)
        return chain, (*((lacking,) if unread else ()), *masses.guesses), masses.numbers
    there = tip.rotation.T @ (end - tip.translation)
    place = " ".join(f"{value:.4g}" for value in there + 0.0)
    guess = Guess("tip", Message("robot_file.guessed_end", {"tip": shown(name), "place": place}))
    return chain, (guess, *masses.guesses), repr(end.tolist()) + masses.numbers


def _far_end(groups: Sequence[Group], tip: RigidTransform) -> tuple[Array | None, bool]:
    """The end of what is drawn of the last body, in its frame, (3,), [m].

    None if enough joints move the tip, or nothing is drawn: a tip on the axis of the last joint
    is not moved by that. And whether a package is missing that would have read what is drawn.
    """
    joint = groups[-1].joint
    on_axis = float(np.hypot(*tip.translation[:2])) < ON_AXIS
    if joint is None or joint.slides or not on_axis or len(groups) - 1 > FEW:
        return None, False
    hulls = hulls_of(groups[-1].shapes)
    ends = [np.array(hull.far) for hull in hulls if not hull.fault]
    end = max(ends, key=lambda each: float(np.hypot(*each[:2])), default=np.zeros(3))
    unread = any(hull.fault == LIBRARY for hull in hulls)
    return rounded(end) if np.hypot(*end[:2]) > ON_AXIS else None, unread
