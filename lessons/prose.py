"""Reads a paragraph, list, table or picture of a lesson's text: safe HTML, lab links, faults."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup

from onpath.lessons.action_schema import Action
from onpath.lessons.adaptive.own_numbers import own_faults
from onpath.lessons.formulas import TextError, embedded, folded, render
from onpath.lessons.links import SCHEME, SIMPLE, read_link
from onpath.lessons.problems import near
from onpath.lessons.schema import LabLink, Text
from onpath.lessons.vocabulary.fences import fence_faults
from onpath.lessons.vocabulary.setups import action_faults
from onpath.models.closed_loop.lab_settings import step_specs
from onpath.models.control.sides import SIDES
from onpath.models.systems.catalogue import ROBOTS

HTML = re.compile(
    r"</?[A-Za-z][\w-]*(\s+[\w:-]+(\s*=\s*(\"[^\"]*\"|'[^']*'|[^\s<>\"']+))?)*\s*/?>|<!--"
)
"""HTML tags in a text; they would be shown as typed, which nobody wants."""
CONTROL = re.compile(r"[^\t\n\r\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that no page shows and no XML may contain, such as a SCORM package's manifest."""
CODE = re.compile(r"`[^`]*`|(?<!\\)\$[^$]*\$|<https?://[^\s<>]*>")
"""Code, formulas and addresses in a block of TOML, in which `<` begins no tag."""


ELSEWHERE = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:|[/\\]")
"""The beginning of an address that is not a file of the lesson."""
PICTURE_RULE = "a picture is a file in the lesson's folder"


NO_LINK = re.compile(
    r"\]\(\s*<?((?:javascript:|vbscript:|file:|data:(?!image/))[^\s)]{0,40})", re.IGNORECASE
)
"""Addresses that the parser does not accept and shows as typed."""


@dataclass(slots=True)
class Prose:
    """A part of a text that has been read.

    Attributes:
        html: the text; empty if it consists of links only, which become buttons.
        faults: each with the number of lines after the first one.
    """

    html: Markup = field(default_factory=Markup)
    links: list[LabLink] = field(default_factory=list[LabLink])
    faults: list[tuple[int, str]] = field(default_factory=list[tuple[int, str]])

    def text(self, when: str = "") -> Text:
        """The text as a block of a step."""
        return Text(self.html, tuple(self.links), when)


def read_prose(
    markdown: MarkdownIt, tokens: list[Token], home: Path, robot: str, fold: str = ""
) -> Prose:
    """Read a part of a text.

    Args:
        home: the folder of the pictures.
        robot: the robot on which the links act.
        fold: title of a folded text; empty if the text is not folded.
    """
    prose = Prose()
    first = next((token.map[0] for token in tokens if token.map), 0)
    for token in tokens:
        below = token.map[0] - first if token.map else 0
        children = token.children or []
        faults = [*_pictures(children, home), *_written_faults(token)]
        links = list(_links(children, robot, faults))
        prose.links += links
        prose.faults += [(below, fault) for fault in faults]
    try:
        prose.html = render(markdown, tokens)
    except TextError as error:
        prose.faults.append((0, str(error)))
        return prose
    if prose.links and not _has_prose(tokens):
        prose.html = Markup()  # the buttons show the same words
    if fold:
        prose.html = folded(fold, prose.html)
    return prose


def text_faults(text: str) -> Iterator[str]:
    """The faults of the words of a text in Markdown, apart from its formulas."""
    if match := HTML.search(text):
        yield f"{match[0]}: HTML is shown as it is typed; write Markdown, or `{match[0]}` as code"
    if match := CONTROL.search(text):
        yield f"{match[0]!a}: a control character, which no page shows"
    if match := NO_LINK.search(text):
        yield f"{match[1]!r}: an address begins with https:// or {SCHEME}, and {PICTURE_RULE}"
    yield from own_faults(text)


def data_faults(value: Any) -> Iterator[str]:
    """The faults of all texts in a block of TOML."""
    if isinstance(value, dict):
        value = list(cast(dict[str, Any], value).values())
    if isinstance(value, list):
        for each in cast(list[Any], value):
            yield from data_faults(each)
    elif isinstance(value, str):
        if "{{" in value:
            yield f"{value[:40]!r}: {{{{…}}}} belongs into the text of a step, not into a block"
        else:
            yield from text_faults(CODE.sub("", value))
        if value.replace("\\$", "").count("$") % 2:
            yield _unclosed(value)


def _unclosed(text: str) -> str:
    """The fault of a text with a formula that does not end."""
    at = text.rindex("$")
    part = text[max(0, at - 5) : at + 25].strip()
    return f"{part!r}: a formula begins with $ and does not end; a dollar is written \\$"


def _written_faults(token: Token) -> Iterator[str]:
    """The faults of the words of a paragraph, a heading or a cell."""
    words = "".join(child.content for child in token.children or () if child.type == "text")
    yield from text_faults(words)
    if token.type == "fence":
        yield from fence_faults(token.info)
    if words.count("$") > token.content.count("\\$"):
        yield _unclosed(words)


def _pictures(children: Sequence[Token], home: Path) -> Iterator[str]:
    """Embed the pictures in the text; yields the faults of those that cannot be embedded.

    A picture with text in its line is a sign: it is as high as the letters.
    """
    for image, line in _with_lines(children):
        if image.type != "image":
            continue
        source = str(image.attrGet("src") or "")
        if not image.content.strip():
            yield f"picture {source!r}: say what it shows, for those who cannot see it: ![…](…)"
        if "{{" in image.content:
            yield f"picture {source!r}: a number stands in the text, not in what the picture shows"
        try:
            image.attrSet("src", own_picture(source, home))
            if any(each.type == "text" and each.content.strip() for each in line):
                image.attrSet("class", "sign")
        except ValueError as error:
            image.type = "text"
            yield str(error)


def _with_lines(children: Sequence[Token]) -> Iterator[tuple[Token, Sequence[Token]]]:
    """Each token, and the tokens of its line."""
    ends = [i for i, each in enumerate(children) if each.type in ("softbreak", "hardbreak")]
    for begin, end in zip([0, *ends], [*ends, len(children)], strict=True):
        line = children[begin:end]
        yield from ((each, line) for each in line)


def own_picture(source: str, home: Path) -> str:
    """A picture in a lesson's folder as a data: URL.

    Raises:
        ValueError: there is no such picture in the folder, or see `formulas.embedded`.
    """
    try:
        picture = (home / source).resolve()
        if ELSEWHERE.match(source):
            raise ValueError(f"picture {source[:40]!r}: {PICTURE_RULE}")
        if not picture.is_relative_to(home.resolve()):
            raise ValueError(f"picture {source!r} is not in the lesson's folder")
        return embedded(picture)
    except (OSError, RuntimeError):  # the latter for links that lead to each other
        raise ValueError(f"no picture {source!r}: {PICTURE_RULE}") from None


def _links(children: list[Token], robot: str, faults: list[str]) -> Iterator[LabLink]:
    """The lab links of a text, in which their words become bold text."""
    for i, token in enumerate(children):
        if token.type != "link_open":
            continue
        address = str(token.attrGet("href") or "")
        if address.startswith("https://"):
            token.attrSet("target", "_blank")
            token.attrSet("rel", "noopener noreferrer")
            continue
        end = next(j for j in range(i, len(children)) if children[j].type == "link_close")
        label = "".join(child.content for child in children[i + 1 : end])
        token.tag = children[end].tag = "strong"
        token.attrs = {}
        _separate(children[end + 1 : end + 3])
        try:
            actions = read_link(address)
        except ValueError as error:
            faults.append(str(error))
            continue
        for action in actions:
            faults += _unknown_names(action, robot) or action_faults(action, robot)
        yield LabLink(label, actions)


def _unknown_names(action: Action, robot: str) -> list[str]:
    """The faults of names in a link that are neither actions nor parameters."""
    known = step_specs(ROBOTS[robot].parameters) if robot in ROBOTS else action.set or {}
    names = [*SIMPLE, "path", "robot", *SIDES, *known]
    return [
        f"{SCHEME}{name}: neither an action nor a parameter{near(name, names)}"
        for name in action.set or {}
        if name not in known
    ]


def _separate(after: list[Token]) -> None:
    """Put a comma between two adjacent links, whose words would run together.

    Args:
        after: the two tokens after the first link.
    """
    kinds = [token.type for token in after]
    if kinds == ["text", "link_open"] and not after[0].content.strip():
        after[0].content = ", "


def _has_prose(tokens: list[Token]) -> bool:
    """Whether there is any text outside links."""
    inline = [child for token in tokens for child in token.children or ()]
    return any(child.level == 0 and child.content.strip(" \u00a0,.;:·|") for child in inline)
