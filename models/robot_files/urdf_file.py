"""Reads a robot from a URDF file as a chain of bodies, and refuses what it cannot take.

The chain leads from the root of the tree of links to the tip. Its joints move, unless they are
fixed or locked, at most `MOST_JOINTS` of them; all other joints are locked, and links that do not
move against each other are one body. Source: http://wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.robot_files.chain import Chain, Joint, Shape
from onpath.models.robot_files.file_chain import (
    MOST_JOINTS,
    MOST_NAMES,
    FileChain,
    Group,
    Options,
    RigidTransform,
    TipAt,
    aligned,
    check_joints,
    exact,
    guessed_tip,
    locked_guess,
    locked_guesses,
    some_names,
    tip_at,
    turn,
)
from onpath.models.robot_files.file_masses import LinkMass, is_dummy
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.mesh_folders import MeshFolders
from onpath.models.robot_files.tip_guess import TipPlace, suggested_tips, surplus_joints
from onpath.models.robot_files.whole_chain import whole_chain
from onpath.models.robot_files.xml_elements import Element, FileFault, shown

MOST_LINKS = 1000
NO_LIMIT = 1e6  # [rad], [m] or [N m], from which on a limit is none
MESHES = (".stl", ".obj", ".dae")
TURNING, SLIDING, STILL = ("revolute", "continuous"), ("prismatic",), ("fixed",)
FREE = ("floating", "planar")


def read_urdf(file: Path, root: Element, options: Options) -> FileChain:
    """The chain of a URDF file.

    Args:
        root: its outermost element.

    Raises:
        FileFault: something in the file is refused.
        CodedError: an option names a link or joint that does not exist.
    """
    tree = _Tree(file, root, options)
    chain, guesses, numbers = tree.chain()
    return FileChain(
        chain=chain,
        home={},
        remarks=tuple(tree.remarks()),
        guesses=(*tree.guesses(), *guesses),
        tips=tree.tips,
        places=tree.places,
        rests=numbers,
    )


class _Tree:
    """The links and joints of a file."""

    def __init__(self, file: Path, root: Element, options: Options) -> None:
        if root.tag != "robot":
            raise FileFault(root, Message("robot_file.root"))
        _refuse_xacro(root)
        self._still = list[str]()  # joints without travel
        self._left_out = list[str]()  # what is not drawn
        self._folders = MeshFolders(file, options.packages, MESHES)
        self._options = options
        self._root = root
        self._links = _named(root, "link", MOST_LINKS)
        self._joints = _named(root, "joint", MOST_LINKS)
        self._before = self._parents()
        self._after = dict[str, list[Element]]()
        for joint in self._joints.values():
            self._after.setdefault(joint.need("parent").name("link"), []).append(joint)
        self._base = self._checked_base()
        check_joints(options, self._joints)
        self._places = self._tree()
        self.tips = self._suggested()
        self.places = dict[str, TipAt]()
        self._tip = self.tips[0]
        self._way = self._joints_to(self._tip)
        self._held = self._held_joints()

    def _parents(self) -> dict[str, Element]:
        """The joint before each link."""
        before = dict[str, Element]()
        for joint in self._joints.values():
            for end in ("parent", "child"):
                named = joint.need(end)
                if named.name("link") not in self._links:
                    raise FileFault(
                        named, Message("robot_file.no_link", {"name": named.name("link")})
                    )
            child = joint.need("child").name("link")
            if child in before:
                other = before[child].name()
                raise FileFault(
                    joint, Message("robot_file.two_parents", {"name": child, "other": other})
                )
            before[child] = joint
        return before

    def _checked_base(self) -> str:
        """The link from which all others can be reached."""
        roots = [name for name in self._links if name not in self._before]
        if not roots:
            raise FileFault(self._root, Message("robot_file.loop"))
        reached, waiting = set[str](), [roots[0]]
        while waiting:
            name = waiting.pop()
            reached.add(name)
            waiting += [j.need("child").name("link") for j in self._after.get(name, [])]
        for name, link in self._links.items():
            if name not in reached and name in roots:
                raise FileFault(link, Message("robot_file.apart", {"name": roots[0]}))
            if name not in reached:
                raise FileFault(link, Message("robot_file.loop"))
        return roots[0]

    def _suggested(self) -> tuple[str, ...]:
        """The links that may be the tip; the first one is it."""
        tip = self._options.tip
        if tip and tip not in self._links:
            names = ", ".join(self._links)
            raise CodedError("robot_file.no_tip", tip=shown(tip), names=names)
        return suggested_tips(self._places, tip)

    def _tree(self) -> list[TipPlace]:
        """The links, parents before children."""
        places, waiting = [TipPlace(self._base, -1)], [(self._base, 0)]
        while waiting:
            link, number = waiting.pop()
            for joint in reversed(self._after.get(link, [])):
                child = joint.need("child").name("link")
                moves = joint.text("type") in (*TURNING, *SLIDING) and not _is_still(joint)
                place = TipPlace(
                    name=child,
                    parent=number,
                    joints=(joint.name(),) if moves else (),
                    follows=joint.first("mimic") is not None,
                    step=float(np.linalg.norm(_origin(joint).translation)),
                )
                waiting.append((child, len(places)))
                places.append(place)
        return places

    def _joints_to(self, tip: str) -> dict[str, Element]:
        """The joints from the base to the tip, by name."""
        way, link = list[Element](), tip
        while link in self._before:
            way.append(self._before[link])
            link = way[-1].need("parent").name("link")
        return {joint.name(): joint for joint in reversed(way)}

    def _held_joints(self) -> dict[str, str]:
        """The joints on the way to the tip that are locked without being asked, and why."""
        held, moving = dict[str, str](), list[str]()
        for name, joint in self._way.items():
            kind = joint.text("type")
            if kind in STILL or name in self._options.lock:
                continue
            if kind in FREE:
                held[name] = "robot_file.guessed_free"
            elif joint.first("mimic") is not None:
                held[name] = "robot_file.guessed_mimic"
            elif not _is_still(joint):
                moving.append(name)
        many = surplus_joints(self._places, self._tip, moving, MOST_JOINTS)
        return held | dict.fromkeys(many, "robot_file.guessed_many")

    def remarks(self) -> Iterator[Message]:
        """What is left out or unusual."""
        if self._still:
            yield Message("robot_file.still", some_names(self._still))
        if self._left_out:
            yield Message("robot_file.not_drawn", some_names([*dict.fromkeys(self._left_out)]))

    def guesses(self) -> Iterator[Guess]:
        """What the file does not say."""
        options = self._options
        if not options.tip and [n for n in self._links if n not in self._after] != [self._tip]:
            yield guessed_tip(self._tip)
        off = [
            name
            for name, joint in self._joints.items()
            if name not in self._way and joint.text("type") not in STILL
        ]
        yield from locked_guesses(self._held, off, options)
        free = [
            name
            for name, joint in self._way.items()
            if joint.text("type") in ("revolute", *SLIDING)
            and name not in {*self._held, *options.lock}
            and _without_limits(joint.first("limit"))
        ]
        if free:
            yield locked_guess("robot_file.guessed_limits", free, {})
        for name in self._folders.missing[:MOST_NAMES]:
            message = Message("robot_file.guessed_package", {"package": shown(name)})
            yield Guess("package", message, f"--package {shlex.quote(name)}=FOLDER")

    def chain(self) -> tuple[Chain, tuple[Guess, ...], str]:
        """The moving bodies, from the base to the tip; see `whole_chain`."""
        groups, tip = [Group(self._base)], RigidTransform()
        masses = list[list[LinkMass]]([[]])
        waiting = [(self._base, 0, RigidTransform())]
        while waiting:
            name, number, place = waiting.pop()
            if name in self.tips:
                self.places[name] = tip_at(number, place.translation)
            if name == self._tip:
                last, tip = number, place
                _check_last(self._links[name], last, groups)
            mass = self._link_mass(self._links[name], place, bool(number))
            masses[number].append(mass)
            groups[number].shapes += mass.drawn
            # the way to the tip comes last, and so is taken first
            further = self._after.get(name, [])
            for joint in sorted(further, key=lambda each: each.name() in self._way):
                child = joint.need("child").name("link")
                origin = place @ _origin(joint)
                moving = self._moving(joint)
                if moving is None:
                    waiting.append((child, number, origin @ self._locked(joint)))
                    continue
                frame = RigidTransform(aligned(_axis(joint)))
                groups.append(Group(child, moving, origin @ frame))
                masses.append([])
                waiting.append((child, len(groups) - 1, RigidTransform(frame.rotation.T)))
        return whole_chain(
            groups=groups, links=masses, tip=tip, name=self._tip, options=self._options
        )

    def _moving(self, joint: Element) -> Joint | None:
        """The joint if it is on the way to the tip and moves; None if it is locked."""
        kind, name = joint.text("type"), joint.name()
        if kind not in (*TURNING, *SLIDING, *STILL, *FREE):
            raise FileFault(joint, Message("robot_file.type", {"type": shown(kind)}))
        data = _joint(joint, kind, self._options.armature)
        if name not in self._way or kind in STILL:
            return None
        if name in self._options.lock or name in self._held:
            return None
        if data.low == data.high:
            self._still.append(name)
            return None
        return data

    def _locked(self, joint: Element) -> RigidTransform:
        """The motion of a joint that stays where it is."""
        kind, name = joint.text("type"), joint.name()
        if kind in (*STILL, *FREE):
            return RigidTransform()
        data = _joint(joint, kind, 0.0)
        options = self._options
        wanted = options.lock.get(name, options.pose.get(name, 0.0))
        value = min(max(wanted, data.low), data.high)
        if name in (*options.lock, *options.pose) and value != wanted:
            low, high = f"{data.low:.3g}", f"{data.high:.3g}"
            raise FileFault(
                joint,
                Message("robot_file.outside", {"value": f"{wanted:.3g}", "low": low, "high": high}),
            )
        axis = _axis(joint)
        if data.slides:
            return RigidTransform(translation=value * axis)
        return RigidTransform(turn(axis, value))

    def _link_mass(self, link: Element, place: RigidTransform, moves: bool) -> LinkMass:
        """What the file says of a link's mass, and what it draws of it, in the group's frame."""
        drawn = [*self._shapes(link.all("visual"), place, self._left_out)]
        mass = LinkMass(link.name(), drawn=drawn)
        inertial = link.first("inertial")
        if inertial is not None:
            stated, inertia = _mass(inertial)
            if not is_dummy(stated, inertia):
                here = place @ _origin(inertial)
                mass.mass, mass.centre = stated, here.translation
                mass.inertia = here.rotation @ inertia @ here.rotation.T
        if moves and not mass.inertia.any():
            mass.solid = [*self._shapes(link.all("collision"), place, [])]
        return mass

    def _shapes(
        self, elements: Iterable[Element], place: RigidTransform, left_out: list[str]
    ) -> Iterator[Shape]:
        """The shapes of some elements; those that cannot be read are named in `left_out`."""
        for element in elements:
            try:
                shape = self._shape(element, place)
            except FileFault as fault:
                address = fault.element.values.get("filename", f"<{fault.element.tag}>")
                if not self._folders.is_missing(address):
                    left_out.append(address.rsplit("/", 1)[-1])
                continue
            if shape is not None:
                yield shape

    def _shape(self, visual: Element, place: RigidTransform) -> Shape | None:
        """A shape; None if it is none that is known.

        Raises:
            FileFault: it is not there, or has no size.
        """
        geometry = visual.first("geometry")
        here = place @ _origin(visual)
        for element in geometry.children if geometry is not None else ():
            kind, size, file = element.tag, (1.0, 1.0, 1.0), ""
            if kind == "mesh":
                x, y, z = element.numbers("scale", 3, "1 1 1")
                address, size = element.text("filename"), (x, y, z)
                found = self._folders.mesh(address)
                if found is None or not all(size):
                    raise FileFault(element, Message("robot_file.shape"))
                file = str(found)
            elif kind == "box":
                x, y, z = element.numbers("size", 3)
                size = (x, y, z)
            elif kind == "sphere":
                radius = element.number("radius")
                size = (radius, radius, radius)
            elif kind == "cylinder":
                radius = element.number("radius")
                size = (radius, radius, element.number("length"))
            else:
                continue
            if kind != "mesh" and not 0 < min(size) <= max(size) < 100:
                raise FileFault(element, Message("robot_file.shape"))
            return Shape(
                kind=kind,
                file=file,
                size=size,
                rotation=here.rotation,
                translation=here.translation,
            )
        return None


def _named(root: Element, tag: str, most: int) -> dict[str, Element]:
    """The elements of a kind by name."""
    found = dict[str, Element]()
    for element in root.all(tag):
        name = element.name()
        if name in found:
            raise FileFault(element, Message("robot_file.twice", {"line": found[name].line}))
        found[name] = element
        if len(found) > most:
            raise FileFault(element, Message("robot_file.many", {"most": most}))
    if tag == "link" and not found:
        raise FileFault(root, Message("robot_file.without", {"what": "<link>"}))
    return found


def _refuse_xacro(root: Element) -> None:
    """Refuse what xacro would have replaced, except in its own leftovers and in what is drawn."""
    for element in (root, *root.children):
        if element.tag.startswith("xacro:") and element.tag not in ("xacro:property", "xacro:arg"):
            raise FileFault(element, Message("robot_file.xacro"))
    waiting = [each for each in root.children if each.tag in ("link", "joint")]
    while waiting:
        element = waiting.pop()
        if element.tag.startswith("xacro:") or any("${" in v for v in element.values.values()):
            raise FileFault(element, Message("robot_file.xacro"))
        waiting += [each for each in element.children if each.tag not in ("visual", "collision")]


def _mass(inertial: Element) -> tuple[float, Array]:
    """The mass that a link states, and its inertia in the frame of <inertial>, (3, 3)."""
    mass = inertial.need("mass").number("value")
    if mass < 0:
        raise FileFault(inertial.need("mass"), Message("robot_file.mass", {"value": f"{mass:g}"}))
    element = inertial.first("inertia")
    if element is None:
        return mass, np.zeros((3, 3))
    xx, xy, xz = (element.number(key, 0.0) for key in ("ixx", "ixy", "ixz"))
    yy, yz, zz = (element.number(key, 0.0) for key in ("iyy", "iyz", "izz"))
    return mass, np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _check_last(link: Element, number: int, groups: list[Group]) -> None:
    """Check that a joint moves the tip."""
    if number == 0 or len(groups) < 2:
        raise FileFault(link, Message("robot_file.still_tip"))


def _is_still(joint: Element) -> bool:
    """Whether a joint that could move has no travel between its limits."""
    data = _joint(joint, joint.text("type"), 0.0)
    return data.low == data.high


def _end(limit: Element, key: str) -> float:
    """An end of a joint's travel, which may be infinite."""
    text = limit.values.get(key, "").strip().lower()
    if text.lstrip("+-") in ("inf", "infinity"):
        return float(text)
    value = limit.number(key, 0.0, most=math.inf)
    return value if abs(value) < NO_LIMIT else math.copysign(math.inf, value)


def _without_limits(limit: Element | None) -> bool:
    """Whether the ends of a joint that could have some are left out, or those of an exporter."""
    if limit is None or not {"lower", "upper"} & limit.values.keys():
        return True
    return not any(_end(limit, key) for key in ("lower", "upper", "effort", "velocity"))


def _joint(joint: Element, kind: str, armature: float) -> Joint:
    """Limits and friction of a joint."""
    limit, dynamics = joint.first("limit"), joint.first("dynamics")
    low, high, effort = -math.inf, math.inf, math.inf
    if limit is not None:
        effort = _end(limit, "effort")
        effort = effort if effort > 0 else math.inf  # exporters write 0 or -1 for "not known"
    if kind in ("revolute", *SLIDING) and limit is not None and not _without_limits(limit):
        low, high = _end(limit, "lower"), _end(limit, "upper")
        if low > high:
            raise FileFault(
                limit, Message("robot_file.limits", {"low": f"{low:g}", "high": f"{high:g}"})
            )
    damping = 0.0 if dynamics is None else dynamics.number("damping", 0.0)
    if dynamics is not None and damping < 0:
        raise FileFault(dynamics, Message("robot_file.negative", {"field": "damping"}))
    return Joint(
        name=joint.name(),
        slides=kind in SLIDING,
        low=low,
        high=high,
        effort=effort,
        damping=damping,
        armature=armature,
    )


def _axis(joint: Element) -> Array:
    """The unit vector of a joint's axis, shape (3,)."""
    element = joint.first("axis")
    axis = np.array((1.0, 0.0, 0.0) if element is None else element.numbers("xyz", 3))
    length = np.linalg.norm(axis)
    if not length > 1e-6:
        raise FileFault(joint if element is None else element, Message("robot_file.axis"))
    return axis / length


def _origin(element: Element) -> RigidTransform:
    """The place that an <origin> in an element gives."""
    origin = element.first("origin")
    if origin is None:
        return RigidTransform()
    roll, pitch, yaw = origin.numbers("rpy", 3, "0 0 0")
    x, y, z = np.eye(3)
    rotation = turn(z, yaw) @ turn(y, pitch) @ turn(x, roll)
    return RigidTransform(exact(rotation), np.array(origin.numbers("xyz", 3, "0 0 0")))
