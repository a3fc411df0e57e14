"""What is kept for viser is what viser itself would work out."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from typing import Any, get_type_hints

import numpy as np
import pytest
import viser
from viser import _gui_api, _icons

from onpath.app.viser_adapter import viser_caches
from onpath.app.viser_adapter.secure_server import make_server


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = make_server(port=0)
    yield server
    server.stop()


@pytest.mark.parametrize("icon", [viser.Icon.SCHOOL, viser.Icon.ROBOT, viser.Icon.HELP])
def test_an_icon_is_that_of_viser(icon: Any) -> None:
    assert viser_caches.icon_svg(icon) == _icons.svg_from_icon(icon)


def test_handles_know_the_hints_of_their_own_class(server: viser.ViserServer) -> None:
    handles: list[Any] = [
        server.gui.add_button("b", icon=viser.Icon.CHECK),
        server.gui.add_slider("s", 0.0, 1.0, 0.1, 0.5),
        server.scene.add_label("/label", "text"),
        server.scene.add_icosphere("/ball", 1.0),
    ]
    for handle in handles:
        assert handle._prop_hints == get_type_hints(type(handle._impl.props))
    handles[2].text = "another"
    assert handles[2].text == "another"


def test_neither_is_worked_out_again(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def build() -> None:
        server.gui.add_button("b", icon=viser.Icon.CHECK).label = "c"
        server.scene.add_point_cloud("/node", np.zeros((1, 3)), (0, 0, 0)).point_size = 0.1

    build()
    before = viser_caches.evaluated_hints.cache_info().misses

    def refuse(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(zipfile.ZipFile, "_RealGetContents", refuse)
    build()
    assert viser_caches.evaluated_hints.cache_info().misses == before
    assert vars(_gui_api)["svg_from_icon"] is viser_caches.icon_svg
