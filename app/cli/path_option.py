"""Reads `--path`: a text that describes a path, or a file with options."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from onpath.models.errors import Message
    from onpath.models.paths.curves import Curve
    from onpath.models.systems.robots import Robot

NEAREST = "nearest"


def read_path(text: str, robot: Robot) -> Curve:
    """The path that `--path` describes, or the file that it names; remarks go to stderr.

    Args:
        text: as described in models/path_files/reading.py; with the word "nearest" after a file,
            the nearest path that the robot can follow, if it cannot follow the one in the file.

    Raises:
        ValueError: the text is not a path, or the file cannot be read.
    """
    from onpath.models.paths.curve_fit import deviation_remark
    from onpath.models.studies.path_text import curve_from_text

    if text.startswith("@"):
        return _path_in(text[1:], robot)
    curve = curve_from_text(text)
    if remark := deviation_remark(curve):
        print(f"onpath: {remark}", file=sys.stderr)
    return curve


def path_name(text: str) -> str:
    """The name of a path in a list: that of its file, or the text itself."""
    from onpath.models.path_files.reading import read_reference

    return read_reference(_without_nearest(text[1:])[0])[0].stem if text.startswith("@") else text


def _path_in(text: str, robot: Robot) -> Curve:
    from onpath.models.errors import Message
    from onpath.models.path_files.reading import path_in, read_reference
    from onpath.models.paths.curve_faults import curve_faults
    from onpath.models.paths.nearest_path import nearest_path

    reference, wants_nearest = _without_nearest(text)
    file, placing = read_reference(reference)
    try:
        read = path_in(file, placing)
    except OSError as error:
        raise ValueError(f"--path @{file}: {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"--path @{file}: {error}") from None
    curve, remarks = read.curve, [*read.remarks]
    if faults := curve_faults(robot.margin, curve):
        reasons = tuple(fault.reason for fault in faults)
        found = nearest_path(robot.margin, curve)
        if found is None or not wants_nearest:
            raise ValueError(f"--path @{file}: {_with_hint(reasons, found)}")
        apart = f"{1e3 * found.deviation:.1f}"
        remarks.append(Message("say.nearest", {"reasons": reasons, "apart": apart}))
        curve = found
    for remark in remarks:
        print(f"onpath: {file}: {remark}", file=sys.stderr)
    return curve


def _with_hint(reasons: tuple[Message, ...], found: Curve | None) -> str:
    """Why a path cannot be followed, and how one near it can."""
    text = "; ".join(map(str, reasons))
    if found is None:
        return text
    apart = f"up to {1e3 * found.deviation:.1f} mm away"
    return f"{text}; add the word nearest after the file to follow a path {apart}"


def _without_nearest(text: str) -> tuple[str, bool]:
    """A reference to a file without the word "nearest", and whether it had it."""
    file, *options = text.split(" ")
    kept = [word for word in options if word != NEAREST]
    return " ".join([file, *kept]), len(kept) < len(options)
