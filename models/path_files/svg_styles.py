"""The style of an element of an SVG drawing: attributes, rules of its style sheets, and `style`.

Rules may select by the name of an element, classes and ids, also of elements around it, which is
what drawing programs write; others have no effect. Sheets of hostile files are bounded by the
number of comparisons that they ask for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

from onpath.models.errors import CodedError
from onpath.models.path_files.svg_document import LINE

MOST_COMPARISONS = 1_000_000
INHERITED = ("fill", "fill-opacity", "stroke", "stroke-opacity", "stroke-width", "visibility")
OWN = (
    *("display", "opacity", "transform", "transform-origin", "x", "y", "width", "height"),
    *("cx", "cy", "r", "rx", "ry"),
)
"""Properties of an element; those of `INHERITED` also hold for the elements in it."""
_COMPOUND = re.compile(r"(\*|[a-zA-Z][\w-]*)?((?:[.#][\w-]+)*)")
Style = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class _Compound:
    """What a part of a selector asks of one element."""

    tag: str
    ids: frozenset[str]
    classes: frozenset[str]

    def fits(self, place: StyledElement) -> bool:
        return (
            self.tag in ("", "*", place.tag)
            and self.ids <= {place.id}
            and self.classes <= place.classes
        )


@dataclass(frozen=True, slots=True)
class StyledElement:
    """An element as selectors see it, and the one around it.

    Attributes:
        tag, id, classes: of the element.
        parent: None for the root.
        depth: number of elements around it.
    """

    tag: str
    id: str
    classes: frozenset[str]
    parent: StyledElement | None
    depth: int


@dataclass(frozen=True, slots=True)
class _Rule:
    """One selector and its declarations.

    Attributes:
        parts: compounds from left to right.
        within: whether a part's parent is meant by the part before it, not any element around it.
    """

    parts: tuple[_Compound, ...]
    within: tuple[bool, ...]
    declared: Mapping[str, str]
    important: Mapping[str, str]

    @property
    def weight(self) -> tuple[int, int, int]:
        return (
            sum(len(part.ids) for part in self.parts),
            sum(len(part.classes) for part in self.parts),
            sum(part.tag not in ("", "*") for part in self.parts),
        )


class StyleSheets:
    """The style sheets of a drawing.

    Args:
        root: of the drawing.
    """

    def __init__(self, root: Element) -> None:
        sheets = [each.text or "" for each in root.iter("style")]
        rules = [rule for sheet in sheets for rule in _rules(sheet)]
        self._rules = sorted(rules, key=lambda rule: rule.weight)
        self._left = MOST_COMPARISONS

    def place(self, element: Element, parent: StyledElement | None) -> StyledElement:
        """An element as selectors see it."""
        return StyledElement(
            tag=element.tag,
            id=element.get("id", ""),
            classes=frozenset(element.get("class", "").split()),
            parent=parent,
            depth=0 if parent is None else parent.depth + 1,
        )

    def style(self, element: Element, place: StyledElement, around: Style) -> Style:
        """The properties of an element.

        Args:
            around: style of the element around it.

        Raises:
            CodedError: the rules ask for too many comparisons.
        """
        fitting = [rule for rule in self._rules if self._fits(rule, place, element)]
        own, important = _declarations(element.get("style", ""))
        attributes = {
            name: element.attrib[name] for name in (*INHERITED, *OWN) if name in element.attrib
        }
        found = {name: around[name] for name in INHERITED if name in around}
        for declared in (
            attributes,
            *(rule.declared for rule in fitting),
            own,
            *(rule.important for rule in fitting),
            important,
        ):
            found.update(declared)
        return found

    def _fits(self, rule: _Rule, place: StyledElement, element: Element) -> bool:
        """Whether a rule's selector selects an element."""
        self._left -= 1
        if self._left < 0:
            raise CodedError("error.svg_styles", line=element.get(LINE, "0"))
        if not rule.parts[-1].fits(place):
            return False
        if len(rule.parts) == 1:
            return True
        self._left -= place.depth * len(rule.parts)
        chain = [place]
        while (parent := chain[-1].parent) is not None:
            chain.append(parent)
        # the parts that can end at an element, from the root on
        reached, above = set[int](), set[int]()
        for each in reversed(chain):
            here = {
                i
                for i, part in enumerate(rule.parts)
                if (i == 0 or i - 1 in (above if rule.within[i] else reached)) and part.fits(each)
            }
            reached, above = reached | here, here
        return len(rule.parts) - 1 in above


def _rules(sheet: str) -> Iterable[_Rule]:
    import tinycss2

    for node in tinycss2.parse_stylesheet(sheet, skip_comments=True, skip_whitespace=True):
        if node.type != "qualified-rule":
            continue
        declared, important = _parsed(node.content)
        for selector in _text(node.prelude).split(","):
            parts, within = _selector(selector)
            if parts and (declared or important):
                yield _Rule(parts, within, declared, important)


def _text(nodes: Any) -> str:
    """The text of a part of a style sheet; empty if it is nested too deep."""
    import tinycss2

    try:
        return tinycss2.serialize(nodes)
    except RecursionError:
        return ""


def _selector(text: str) -> tuple[tuple[_Compound, ...], tuple[bool, ...]]:
    """Parts of a selector, and whether each has the one before as its parent; empty if unknown."""
    parts, within, child = list[_Compound](), list[bool](), False
    for word in text.replace(">", " > ").split():
        if word == ">":
            child = True
            continue
        found = _COMPOUND.fullmatch(word)
        if found is None:
            return (), ()
        names = re.findall(r"[.#][\w-]+", found[2])
        parts.append(
            _Compound(
                tag=found[1] or "",
                ids=frozenset(name[1:] for name in names if name[0] == "#"),
                classes=frozenset(name[1:] for name in names if name[0] == "."),
            )
        )
        within.append(child)
        child = False
    return tuple(parts), tuple(within)


def _declarations(text: str) -> tuple[dict[str, str], dict[str, str]]:
    """The properties that a text declares, and those that it declares to be important."""
    if not text.strip():
        return {}, {}
    return _parsed(text)


def _parsed(content: Any) -> tuple[dict[str, str], dict[str, str]]:
    import tinycss2

    plain, important = dict[str, str](), dict[str, str]()
    for node in tinycss2.parse_blocks_contents(content, skip_comments=True, skip_whitespace=True):
        if node.type == "declaration" and node.lower_name in (*INHERITED, *OWN):
            value = _text(node.value).strip()
            if value.lower() != "inherit":
                (important if node.important else plain)[node.lower_name] = value
    return plain, important


def is_painted(style: Style, what: str, default: str) -> bool:
    """Whether fill or stroke of an element can be seen on white paper.

    Args:
        what: "fill" or "stroke".
        default: its colour if none is given.
    """
    from tinycss2.color3 import parse_color

    value = style.get(what, default).strip()
    if value.lower() == "none" or is_zero(style.get(f"{what}-opacity", "1")):
        return False
    colour = parse_color(value)
    if colour is None or isinstance(colour, str):  # a pattern, or the colour of text
        return True
    return colour.alpha > 0 and min(colour.red, colour.green, colour.blue) < 1


def is_drawn(style: Style) -> bool:
    """Whether an element and those in it are drawn at all."""
    return style.get("display", "").strip() != "none" and not is_zero(style.get("opacity", "1"))


def is_zero(text: str) -> bool:
    """Whether a text is a length or share of 0."""
    return re.fullmatch(r"\s*[-+]?0*\.?0*(px|%)?\s*", text) is not None and "0" in text
