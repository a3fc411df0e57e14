"""The only way to turn a lesson's words into `Markup`: an allow-list of elements and attributes.

Whatever a converter writes, only text and these elements with these attributes reach a page: no
scripts, styles or forms, and no addresses except the data of a picture and links to https.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from html.parser import HTMLParser

import nh3
from markupsafe import Markup

TEXT = re.compile(r".*", re.DOTALL)
WORD = re.compile(r"[\w#.-]{1,40}")
LENGTHS = re.compile(r"[+-]?(\d{0,3}(\.\d{0,4})?[a-z]{0,5}|[a-z]{3,30})%?( [\w.+-]{1,12}){0,40}")
PICTURE = re.compile(r"data:image/(svg\+xml|png|jpeg|webp);base64,[A-Za-z0-9+/]*={0,2}")
LINK = re.compile(r"https://[^\s]+")
ALIGNED = re.compile("text-align:(left|center|right)")
SYMBOL = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
"""The name of the quantity to which a mark in a text refers."""

Allowed = Mapping[str, re.Pattern[str]]
"""Attribute -> pattern of its whole value."""
HTML = (
    *("p", "em", "strong", "br", "hr", "blockquote", "ul", "ol", "li", "pre", "code", "a", "img"),
    *("h1", "h2", "h3", "h4", "h5", "h6", "table", "thead", "tbody", "tr", "th", "td"),
    *("details", "summary", "div", "span"),
)
MATHML = (
    *("math", "mrow", "mi", "mo", "mn", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub"),
    *("msup", "msubsup", "munder", "mover", "munderover", "mmultiscripts", "mprescripts", "none"),
    *("mtable", "mtr", "mtd", "mstyle", "mpadded", "mphantom", "menclose"),
)
ANY: Allowed = {"translate": re.compile("no")}
"""Attributes of every element."""
ANY_MATHML: Allowed = {
    **dict.fromkeys(("mathvariant", "mathcolor", "mathbackground", "displaystyle"), WORD),
    **dict.fromkeys(("mathsize", "scriptlevel"), LENGTHS),
}
"""Attributes of every element of a formula."""
OF_ELEMENT: Mapping[str, Allowed] = {
    "a": {"href": LINK, "title": TEXT, "target": re.compile("_blank")},
    "img": {"src": PICTURE, "alt": TEXT, "title": TEXT, "class": re.compile("sign")},
    "ol": {"start": re.compile(r"\d{1,9}")},
    "th": {"style": ALIGNED},
    "td": {"style": ALIGNED},
    "code": {"class": re.compile(r"language-\S{1,40}")},
    "div": {"class": re.compile("math block|wide"), "tabindex": re.compile("0")},
    "span": {
        "class": re.compile("math inline"),
        "data-own": WORD,
        "data-step": WORD,
        "data-symbol": SYMBOL,
    },
    "math": {
        "xmlns": re.compile("http://www.w3.org/1998/Math/MathML"),
        "display": re.compile("inline|block"),
    },
    "mi": {"data-symbol": SYMBOL},
    "msub": {"data-symbol": SYMBOL},
    "msubsup": {"data-symbol": SYMBOL},
    "mo": {
        **dict.fromkeys(("stretchy", "fence", "separator", "form", "largeop"), WORD),
        **dict.fromkeys(("movablelimits", "symmetric", "accent"), WORD),
        **dict.fromkeys(("minsize", "maxsize", "lspace", "rspace"), LENGTHS),
    },
    "mrow": {"movablelimits": WORD},
    "mspace": {**dict.fromkeys(("width", "height", "depth"), LENGTHS), "linebreak": WORD},
    "mpadded": {
        **dict.fromkeys(("width", "height", "depth", "lspace", "voffset"), LENGTHS),
        "border-color": WORD,
    },
    "mfrac": {"linethickness": LENGTHS},
    "mover": {"accent": WORD},
    "munder": {"accentunder": WORD},
    "munderover": dict.fromkeys(("accent", "accentunder"), WORD),
    "mtable": dict.fromkeys(
        ("columnalign", "columnspacing", "columnlines", "rowspacing", "rowlines"), LENGTHS
    ),
    "mtd": {"columnalign": WORD},
    "menclose": {"notation": re.compile(r"[a-z]+( [a-z]+){0,5}")},
}
"""Element -> the attributes that only some elements have."""
ALLOWED: Mapping[str, Allowed] = {
    **{element: {**ANY, **OF_ELEMENT.get(element, {})} for element in HTML},
    **{element: {**ANY, **ANY_MATHML, **OF_ELEMENT.get(element, {})} for element in MATHML},
}
"""Element -> its attributes."""
NOT_WORDS = {element: {"translate": "no"} for element in ("math", "code", "pre")}
"""Elements that a translator of pages would garble."""


@lru_cache(maxsize=256)  # every page asks at 10 Hz, for texts with a student's numbers
def safe(html: str) -> Markup:
    """HTML without anything that is not in `ALLOWED`; idempotent.

    Formulas and code are marked as not to be translated.
    """
    return Markup(_cleaner().clean(html))


def refused(html: str) -> Iterator[str]:
    """Describes what `safe` would remove from HTML; nothing if it would leave it unchanged."""
    found = _Refused()
    found.feed(html)
    found.close()
    yield from dict.fromkeys(found.faults)


@cache
def _cleaner() -> nh3.Cleaner:
    return nh3.Cleaner(
        tags=set(ALLOWED),
        clean_content_tags={"script", "style"},
        attributes={element: set(allowed) for element, allowed in ALLOWED.items()},
        attribute_filter=lambda element, name, value: (
            value if _fits(element, name, value) else None
        ),
        set_tag_attribute_values=NOT_WORDS,
        url_schemes={"https", "data"},
    )


def _fits(element: str, name: str, value: str | None) -> bool:
    """Whether an attribute of an allowed element is allowed, with this value."""
    pattern = ALLOWED.get(element, {}).get(name)
    return pattern is not None and pattern.fullmatch(value or "") is not None


class _Refused(HTMLParser):
    """Collects the elements, attributes and values that are not allowed."""

    def __init__(self) -> None:
        super().__init__()
        self.faults: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ALLOWED:
            self.faults.append(f"<{tag}> is not allowed")
            return
        for name, value in attrs:
            if name == "rel" and tag == "a":
                continue  # written by `safe` itself
            if not _fits(tag, name, value):
                self.faults.append(f"{name}={(value or '')[:60]!r} of <{tag}> is not allowed")

    def handle_comment(self, data: str) -> None:
        self.faults.append("a comment is not allowed")
