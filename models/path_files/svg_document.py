"""Reads an SVG file to elements that know their line; the file is untrusted.

A document type is skipped, but for entities that stand for plain text, as Illustrator's prologue
has them: references to files, entities made of others, and text that grows are refused, as are deep
nesting and too many elements.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element
from xml.parsers import expat

from onpath.models.errors import CodedError

DEEPEST, MOST_ELEMENTS = 50, 20_000
MOST_GROWTH, SPARE = 2, 100_000  # of a file by its entities: a factor, and characters more
SVG = "http://www.w3.org/2000/svg"
LINE = "line-in-file"
LINK = "href"
LAYER = "layer-in-file"
_INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
_NAMES = {
    "http://www.w3.org/1999/xlink href": LINK,
    f"{_INKSCAPE} label": LAYER,
}
"""Attributes of other languages that are used, and the names that they get."""


def read_document(data: bytes) -> Element:
    """The root element, without the elements of other languages.

    Attributes `LINE`, `LINK` and `LAYER` are line in the file, referenced element, and name of an
    Inkscape layer.

    Raises:
        CodedError: it is no SVG drawing, or has what the module refuses; the message names the
            line.
    """
    root = _DocumentReader(len(data)).read(data)
    if root.tag != "svg":
        raise CodedError("error.svg_no_drawing")
    return root


def too_large(line: str) -> CodedError:
    """The refusal of a drawing with too many elements."""
    return CodedError("error.svg_large", line=line, deepest=DEEPEST, most=MOST_ELEMENTS)


class _DocumentReader:
    """Reads XML to elements; see the module."""

    def __init__(self, size: int) -> None:
        self._open, self._count, self._characters = [Element("file")], 0, 0
        self._most = MOST_GROWTH * size + SPARE
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.EntityDeclHandler = self._declare
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text

    def read(self, data: bytes) -> Element:
        """The root element."""
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            reason = expat.errors.messages[error.code]
            place = str(error.lineno), str(error.offset + 1)
            raise CodedError(
                "error.svg_no_xml", line=place[0], column=place[1], reason=reason
            ) from None
        except CodedError:
            raise
        except (LookupError, ValueError):  # an encoding that does not exist
            raise CodedError("error.file_no_text") from None
        return self._open[0][0]

    def _declare(
        self, name: str, is_parameter: bool, value: str | None, *external: str | None
    ) -> None:
        plain = value is not None and not is_parameter and not set("&<%") & {*value}
        if not plain:
            raise CodedError("error.svg_entity", line=self._line(), name=name[:40])

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if len(self._open) > DEEPEST or self._count > MOST_ELEMENTS:
            raise too_large(self._line())
        self._grow(sum(map(len, attributes.values())))
        named = {_NAMES.get(name, name): value for name, value in attributes.items()}
        space, _, plain = tag.rpartition(" ")
        element = Element(plain if space in ("", SVG) else tag, named | {LINE: self._line()})
        self._open[-1].append(element)
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _text(self, text: str) -> None:
        self._grow(len(text))
        element = self._open[-1]
        if element.tag == "style":
            element.text = (element.text or "") + text

    def _grow(self, characters: int) -> None:
        self._characters += characters
        if self._characters > self._most:
            raise CodedError("error.svg_grows", line=self._line())

    def _line(self) -> str:
        return str(self._parser.CurrentLineNumber)
