"""Caches for constants that viser computes again for every handle or icon.

A page has a hundred handles: for each, viser evaluates the type hints of its properties, which is
two fifths of the time to build a page. For each icon it reads the directory of an archive of
thousands, which delays the first picture by a third of a second.
"""

from __future__ import annotations

from functools import cache
from typing import Any, get_type_hints
from zipfile import ZipFile

from viser import _assignable_props_api, _gui_api, _gui_handles, _icons

evaluated_hints = cache(get_type_hints)


def keep_what_is_constant() -> None:
    """Make viser evaluate the type hints of each class once, and open its archive of icons once."""
    handle: Any = _assignable_props_api.AssignablePropsBase
    handle._prop_hints = property(lambda self: evaluated_hints(type(self._impl.props)))
    modules: list[Any] = [_gui_api, _gui_handles]
    for module in modules:
        module.svg_from_icon = icon_svg


@cache
def icon_svg(name: str) -> str:
    """The SVG element of an icon."""
    return _archive().read(f"{name}.svg").decode()


@cache
def _archive() -> ZipFile:
    """The archive of icons, which stays open; `ZipFile` is thread-safe."""
    return ZipFile(_icons.ICONS_DIR / "tabler-icons.zip")
