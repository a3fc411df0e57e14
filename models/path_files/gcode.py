"""Reads the lines that a tool draws from G-code.

    G0        moves without drawing                 G20, G21  lengths are in inches, in millimetres
    G1        moves along a straight line           G90, G91  X and Y are absolute, relative
    G2, G3    move along an arc clockwise, anticlockwise, with its centre at (I, J) from its
              beginning or with radius R, negative for the longer arc; a helix is its circle
    G92, G28  state the place where the tool is, send it home

A move with G1 to G3 draws, unless

- in a print, no material comes: E does not grow;
- a laser or spindle is off: M5 or S0, or M3 and M4 are still to come; without these, M107;
- a pen is raised: by a servo (M280, M300, or the S of M3), whose raised state is the one in which
  it travels with G0, or in which the file ends; or by its height.

Of heights, those from 0 on are up if the tool also goes below 0, else the upper half; down is up if
G0 travels below the lines. The way of a tool that goes down while it moves belongs to its line, and
a move whose X and Y stay is none. Of a print, one layer is read.

Codes hold until the next one, and before the first one G0 does; M2 and M30 end the program. Codes
without effect on the lines are listed. Those that would change them are refused by name.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import atan2, ceil, cos, hypot, pi, sin, sqrt
from typing import TypeVar

from onpath.models.errors import CodedError, Message
from onpath.models.path_files.gcode_words import Words, bare_lines, column_of, words_of
from onpath.models.path_files.stroke import UNITS, Stroke, check_count, drawn_stroke

TURN = pi / 90  # [rad], largest turn between two points of an arc
UNEVEN = 0.01  # largest relative difference of an arc's radius at its ends
ROUNDED = 2e-5  # [m], difference that rounded numbers may make
STILL = 1e-9  # [m], of a move that is none
MOST_LISTED = 12  # codes without effect
MOTIONS = {"0": 0, "1": 1, "2": 2, "3": 3} | {str(code): 0 for code in (*range(81, 90), 73)}
"""Motions; of a cycle of drilling, only the ways between its holes are left."""
SIZES = {"20": UNITS["in"], "21": UNITS["mm"]}
WAYS = {"90": False, "91": True}
CENTRES = {"90.1": True, "91.1": False}
PLANES = {"17": 17, "18": 18, "19": 19}
STILL_CODES = frozenset(("G4", "G31", "G38.2", "G38.3", "G38.4", "G38.5"))
"""Codes whose axes are no place on a line: a pause may have its time as X, and probes end early."""
OBEYED = frozenset(
    f"G{code}" for code in (*MOTIONS, *SIZES, *WAYS, *CENTRES, *PLANES, 28, 30, 92, 92.1)
) | {"M3", "M4", "M5", "M82", "M83", "M280", "M300"}
WITHOUT_EFFECT = STILL_CODES | frozenset(
    f"G{code}"
    for code in (
        *(
            4,
            8,
            9,
            11,
            15,
            17,
            29,
            38.2,
            38.3,
            38.4,
            38.5,
            40,
            43,
            43.1,
            44,
            49,
            50,
            53,
            54,
            60,
            61,
        ),
        *(61.1, 64, 69, 80, 92.2, 93, 94, 95, 96, 97, 98, 99),
    )
)
"""G codes besides those that leave the lines as they are; M codes do, unless they are below."""
CHANGING = {
    **dict.fromkeys(("G41", "G42"), "radius"),
    **dict.fromkeys(("G10", "G52", "G55", "G56", "G57", "G58", "G59"), "origin"),
    **dict.fromkeys(("G16", "G51", "G68", "G7"), "turned"),
    **dict.fromkeys(("G65", "G66", "M97", "M98", "M99"), "program"),
    **dict.fromkeys(("G5", "G5.1", "G6", "G12", "G13"), "curve"),
}
"""Codes that would change the lines, and how."""
ENDS = frozenset(("M2", "M30"))
_PRINTS = re.compile(r"[XY].*E\s*[-+]?\.?\d")
_SWITCHES = re.compile(r"M0*[34](?!\d)")
_POWER = re.compile(r"S\s*[0.]*[1-9]")
_LAYER = re.compile(r"\s*;\s*(?:LAYER:\s*-?\d+|LAYER_CHANGE|CHANGE_LAYER)\b", re.IGNORECASE)
Point = tuple[float, float]
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _Move:
    """A move that may draw.

    Attributes:
        line: of the file.
        points: from its beginning on.
        heights: at its beginning and its end, None if nothing has been said of them.
        power: S of a laser or spindle, 0 if it is off.
        pen: state of a servo, None if nothing has been said of it.
        draws: whether material comes, in a print.
    """

    line: int
    points: list[Point]
    heights: tuple[float | None, float | None]
    power: float
    pen: float | None
    draws: bool


@dataclass(slots=True)
class _Used:
    """Values of a state while the tool moves in the plane, and all that are stated, in order."""

    rapid: set[float] = field(default_factory=set[float])
    feed: set[float] = field(default_factory=set[float])
    stated: list[float] = field(default_factory=list[float])
    counts: Counter[float] = field(default_factory=Counter[float])

    def raised(self) -> frozenset[float]:
        """The states in which a servo holds the pen up: all but the one that draws."""
        used = self.rapid | self.feed
        two = sorted(used, key=lambda value: -self.counts[value])[:2]  # others: it is off
        if len(two) < 2:
            return frozenset()
        travel = [value for value in two if value in self.rapid - self.feed]
        if not self.rapid:
            travel = [value for value in reversed(self.stated) if value in two][:1]
        return frozenset(used - {*two}) | {*travel[:1]}


@dataclass(slots=True)
class _Machine:
    """The state of the machine, and its moves so far.

    Attributes:
        prints: whether the file is that of a printer.
        marked: whether comments mark the layers of a print.
        wanted: the layer of a print that is read, from 1.
        has_power: whether any S is more than 0; else only M3, M4 and M5 switch.
        spindle: whether M3 or M4 switches a spindle or laser; else, with `fan`, M106 does.
        moves: those that may draw; None where a line ends.
    """

    prints: bool
    marked: bool
    wanted: int
    has_power: bool
    spindle: bool
    fan: bool
    at: Point = (0.0, 0.0)
    shift: Point = (0.0, 0.0)  # of the coordinates by G92
    height: float | None = None
    motion: int = 0
    unit: float = SIZES["21"]
    plane: int = 17
    relative: bool = False
    absolute_centres: bool = False
    on: bool = True
    power: float | None = None
    pen: float | None = None
    extruded: float = 0.0
    relative_extrusion: bool = False
    layer: int = 0
    layer_height: float | None = None
    count: int = 0
    moves: list[_Move | None] = field(default_factory=list["_Move | None"])
    stated: set[float] = field(default_factory=set[float])
    heights: _Used = field(default_factory=_Used)
    powers: _Used = field(default_factory=_Used)
    pens: _Used = field(default_factory=_Used)
    without_effect: dict[str, None] = field(default_factory=dict[str, None])

    def rest(self) -> None:
        """End the line that is being drawn."""
        if self.moves and self.moves[-1] is not None:
            self.moves.append(None)

    def go(self, points: list[Point], before: float | None, line: int, *, draws: bool) -> None:
        """Move through points.

        Args:
            before: height at the beginning.
            draws: whether material comes, in a print.
        """
        power = (1.0 if self.power is None else self.power) if self.on else 0.0
        for used, value in (
            (self.heights, self.height),
            (self.powers, power),
            (self.pens, self.pen),
        ):
            if value is not None:
                (used.feed if self.motion else used.rapid).add(value)
                used.counts[value] += 1
        if draws and not self.marked and self.height != self.layer_height:
            self.layer, self.layer_height = self.layer + 1, self.height
        wanted = draws and self.layer == self.wanted if self.prints else self.motion > 0
        if wanted:
            self.count += len(points)
            check_count(self.count, line)
            heights = before, self.height
            self.moves.append(_Move(line, [self.at, *points], heights, power, self.pen, draws))
        else:
            self.rest()
        self.at = points[-1]


def strokes_of_gcode(text: str, layer: str | None = None) -> tuple[list[Stroke], list[Message]]:
    """The lines that a tool draws, in the order of the file, and what has no effect.

    Args:
        layer: number of a print's layer, from 1; None: the first.

    Raises:
        CodedError: the text has what is refused, or an impossible arc, or no such layer; the
            message names line and column.
    """
    lines, comments = bare_lines(text), text.splitlines()
    machine = _Machine(
        prints=any(_PRINTS.search(line) for line in lines),
        marked=any(_LAYER.match(line) for line in comments),
        wanted=int(layer) if layer and re.fullmatch(r"0*[1-9]\d{0,8}", layer, re.ASCII) else 1,
        has_power=any(_POWER.search(line) for line in lines),
        spindle=any(_SWITCHES.search(line) for line in lines),
        fan=any("M106" in line for line in lines) and any("M107" in line for line in lines),
    )
    machine.marked = machine.marked and machine.prints
    machine.fan = machine.fan and not machine.spindle and not machine.prints
    machine.on = not machine.spindle and not machine.fan
    for number, bare in enumerate(lines, start=1):
        if machine.marked and _LAYER.match(comments[number - 1]):
            machine.layer += 1
            machine.rest()
        words = words_of(bare, number)
        _check(words, bare, number)
        _obey(machine, words, number)
        if words.keys() & ENDS:
            break
    if layer is not None and not (machine.prints and layer.lstrip("0") == str(machine.wanted)):
        raise _no_layer(machine, layer)
    drawn = _lines(machine)
    if layer is not None and not drawn:
        raise _no_layer(machine, layer)
    strokes = [drawn_stroke(points, f"line {line}") for line, points in drawn]
    return strokes, _remarks(machine)


def _no_layer(machine: _Machine, layer: str) -> CodedError:
    names = f"1 … {machine.layer}" if machine.layer else "–"
    return CodedError("error.file_layer", layer=layer[:40], names=names)


def _remarks(machine: _Machine) -> list[Message]:
    remarks = list[Message]()
    if machine.layer > 1:
        layer, count = str(machine.wanted), machine.layer
        remarks.append(Message("say.gcode_layer", {"layer": layer, "count": count}))
    if codes := [*machine.without_effect]:
        more = len(codes) - MOST_LISTED
        words = ", ".join(codes[:MOST_LISTED])
        remarks.append(Message("say.gcode_words", {"words": words, "more": max(more, 0)}))
    return remarks


def _lines(machine: _Machine) -> list[tuple[int, list[Point]]]:
    """Number in the file and points of the lines that are drawn."""
    pen, power = machine.pens.raised(), frozenset({0.0})
    is_down = _down(machine.heights, machine.stated if machine.spindle else set())
    powers = machine.powers.rapid | machine.powers.feed
    if is_down is None and len(powers) == 2 and 0.0 not in powers:
        power = machine.powers.raised()
    drawn, fresh = list[tuple[int, list[Point]]](), True
    for move in machine.moves:
        draws = (
            move is not None
            and (not pen or (move.pen is not None and move.pen not in pen))
            and (move.draws if machine.prints else move.power not in power)
            and (machine.prints or is_down is None or any(map(is_down, move.heights)))
        )
        if move is None or not draws:
            fresh = True
            continue
        if fresh:
            drawn.append((move.line, move.points[:1]))
        drawn[-1][1].extend(move.points[1:])
        fresh = False
    return drawn


class _Down:
    """Whether a tool at a height is down.

    Args:
        limit: height from which on it is up.
        sign: -1 if down is up.
    """

    def __init__(self, limit: float, *, sign: int) -> None:
        self._limit, self._sign = limit, sign

    def __call__(self, height: float | None) -> bool:
        return height is not None and self._sign * (height - self._limit) < 0


def _down(used: _Used, stated: set[float]) -> _Down | None:
    """What tells whether the tool is down; None if its height says nothing.

    Args:
        stated: all heights of a spindle, also those at which it does not move in the plane.
    """
    heights = used.rapid | used.feed
    if not used.feed:
        return None
    low, high = min(heights), max(heights | stated)
    if used.rapid and max(used.rapid) < min(used.feed):
        return _Down((max(used.rapid) + min(used.feed)) / 2, sign=-1)
    if low < 0 <= high:
        return _Down(0.0, sign=1)
    high = max(heights)
    return _Down((low + high) / 2, sign=1) if low < high else None


def _check(words: Iterable[str], bare: str, line: int) -> None:
    """Refuse codes that would change the lines, and unknown ones.

    Raises:
        CodedError: there is one.
    """
    axes = {*words} & {"X", "Y"}
    for name in words:
        why = CHANGING.get(name)
        if name in ("G10", "G52") and not axes:
            why = None
        if name == "G53" and axes and not {*words} & {"G0", "G00"}:
            why = "origin"
        known = name in OBEYED or name in WITHOUT_EFFECT or name in CHANGING
        if why is None and not known and re.fullmatch(r"G[\d.]+", name):
            why = "unknown"
        if why is not None:
            column = column_of(bare, name)
            raise CodedError(
                "error.gcode_changes", line=str(line), column=column, text=name, why=why
            )


def _obey(machine: _Machine, words: Words, line: int) -> None:
    """Do what a line says."""
    machine.motion = _code(words, MOTIONS, machine.motion, line)
    machine.unit = _code(words, SIZES, machine.unit, line)
    machine.plane = _code(words, PLANES, machine.plane, line)
    machine.absolute_centres = _code(words, CENTRES, machine.absolute_centres, line)
    relative = _code(words, WAYS, machine.relative, line)
    if words.keys() & {"G90", "G91"}:
        machine.relative_extrusion = relative
    machine.relative = relative
    _switch(machine, words)
    for name in words:
        if len(name) > 1 and name not in OBEYED and name not in ENDS and not _is_fan(machine, name):
            machine.without_effect[name] = None
    if words.keys() & STILL_CODES:
        return
    if words.keys() & {"G92", "G92.1"}:
        _restate(machine, words)
    elif words.keys() & {"G28", "G30"}:
        axes = words.keys() & set("XYZ") or set("XYZ")
        x, y = (0.0 if name in axes else machine.at[i] for i, name in enumerate("XY"))
        machine.at = (x, y)
        machine.height = None if "Z" in axes else machine.height
        machine.rest()
    elif words.keys() & set("XYZIJR"):
        _move(machine, words, line)
    elif "E" in words:
        _extrude(machine, words)


def _is_fan(machine: _Machine, name: str) -> bool:
    return machine.fan and name in ("M106", "M107")


def _switch(machine: _Machine, words: Words) -> None:
    """Switch a laser, a spindle or a servo, and the way in which E counts."""
    if words.keys() & {"M82", "M83"}:
        machine.relative_extrusion = "M83" in words
    if machine.fan and words.keys() & {"M106", "M107"}:
        machine.on = "M106" in words
        return
    if words.keys() & {"M280", "M300"}:
        if "S" in words:
            machine.pen = words["S"]
            machine.pens.stated.append(words["S"])
        return
    if "S" in words and "G4" not in words and machine.has_power:
        machine.power = words["S"]
        machine.powers.stated.append(words["S"])
    if words.keys() & {"M3", "M4"}:
        machine.on = True
    elif "M5" in words:
        machine.on = False


def _restate(machine: _Machine, words: Words) -> None:
    """State that the tool is at another place than the one where it is, without moving it."""
    if "E" in words:
        machine.extruded = words["E"]
    if "G92.1" in words:
        machine.shift = (0.0, 0.0)
    elif words.keys() & {"X", "Y"}:
        x, y = (
            machine.at[i] - machine.unit * words[name] if name in words else machine.shift[i]
            for i, name in enumerate("XY")
        )
        machine.shift = (x, y)
    if "Z" in words:
        machine.height = machine.unit * words["Z"]


def _extrude(machine: _Machine, words: Words) -> bool:
    """Bring material; returns whether any comes."""
    if "E" not in words:
        return False
    before = 0.0 if machine.relative_extrusion else machine.extruded
    grows = words["E"] > before + 1e-9
    if not machine.relative_extrusion:
        machine.extruded = words["E"]
    return grows


def _move(machine: _Machine, words: Words, line: int) -> None:
    """Move the tool."""
    before = machine.height
    if "Z" in words:
        below = (machine.height or 0.0) if machine.relative else 0.0
        machine.height = below + machine.unit * words["Z"]
        machine.stated.add(machine.height)
    draws = _extrude(machine, words)
    x, y = (
        machine.at[i]
        if name not in words
        else machine.unit * words[name] + (machine.at if machine.relative else machine.shift)[i]
        for i, name in enumerate("XY")
    )
    if machine.motion < 2:
        if words.keys() & set("IJR") and machine.motion == 1:
            raise CodedError("error.gcode_no_arc", line=str(line))
        points = [(x, y)]
        if hypot(x - machine.at[0], y - machine.at[1]) < STILL:
            if machine.height != before:
                machine.rest()
            return
    else:
        if machine.plane != 17:
            raise CodedError("error.gcode_plane", line=str(line), text=f"G{machine.plane}")
        points = _arc(machine, words, (x, y), line)
    machine.go(points, before, line, draws=draws)


def _code(words: Words, codes: Mapping[str, T], before: T, line: int) -> T:
    """The meaning of the one of these G codes that a line has; the one before if it has none."""
    found = [code for code in codes if f"G{code}" in words]
    if len(found) > 1:
        raise CodedError("error.gcode_both", line=str(line), text=f"G{found[0]}, G{found[1]}")
    return codes[found[0]] if found else before


def _arc(machine: _Machine, words: Words, end: Point, line: int) -> list[Point]:
    """Points of an arc after its beginning."""
    begin, clockwise = machine.at, machine.motion == 2
    if ("R" in words) == bool(words.keys() & {"I", "J"}):
        raise CodedError("error.gcode_arc_form", line=str(line))
    if "R" in words:
        x, y = _centre(begin, end, machine.unit * words["R"], clockwise, line)
    else:
        base = machine.shift if machine.absolute_centres else begin
        x, y = (base[i] + machine.unit * words.get(name, 0.0) for i, name in enumerate("IJ"))
    first, last = (hypot(p[0] - x, p[1] - y) for p in (begin, end))
    if not first or abs(first - last) > max(UNEVEN * first, ROUNDED):
        one, other = f"{1e3 * first:.4g}", f"{1e3 * last:.4g}"
        raise CodedError("error.gcode_arc_ends", line=str(line), first=one, last=other)
    angle = atan2(begin[1] - y, begin[0] - x)
    sweep = (atan2(end[1] - y, end[0] - x) - angle) % (2 * pi)
    if hypot(end[0] - begin[0], end[1] - begin[1]) < ROUNDED / 20:
        sweep = -2 * pi if clockwise else 2 * pi  # the whole circle
    elif clockwise:
        sweep -= 2 * pi
    count = max(2, ceil(abs(sweep) / TURN))
    points = list[Point]()
    for i in range(1, count + 1):
        radius, turned = first + (last - first) * i / count, angle + sweep * i / count
        points.append((x + radius * cos(turned), y + radius * sin(turned)))
    points[-1] = end
    return points


def _centre(begin: Point, end: Point, radius: float, clockwise: bool, line: int) -> Point:
    """The centre of an arc given by its radius."""
    dx, dy = end[0] - begin[0], end[1] - begin[1]
    chord = hypot(dx, dy)
    if chord < ROUNDED / 20 or abs(radius) < chord / 2 - ROUNDED:
        raise CodedError("error.gcode_radius", line=str(line), radius=f"{1e3 * radius:g}")
    height = sqrt(max(radius**2 - chord**2 / 4, 0.0))
    side = -1 if clockwise == (radius > 0) else 1
    return (
        (begin[0] + end[0]) / 2 - side * height * dy / chord,
        (begin[1] + end[1]) / 2 + side * height * dx / chord,
    )
