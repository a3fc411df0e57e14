"""Where the meshes of a robot's file may be: in its folder, its package, or packages by name."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from itertools import takewhile
from pathlib import Path
from urllib.parse import unquote, urlsplit

LARGEST_MESH = 20_000_000  # [B]
LARGEST_PACKAGE = 100_000  # characters of a package.xml
LEVELS = 5  # above a file, at which its package may be
_FIND = re.compile(r"(?:file://)?\$\(find ([^)]+)\)/*(.*)", re.DOTALL)


class MeshFolders:
    """The folders from which a robot's meshes are read.

    Args:
        file: of the robot. Its own folder is one, and so is its package: the nearest folder with a
            package.xml, at most `LEVELS` above it, which is neither a home nor at the root. Without
            such a file, it is a folder above that is called like the package.
        packages: further folders, by the names of their packages.
        kinds: endings of files that are meshes, in lower case.

    Attributes:
        allowed: the folders themselves.
        missing: packages that meshes are in, but that are not known.
    """

    def __init__(self, file: Path, packages: Mapping[str, Path], kinds: Collection[str]) -> None:
        self._home = file.resolve().parent
        near = (self._home, *self._home.parents)[: LEVELS + 1]
        above = list(takewhile(lambda folder: not _is_home(folder), near))
        at = next((i for i, f in enumerate(above) if (f / "package.xml").is_file()), None)
        self._own = above[at] if at is not None else None
        self._above = above[: len(above) if at is None else at + 1]
        self._packages = {name: folder.resolve() for name, folder in packages.items()}
        self.allowed = (self._own or self._home, *self._packages.values())
        self._kinds = kinds
        self.missing = list[str]()

    def mesh(self, address: str) -> Path | None:
        """The file of a mesh; None if it is not there, not a mesh, too large, or elsewhere."""
        try:
            path = self._resolved(address)
            if path is None or path.suffix.lower() not in self._kinds:
                return None
            path = path.resolve()
            allowed = (*self.allowed, *self._named(address))
            if not any(path.is_relative_to(folder) for folder in allowed) or not path.is_file():
                return None
            return path if path.stat().st_size <= LARGEST_MESH else None
        except (OSError, ValueError, RuntimeError):  # not a path, or links in a circle
            return None

    def folder(self, package: str) -> Path | None:
        """The folder of a package; None if it is not known.

        The file's own package, whose folder may have another name, is called as it says itself.
        """
        given = self._packages.get(package)
        named = self._named(f"package://{package}/")
        return given or next((f for f in named if f.name == package or _says(f, package)), None)

    def is_missing(self, address: str) -> bool:
        """Whether a mesh is in a package of `missing`."""
        package = _package_in(address)
        return package is not None and package[0] in self.missing

    def _resolved(self, address: str) -> Path | None:
        package = _package_in(address)
        if package is None:
            if "://" not in address:
                return self._home / address
            parts = urlsplit(address)
            return Path(unquote(parts.path)) if parts.scheme == "file" else None
        name, within = package
        if name in self._packages:
            return self._packages[name] / within
        places = [folder / within for folder in self._named(address)]
        found = next((place for place in places if place.is_file()), None)
        known = any(folder.name == name for folder in self._named(address))
        if found is None and not known and name not in self.missing:
            self.missing.append(name)
        return found

    def _named(self, address: str) -> list[Path]:
        """The folders above the file that may be the package of an address."""
        package = _package_in(address)
        if package is None:
            return []
        name, _ = package
        around = self._above if self._own else [self._home]
        inside = [f / name for f in around if name and (f / name).is_dir()]
        called = [f for f in self._above if f.name == name]
        return [*called, *inside, *([self._own] if self._own else [])]


def _package_in(address: str) -> tuple[str, str] | None:
    """The package that an address names, and the path in it; None if it names none."""
    found = _FIND.match(address)
    if found is not None:
        return found[1].strip(), found[2]
    scheme, _, rest = address.partition("://")
    if scheme not in ("package", "model"):
        return None
    name, _, within = rest.lstrip("/").partition("/")
    return unquote(name), unquote(within).lstrip("/")


def _says(folder: Path, package: str) -> bool:
    """Whether a folder's package.xml says that this is the package's name."""
    path = (folder / "package.xml").resolve()
    if not path.is_file() or not path.is_relative_to(folder):
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        text = file.read(LARGEST_PACKAGE)
    return re.search(rf"<name>\s*{re.escape(package)}\s*</name>", text) is not None


def _is_home(folder: Path) -> bool:
    """Whether a folder is a home, or at the root of the file system, as homes' folders are."""
    try:
        home = Path.home().resolve()
    except RuntimeError:  # there is none
        home = Path("/")
    return folder == home or folder.parent in (folder, home.parent, Path(folder.anchor))
