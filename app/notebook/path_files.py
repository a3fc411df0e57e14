"""`onpath.path_from` and `onpath.check_path`: paths from files, and whether a robot can follow."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from onpath.app.common.user_files import user_file
from onpath.app.notebook.arguments import curve_of, looked_up, plane_point
from onpath.app.notebook.display import cell
from onpath.app.notebook.simulate import check_names, entry_named
from onpath.models.arrays import Array
from onpath.models.control.settable import with_values
from onpath.models.path_files.placing import RADIUS, SMOOTH, Placing
from onpath.models.path_files.reading import path_in
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.nearest_path import nearest_path
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS, RobotEntry

SVG = "http://www.w3.org/2000/svg"


def path_from(
    file: str | Path,
    *,
    unit: str | None = None,
    scale: float = 1.0,
    fit: float | None = None,
    centre: Sequence[float] | None = None,
    corners: str = SMOOTH,
    radius: float = RADIUS,
    closed: bool | None = None,
    part: int | Sequence[int] | None = None,
    layer: str | int | None = None,
    turn: float = 0.0,
) -> Curve:
    """A path from a file: points (CSV), a drawing (SVG) or G-code.

    Points are a table with two columns, or with columns named x and y, as any spreadsheet writes
    it; a name may state the unit, as in x_mm. Drawings need `pip install "onpath[svg]"`. Of G-code,
    what the tool draws is read, and not its travel: see `models/path_files/gcode.py`. Several
    lines are drawn one after the other, with the pen raised between them.

    A path is smooth, and slows for bends: see its `deviation` from the lines in the file. Its
    drawing in a notebook shows both.

    Args:
        file: such as "points.csv", "logo.svg" or "plate.nc".
        unit: of the numbers in the file: "m", "cm", "mm", "in", "pt" or "px"; None: the one that
            the file states, else metres for points, millimetres for G-code, 1/96 inch for drawings.
        scale: factor of all lengths.
        fit: wanted larger side of its bounding box, [m]; None: as it is.
        centre: wanted centre of its bounding box, shape (2,), [m]; None: where it is, or with `fit`
            the origin.
        corners: "smooth", or "round" to put arcs in the place of corners first.
        radius: of these arcs, [m].
        closed: whether the end of each line is joined to its beginning; None: as the file says,
            else a single line is.
        part: number of the line in a file with several, from 1, or numbers; None: all.
        layer: number of a print's layer, from 1, or name of a drawing's layer; None: the first of
            a print, all of a drawing.
        turn: angle by which it is turned anticlockwise, [degrees].

    Raises:
        ValueError: there is no path in the file; the message names the line.
        OSError: the file cannot be read.

    Warns:
        UserWarning: how long the pen is raised, words of G-code without effect, the smallest
            radius of rounded corners, and a deviation of more than 4 mm.

    >>> import onpath, pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp(), "square.nc")
    >>> _ = file.write_text("G0 X0 Y0\\nG1 X80\\nY80\\nX0\\nY0")
    >>> path = onpath.path_from(file, centre=(0, 0))
    >>> path, round(path.deviation, 4)
    (<closed path, 319 mm long, 80 x 80 mm>, 0.0003)
    """
    placing = Placing(
        unit=unit,
        scale=scale,
        fit=fit,
        centre=None if centre is None else plane_point("centre", centre),
        corners=corners,
        radius=radius,
        closed=closed,
        part=(part,) if isinstance(part, int) else None if part is None else (*part,),
        layer=None if layer is None else str(layer),
        turn=turn,
    )
    read = path_in(user_file(file), placing)
    for remark in read.remarks:
        warnings.warn(str(remark), stacklevel=2)
    return read.curve


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PathCheck:
    """Whether a robot can follow a path. A notebook draws it, red where it cannot.

    Attributes:
        path: the path.
        reasons: why the robot cannot follow it; empty if it can.
        remarks: where the closest point is not unique; the robot follows the path all the same.
        places: where it cannot be followed, shape (n, 2), [m].
        nearest: the nearest path found that the robot can follow, `path` itself if it can, or None.
    """

    path: Curve
    reasons: tuple[str, ...]
    remarks: tuple[str, ...]
    places: Array
    nearest: Curve | None

    @property
    def ok(self) -> bool:
        """Whether the robot can follow the path."""
        return not self.reasons

    def __repr__(self) -> str:
        lines = [*(self.reasons or ("it can be followed",)), *self.remarks]
        if self.reasons:
            far = None if self.nearest is None else f"{1e3 * self.nearest.deviation:.1f} mm away"
            lines.append(f"the nearest that can be followed is {far or 'not found'}")
        return "\n".join(lines)

    def _repr_svg_(self) -> str:
        ElementTree.register_namespace("", SVG)
        drawing = ElementTree.fromstring(self.path._repr_svg_())
        for x, y in self.places:
            at = {"cx": f"{1e3 * x:.1f}", "cy": f"{-1e3 * y:.1f}", "r": "1.5", "fill": "red"}
            ElementTree.SubElement(drawing, f"{{{SVG}}}circle", at)
        if self.nearest is not None and self.nearest is not self.path:
            for stroke in self.nearest.strokes():
                line = " ".join(f"{x:.1f},{y:.1f}" for x, y in 1e3 * stroke[:, :2] * (1, -1))
                shape = {"points": line, "fill": "none", "stroke": "green"}
                ElementTree.SubElement(drawing, f"{{{SVG}}}polyline", shape)
        return ElementTree.tostring(drawing, encoding="unicode")

    def _repr_html_(self) -> str:
        return cell(drawing=self._repr_svg_(), after=repr(self).split("\n"))


def check_path(
    robot: str | Path | RobotEntry = "five_bar",
    path: str | Path | Curve = "circle",
    **settings: float | str,
) -> PathCheck:
    """Whether a robot can follow a path, and the nearest path that it can follow.

    The nearest one is looked for among smoothed, scaled and moved versions of the path.

    Args:
        robot, path, settings: as for `onpath.simulate`.

    Raises:
        ValueError: an unknown robot, path or setting.
        OSError: a file cannot be read.

    >>> import onpath
    >>> check = onpath.check_path("five_bar", onpath.circle(0.006))
    >>> check.ok, check.nearest.length() > 0.05
    (False, True)
    """
    exchanged = isinstance(robot, Curve) or isinstance(path, RobotEntry)
    if exchanged or str(robot) in presets() or str(path) in ROBOTS:
        raise TypeError("check_path(robot, path): the robot comes first, as in onpath.simulate")
    entry = entry_named(robot)
    check_names(settings, entry, check_path)
    with looked_up("onpath.paths()"):
        curve = curve_of("path", path)
    margin = entry.make(with_values(entry.parameters(), settings)).margin
    faults = curve_faults(margin, curve)
    nearest: Curve | None = curve
    if faults:
        finite = all(fault.check != "not_numbers" for fault in faults)
        nearest = nearest_path(margin, curve) if finite and curve.dimension == 2 else None
    places = [fault.points[:, :2] for fault in faults]
    return PathCheck(
        path=curve,
        reasons=tuple(str(fault.reason) for fault in faults),
        remarks=tuple(str(each.reason) for each in ambiguities(curve)),
        places=np.concatenate(places) if places else np.zeros((0, 2)),
        nearest=nearest,
    )
