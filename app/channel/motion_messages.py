"""How the robots have moved, and the path that they follow."""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, Struct, UnsetType

# From the page


class Plot(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="plots"):
    """Tell more of each sample, also of the past, until another one comes.

    Attributes:
        fields: that the page plots; see `ASKED` in app/lab/plot_rows.py.
    """

    fields: Annotated[tuple[str, ...], Meta(max_length=20)]


# To the page


class FrameMessage(Struct, tag_field="is", tag="frame", omit_defaults=True):
    """The samples since the last frame; 20 times a second while anything in it changes, less often
    under load or if the page reads slowly.

    A row is `[time, flags, …left robot, …right robot]`. The flags are bits: left held, right held,
    left pulled, right pulled. A robot has p + p + 3 numbers, where p is 2 or 3: its distance from
    the path, θ of the closest point, θ of the reference point, end-point (p), external force on it
    (p). Times are in 0.1 ms, lengths in 10 µm, angles in 0.1 mrad, forces in 10 mN. End-points are
    coordinates of the output space, `Robot.position` of which is where they are drawn. After both
    robots come the numbers of `fields`, all of the left robot, then all of the right one; null
    where ξ had another unit than now.

    Attributes:
        rows: 60 per second, the oldest first; the last one is the present. They replace all samples
            of the page from the time of the first one on.
        running: whether time runs.
        past: the past instant that the lab shows [s], or null.
        anew: whether the page must forget all its samples first; `rows` has the last minute.
        fields: with `anew`: for each field that the page has asked for and the robots have, its
            name, how many of its numbers are told, and how many units an SI unit has.
        straight: only for a link that bends: for each of the last rows, where the end-points would
            be if it did not, as end-points are given in a row.
    """

    rows: list[list[int | None]]
    running: bool
    past: float | None
    anew: bool = False
    fields: list[tuple[str, int, float]] | UnsetType = UNSET
    straight: list[list[int]] | UnsetType = UNSET


class LogMessage(Struct, frozen=True, tag_field="is", tag="log"):
    """The log of a real arm that is drawn over the plots, when it or the path changes.

    Attributes:
        file: name of its file; empty: there is no log.
        times: of its rows, [s].
        fields: names of fields as in `FrameMessage`, with the number of units that an SI unit has,
            and each of its numbers in all rows; null where it is not known, as in a gap.
    """

    file: str = ""
    times: tuple[float, ...] = ()
    fields: tuple[tuple[str, float, tuple[tuple[int | None, ...], ...]], ...] = ()


class PathMessage(Struct, frozen=True, tag_field="is", tag="path"):
    """The drawn path, when it changes.

    Attributes:
        points: of the output space, at evenly spaced θ from -π to π, in 10 µm. A closed path is
            periodic, an open one goes on along its end tangents.
        closed: whether it is closed.
        raised: where the pen is up: θ from and to, [rad].
        right, up: two unit vectors at right angles, in which the path is seen from in front.
    """

    points: list[list[int]]
    closed: bool
    raised: tuple[tuple[float, float], ...]
    right: list[float]
    up: list[float]
