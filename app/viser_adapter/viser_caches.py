"""A cache for what viser computes again for every handle.

A scene has dozens of handles: for each, viser evaluates the type hints of its properties.
"""

from __future__ import annotations

from functools import cache
from typing import Any, get_type_hints

from viser import _assignable_props_api

evaluated_hints = cache(get_type_hints)


def keep_what_is_constant() -> None:
    """Make viser evaluate the type hints of each class once."""
    handle: Any = _assignable_props_api.AssignablePropsBase
    handle._prop_hints = property(lambda self: evaluated_hints(type(self._impl.props)))
