"""How robots move in a lab, or on a page, that somebody opens for the first time."""

from __future__ import annotations

GENTLE = {"speed": 2.0, "ramp": 4.0}
"""Along the path, [rad/s]: an end-point on the usual circle does 0.1 m/s, so that a hand can catch
it. And how it is reached, [rad/s²]: with a ramp, both robots are on the path from the beginning."""
