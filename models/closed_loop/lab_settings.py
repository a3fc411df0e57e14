"""The lab's own settings, each declared once; those of robots and laws are `Parameters`.

A setting is a field of `LabSettings`, and its texts in other languages are those of a parameter:
`parameter-NAME-label`, `-help`, `-unit` and `-option-OPTION` in their catalogues. Command, page,
lessons, share codes and help follow from the declaration.

They are declared here, even those of what a page shows, because a lesson's step sets them, and
lessons know only `models`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any, Literal

from onpath.models.closed_loop.obstacles import ALONG, DIRECTIONS, FARTHEST, Wall
from onpath.models.closed_loop.start import BOUNDS, Start
from onpath.models.control.settable import specs
from onpath.models.systems.parameter_specs import (
    DEGREES,
    MM,
    Need,
    Spec,
    checked,
    choice,
    number,
    switch,
    unknown_name,
)
from onpath.models.systems.parameters import Parameters

RATES = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0)
"""Rates that are offered, simulated seconds per second."""
LARGEST = 20.0  # magnification of the drawn deflection

Role = Literal["lab", "process"]
"""Who may set something; the process may also set what everybody in the lab may."""
Kept = Literal["code", "lab", "nowhere"]


@dataclass(frozen=True, slots=True)
class LabSetting:
    """Declaration of one of the lab's own settings.

    Attributes:
        spec: unit, range, words, and what it needs.
        default: in a new lab.
        by: who may set it: everybody in the lab, or only the process that it runs in.
        kept: "code": in set-ups, so in share codes and in the stored lab, and a lesson's step
            restores it; "lab": in the stored lab alone; "nowhere": until the lab is closed.
        of_robot: whether each robot of the lab has its own.
    """

    spec: Spec
    default: Any
    by: Role
    kept: Kept
    of_robot: bool

    def allows(self, role: Role) -> bool:
        """Whether a role may set it."""
        return role == "process" or self.by == "lab"


def own(declared: Any, *, kept: Kept = "code", by: Role = "lab", of_robot: bool = False) -> Any:
    """A field of `LabSettings`.

    Args:
        declared: what `number`, `choice` or `switch` returns.
        kept, by, of_robot: see `LabSetting`.

    Raises:
        ValueError: it is kept in share codes, which anybody makes, and not everybody may set it; or
            it is a robot's, whose settings are kept in set-ups only.
    """
    if kept == "code" and by != "lab":
        raise ValueError("whoever makes a share code can set what it keeps")
    if kept == "lab" and of_robot:
        raise ValueError("the settings of single robots are kept in set-ups")
    spec, default = declared.metadata["spec"], declared.default
    setting = LabSetting(spec=spec, default=default, by=by, kept=kept, of_robot=of_robot)
    return dataclasses.field(default=default, metadata={"setting": setting})


def _start(name: str, unit: str, step: float, text: str, label: str, **more: Any) -> Any:
    """A number of the start of the next run."""
    bounds = -BOUNDS[name], BOUNDS[name], step
    declared = number(0.0, unit, bounds, text, group="start", label=label, **more)
    return own(declared, of_robot=True)


def _wall(most: float, unit: str, step: float, text: str, label: str, **more: Any) -> Any:
    """A number of the wall."""
    needs, bounds = (Need("wall"),), (-most, most, step)
    declared = number(0.0, unit, bounds, text, group="wall", label=label, needs=needs, **more)
    return own(declared, of_robot=True)


@dataclass(frozen=True, slots=True)
class LabSettings:
    """The lab's own settings, SI."""

    rate: float = own(
        number(
            1.0,
            "×",
            (RATES[0], RATES[-1], 0.125),
            "simulated seconds per second: below 1, both robots move in slow motion",
            group="time",
            label="Speed of time",
            scale="log",
        )
    )
    copy: bool = own(
        switch(
            True,
            "a pull or hold acts on both robots alike; one sees what their laws make of it",
            group="touch",
            label="Copy to both",
        )
    )
    hold_direction: str = own(
        choice(
            ALONG,
            DIRECTIONS,
            "the motion that Hold stops: along the path, across it, or both",
            group="touch",
            label="Hold direction",
        )
    )
    larger: float = own(
        number(
            1.0,
            "×",
            (1.0, LARGEST, 1.0),
            "how many times larger the bending is drawn; the motion stays the same",
            group="view",
            label="Drawn larger",
            needs=(Need("modes"),),
        )
    )
    start_theta: float = _start(
        "theta",
        "rad",
        math.radians(5.0),
        "the path's point near which both robots start the next run",
        "Start: place",
        symbol="θ",
        shown_in=DEGREES,
    )
    start_beside: float = _start(
        "beside",
        "m",
        1e-3,
        "how far beside the path both start, positive to the left",
        "Start: beside the path",
        symbol="ξ₁",
        shown_in=MM,
    )
    start_along: float = _start(
        "along",
        "m/s",
        1e-2,
        "the speed along the path with which both start",
        "Start: speed along",
        shown_in=("mm/s", 1e3),
    )
    start_across: float = _start(
        "across",
        "m/s",
        1e-2,
        "the speed across the path with which both start, positive to the left",
        "Start: speed across",
        symbol="ξ₂",
        shown_in=("mm/s", 1e3),
    )
    start_clock_offset: float = _start(
        "clock_offset",
        "rad",
        math.radians(5.0),
        "how far ahead of its robot the point of a law with a clock starts",
        "Start: lead of the clock",
        shown_in=DEGREES,
    )
    wall: bool = own(
        switch(
            False,
            "a wall in the way of both robots, which gives way a little",
            group="wall",
            label="Wall",
        ),
        of_robot=True,
    )
    wall_z1: float = _wall(
        FARTHEST, "m", 1e-3, "where the wall's middle is, to the right", "Wall: right", shown_in=MM
    )
    wall_z2: float = _wall(
        FARTHEST, "m", 1e-3, "where the wall's middle is, upwards", "Wall: up", shown_in=MM
    )
    wall_angle: float = _wall(
        math.pi,
        "rad",
        math.radians(5.0),
        "direction of the wall's free side, counter-clockwise from the right; 90° is up",
        "Wall: angle",
        shown_in=DEGREES,
    )
    presenting: bool = own(
        switch(False, "texts are larger, as for a projector", group="view", label="Large type"),
        kept="lab",
    )

    @property
    def values(self) -> dict[str, Any]:
        """The values by name."""
        return {name: getattr(self, name) for name in SETTINGS}

    @property
    def start(self) -> Start:
        """The start of the next run."""
        return Start(**{name: getattr(self, f"start_{name}") for name in BOUNDS})

    @property
    def obstacle(self) -> Wall | None:
        """The wall, if there is one."""
        return Wall(self.wall_z1, self.wall_z2, self.wall_angle) if self.wall else None


def settings_of_start(start: Start) -> dict[str, float]:
    """The settings that make a start."""
    return {f"start_{name}": value for name, value in asdict(start).items()}


def settings_of_wall(wall: Wall) -> dict[str, Any]:
    """The settings that make a wall."""
    return {"wall": True} | {f"wall_{name}": value for name, value in asdict(wall).items()}


SETTINGS: Mapping[str, LabSetting] = MappingProxyType(
    {field.name: field.metadata["setting"] for field in dataclasses.fields(LabSettings)}
)
"""Name -> declaration of each field of `LabSettings`."""


def settings_kept(where: Kept, of_robot: bool = False) -> dict[str, LabSetting]:
    """Name -> declaration of the settings that are kept somewhere.

    Args:
        of_robot: whether those that each robot has for itself are meant, or the others.
    """
    return {n: s for n, s in SETTINGS.items() if (s.kept, s.of_robot) == (where, of_robot)}


def lab_specs(kind: type[Parameters] | Parameters) -> Mapping[str, Spec]:
    """Name -> declaration of everything that can be set in a lab with a robot."""
    return {**specs(kind), **{name: setting.spec for name, setting in SETTINGS.items()}}


def step_specs(kind: type[Parameters] | Parameters) -> Mapping[str, Spec]:
    """Like `lab_specs`, but without settings that no set-up has, and so no lesson's step."""
    known = lab_specs(kind)
    return {n: s for n, s in known.items() if n not in SETTINGS or SETTINGS[n].kept == "code"}


def changed_setting(settings: LabSettings, name: str, value: Any) -> LabSettings:
    """The settings with one value changed.

    Args:
        value: in the setting's unit; None changes a switch to its other position.

    Raises:
        ValueError: unknown name or bad value.
    """
    if name not in SETTINGS:
        raise unknown_name(name, list(SETTINGS), "setting")
    spec = SETTINGS[name].spec
    if value is None and spec.kind == "switch":
        value = not getattr(settings, name)
    return dataclasses.replace(settings, **{name: checked(spec, name, value)})
