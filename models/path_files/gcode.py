"""Reads the lines that a tool draws from G-code.

    G0        moves to the beginning of a line      G20, G21  lengths are in inches, in millimetres
    G1        draws a straight line                 G90, G91  X and Y are absolute, relative
    G2, G3    draw an arc clockwise, anticlockwise, with its centre at (I, J) from its beginning or
              with radius R, negative for the longer arc

Codes hold until the next one, and M2 and M30 end the program. Where the tool is raised or lowered,
a line ends; Z does not change within one. Numbers of lines and programs, comments and % are
skipped. Words that leave the path as it is have no effect: speeds, tools, pauses, coolant, and the
codes in `WITHOUT_EFFECT`. Everything else is refused: a compensated tool, for example, would follow
another path than the one read here.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import atan2, ceil, cos, hypot, isfinite, pi, sin, sqrt
from typing import TypeVar

from onpath.models.errors import CodedError
from onpath.models.path_files.stroke import UNITS, Stroke, check_count, drawn_stroke

LONGEST_LINE = 1000  # [characters]
TURN = pi / 90  # [rad], largest turn between two points of an arc
UNEVEN = 0.01  # largest relative difference of an arc's radius at its ends
ROUNDED = 2e-5  # [m], difference that rounded numbers may make
MOTIONS = {"0": 0, "1": 1, "2": 2, "3": 3}
SIZES = {"20": UNITS["in"], "21": UNITS["mm"]}
WAYS = {"90": False, "91": True}
WITHOUT_EFFECT = frozenset(
    [f"G{code}" for code in (4, 17, 40, 43, 49, 54, 61, 64, 80, 91.1, 92.1, 93, 94)]
    + [f"M{code}" for code in (0, 1, 3, 4, 5, 6, 7, 8, 9, 48, 49, 52)]
)
"""Codes besides those above that leave the path in the plane as it is."""
LETTERS_WITHOUT_EFFECT = frozenset("FSTHP")
"""Letters of further words without effect: speeds, tools and times."""
ENDS = frozenset(("M2", "M30"))
_COMMENT = re.compile(r"\([^()]*\)|;.*")
_OBEYED = {f"G{code}" for code in (*MOTIONS, *SIZES, *WAYS)} | set("XYZIJRNO")
_KNOWN = _OBEYED | WITHOUT_EFFECT | LETTERS_WITHOUT_EFFECT | ENDS
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.ASCII)

Point = tuple[float, float]
T = TypeVar("T")


@dataclass(slots=True)
class _Machine:
    """The state of the machine, and the lines drawn so far."""

    at: Point = (0.0, 0.0)
    height: float = 0.0
    motion: int | None = None
    unit: float = SIZES["21"]
    relative: bool = False
    count: int = 0
    drawn: list[tuple[int, list[Point]]] = field(default_factory=list[tuple[int, list[Point]]])
    fresh: bool = True  # the next line begins where the machine is
    without_effect: dict[str, None] = field(default_factory=dict[str, None])

    def lift(self, height: float, *, moves: bool, line: int) -> None:
        """Raise or lower the tool, which ends a line.

        Args:
            moves: whether it also moves in the plane.
        """
        if height == self.height:
            return
        if moves and self.motion:
            raise CodedError("error.gcode_height", line=str(line))
        self.height, self.fresh = height, True

    def go(self, points: list[Point], line: int) -> None:
        """Move through points, and draw unless the motion is G0."""
        if self.motion == 0:
            self.fresh = True
        else:
            if self.fresh:
                self.drawn.append((line, [self.at]))
                self.fresh = False
            self.drawn[-1][1].extend(points)
            self.count += len(points)
            check_count(self.count, line)
        self.at = points[-1]


def strokes_of_gcode(text: str) -> tuple[list[Stroke], tuple[str, ...]]:
    """The lines that a tool draws, in the order of the file, and the words without effect.

    Raises:
        CodedError: the text has anything but the words above, or an impossible arc; the
            message names line and column.
    """
    machine = _Machine()
    for number, line in enumerate(text.splitlines(), start=1):
        if len(line) > LONGEST_LINE:
            raise CodedError("error.table_long_line", line=str(number), most=str(LONGEST_LINE))
        bare = _COMMENT.sub(lambda found: " " * len(found[0]), line.upper())  # columns stay
        words = _words(bare, number) if bare.strip() != "%" else {}
        _obey(machine, words, number)
        if words.keys() & ENDS:
            break
    strokes = [drawn_stroke(points, f"line {line}") for line, points in machine.drawn]
    return strokes, tuple(machine.without_effect)


def _words(bare: str, line: int) -> dict[str, float]:
    """The words of a line by letter; codes of G and M as G0, M3 and so on.

    Raises:
        CodedError: a word that is not read, or is repeated.
    """
    words, place, end = dict[str, float](), 0, len(bare.rstrip())
    while place < end:
        found = _WORD.match(bare, place)
        if found is None:
            column, text = _at(bare, place)
            raise CodedError("error.gcode_word", line=str(line), column=column, text=text)
        letter, number = found[1], found[2]
        name, value = letter, float(number)
        if letter in "GM":
            whole, _, rest = number.partition(".")
            name += whole.lstrip("0") or "0" if not rest.strip("0") else number
        if name not in _KNOWN or not isfinite(value):
            column, text = _at(bare, place)
            raise CodedError("error.gcode_word", line=str(line), column=column, text=text)
        if name in words:
            column, text = _at(bare, place)
            raise CodedError("error.gcode_twice", line=str(line), column=column, text=text)
        words[name] = value
        place = found.end()
    return words


def _at(bare: str, place: int) -> tuple[str, str]:
    """Column and text of the word at a place of a line, for a message."""
    begin = place + len(bare[place:]) - len(bare[place:].lstrip())
    word = re.match(r"\S[^A-Z\s]*", bare[begin:])
    return str(begin + 1), repr((word[0] if word else bare[begin:])[:20])


def _obey(machine: _Machine, words: dict[str, float], line: int) -> None:
    """Do what a line says."""
    machine.motion = _code(words, MOTIONS, machine.motion, line)
    machine.unit = _code(words, SIZES, machine.unit, line)
    machine.relative = _code(words, WAYS, machine.relative, line)
    without_effect = WITHOUT_EFFECT | LETTERS_WITHOUT_EFFECT
    machine.without_effect.update((name, None) for name in words if name in without_effect)
    moves = words.keys() & set("XYIJR")
    if not moves and "Z" not in words:
        return
    if "G4" in words:  # X may be a time
        raise CodedError("error.gcode_both", line=str(line), text=f"G4, {min(moves | {'Z'})}")
    if machine.motion is None:
        raise CodedError("error.gcode_no_motion", line=str(line))
    if "Z" in words:
        below = machine.height if machine.relative else 0.0
        height = below + machine.unit * words["Z"]
        machine.lift(height, moves=bool(moves), line=line)
    if not moves:
        return
    base = machine.at if machine.relative else (0.0, 0.0)
    x, y = (
        base[i] + machine.unit * words[name] if name in words else machine.at[i]
        for i, name in enumerate("XY")
    )
    if machine.motion < 2:
        if moves & set("IJR"):
            raise CodedError("error.gcode_no_arc", line=str(line))
        machine.go([(x, y)], line)
    else:
        machine.go(_arc(machine, words, (x, y), line), line)


def _code(words: dict[str, float], codes: Mapping[str, T], before: T, line: int) -> T:
    """The meaning of the one of these G codes that a line has; the one before if it has none."""
    found = [code for code in codes if f"G{code}" in words]
    if len(found) > 1:
        raise CodedError("error.gcode_both", line=str(line), text=f"G{found[0]}, G{found[1]}")
    return codes[found[0]] if found else before


def _arc(machine: _Machine, words: dict[str, float], end: Point, line: int) -> list[Point]:
    """Points of an arc after its beginning."""
    begin, clockwise = machine.at, machine.motion == 2
    if ("R" in words) == bool(words.keys() & {"I", "J"}):
        raise CodedError("error.gcode_arc_form", line=str(line))
    if "R" in words:
        x, y = _centre(begin, end, machine.unit * words["R"], clockwise, line)
    else:
        x, y = (begin[i] + machine.unit * words.get(name, 0.0) for i, name in enumerate("IJ"))
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
