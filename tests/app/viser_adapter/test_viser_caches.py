"""What is kept for viser is what viser itself would work out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_type_hints

import numpy as np
import pytest
import viser

from onpath.app.viser_adapter import viser_caches
from onpath.app.viser_adapter.secure_server import make_server


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = make_server(port=0)
    yield server
    server.stop()


def test_handles_know_the_hints_of_their_own_class(server: viser.ViserServer) -> None:
    handles: list[Any] = [
        server.scene.add_box("/box"),
        server.scene.add_frame("/frame"),
        server.scene.add_label("/label", "text"),
        server.scene.add_icosphere("/ball", 1.0),
    ]
    for handle in handles:
        assert handle._prop_hints == get_type_hints(type(handle._impl.props))
    handles[2].text = "another"
    assert handles[2].text == "another"


def test_they_are_not_worked_out_again(server: viser.ViserServer) -> None:
    def build() -> None:
        server.scene.add_point_cloud("/node", np.zeros((1, 3)), (0, 0, 0)).point_size = 0.1

    build()
    before = viser_caches.evaluated_hints.cache_info().misses

    build()
    assert viser_caches.evaluated_hints.cache_info().misses == before
