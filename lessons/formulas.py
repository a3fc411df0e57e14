"""Converts Markdown to safe HTML: typed HTML is escaped, LaTeX becomes MathML.

All output passes through `onpath.lessons.safe_html`.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import tostring
from xml.parsers.expat import ExpatError, ParserCreate

from latex2mathml.converter import convert_to_element
from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup
from mdit_py_plugins.dollarmath import dollarmath_plugin

from onpath.lessons.safe_html import refused, safe
from onpath.lessons.vocabulary.latex import brace_faults, latex_faults

MIME = {
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".jpeg": "image/jpeg",
    ".webp": "image/webp",
}
COMMA = re.compile(r"<mn>(\d+)</mn><mrow><mo>,</mo></mrow><mn>(\d+)</mn>")
"""A decimal comma, 0{,}5 in LaTeX, which the converter writes as an operator between spaces."""
LARGEST = 400_000
"""Largest size of a picture, [B]."""
QUOTED = 80
"""Longest part of a formula in a message, [characters]."""


class TextError(ValueError):
    """A formula that cannot be converted, or a link or picture that must not be shown."""


def mathml(latex: str, options: dict[str, Any]) -> str:
    """A formula as MathML.

    Args:
        latex: the formula.
        options: `display_mode` for a formula on a line of its own.

    Raises:
        TextError: the LaTeX cannot be converted.
    """
    if faults := list(brace_faults(latex)):
        raise TextError(f"formula {_quoted(latex)}: {'; '.join(faults)}")
    try:
        written = _converted(latex, "block" if options.get("display_mode") else "inline")
    except Exception as error:  # the library raises many kinds
        raise TextError(f"formula {_quoted(latex)}: {error or type(error).__name__}") from None
    if faults := [*latex_faults(latex, written), *refused(written)]:
        raise TextError(f"formula {_quoted(latex)}: {'; '.join(faults)}")
    return COMMA.sub(r"<mn>\1,\2</mn>", written)


def _quoted(latex: str) -> str:
    return repr(latex if len(latex) <= QUOTED else f"{latex[:QUOTED]}…")


def _converted(latex: str, display: str) -> str:
    """MathML in which every text is text: the library's own writer lets `<` in \\text through."""
    formula = convert_to_element(latex, display=display)
    for element in formula.iter():
        element.text = html.unescape(element.text or "")  # it writes symbols as &#x003B8;
    return tostring(formula, encoding="unicode")


@cache
def reader() -> MarkdownIt:
    """A CommonMark parser with tables and formulas, and without HTML."""
    markdown = MarkdownIt("commonmark", {"html": False, "typographer": True}).enable(["table"])
    markdown.add_render_rule("table_open", _table_open)
    markdown.add_render_rule("table_close", _table_close)
    return markdown.use(dollarmath_plugin, renderer=mathml, double_inline=True)


def _table_open(*_: object) -> str:
    """A table in a box that scrolls, also by keyboard, if the table is wider than the page."""
    return '<div class="wide" tabindex="0"><table>\n'


def _table_close(*_: object) -> str:
    return "</table></div>\n"


def render(markdown: MarkdownIt, tokens: Sequence[Token]) -> Markup:
    """The HTML of parsed Markdown.

    Raises:
        TextError: a formula cannot be converted, or `safe` would remove a link or a picture.
    """
    written = markdown.renderer.render(tokens, markdown.options, {})
    if faults := list(refused(written)):
        raise TextError("; ".join(faults))
    return safe(written)


def folded(title: str, content: Markup) -> Markup:
    """Content that is shown when its title is pressed."""
    return safe(f"<details><summary>{html.escape(title)}</summary>{content}</details>")


def to_html(text: str) -> Markup:
    """The HTML of a short text such as a question or a hint; a single paragraph has no <p>.

    Raises:
        TextError: as `render`; or there is a picture, which only the text of a step may have.
    """
    markdown = reader()
    tokens = markdown.parse(text)
    for child in (child for token in tokens for child in token.children or ()):
        if child.type == "image":
            source = child.attrGet("src")
            raise TextError(f"picture {source!r}: a picture stands in the text of a step")
    if len(tokens) == 3 and tokens[0].type == "paragraph_open":
        tokens = tokens[1:2]
    return render(markdown, tokens)


def embedded(picture: Path) -> str:
    """A picture as a data: URL.

    Raises:
        ValueError: the file type is not supported, the file is too large, or it is not valid SVG.
        OSError: the file cannot be read.
    """
    mime = MIME.get(picture.suffix.lower())
    if mime is None:
        raise ValueError(f"picture {picture.name!r}: its name must end in {', '.join(MIME)}")
    if not picture.is_file():
        raise FileNotFoundError(picture)
    if picture.stat().st_size > LARGEST:
        raise ValueError(f"picture {picture.name!r} is larger than {LARGEST // 1000} kB")
    content = picture.read_bytes()
    if picture.suffix.lower() == ".svg":
        try:
            ParserCreate().Parse(content, True)
        except ExpatError as error:
            raise ValueError(f"picture {picture.name!r} is no well-formed XML: {error}") from None
    return f"data:{mime};base64,{base64.b64encode(content).decode()}"
