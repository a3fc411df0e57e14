"""Where the meshes of a robot's file may be: in its folder, its package, or packages by name."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from urllib.parse import unquote, urlsplit

LARGEST_MESH = 20_000_000  # [B]


class MeshFolders:
    """The folders from which a robot's meshes are read.

    Args:
        file: of the robot; its own folder, or the nearest one around it with a package.xml, is one.
        packages: further folders, by the names of their packages.
        kinds: endings of files that are meshes, in lower case.
    """

    def __init__(self, file: Path, packages: Mapping[str, Path], kinds: Collection[str]) -> None:
        self._home = file.resolve().parent
        inside = (self._home, *self._home.parents)
        self._package = next((f for f in inside if (f / "package.xml").is_file()), None)
        self._packages = {name: folder.resolve() for name, folder in packages.items()}
        self._kinds = kinds

    def mesh(self, address: str) -> Path | None:
        """The file of a mesh; None if it is not there, not a mesh, too large, or elsewhere."""
        try:
            path = self._resolved(address)
            if path is None or path.suffix.lower() not in self._kinds:
                return None
            path = path.resolve()
            allowed = self._package or self._home, *self._packages.values()
            if not any(path.is_relative_to(folder) for folder in allowed) or not path.is_file():
                return None
            return path if path.stat().st_size <= LARGEST_MESH else None
        except (OSError, ValueError, RuntimeError):  # not a path, or links in a circle
            return None

    def _resolved(self, address: str) -> Path | None:
        if "://" not in address:
            return self._home / address
        parts = urlsplit(address)
        if parts.scheme == "file":
            return Path(unquote(parts.path))
        if parts.scheme != "package":
            return None
        folder = self._packages.get(parts.netloc, self._package)
        return None if folder is None else folder / unquote(parts.path).lstrip("/")
