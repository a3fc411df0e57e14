"""What was done in a lab, and what came about."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LabEvent:
    """Something that was done, or that came about.

    Attributes:
        run: how often the robots had been set back to the start before.
        time: simulated, [s].
        name: "set", "path", "robot", "reset", "hold", "let_go", "pull", "release", "identify" or
            "diverged".
        detail: the parameter, the path, the robot; or empty.
        controllers: whom it concerns.
    """

    run: int
    time: float
    name: str
    detail: str
    controllers: tuple[str, ...]
