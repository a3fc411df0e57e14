"""Reads a robot's file of any kind: URDF, xacro or MJCF, with the files that it includes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from onpath.models.errors import Message
from onpath.models.robot_files.file_chain import FileChain, Options
from onpath.models.robot_files.mesh_folders import MeshFolders
from onpath.models.robot_files.mjcf_file import read_mjcf
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.xacro_process import expanded
from onpath.models.robot_files.xml_elements import (
    MOST_ELEMENTS,
    Element,
    FileFault,
    file_bytes,
    root_of,
    shown,
)

XACRO = ".xacro"
MOST_INCLUDES = 50
DEEPEST_INCLUDE = 4  # files within each other


def read_file(file: Path, options: Options) -> tuple[FileChain, bytes]:
    """The chain of a file, and the file; of a xacro file, what xacro makes of it.

    Raises:
        FileFault: something in the file is refused.
        CodedError: it cannot be read, or an option does not fit.
    """
    data = file_bytes(file)
    if file.name.endswith(XACRO):
        data = expanded(file, options.packages)
        read = read_urdf(file, root_of(data), options)
        ran = Message("robot_file.xacro_ran", {"file": shown(file.name)})
        return replace(read, remarks=(ran, *read.remarks)), data
    root = root_of(data)
    if root.tag != "mujoco":
        return read_urdf(file, root, options), data
    includes = _Includes(file, options.packages)
    read = read_mjcf(file, includes.expanded(root), options)
    return replace(read, rests=read.rests + includes.digests), data


class _Includes:
    """Puts the files that an MJCF file includes in their place, as MuJoCo does.

    Attributes:
        digests: of their contents.
    """

    def __init__(self, file: Path, packages: Mapping[str, Path]) -> None:
        self._folders = MeshFolders(file, packages, (".xml", ".mjcf"))
        self._seen = {file.resolve()}
        self._count, self._depth = 0, 0
        self.digests = ""

    def expanded(self, element: Element) -> Element:
        """An element in which no file is included.

        Raises:
            FileFault: an included file is not there, outside of the folders, or included twice.
        """
        self._count += 1
        if self._count > MOST_ELEMENTS:
            raise FileFault(element, Message("robot_file.many", {"most": MOST_ELEMENTS}))
        children = [part for child in element.children for part in self._parts(child)]
        return replace(element, children=children)

    def _parts(self, element: Element) -> Iterator[Element]:
        if element.tag != "include":
            yield self.expanded(element)
            return
        address = element.text("file")
        found = self._folders.mesh(address)
        many = len(self._seen) > MOST_INCLUDES or self._depth == DEEPEST_INCLUDE
        if found is None or found in self._seen or many:
            raise FileFault(element, Message("robot_file.include", {"file": shown(address)}))
        self._seen.add(found)
        data = file_bytes(found)
        self.digests += hashlib.sha256(data).hexdigest()[:16]
        try:
            root = root_of(data)
        except FileFault as fault:
            raise FileFault(element, fault.reason) from None
        self._depth += 1
        for child in root.children:
            yield from self._parts(_at_line(child, element.line))
        self._depth -= 1


def _at_line(element: Element, line: int) -> Element:
    """An element whose line is that of what includes it."""
    children = [_at_line(child, line) for child in element.children]
    return replace(element, line=line, children=children)
