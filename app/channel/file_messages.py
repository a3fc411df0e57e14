"""Files that a page sends, and files that are made for it."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

LONGEST_NAME = 200  # [characters] of a file's name
MOST_PARTS = 200  # lines of a file that are shown and can be chosen
MOST_QUANTITIES = 100  # that a log can have

# From the page

Part = Annotated[int, Meta(ge=1, le=MOST_PARTS)]


class PathFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="path"):
    """A file with a path that the robots are to follow.

    Attributes:
        size: of the path, [mm]; 0: as the file states it.
        radius: with which its corners are rounded, [mm]; 0: it is smoothed.
        opened: whether it is open, although its ends meet.
        turn: angle by which it is turned anticlockwise, [degrees].
        right, up: coordinates of its middle in the plane of the path, [mm].
        parts: numbers of the wanted lines of the file, from 1; none: all of them.
    """

    size: Annotated[float, Meta(ge=0, le=400)] = 100.0
    radius: Annotated[float, Meta(ge=0, le=100)] = 0.0
    opened: bool = False
    turn: Annotated[float, Meta(ge=-360, le=360)] = 0.0
    right: Annotated[float, Meta(ge=-400, le=400)] = 0.0
    up: Annotated[float, Meta(ge=-400, le=400)] = 0.0
    parts: Annotated[tuple[Part, ...], Meta(max_length=MOST_PARTS)] = ()


Column = Annotated[str, Meta(max_length=LONGEST_NAME)]


class LogFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="log"):
    """The log of a real arm, which is drawn over the plots.

    Attributes:
        columns: the file's names, or places, of the robot's quantities, by name; what is missing is
            guessed.
        units: of these columns, or their sizes in SI units; those that are missing are guessed.
    """

    columns: Annotated[dict[Column, Column], Meta(max_length=MOST_QUANTITIES)] = {}
    units: Annotated[dict[Column, Column], Meta(max_length=MOST_QUANTITIES)] = {}


class SendFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="send"):
    """A file will come in parts: the first after the answer to this, `FileMessage`, and each
    further one after the answer to the one before.

    Attributes:
        number: names the file in what follows.
        name: of the file.
        size: [B].
        use: what is done with it.
        again: number of the same file when it was sent before, whose content need not come again;
            0 if it was not.
    """

    number: int
    name: Annotated[str, Meta(max_length=LONGEST_NAME)]
    size: Annotated[int, Meta(ge=0)]
    use: PathFile | LogFile
    again: int = 0


class SendPart(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="part"):
    """The next part of a file.

    Attributes:
        number: of the file.
        content: at most 180 kB, in base64.
    """

    number: int
    content: bytes


class DropFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="drop"):
    """No more of a file will come.

    Attributes:
        number: of the file.
    """

    number: int


class MakeFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="make"):
    """Make a file for a download; one at a time. Answered by `DownloadMessage`.

    Attributes:
        file: a table of the last minute (CSV), a picture of its plots or of the lines that the
            robots have written (PNG), a page with the scene of its last seconds, or a page with the
            record of all lessons.
        with_code: whether the record shows the lab's code, which then opens the lab.
    """

    file: Literal["table", "picture", "lines", "film", "report"]
    with_code: bool = False


# To the page


class PathHelp(Struct, frozen=True):
    """What would help where a path cannot be followed.

    Attributes:
        text: of its button.
        size, radius: of `PathFile`, with which the path can be followed, [mm].
    """

    text: str
    size: float
    radius: float


class LogQuantity(Struct, frozen=True):
    """A quantity of the robot in a log.

    Attributes:
        name: such as "q1".
        column: of the file that is read as it; empty if there is none.
        unit: in which it is read.
        units: those that it may have.
        is_optional: whether the file need not have it.
    """

    name: str
    column: str
    unit: str
    units: tuple[str, ...]
    is_optional: bool


class FileMessage(Struct, frozen=True, tag_field="is", tag="file"):
    """How far the server is with a file of the page.

    Attributes:
        number: of the file.
        state: more of it is awaited, it is being read, it has been used, or it is refused.
        received: how much has come, [B].
        why: it is refused, in a sentence in the page's language; else empty.
        lines: those in the file as they lie in it, each x, y, x, y, … from 0 to 1000; y points up.
        helps: what would help.
        columns: names of a log's columns.
        quantities: what is read from them.
    """

    number: int
    state: Literal["awaited", "reading", "used", "refused"]
    received: int = 0
    why: str = ""
    lines: tuple[tuple[int, ...], ...] = ()
    helps: tuple[PathHelp, ...] = ()
    columns: tuple[str, ...] = ()
    quantities: tuple[LogQuantity, ...] = ()


class DownloadMessage(Struct, frozen=True, tag_field="is", tag="download"):
    """How far the server is with a file for the page.

    Attributes:
        number: names the file in what follows.
        name: of the file.
        state: it is being made, its parts come now, or it cannot be made.
        text: the same in the page's language.
        size: of a file whose parts come now, [B]; else 0.
    """

    number: int
    name: str
    state: Literal["making", "coming", "failed"]
    text: str
    size: int = 0


class DownloadPart(Struct, frozen=True, tag_field="is", tag="part"):
    """The next part of a file for the page.

    Attributes:
        number: of the file.
        content: in base64.
    """

    number: int
    content: bytes
