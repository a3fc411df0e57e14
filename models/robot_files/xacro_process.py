"""Lets xacro expand a file in a process of its own.

A xacro file is a program: its expressions are code. The process has limits of time and memory, no
network, and an audit hook, which lets it read files of the robot's folder, its package and the
packages given, and Python's own modules, and do nothing else to the system.
"""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Mapping
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec

from onpath.models.errors import CodedError
from onpath.models.robot_files.limited_process import ProcessEnded, answer_of, serve
from onpath.models.robot_files.mesh_folders import MeshFolders
from onpath.models.robot_files.xml_elements import LARGEST_FILE, shown

HARMLESS = (
    *("import", "compile", "exec", "open", "os.listdir", "os.scandir", "marshal.loads"),
    *("glob.glob", "glob.glob/2", "sys._getframe", "builtins.id", "code.__new__"),
    *("object.__getattr__", "object.__setattr__", "function.__new__", "marshal.load"),
)
"""What an expanded file may lead to; files and folders are looked at as well."""
UNDEFINED = "Undefined substitution argument"  # xacro's words for $(arg …) without a value


class XacroJob(msgspec.Struct, frozen=True):
    """A file, and folders of packages by name."""

    file: str
    packages: dict[str, str]


class XacroAnswer(msgspec.Struct, frozen=True):
    """The expanded file, or why there is none, and a package that is not known."""

    text: str = ""
    fault: str = ""
    package: str = ""


def expanded(file: Path, packages: Mapping[str, Path]) -> bytes:
    """The URDF file that a xacro file makes.

    Raises:
        CodedError: xacro is not installed, refuses the file, or was ended.
    """
    if find_spec("xacro") is None:
        raise CodedError("robot_file.no_xacro", file=file.name)
    named = {name: str(folder.resolve()) for name, folder in packages.items()}
    job = XacroJob(str(file.resolve()), named)
    try:
        found = msgspec.msgpack.decode(
            answer_of(__name__, msgspec.msgpack.encode(job)), type=XacroAnswer
        )
    except (ProcessEnded, msgspec.MsgspecError):
        raise CodedError("robot_file.xacro_ended", file=file.name) from None
    if found.package:
        line = f"--package {shlex.quote(found.package)}=FOLDER"
        package = shown(found.package)
        raise CodedError("robot_file.xacro_package", file=file.name, package=package, line=line)
    if found.fault or len(found.text) > LARGEST_FILE:
        if found.fault.startswith(UNDEFINED):
            name = shown(found.fault.removeprefix(UNDEFINED).strip())
            raise CodedError("robot_file.xacro_argument", file=file.name, name=name)
        reason = shown(" ".join(found.fault.split()) or "it makes more than 1 MB", 200)
        raise CodedError("robot_file.xacro_refused", file=file.name, reason=reason)
    return found.text.encode()


def _answer(job: bytes) -> bytes:
    asked = msgspec.msgpack.decode(job, type=XacroJob)
    packages = {name: Path(folder) for name, folder in asked.packages.items()}
    folders, missing = MeshFolders(Path(asked.file), packages, ()), list[str]()
    try:
        xacro: Any = import_module("xacro")
        arguments: Any = import_module("xacro.substitution_args")
        for module in ("yaml", "xml.dom.expatbuilder", "encodings.idna", "glob"):
            import_module(module)
        find = partial(_found, folders, missing)
        arguments._eval_find = arguments._eval_dict["find"] = find
        os.environ.clear()
        guard(folders.allowed)
        text = xacro.process_file(asked.file).toprettyxml(indent=" ")
        answer = XacroAnswer(text=text)
    except SystemExit:
        answer = XacroAnswer(fault="SystemExit")
    except Exception as error:  # of a user's code
        fault = str(error) or type(error).__name__
        answer = XacroAnswer(fault=fault, package=missing[0] if missing else "")
    return msgspec.msgpack.encode(answer)


def _found(folders: MeshFolders, missing: list[str], package: str) -> str:
    folder = folders.folder(package)
    if folder is None:
        missing.append(package)
        raise ValueError(f"there is no package {package}")
    return str(folder)


def guard(folders: tuple[Path, ...]) -> None:
    """From now on, let this process read in some folders, and do nothing else to the system."""
    code = [os.path.realpath(place) for place in (sys.prefix, sys.base_prefix, *sys.path) if place]
    data = [os.path.realpath(folder) for folder in folders]

    def within(path: str, places: list[str]) -> bool:
        return any(path == place or path.startswith(place + os.sep) for place in places)

    def hook(event: str, values: tuple[Any, ...]) -> None:
        if event not in HARMLESS:
            raise PermissionError(f"{event} is not allowed in a robot's file")
        if event not in ("open", "os.listdir", "os.scandir") or isinstance(values[0], int):
            return
        path = os.path.realpath(os.fsdecode(values[0] or "."))
        read = event != "open" or not values[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        module = event != "open" or path.endswith((".py", ".pyc", ".so", ".pyd"))
        if not read or not (within(path, data) or (module and within(path, code))):
            raise PermissionError(f"{path} is outside of the robot's folder and packages")

    sys.addaudithook(hook)


if __name__ == "__main__":
    serve(_answer)
