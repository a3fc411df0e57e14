"""HTML from the templates in assets/templates: every value is escaped unless it is `Markup`.

Colours are those of the palette; a dark page replaces some of them, see
assets/web/dark_colours.css.

`Markup` is made only in `phrase`, `inlined`, `math_font`, `part_of_page` and `json_block` and, from
a lesson's words, by `lessons.safe_html.safe`.
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from functools import cache
from types import SimpleNamespace

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from onpath.app.common import palette
from onpath.assets import asset_path
from onpath.lessons.words import Words


@cache
def environment() -> Environment:
    """All templates; each is compiled once per process."""
    made = Environment(
        loader=FileSystemLoader(asset_path("templates")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        auto_reload=False,
        cache_size=-1,
    )
    colours = {n: c for n, c in vars(palette).items() if isinstance(c, palette.Colour)}
    shown = {n: f"var(--op-{n.lower()}, {c.hex})" for n, c in colours.items()}
    shown |= {"SCALE": ", ".join(colour.hex for colour in palette.SCALE)}
    made.globals = {"palette": SimpleNamespace(**shown), "phrase": phrase, "math_font": math_font}
    return made


def render(template: str, /, **values: object) -> str:
    """Render a template with values. Thread-safe.

    The result is a plain string, because viser's messages cannot hold `Markup`.

    Args:
        template: path in assets/templates.

    Raises:
        jinja2.TemplateNotFound: there is no such template.
        jinja2.UndefinedError: it uses a value that is not given.
    """
    return environment().get_template(template).render(values)


def phrase(words: Words, key: str, /, **values: object) -> Markup:
    """The message of a key as `Markup`; its values are escaped unless they are `Markup`.

    Values that are `Markup` are replaced by private characters while the rest is escaped.
    """
    marks = {f"\ue000{name}\ue001": v for name, v in values.items() if isinstance(v, Markup)}
    plain = {name: v for name, v in values.items() if not isinstance(v, Markup)}
    text = words(key, **plain, **{mark[1:-1]: mark for mark in marks})
    pieces = re.split("(" + "|".join(marks) + ")", text) if marks else [text]
    return Markup().join(marks.get(piece, escape(piece)) for piece in pieces)


def inlined(asset: str) -> Markup:
    """One of our scripts or styles, to be put into a page verbatim."""
    return Markup(asset_path(asset).read_text("utf-8"))


def math_font(address: str = "") -> Markup:
    """The style of formulas, in a font of ours that a browser loads when it meets the first one.

    Args:
        address: where the page finds the font; by default it is in the style.
    """
    if not address:
        font = asset_path("web/math.woff2").read_bytes()
        address = f"data:font/woff2;base64,{b64encode(font).decode()}"
    face = f"font-family: 'STIX Two Math'; src: url({address}) format('woff2');"
    return Markup(f"@font-face {{ {face} }}\nmath {{ font-family: 'STIX Two Math', math; }}")


def part_of_page(template: str, /, **values: object) -> Markup:
    """A template, rendered to be put into a page verbatim."""
    return Markup(render(template, **values))


def json_block(data: object) -> Markup:
    """Data for a JSON block of a page; no text in it can end the block."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))
