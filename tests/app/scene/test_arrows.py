"""An arrow in the scene is as long as what it stands for, or is not there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import viser

from onpath.app.common import palette
from onpath.app.scene.arrows import SHORTEST, Arrows, ArrowShape
from tests.support.drawing import drawn_length

SHAPE = ArrowShape(shaft_radius=0.0018, head_radius=0.0055, head_length=0.012)


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server
    server.stop()


def random_arrows(rng: np.random.Generator, count: int) -> np.ndarray:
    """Arrows from nothing at all to longer than a robot, shape (count, 2, 3)."""
    begin, way = rng.uniform(-0.5, 0.5, (count, 3)), rng.normal(size=(count, 3))
    length = 10.0 ** rng.uniform(-7, 0, count) * rng.integers(0, 2, count)
    way *= (length / np.linalg.norm(way, axis=1))[:, None]
    return np.stack([begin, begin + way], axis=1)


def as_drawn(nodes: list[viser.ArrowsHandle], arrows: np.ndarray) -> None:
    """Assert that what is drawn has the lengths of the arrows, and the shape of an arrow."""
    lengths = np.linalg.norm(arrows[:, 1] - arrows[:, 0], axis=1)
    seen = lengths >= SHORTEST
    np.testing.assert_allclose(
        [drawn_length(node) for node in nodes], np.where(seen, lengths, 0.0), rtol=1e-4
    )
    for node, arrow in zip(np.array(nodes)[seen], arrows[seen], strict=True):
        np.testing.assert_allclose(node.points[0], arrow, atol=1e-6)
        assert node.shaft_radius < node.head_radius < node.head_length


def test_it_is_as_long_as_what_it_stands_for(server: viser.ViserServer) -> None:
    rng = np.random.default_rng(7)
    first = random_arrows(rng, 12)
    arrows = Arrows(server.scene, "/arrows", first, palette.AZURE, SHAPE)
    as_drawn(arrows.nodes, first)
    for _ in range(40):
        points = random_arrows(rng, 12)
        arrows.draw(points)
        as_drawn(arrows.nodes, points)
    arrows.draw(np.full((12, 2, 3), np.nan))
    assert not any(node.visible for node in arrows.nodes)
    arrows.remove()


def test_the_client_still_draws_every_head_at_full_length() -> None:
    """What `drawn_length` rests on."""
    client = Path(viser.__file__).parent / "client" / "src" / "Arrows.tsx"
    text = client.read_text(encoding="utf-8")
    assert "const shaftLength = Math.max(arrowLength - head_length, 0);" in text
    assert "headScales[i * 3 + 1] = head_length;" in text
