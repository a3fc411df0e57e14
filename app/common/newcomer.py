"""How robots move in a lab that somebody opens for the first time, and in an exported figure."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

NEWCOMER: Mapping[str, Any] = MappingProxyType({"speed": 2.0, "ramp": 4.0})
"""Parameters that differ from a robot's defaults, for readers of `onpath.NEWCOMER`, too.

The speed along the path, [rad/s]: an end-point on the usual circle does 0.1 m/s, so that a hand can
catch it. And how it is reached, [rad/s²]: with a ramp, both robots are on the path from the
beginning."""
