"""What a lab's form says besides the values of its settings."""

from __future__ import annotations

import math

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.view.poles import WARNS
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words

NEVER = 1e9
"""Stands for a limit that does not exist."""


def alpha_note(
    alpha: float,
    critical: float | None,
    modes: int,
    zeta: float,
    words: Words,
    key: str = "flexible.critical",
) -> str:
    """From which α on the zero dynamics are unstable, and whether they are.

    Args:
        critical: α; infinity if there is none up to 1, None while it is being computed.
        modes, zeta: of the beam, on which it depends, and their damping ratio.
        key: of the sentence that says where that is.
    """
    if critical is None:
        return words("flexible.computing")
    text = words("flexible.none")
    if math.isfinite(critical):
        text = words(key, critical=f"{critical:.2f}")
    text += f" ({words('flexible.of_beam', modes=modes, zeta=f'{zeta:g}')})"
    return f"{text}\n{WARNS}{words('flexible.unstable')}" if alpha > critical else text


def deflections(snapshot: PageSnapshot, words: Words) -> str:
    """How far the flexible link of each robot bends at its tip."""
    titles = side_titles(snapshot.laws, words)
    each = [
        words("flexible.deflection", robot=titles[side], value=f"{1e3 * robot.deflection:.1f}")
        for side, robot in snapshot.robots.items()
    ]
    larger = snapshot.settings.larger
    scale = words("flexible.drawn", factor=f"{larger:g}")
    return words(
        "flexible.deflections",
        each=", ".join(each),
        scale=words("scene.true_scale") if larger == 1 else scale,
    )


def wall_forces(snapshot: PageSnapshot, words: Words) -> str:
    """The force between each robot and the wall; empty without a wall."""
    titles = side_titles(snapshot.laws, words)
    each = [
        f"{titles[side]} {words.written(f'{force:.1f}')} N"
        for side, force in snapshot.wall_forces.items()
    ]
    return f"{words('wall.forces')}: {', '.join(each)}" if each else ""


def tube_note(width: float, words: Words, steps: tuple[float, float] | None = None) -> str:
    """How far from the path the closest point is unique, and how far apart the lines are.

    Args:
        width: [m]; infinity if it is unique everywhere.
        steps: of ξ, [m], and of θ, [°], from a line to the next; None without lines.
    """
    text = words("show.width_none")
    if width < math.inf:
        text = words("show.width", width=f"{1e3 * width:.1f}")
    if steps is None:
        return text
    across, along = steps
    return f"{text} {words('show.steps', xi=f'{1e3 * across:g}', theta=f'{along:g}')}"


def rank_note(largest: float, alpha: float | None, words: Words) -> str:
    """What the colours of the rank test's map mean, below their scale.

    Args:
        largest: the value at the upper end of the scale.
        alpha: of a flexible link, or None.
    """
    ends = f"0 … {words.written(f'{largest:.3g}')}"
    text = f"{ends}. {words('show.rank_scale')}"
    return text if alpha is None else f"{text} {words('show.rank_alpha', alpha=f'{alpha:g}')}"
