"""A figure as one HTML file, which needs no server, network or other file."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

from onpath.app.common.product import product_version
from onpath.app.common.templates import inlined, json_block, render
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.exports.standalone.page_style import page_style
from onpath.lessons.sides import law_label
from onpath.lessons.words import Words
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.guessed_numbers import guess_sentences

POLICY = (
    "default-src 'none'; script-src {script}; style-src '{style}'; img-src {picture}; "
    "base-uri 'none'; form-action 'none'"
)
"""The page's Content-Security-Policy, with the hashes of its script and style: no requests, no
other scripts, no eval except WebAssembly, and no pictures except one in the page."""


def figure_page(
    figure: FigureChoice,
    words: Words,
    title: str = "",
    numbers: Mapping[str, Any] | None = None,
    picture: bytes = b"",
    without: Sequence[str] = (),
) -> str:
    """The page of a figure; the same choice gives the same page.

    Args:
        title: heading above the figure; may be empty.
        numbers: see `figure_data`.
        picture: what is shown where no script runs, as a PNG file.
        without: what a recorded run had: parts of standalone-recorded_… in the catalogues.
    """
    names, script = " / ".join(law_label(law, words) for law in figure.laws), "web/figure.js"
    data = json_block(figure_data(figure, words, numbers))
    text, hint = words("standalone.no_script"), _hint(figure, words, without)
    return _page(names, words, title, picture, text, hint=hint, data=data, script=inlined(script))


def picture_page(laws: str, words: Words, title: str, picture: bytes, reason: str) -> str:
    """The page of a figure that is only a picture.

    Args:
        laws: names of its laws.
        title, picture: as for `figure_page`.
        reason: why it is only a picture.
    """
    text = words("standalone.only_picture", reason=reason)
    return _page(laws, words, title, picture, text)


def _page(
    names: str,
    words: Words,
    title: str,
    picture: bytes,
    text: str,
    *,
    hint: str = "",
    data: str = "",
    script: str = "",
) -> str:
    style = page_style("standalone/figure.css")
    return render(
        "standalone/figure.html",
        language=words.language,
        heading=title or f"OnPath: {names}",
        titled=bool(title),
        description=words("standalone.description", laws=names),
        policy=POLICY.format(
            script=f"'{_hash(script)}' 'wasm-unsafe-eval'" if script else "'none'",
            style=_hash(style),
            picture="data:" if picture else "'none'",
        ),
        style=style,
        hint=hint,
        picture=b64encode(picture).decode(),
        described=words("standalone.still", laws=names),
        text=text,
        about=words("standalone.about", product=f"OnPath {product_version()}".rstrip()),
        data=data,
        script=script,
    )


def _hint(figure: FigureChoice, words: Words, without: Sequence[str]) -> str:
    """What a reader can do first, and what a recorded run had besides."""
    hints, robots = list[str](), len(figure.laws)
    if {"hold", "pull"} <= set(figure.controls):
        hints.append(words("standalone.hint_hold_pull", robots=robots))
    elif "hold" in figure.controls:
        hints.append(words("standalone.hint_hold", robots=robots))
    elif "pull" in figure.controls:
        hints.append(words("standalone.hint_pull"))
    if any(isinstance(each, SplineCurve) and each.raised for each in figure.paths.values()):
        hints.append(words("standalone.hint_raised"))
    if without:
        parts = ", ".join(words(f"standalone.recorded_{part}") for part in without)
        hints.append(words("standalone.recorded", parts=parts))
    return " ".join([*hints, *guess_sentences(figure.entry.guesses, words.language)])


def _hash(text: str) -> str:
    """The name of an inline script or style in a Content-Security-Policy."""
    return "sha256-" + b64encode(sha256(text.encode()).digest()).decode()
