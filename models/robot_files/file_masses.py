"""Masses and inertias that a robot's file leaves out, or that no body can have.

A body without mass is taken for the hulls of what the file draws of it, else of its shapes for
collisions, of one density, or for a capsule from its joint to the next one. A mass without inertia,
or with the one of a dummy, keeps its mass and gets the inertia of the same solid. An inertia is
repaired if the second moments

    C = ½ tr(I) 1 - I

of its mass are not all positive, as when the largest principal moment exceeds the sum of the
others: those below zero are set to zero, and I = tr(C) 1 - C.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import msgspec
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.robot_files.chain import Shape
from onpath.models.robot_files.file_chain import Group, Options, aligned, rounded, some_names
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.hull_process import LIBRARY, Hull, hulls_of

DENSITY = 1000.0  # [kg/m³]
NO_MASS = 1e-6  # [kg], below which a mass is a dummy
NO_INERTIA = 1e-9  # [m²], inertia by mass below which a body is a point
OFF = 0.01  # share of the largest moment by which the others may miss it without a remark
THICKNESS = 0.045
"""Radius of a capsule, as a share of the robot's length."""
THINNEST, THICKEST = 0.008, 0.06  # [m]
INSTALL = 'pip install "onpath[meshes]"'


@dataclass(slots=True, eq=False)
class LinkMass:
    """What a file says of a link's mass, in the frame of its group.

    Attributes:
        name: of the link.
        mass: [kg]; 0 if nothing is said.
        centre: of mass, [m].
        inertia: about that, (3, 3), [kg m²].
        drawn: what is drawn of it.
        solid: shapes for collisions, which are weighed where nothing is drawn.
    """

    name: str
    mass: float = 0.0
    centre: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    drawn: Sequence[Shape] = ()
    solid: Sequence[Shape] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Masses:
    """What has been guessed.

    Attributes:
        guesses: of masses and inertias.
        numbers: those that were guessed, as text: all that the motion depends on besides the file.
    """

    guesses: tuple[Guess, ...]
    numbers: str


def add_masses(
    groups: Sequence[Group], links: Sequence[Sequence[LinkMass]], tip: Array, options: Options
) -> Masses:
    """Add the masses of links to their groups.

    Args:
        groups: the base, and the moving bodies, without masses yet.
        links: those of each group.
        tip: in the frame of the last group, [m].

    Raises:
        CodedError: `options.mass` is less than the masses that the file states.
    """
    guesses = list(_repaired(links[1:]))
    stated = [sum(link.mass for link in each) for each in links]
    light = [i for i in range(1, len(groups)) if _is_light(i, groups, links, stated)]
    points = [
        i for i in range(1, len(groups)) if i not in light and stated[i] and _is_point(links[i])
    ]
    solids = _solids(groups, links, [*light, *points], tip)
    masses = {i: DENSITY * solids[i].volume for i in light}
    if light:
        factor = mass_factor(options, sum(stated[1:]), sum(masses.values()))
        masses = {i: factor * mass for i, mass in masses.items()}
    numbers = list[float]()
    for i, each in enumerate(links):
        for link in each if i not in light else ():
            groups[i].add(link.mass, link.centre, link.inertia)
        if i in light or i in points:
            mass = masses.get(i, stated[i])
            share = mass / solids[i].volume
            inertia = rounded(share * np.array(solids[i].inertia))
            mass, centre = float(rounded(mass)), rounded(np.array(solids[i].centre))
            if i in light:
                groups[i].add(mass, centre, inertia)
            else:
                groups[i].inertia = groups[i].inertia + inertia
            numbers += [mass, *centre.tolist(), *np.ravel(inertia).tolist()]
    if light:
        total, volume = sum(masses.values()), sum(solids[i].volume for i in light)
        lacks = any(solid.fault == LIBRARY for solid in solids.values())
        names = [groups[i].name for i in light]
        guesses.append(mass_guess(names, total, total / volume, INSTALL if lacks else "", options))
    if points:
        names = [groups[i].name for i in points]
        message = Message("robot_file.guessed_inertia", some_names(names))
        guesses.append(Guess("inertia", message))
    return Masses(tuple(guesses), repr(numbers) if numbers else "")


def is_dummy(mass: float, inertia: Array) -> bool:
    """Whether a mass says nothing: almost none, or 1 kg and 1 kg m² about each axis."""
    return mass < NO_MASS or (mass == 1.0 and bool((inertia == np.eye(3)).all()))


def _is_light(
    i: int, groups: Sequence[Group], links: Sequence[Sequence[LinkMass]], stated: Sequence[float]
) -> bool:
    """Whether a group has no mass, and should have one.

    A file that states masses may have bodies without mass between joints that meet in a point.
    """
    if stated[i]:
        return False
    drawn = any(link.drawn or link.solid for link in links[i])
    return drawn or not any(stated[i:]) or not any(stated[1:])


def _is_point(links: Sequence[LinkMass]) -> bool:
    mass = sum(link.mass for link in links)
    return all(np.trace(link.inertia) <= NO_INERTIA * mass for link in links)


def _repaired(links: Sequence[Sequence[LinkMass]]) -> Iterator[Guess]:
    """Repair inertias, and say of which links."""
    names = list[str]()
    for link in (link for each in links for link in each):
        least, middle, most = np.linalg.eigvalsh(link.inertia)
        if least < 0 or least + middle < (1 - OFF) * most:
            if least < -1e-6 * abs(most) or least + middle < (1 - OFF) * most:
                names.append(link.name)
            link.inertia = repaired(link.inertia)
    if names:
        yield Guess("inertia", Message("robot_file.repaired", some_names(names)))


def repaired(inertia: Array) -> Array:
    """The inertia of a body whose second moments that are negative are set to zero, (3, 3)."""
    second, axes = np.linalg.eigh(np.trace(inertia) / 2 * np.eye(3) - inertia)
    spread = (axes * np.maximum(second, 0.0)) @ axes.T
    found: Array = np.trace(spread) * np.eye(3) - spread
    return found


def _solids(
    groups: Sequence[Group], links: Sequence[Sequence[LinkMass]], wanted: Sequence[int], tip: Array
) -> dict[int, Hull]:
    """The solids of groups: hulls of what is drawn, of what is solid, or capsules."""
    ends = [*(group.place.translation for group in groups[2:]), tip]
    length = sum(float(np.linalg.norm(end)) for end in ends)
    radius = float(np.clip(THICKNESS * length, THINNEST, THICKEST))
    shapes = [
        (i, kind, shape)
        for i in wanted
        for kind in ("drawn", "solid")
        for link in links[i]
        for shape in getattr(link, kind)
    ]
    hulls = list(zip(shapes, hulls_of([shape for _, _, shape in shapes]), strict=True))
    found = dict[int, Hull]()
    for i in wanted:
        faults = [hull.fault for (k, _, _), hull in hulls if k == i and hull.fault == LIBRARY]
        for kind in ("drawn", "solid"):
            own = [h for (k, of, _), h in hulls if (k, of) == (i, kind) and not h.fault]
            if own and i not in found:
                found[i] = _joined(own)
        if i not in found:
            simple = hulls_of([_capsule(ends[i - 1], radius), _capsule(np.zeros(3), radius)])
            found[i] = next(hull for hull in simple if not hull.fault)  # it may be far too long
        if faults:
            solid = found[i]
            found[i] = msgspec.structs.replace(solid, fault=LIBRARY)
    return found


def _joined(hulls: Sequence[Hull]) -> Hull:
    """Several solids as one."""
    whole = Group("")
    for hull in hulls:
        whole.add(hull.volume, np.array(hull.centre), np.array(hull.inertia))
    centre = whole.moment / whole.mass
    about = Group("")
    for hull in hulls:
        about.add(hull.volume, np.array(hull.centre) - centre, np.array(hull.inertia))
    inertia = tuple(tuple(map(float, row)) for row in about.inertia)
    return Hull(whole.mass, tuple(map(float, centre)), inertia)


def _capsule(end: Array, radius: float) -> Shape:
    """A capsule from a joint to the next one; a sphere if they are one point."""
    length = float(np.linalg.norm(end))
    straight = length > radius / 2
    return Shape(
        kind="capsule" if straight else "sphere",
        file="",
        size=(radius, radius, length) if straight else (radius, radius, radius),
        rotation=aligned(end / length) if straight else np.eye(3),
        translation=end / 2 if straight else np.zeros(3),
    )


def mass_factor(options: Options, stated: float, guessed: float) -> float:
    """What masses that are guessed by `DENSITY` are multiplied by, as the options want it.

    Args:
        stated: sum of the masses that the file states, of what moves, [kg].
        guessed: sum of the others, [kg].

    Raises:
        CodedError: `options.mass` is not more than the masses that the file states.
    """
    if options.mass is None:
        return (DENSITY if options.density is None else options.density) / DENSITY
    if options.mass <= stated:
        mass, least = f"{options.mass:.6g}", f"{stated:.6g}"
        raise CodedError("robot_file.mass_stated", mass=mass, stated=least)
    return (options.mass - stated) / guessed


def mass_guess(
    names: Sequence[str], mass: float, density: float, install: str, options: Options
) -> Guess:
    """The guess of the masses of bodies.

    Args:
        mass: their sum, [kg].
        density: of all of them, [kg/m³].
        install: what installs a package that would have read their meshes; "" if none is missing.
    """
    message = Message(
        "robot_file.guessed_mass_without" if install else "robot_file.guessed_mass",
        {**some_names(names), "mass": f"{mass:.3g}", "density": f"{density:.0f}"},
    )
    given = options.mass is not None or options.density is not None
    return Guess("mass", message, install or ("" if given else f"--mass {mass:.3g}"))
