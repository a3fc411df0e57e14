"""A path in a file that a browser has sent; see upload_reader.py."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from onpath.app.channel.file_inbox import MOST_BYTES
from onpath.app.channel.file_messages import MOST_PARTS
from onpath.app.lab.commands.path import FollowCurve
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.errors import Coded, CodedError, Message
from onpath.models.path_files.placing import RADIUS, ROUND, SMOOTH, Placing
from onpath.models.path_files.reading import (
    ImportedPath,
    drawing_of,
    path_of,
    path_of_drawing,
)
from onpath.models.path_files.stroke import LineDrawing
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import deviation_of
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

PREVIEWED = 4000  # points of all lines that are shown before one is chosen
SAMPLES = 256
LARGEST = 0.4  # [m], size that a page can wish
ARCS = (0.008, 0.012, 0.02, 0.03)  # [m], radii of corners that are tried where one is needed
HELPING = 3.0  # [s] of processor time that the search for what helps may take


@dataclass(frozen=True, slots=True, eq=False)
class Upload:
    """A file from a browser, and the robot that is to follow its path.

    Attributes:
        name, content: of the file.
        placing: what is done with it.
        robot: name of the robot, with these parameters.
    """

    name: str
    content: bytes
    placing: Placing
    robot: str
    parameters: Parameters


@dataclass(frozen=True, slots=True, eq=False)
class Read:
    """What became of a file.

    Attributes:
        found: the command that follows its path, or why there is none.
        lines: points of the first lines of the file from 0 to 1, y upwards, shape (n, 2) each.
        why: why the path is not followed, in the page's language; else empty. The command then
            shows where, and the path remains as it was.
        helps: what would help, and how the line must then be placed.
    """

    found: FollowCurve | Message | ValueError
    lines: tuple[Array, ...] = ()
    why: str = ""
    helps: tuple[tuple[Message, Placing], ...] = ()


def read_upload(upload: Upload, language: str) -> Read:
    """Read the path in a file. Runs in the process."""
    drawing, placing = None, upload.placing
    try:
        drawing = _drawing(upload)
        if drawing is None:  # a path in words, which has its own place
            read = path_of(upload.content, upload.name, Placing(), MOST_BYTES)
        else:
            read = path_of_drawing(drawing, placing)
    except ValueError as error:
        why = error.message if isinstance(error, Coded) else error
        return Read(why, _preview(drawing))
    curve, words, remarks = read.curve, Words(language), read.remarks
    robot = ROBOTS[upload.robot].make(upload.parameters)
    why, helps = "", tuple[tuple[Message, Placing], ...]()
    if faults := curve_faults(robot.margin, curve):
        reasons = "; ".join(words.sentence(fault.reason) for fault in faults)
        why = words("design.not_followed", reasons=reasons)
        if drawing is not None:
            helps = tuple(_helps(robot, drawing, placing, read))
    if curve.given is not None:
        remarks = (deviation_of(curve), *(each for each in remarks if each.code != "say.deviates"))
    return Read(
        found=FollowCurve(curve, " ".join(words.sentence(remark) for remark in remarks)),
        lines=_preview(drawing),
        why=why,
        helps=helps,
    )


def _drawing(upload: Upload) -> LineDrawing | None:
    """The lines of a file; None if it describes a path in words."""
    try:
        return drawing_of(upload.content, upload.name, most=MOST_BYTES)
    except CodedError as error:
        if error.message.code == "error.file_described":
            return None
        raise


def _preview(drawing: LineDrawing | None) -> tuple[Array, ...]:
    """A few points of each of the first lines, within the unit square."""
    if drawing is None:
        return ()
    points = [stroke.points for stroke in drawing.strokes[:MOST_PARTS]]
    most = max(2, PREVIEWED // len(points))
    thin = [z[np.unique(np.linspace(0, len(z) - 1, most).astype(int))] for z in points]
    low = np.min([z.min(0) for z in points], axis=0)
    side = float((np.max([z.max(0) for z in points], axis=0) - low).max())
    return tuple((z - low) / side if side > 0 else 0 * z for z in thin)


def _helps(
    robot: Robot, drawing: LineDrawing, placing: Placing, read: ImportedPath
) -> Iterator[tuple[Message, Placing]]:
    """The least changes of size and of corners with which the robot can follow a line."""
    begun = time.process_time()
    size = placing.fit or float(np.ptp(read.curve.at(read.curve.sample(SAMPLES)), axis=0).max())
    radius = placing.radius if placing.corners == ROUND else 0.0
    ways = (
        ("design.larger", [(k * size, radius) for k in (1.25, 1.5, 2.0, 3.0)]),
        ("design.smaller", [(k * size, radius) for k in (0.8, 0.65, 0.5)]),
        ("design.rounder", [(size, r) for r in ARCS if r > radius]),
        ("design.both", [(k * size, r) for r in ARCS if r > radius for k in (1.5, 2.0, 3.0)]),
    )
    helped = False
    for code, tried in ways:
        if helped and code == "design.both":
            return
        for side, arc in tried:
            if time.process_time() - begun > HELPING:
                return
            if side > LARGEST:
                continue
            fit = round(side, 3)
            corners = ROUND if arc else SMOOTH
            other = replace(placing, fit=fit, corners=corners, radius=arc or RADIUS)
            with suppress(ValueError):
                if not curve_faults(robot.margin, path_of_drawing(drawing, other).curve):
                    yield _told(code, f"{1e3 * fit:.0f}", f"{1e3 * arc:.0f}"), other
                    helped = True
                    break


def _told(code: str, size: str, radius: str) -> Message:
    """What helps, in words; size and radius in [mm]."""
    ways = (
        Message("design.larger", {"size": size}),
        Message("design.smaller", {"size": size}),
        Message("design.rounder", {"radius": radius}),
        Message("design.both", {"size": size, "radius": radius}),
    )
    return next(way for way in ways if way.code == code)
