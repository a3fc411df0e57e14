"""Lines of drawings lie where Chromium draws them."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.path_files.svg import strokes_of_svg

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytest.importorskip("svgpathtools")
PIXEL = 0.0254 / 96  # [m]
ASPECTS = ("none", "xMidYMid meet", "xMinYMin slice", "xMaxYMid", "xMidYMax meet", "")
SIZES = (
    'width="200mm" height="100mm"',
    'width="300" height="150pt"',
    'style="width:90mm;height:300px"',
    'width="10em" height="200"',
)
SHAPES = "path,circle,ellipse,rect,line,polyline,polygon"
DRAWN = """(shapes) => [...document.querySelectorAll(shapes)].map(
    (shape) => {
        const matrix = shape.getScreenCTM(), length = shape.getTotalLength();
        return Array.from({length: 61}, (_, i) => {
            const point = shape.getPointAtLength((length * i) / 60).matrixTransform(matrix);
            return [point.x, point.y];
        });
    })"""


class Writer:
    """Writes random drawings."""

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)

    def drawing(self) -> str:
        rules = "".join(f".c{i}{{transform:{self._css()}}}" for i in range(3))
        size, aspect = self._one(*SIZES), self._one(*ASPECTS)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{self._box(300)}" '
            f'preserveAspectRatio="{aspect}"><style>{rules}</style>{self._group(0)}</svg>'
        )

    def _one(self, *of: str) -> str:
        return self._random.choice(of)

    def _n(self, low: float = -50, high: float = 50) -> str:
        return f"{self._random.uniform(low, high):.3f}"

    def _box(self, most: float) -> str:
        return f"{self._n()} {self._n()} {self._n(20, most)} {self._n(20, most)}"

    def _group(self, depth: int) -> str:
        text = self._shape()
        if depth < 3 and self._random.random() < 0.8:
            text += f'<g transform="{self._transform()}">{self._group(depth + 1)}</g>'
        if depth < 3 and self._random.random() < 0.5:
            width, aspect = self._one("50%", "80", "30mm"), self._one(*ASPECTS)
            text += (
                f'<svg x="{self._n()}" y="{self._n()}" width="{width}" height="60" '
                f'viewBox="{self._box(90)}" preserveAspectRatio="{aspect}">'
                f"{self._group(depth + 1)}</svg>"
            )
        return text

    def _shape(self) -> str:
        n = self._n
        r = n(5, 40)
        shape = self._one(
            f'<path d="M10 10c10 {n()} 30 {n()} 40 5s20 {n()} 30 0z"',
            f'<path d="m5 5q{n()} 20 30 5t20,{n()}h10v-8"',
            f'<path d="M10 10A{r} {n(5, 40)} {n(0, 90)} {self._one("0", "1")} 1 50 40L3 3"',
            f'<circle cx="{n()}" cy="{n()}%" r="{r}{self._one("", "%", "mm", "px")}"',
            f'<ellipse cx="{n()}mm" rx="{r}" ry="{n(5, 30)}"',
            f'<ellipse ry="{r}"',
            f'<rect x="{n()}" y="{n()}%" width="30" height="{r}"',
            f'<rect width="30" height="{r}" rx="{n(1, 60)}"',
            f'<line x1="{n()}" y2="{n()}" x2="10%"',
            f'<polyline points="1,2 {n()},{n()} 30-4 50 3"',
            f'<polygon points="1,2 {n()},{n()} 30 40"',
        )
        placed = self._one(
            f'transform="{self._transform()}"',
            f'style="transform:{self._css()}"',
            f'style="transform:{self._css()};transform-origin:{self._one("center", "9px 20%")}"',
            f'class="c{self._one("0", "1", "2")}"',
        )
        return f'{shape} {placed} fill="none" stroke="black"/>'

    def _transform(self) -> str:
        n = self._n
        return self._one(
            f"translate({n()},{n()}) scale({n(0.3, 2)},-{n(0.3, 2)})",
            f"rotate({n(0, 360)} {n()} {n()}) skewX({n()})",
            f"matrix(1 .2 -.3 .9 {n()} {n()}) skewY({n()})",
        )

    def _css(self) -> str:
        n = self._n
        return self._one(
            f"translate({n()}px,{n()}mm) rotate({n(0, 6)}rad)",
            f"translateX({n()}%) scaleY({n(0.3, 2)})",
            f"skew({n()}deg,{n(0, 20)}deg) rotate({n(0, 1)}turn)",
        )


def far(points: Array, line: Array) -> float:
    """Largest distance of points from a line."""
    begin, along = line[:-1], np.diff(line, axis=0)
    squared = np.maximum((along**2).sum(1), 1e-12)
    share = np.clip(((points[:, None] - begin) * along).sum(-1) / squared, 0, 1)
    nearest = begin + share[..., None] * along
    return float(np.linalg.norm(points[:, None] - nearest, axis=-1).min(1).max())


def test_lines_of_random_drawings_lie_where_chromium_draws_them(
    browser: Browser, tmp_path: Path
) -> None:
    page, compared = browser.new_page(), 0
    for seed in range(25):
        text = Writer(seed).drawing()
        file = tmp_path / f"{seed}.svg"
        file.write_text(text, "utf-8")
        page.goto(file.as_uri())
        drawn, (strokes, _) = page.evaluate(DRAWN, SHAPES), strokes_of_svg(text.encode())
        assert len(drawn) == len(strokes)
        for points, stroke in zip(drawn, strokes, strict=True):
            line = stroke.points * (1, -1) / PIXEL
            size = max(float(np.ptp(line, axis=0).max()), 1.0)
            assert far(np.array(points), line) < 5e-3 * size, text
            compared += 1
    page.close()
    assert compared > 50
