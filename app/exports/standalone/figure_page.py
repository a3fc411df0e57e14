"""A figure as one HTML file, which needs no server, network or other file."""

from __future__ import annotations

from base64 import b64encode
from hashlib import sha256

from onpath.app.common.templates import inlined, json_block, render
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.exports.standalone.page_style import page_style
from onpath.lessons.sides import law_label
from onpath.lessons.words import Words

POLICY = (
    "default-src 'none'; script-src '{script}' 'wasm-unsafe-eval'; style-src '{style}'; "
    "base-uri 'none'; form-action 'none'"
)
"""The page's Content-Security-Policy, with the hashes of its script and style: no requests, no
other scripts, and no eval except WebAssembly."""


def figure_page(figure: FigureChoice, words: Words, title: str = "") -> str:
    """The page of a figure; the same choice gives the same page.

    Args:
        title: heading above the figure; may be empty.
    """
    script, style = inlined("web/onpath.js"), page_style("standalone/figure.css")
    names = " / ".join(law_label(law, words) for law in figure.laws)
    return render(
        "standalone/figure.html",
        language=words.language,
        heading=title or f"OnPath: {names}",
        titled=bool(title),
        description=words("standalone.description", laws=names),
        policy=POLICY.format(script=_hash(script), style=_hash(style)),
        style=style,
        hint=_hint(figure, words),
        no_script=words("standalone.no_script"),
        data=json_block(figure_data(figure, words)),
        script=script,
    )


def _hint(figure: FigureChoice, words: Words) -> str:
    """What a reader can do first."""
    acts = [act for act in ("hold", "pull") if act in figure.controls]
    return words(f"standalone.hint_{'_'.join(acts)}") if acts else ""


def _hash(text: str) -> str:
    """The name of an inline script or style in a Content-Security-Policy."""
    return "sha256-" + b64encode(sha256(text.encode()).digest()).decode()
