"""Contrast of what is drawn in the scene with what is behind it, as WCAG 2.2 has it."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from onpath.app.common.palette import OF_SIDE, Colour
from onpath.app.scene.tones import DARK, LIGHT, Tones

BEHIND = {"wall", "floor", "cells", "sections", "frame"}
DRAWN = [field.name for field in fields(Tones) if field.name not in BEHIND]


def luminance(colour: Colour) -> float:
    return float(colour.linear / 255.0 @ np.array([0.2126, 0.7152, 0.0722]))


def contrast(one: Colour, other: Colour) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("tones", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize("behind", ["wall", "floor"])
def test_what_is_drawn_stands_out(tones: Tones, behind: str) -> None:
    ground: Colour = getattr(tones, behind)
    weak = {name for name in DRAWN if contrast(getattr(tones, name), ground) < 3}
    assert weak == set()
    for colour in OF_SIDE.values():
        assert contrast(colour, ground) >= 2.9


@pytest.mark.parametrize("tones", [LIGHT, DARK], ids=["light", "dark"])
def test_words_on_a_board_can_be_read(tones: Tones) -> None:
    assert contrast(tones.line, tones.wall) >= 4.5


def test_a_dark_scene_is_dark() -> None:
    assert luminance(DARK.wall) < 0.03 < 0.8 < luminance(LIGHT.wall)
    assert luminance(DARK.floor) < 0.03
