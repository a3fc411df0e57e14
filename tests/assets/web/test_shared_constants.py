"""What the pages' scripts and the server both write down is the same."""

from __future__ import annotations

import re
from typing import Any, get_args

import pytest
from msgspec import Meta

from onpath.app.channel.messages import Kept
from onpath.app.channel.sheet_messages import Typed
from onpath.app.scene.stage import FIRST_SIZE
from onpath.app.view.poles import WARNS
from onpath.assets import asset_path


def longest(text: Any) -> int | None:
    """The longest text that a message may have."""
    (meta,) = (each for each in get_args(text) if isinstance(each, Meta))
    return meta.max_length


@pytest.mark.parametrize(
    ("script", "name", "value"),
    [
        ("channel/channel.ts", "FIRST_SHAPE", FIRST_SIZE[0] / FIRST_SIZE[1]),
        ("channel/kept.ts", "LONGEST", longest(Kept)),
        ("parts/class_sheet.ts", "LONGEST", longest(Typed)),
        ("core/words.ts", "WARNS", WARNS),
    ],
)
def test_a_constant_of_a_script_is_that_of_the_server(
    script: str, name: str, value: float | str
) -> None:
    source = asset_path(f"web/{script}").read_text(encoding="utf-8")
    found = re.search(rf"^(?:export )?const {name} = (\S+|\".*\")(?: //|$)", source, re.MULTILINE)
    assert found is not None
    assert found[1].strip('"') == str(value) if isinstance(value, str) else float(found[1]) == value
