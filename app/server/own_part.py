"""The script and the style of our own part of a page; see assets/web/pages/lab.ts."""

from __future__ import annotations

from functools import cache

from onpath.app.common.templates import inlined, render
from onpath.app.exports.standalone.page_style import page_style


@cache
def own_part() -> bytes:
    """A <style> and a <script> element."""
    style, script = page_style("web/lab.css"), inlined("web/lab.js")
    return render("web/lab.html", style=style, script=script).encode()
