"""Checks an MJCF file before MuJoCo sees it, and writes out what MuJoCo is to read.

What moves, weighs or is drawn is passed on: bodies, joints, geoms, sites, meshes, actuators of
joints, defaults and keyframes. What is left of a model (sensors, contacts, pictures, …) is left
out, and what would read other files, run code or make many elements of one is refused. Meshes are
read here, from the robot's folder only, and MuJoCo gets their content: it opens no file. Geoms of
meshes that are not there are left out; a body of which nothing remains gets the mass of a dummy.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from xml.sax.saxutils import quoteattr

from onpath.models.errors import Message
from onpath.models.robot_files.mesh_folders import MeshFolders
from onpath.models.robot_files.xml_elements import LARGEST_NUMBER, Element, FileFault, shown

MESHES = (".stl", ".obj", ".msh")
MOST_MESH_BYTES = 200_000_000  # of all meshes of a file
MOST = {"body": 200, "joint": 200, "geom": 2000, "site": 1000, "mesh": 1000, "key": 100}
"""How many elements of a kind a file may have."""
_ACTUATORS = (
    *("general", "motor", "position", "velocity", "intvelocity", "pid", "damper"),
    *("cylinder", "muscle", "dcmotor"),
)
_IN_BODIES = ("body", "frame", "inertial", "joint", "freejoint", "geom", "site")
PASSED: Mapping[str, tuple[str, ...]] = {
    "mujoco": ("compiler", "default", "asset", "worldbody", "actuator", "keyframe"),
    "default": ("default", "joint", "geom", "site", "mesh", *_ACTUATORS),
    "asset": ("mesh",),
    "worldbody": _IN_BODIES,
    "body": _IN_BODIES,
    "frame": _IN_BODIES,
    "actuator": _ACTUATORS,
    "keyframe": ("key",),
}
"""The elements that are passed on, by the element in which they are."""
LEFT_OUT: Mapping[str, tuple[str, ...]] = {
    "mujoco": ("option", "size", "statistic", "visual", "contact", "tendon", "equality", "sensor")
    + ("custom",),
    "compiler": ("lengthrange",),
    "default": ("texture", "material", "camera", "light", "pair", "equality", "tendon")
    + ("orientation", "adhesion"),
    "asset": ("texture", "material", "skin"),
    "worldbody": ("camera", "light"),
    "body": ("camera", "light"),
    "frame": ("camera", "light"),
    "actuator": ("orientation", "adhesion"),
}
"""The elements that are left out with all that is in them."""
REFUSED = (
    *("model", "attach", "plugin", "extension", "replicate", "composite"),
    *("flexcomp", "deformable", "hfield"),
)
DUMMY = '<inertial pos="0 0 0" mass="1e-9" diaginertia="1e-9 1e-9 1e-9"/>'
_NOT_PASSED: Mapping[str, tuple[str, ...]] = {
    "compiler": ("meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "fusestatic")
    + ("usethread", "savecompiled"),
    "geom": ("material", "contype", "conaffinity"),
    "site": ("material",),
    "mesh": ("material", "content_type"),
    "body": ("mocap",),
    "key": ("qvel", "act", "ctrl", "mpos", "mquat"),
}
"""Attributes that are left out: those that name what is left out, or change only what is drawn."""


@dataclass(frozen=True, slots=True, eq=False)
class CheckedModel:
    """What MuJoCo is to read.

    Attributes:
        text: an MJCF file, in which every element is in the line in which it was.
        meshes: content of the files that it names.
        lacking: the files of meshes that are not there.
    """

    text: str
    meshes: Mapping[str, bytes]
    lacking: Sequence[str]


def checked_model(file: Path, root: Element, packages: Mapping[str, Path]) -> CheckedModel:
    """What MuJoCo is to read of a file.

    Args:
        root: its outermost element.
        packages: folders that may have meshes besides that of the file, by name.

    Raises:
        FileFault: something in it is refused.
    """
    counts = dict.fromkeys(MOST, 0)
    for element in all_elements(root):
        tag = element.tag
        if tag in REFUSED:
            raise FileFault(element, Message("robot_file.refused", {"element": tag}))
        if tag in counts:
            counts[tag] += 1
            if counts[tag] > MOST[tag]:
                raise FileFault(element, Message("robot_file.many", {"most": MOST[tag]}))
        _check_numbers(element)
    return _Rewriter(file, root, packages).written()


def all_elements(root: Element) -> Iterator[Element]:
    """An element and all that are in it, in the order of the file."""
    waiting = [root]
    while waiting:
        element = waiting.pop()
        yield element
        waiting += reversed(element.children)


def _check_numbers(element: Element) -> None:
    """Refuse numbers that MuJoCo would take, but with which no robot can be simulated."""
    for field, value in element.values.items():
        try:
            numbers = [float(word) for word in value.split()]
        except ValueError:  # a name, or wrong: then MuJoCo refuses it
            continue
        if not all(abs(number) <= LARGEST_NUMBER for number in numbers):
            reason = Message("robot_file.large", {"field": field, "value": shown(value)})
            raise FileFault(element, reason)


def _mesh_name(element: Element) -> str:
    """The name of a mesh, which is that of its file if it has none."""
    file = PurePosixPath(element.values["file"].replace("\\", "/"))
    return element.values.get("name", file.stem)


class _Rewriter:
    """Writes the elements that are passed on."""

    def __init__(self, file: Path, root: Element, packages: Mapping[str, Path]) -> None:
        self._root = root
        self._folders = MeshFolders(file, packages, MESHES)
        self._meshes, self._size = dict[str, bytes](), 0
        self._files = dict[str, str]()  # of meshes, by their names; "" for one that is not there
        self._lacking = list[str]()
        self._parts, self._line = list[str](), 1
        compilers = [each.values for each in root.all("compiler")]
        self._compiler = {name: value for each in compilers for name, value in each.items()}

    def written(self) -> CheckedModel:
        """The whole file."""
        for element in all_elements(self._root):
            if element.tag == "mesh" and "file" in element.values:
                self._files[_mesh_name(element)] = self._file(element)
        self._write(self._root)
        return CheckedModel("".join(self._parts), self._meshes, self._lacking)

    def _write(self, element: Element) -> None:
        tag, values = element.tag, dict(element.values)
        for name in _NOT_PASSED.get(tag, ()):
            values.pop(name, None)
        if tag == "geom":
            if "hfield" in values or values.get("type") == "hfield":
                raise FileFault(element, Message("robot_file.refused", {"element": "hfield"}))
            values |= {"contype": "0", "conaffinity": "0"}  # contacts cost time, and do not act
        if tag == "mesh" and "file" in values:
            name = _mesh_name(element)
            values |= {"name": name, "file": self._files[name]}
        self._parts.append("\n" * (element.line - self._line))
        self._line = max(self._line, element.line)
        attributes = "".join(f" {name}={quoteattr(value)}" for name, value in values.items())
        self._parts.append(f"<{tag}{attributes}>{DUMMY if self._is_bare(element) else ''}")
        for child in self._passed(element):
            self._write(child)
        self._parts.append(f"</{tag}>")

    def _passed(self, element: Element) -> Iterator[Element]:
        """The children that are passed on."""
        passed, left_out = PASSED.get(element.tag, ()), LEFT_OUT.get(element.tag, ())
        for child in element.children:
            if child.tag not in passed:
                if child.tag not in left_out:
                    raise FileFault(child, Message("robot_file.unknown", {"parent": element.tag}))
            elif self._is_lacking(child):
                continue
            elif element.tag != "actuator" or {"joint", "jointinparent"} & child.values.keys():
                yield child

    def _is_lacking(self, element: Element) -> bool:
        """Whether an element is a mesh that is not there, or the geom of one."""
        if element.tag == "mesh" and "file" in element.values:
            return not self._files[_mesh_name(element)]
        return element.tag == "geom" and not self._files.get(element.values.get("mesh", ""), "any")

    def _is_bare(self, element: Element) -> bool:
        """Whether an element is a body that has lost all of which MuJoCo could take its mass."""
        if element.tag != "body":
            return False
        own, waiting = list[Element](), [*element.children]
        while waiting:
            each = waiting.pop()
            own.append(each)
            waiting += each.children if each.tag == "frame" else []
        weighed = [each for each in own if each.tag in ("inertial", "geom")]
        return bool(weighed) and all(map(self._is_lacking, weighed))

    def _file(self, element: Element) -> str:
        """The file of a mesh as MuJoCo sees it, whose content is kept; "" if it is not there."""
        address = element.values["file"]
        found = self._folders.mesh(self._address(address))
        try:
            content = found.read_bytes() if found is not None else None
        except OSError:
            content = None
        if found is None or content is None:
            self._lacking.append(PurePosixPath(address.replace("\\", "/")).name)
            return ""
        file = f"{len(self._meshes)}{found.suffix.lower()}"
        self._meshes[file] = content
        self._size += len(self._meshes[file])
        if self._size > MOST_MESH_BYTES:
            most = f"{MOST_MESH_BYTES // 10**6} MB"
            raise FileFault(element, Message("robot_file.meshes", {"most": most}))
        return file

    def _address(self, address: str) -> str:
        """The file of a mesh, from the robot's folder."""
        address = address.replace("\\", "/")
        if self._compiler.get("strippath") == "true":
            address = PurePosixPath(address).name
        folder = self._compiler.get("meshdir", self._compiler.get("assetdir", ""))
        return f"{folder}/{address}" if folder and not address.startswith("/") else address
