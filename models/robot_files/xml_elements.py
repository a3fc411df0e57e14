"""Reads small XML files from untrusted sources, with the line of each element."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from onpath.models.errors import CodedError, Message

LARGEST_FILE = 1_000_000  # [B]
MOST_ELEMENTS = 20_000
DEEPEST = 30  # elements within each other
LARGEST_NUMBER = 1e9  # [SI]
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
LONGEST_NAME = 128


@dataclass(frozen=True, slots=True, eq=False)
class Element:
    """An element of an XML file.

    Attributes:
        tag: its name.
        values: its attributes.
        line: on which it begins, counted from 1.
        children: the elements directly within it.
    """

    tag: str
    values: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list["Element"])

    def all(self, tag: str) -> Iterator[Element]:
        """The children with this name."""
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> Element | None:
        """The first child with this name."""
        return next(self.all(tag), None)

    def need(self, tag: str) -> Element:
        """The first child with this name.

        Raises:
            FileFault: there is none.
        """
        child = self.first(tag)
        if child is None:
            raise FileFault(self, Message("robot_file.without", {"what": f"<{tag}>"}))
        return child

    def text(self, key: str) -> str:
        """An attribute.

        Raises:
            FileFault: it is absent.
        """
        if key not in self.values:
            raise FileFault(self, Message("robot_file.without", {"what": key}))
        return self.values[key]

    def name(self, key: str = "name") -> str:
        """An attribute that names something, as `safe_name`.

        Raises:
            FileFault: it is absent or empty.
        """
        text = safe_name(self.text(key))
        if not text:
            raise FileFault(self, Message("robot_file.without", {"what": key}))
        return text

    def number(self, key: str, default: float | None = None, most: float = LARGEST_NUMBER) -> float:
        """An attribute that is a number, up to `most`.

        Raises:
            FileFault: it is not finite, or absent without a default.
        """
        if default is not None and key not in self.values:
            return default
        return self.numbers(key, 1, most=most)[0]

    def numbers(
        self, key: str, count: int, default: str | None = None, most: float = LARGEST_NUMBER
    ) -> tuple[float, ...]:
        """An attribute that consists of numbers with spaces between them.

        Raises:
            FileFault: it does not, or there are more or fewer, or one is not finite.
        """
        text = self.text(key) if default is None else self.values.get(key, default)
        words = text.split(maxsplit=count)
        if len(words) != count or not all(len(w) < 40 and _NUMBER.fullmatch(w) for w in words):
            raise FileFault(
                self,
                Message("robot_file.numbers", {"field": key, "count": count, "value": shown(text)}),
            )
        numbers = tuple(float(word) for word in words)
        if any(not math.isfinite(x) or abs(x) > most for x in numbers):
            raise FileFault(self, Message("robot_file.large", {"field": key, "value": shown(text)}))
        return numbers


class FileFault(Exception):
    """Something in a file that is refused.

    Args:
        element: where it is.
        reason: why.
    """

    def __init__(self, element: Element, reason: Message) -> None:
        super().__init__(reason.code)
        self.element, self.reason = element, reason

    def in_file(self, file: Path) -> CodedError:
        """The error that names the file, the line and the element."""
        tag, named = self.element.tag, self.element.values.get("name", "")
        if not tag:  # not even XML
            return CodedError(
                "robot_file.at_line", file=file.name, line=self.element.line, reason=self.reason
            )
        return CodedError(
            "robot_file.at",
            file=file.name,
            line=self.element.line,
            element=shown(tag) + (f" {shown(named)}" if named else ""),
            reason=self.reason,
        )


def shown(text: str, most: int = 40) -> str:
    """A text of a file as it may appear in a message, cut after `most` characters."""
    plain = "".join(c if c.isprintable() else "?" for c in text[:most])
    return plain + ("…" if len(text) > most else "")


def safe_name(text: str) -> str:
    """A name of a file: of one line, printable and short; as it is if it is so already.

    Other names are changed and get a digest, so that different ones stay different.
    """
    text = text.strip()
    if len(text) <= LONGEST_NAME and text.isprintable():
        return text
    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]
    return f"{shown(text)}~{digest}"


def file_bytes(file: Path) -> bytes:
    """The content of a small file.

    Raises:
        CodedError: there is no such file, it cannot be read, or it is too large.
    """
    if not file.is_file():
        raise CodedError("robot_file.absent", file=str(file))
    try:
        with file.open("rb") as opened:
            data = opened.read(LARGEST_FILE + 1)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CodedError("robot_file.unreadable", file=str(file), reason=reason) from None
    if len(data) > LARGEST_FILE:
        raise CodedError("robot_file.size", file=file.name, most=f"{LARGEST_FILE // 10**6} MB")
    return data


def root_of(data: bytes) -> Element:
    """The outermost element of an XML file.

    Raises:
        FileFault: it is not well-formed, has a document type, which could define entities, or has
            too many elements, or too many within each other.
    """
    parser, top = expat.ParserCreate(), Element("", {}, 1)
    path, count = [top], 0

    def start(tag: str, values: dict[str, str]) -> None:
        nonlocal count
        element = Element(tag, values, parser.CurrentLineNumber)
        count += 1
        if count > MOST_ELEMENTS or len(path) > DEEPEST:
            raise FileFault(
                element, Message("robot_file.elements", {"most": MOST_ELEMENTS, "deepest": DEEPEST})
            )
        path[-1].children.append(element)
        path.append(element)

    def doctype(name: str, *_: object) -> None:
        raise FileFault(
            Element("!DOCTYPE", {}, parser.CurrentLineNumber), Message("robot_file.doctype")
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: path.pop()
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise FileFault(
            Element("", {}, error.lineno), Message("robot_file.xml", {"reason": reason})
        ) from None
    except (ValueError, LookupError) as error:  # an unknown or unsuitable encoding
        raise FileFault(
            Element("", {}, 1), Message("robot_file.xml", {"reason": shown(str(error))})
        ) from None
    return top.children[0]
