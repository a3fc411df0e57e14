"""The colours of the lab, with the same meanings in the scene, the plots and the figures.

The sides' colours are Okabe and Ito's vermillion and blue, which remain distinguishable for every
common form of colour blindness and on a pale projector. Figures of several laws use further ones of
theirs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT


@dataclass(frozen=True, slots=True)
class Colour:
    """An sRGB colour, each channel from 0 to 255."""

    red: int
    green: int
    blue: int

    @property
    def rgb(self) -> tuple[int, int, int]:
        """As a tuple, for the scene."""
        return (self.red, self.green, self.blue)

    @property
    def linear(self) -> np.ndarray:
        """As linear light, shape (3,), uint8.

        viser interprets the colours of instances and of vertices as linear, all others as sRGB.
        """
        s = np.array(self.rgb) / 255.0
        light = np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)
        return np.round(255.0 * light).astype(np.uint8)

    @property
    def hex(self) -> str:
        """As `#rrggbb`, for plots, figures and HTML."""
        return f"#{self.red:02x}{self.green:02x}{self.blue:02x}"

    def toward(self, other: Colour, share: float) -> Colour:
        """This colour mixed with another: (1 - share) self + share other, share from 0 to 1."""
        channels = zip(self.rgb, other.rgb, strict=True)
        red, green, blue = (round(a + (b - a) * share) for a, b in channels)
        return Colour(red, green, blue)


WHITE = Colour(255, 255, 255)
INK = Colour(31, 41, 55)

# Text on a page, from the strongest to the weakest, and right, wrong and neutral answers
SLATE = Colour(63, 74, 90)
GREY = Colour(102, 112, 133)
GREEN = Colour(29, 122, 79)
AMBER = Colour(138, 90, 0)
BLUE = Colour(51, 80, 107)

# Lines and backgrounds on a page
MUTED = Colour(170, 180, 192)
BORDER = Colour(213, 218, 225)
SHADE = Colour(238, 241, 245)
PANEL = Colour(247, 249, 251)

VERMILLION = Colour(213, 94, 0)
AZURE = Colour(0, 114, 178)
VIOLET = Colour(122, 62, 157)
"""Colour of what a reader has drawn, on pages without a server."""
PATH = Colour(71, 80, 95)
FORCE = Colour(154, 30, 122)
WARNING = Colour(196, 18, 48)
SELECTED = Colour(240, 180, 20)
CONTROL_POINT = Colour(90, 100, 116)

FRAME = Colour(196, 202, 210)
MOTOR = Colour(66, 74, 88)
STEEL = Colour(118, 128, 142)
FLOOR = Colour(244, 246, 248)
GRID = Colour(222, 226, 232)

SEEN = AZURE.toward(WHITE, 0.6)
"""Colour of the steps of a lesson that have been opened."""

OF_SIDE: dict[str, Colour] = {LEFT: VERMILLION, RIGHT: AZURE}
OTHERS = (
    *(Colour(0, 158, 115), Colour(204, 121, 167), Colour(230, 159, 0), Colour(86, 180, 233)),
    *(INK, GREY),
)
"""Colours of further laws in a figure."""
TYPED = Colour(140, 86, 75)
"""Colour of a typed law in a figure."""


SCALE = (
    *(Colour(68, 1, 84), Colour(72, 31, 112), Colour(68, 57, 131), Colour(59, 82, 139)),
    *(Colour(49, 104, 142), Colour(40, 124, 142), Colour(33, 145, 140), Colour(32, 164, 134)),
    *(Colour(53, 183, 121), Colour(94, 201, 98), Colour(144, 215, 67), Colour(200, 224, 32)),
    *(Colour(253, 231, 37),),
)
"""A colour scale for maps, evenly spaced samples of viridis, whose order every viewer can see."""


def on_scale(shares: np.ndarray) -> np.ndarray:
    """Colours of `SCALE`, (...,) from 0 to 1 -> (..., 3), uint8; NaN is taken as 0."""
    at = np.clip(np.nan_to_num(shares), 0.0, 1.0) * (len(SCALE) - 1)
    table = np.array([colour.rgb for colour in SCALE], dtype=float)
    channels = [np.interp(at, np.arange(len(SCALE)), table[:, i]) for i in range(3)]
    return np.round(np.stack(channels, axis=-1)).astype(np.uint8)


def of_law(law: str) -> Colour:
    """Colour of a control law in figures of several laws; the default laws have their sides'."""
    sides = {default: side for side, default in DEFAULT_LAWS.items()}
    if law in sides:
        return OF_SIDE[sides[law]]
    if law not in LAWS:
        return TYPED
    others = [name for name in LAWS if name not in sides]
    return OTHERS[others.index(law) % len(OTHERS)]
