"""The phase plane has the path in its middle, and all of the motion within its frame."""

from __future__ import annotations

import re

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from onpath.app.page.panels.phase_plot import HEIGHT, WIDTH, phase_picture
from onpath.lessons.sides import side_titles
from onpath.lessons.words import ENGLISH
from onpath.models.control.sides import DEFAULT_LAWS

NAMES = side_titles(DEFAULT_LAWS, ENGLISH)
values = st.floats(-0.5, 0.5) | st.just(float("nan"))


def drawn(picture: str) -> list[np.ndarray]:
    """Points of each line, shape (n, 2), [px]."""
    lines = re.findall(r'<polyline points="([^"]*)"', picture)
    return [
        np.array([[float(x) for x in pair.split(",")] for pair in line.split()]).reshape(-1, 2)
        for line in lines
    ]


@given(arrays(float, st.tuples(st.integers(0, 20), st.just(2), st.just(2)), elements=values))
def test_all_of_it_is_within_the_frame(phase: np.ndarray) -> None:
    lines = drawn(phase_picture(phase, NAMES, ENGLISH))
    assert len(lines) == 2
    for i, line in enumerate(lines):
        assert line.shape == phase[:, i].shape
        assert ((line >= -0.1) & (line <= [WIDTH + 0.1, HEIGHT + 0.1])).all()
        known = np.where(np.isfinite(phase[:, i]), phase[:, i], 0.0)
        right, up = line[:, 0] - WIDTH / 2, HEIGHT / 2 - line[:, 1]
        assert (np.sign(np.round(right)) * known[:, 0] >= 0).all()  # to the right if positive
        assert (np.sign(np.round(up)) * known[:, 1] >= 0).all()


def test_its_ranges_are_round_and_its_lines_named() -> None:
    phase = np.zeros((2, 2, 2))
    phase[1, 1] = 0.0107, 0.585
    picture = phase_picture(phase, NAMES, ENGLISH)
    assert "ξ₁ [mm] 20" in picture and "ξ₂ [mm/s] 1000" in picture
    assert "Path following" in picture and "Trajectory tracking" in picture
    assert "mm²" in phase_picture(phase, NAMES, ENGLISH, level_set=True)
