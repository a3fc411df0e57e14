"""The pages and the lab take the same shape of a picture before a browser has told its own."""

from __future__ import annotations

import re

from onpath.app.scene.stage import FIRST_SIZE
from onpath.assets import asset_path


def test_the_pages_first_shape_is_that_of_the_labs_first_canvas() -> None:
    source = asset_path("web/channel/channel.ts").read_text(encoding="utf-8")
    shape = re.search(r"^const FIRST_SHAPE = ([\d.]+)", source, re.MULTILINE)
    assert shape is not None
    width, height = FIRST_SIZE
    assert float(shape[1]) == width / height
