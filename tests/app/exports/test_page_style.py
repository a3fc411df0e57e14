"""The colours that pages' scripts and styles name are there."""

from __future__ import annotations

import re

from onpath.app.exports.standalone.page_style import page_style
from onpath.assets import asset_path

NAMED = re.compile(r"--tone-([a-z]+\d?)(\$\{)?")


def test_every_colour_that_is_named_is_there() -> None:
    styles = [page_style(name) for name in ("web/lab.css", "standalone/figure.css")]
    defined = [{*re.findall(r"--tone-(\w+):", style)} for style in styles]
    scripts = [file.read_text("utf-8") for file in asset_path("web").glob("*/*.ts")]
    named = {found for text in (*scripts, *styles) for found in NAMED.findall(text)}
    assert len(named) > 20
    for name, numbered in named:
        assert all((f"{name}0" if numbered else name) in names for names in defined), name
