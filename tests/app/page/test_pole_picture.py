"""The picture of the poles: where the marks stand, and what is said of it."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from onpath.app.page.panels.pole_picture import HEIGHT, RIGHT_HALF, WIDTH, pole_picture
from onpath.lessons.words import ENGLISH
from onpath.models.control.poles import channels
from onpath.models.errors import Message
from onpath.models.systems.five_bar_parameters import FiveBarParameters

PLUS, CROSS = "M-6 0H6M0 -6V6", "M-5 -5L5 5M-5 5L5 -5"


def marks(picture: str, shape: str) -> list[tuple[float, float]]:
    """Where marks stand, [px] from the origin of the plane, up and right positive."""
    found = re.findall(
        rf'd="{re.escape(shape)}" transform="translate\(([\d.-]+) ([\d.-]+)\)', picture
    )
    return [(float(x) - (WIDTH - RIGHT_HALF), HEIGHT / 2 - float(y)) for x, y in found]


@pytest.mark.parametrize(
    "values", [{}, {"K2": 8.0}, {"K2": 0.0, "K3": 0.0}, {"K1": 2500.0, "K2": 200.0}, {"K5": 100.0}]
)
def test_marks_stand_in_proportion_to_the_poles(values: dict[str, float]) -> None:
    across, along = found = channels(replace(FiveBarParameters(), **values))
    picture = pole_picture({"": found}, ENGLISH)
    drawn = [complex(*at) for shape in (CROSS, PLUS) for at in marks(picture, shape)]
    poles = [*across.poles.tolist(), *along.poles.tolist()]
    assert len(drawn) == len(poles)
    scale = max(map(abs, drawn)) / max(map(abs, poles))
    for pole, at in zip(poles, drawn, strict=True):
        assert abs(at - scale * pole) < 0.2
        assert abs(at.imag) < HEIGHT / 2 and at.real > RIGHT_HALF - WIDTH


def test_it_says_the_poles_and_is_nothing_without_any() -> None:
    picture = pole_picture({"": channels(FiveBarParameters())}, ENGLISH)
    assert 'role="img"' in picture and "Across -26.2, -9.95, -3.83" in picture
    assert pole_picture({"Left": Message("behaviour.no_poles")}, ENGLISH) == ""
