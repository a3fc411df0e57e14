"""What our pages are made of: our part of the lab's page, see assets/web/pages/lab.ts, and the
pages of a class that have no lab."""

from __future__ import annotations

from functools import cache

from onpath.app.common.templates import inlined, json_block, render
from onpath.app.exports.standalone.page_style import page_style
from onpath.app.viser_adapter.page_scripts import messages


@cache
def own_part() -> bytes:
    """A <style> and a <script> element."""
    style, script = page_style("web/lab.css"), inlined("web/lab.js")
    return render("web/lab.html", style=style, script=script).encode()


@cache
def screen_page(name: str, language: str) -> str:
    """The page of one of `addresses.SCREENS`."""
    return render(
        "web/screen.html",
        name=name,
        language=language,
        style=page_style(f"web/{name}.css"),
        words=json_block(messages()),
        said=inlined("page/browser_words.js"),
        script=inlined(f"web/{name}.js"),
    )
