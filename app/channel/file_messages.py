"""Files that a page sends, and files that are made for it."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

LONGEST_NAME = 200  # [characters] of a file's name

# From the page


class PathFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="path"):
    """A file with a path that the robots are to follow.

    Attributes:
        size: of the path, [mm]; 0: as the file states it.
        radius: with which its corners are rounded, [mm]; 0: it is smoothed.
        opened: whether it is open, although its ends meet.
    """

    size: Annotated[float, Meta(ge=0, le=400)] = 100.0
    radius: Annotated[float, Meta(ge=0, le=100)] = 0.0
    opened: bool = False


class SendFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="send"):
    """A file will come in parts: the first after the answer to this, `FileMessage`, and each
    further one after the answer to the one before.

    Attributes:
        number: names the file in what follows.
        name: of the file.
        size: [B].
        use: what is done with it.
    """

    number: int
    name: Annotated[str, Meta(max_length=LONGEST_NAME)]
    size: Annotated[int, Meta(ge=0)]
    use: PathFile


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
        file: a table of the last minute (CSV), a picture of its plots (PNG), a page with the scene
            of its last seconds, or a page with the record of all lessons.
        with_code: whether the record shows the lab's code, which then opens the lab.
    """

    file: Literal["table", "picture", "film", "report"]
    with_code: bool = False


# To the page


class FileMessage(Struct, frozen=True, tag_field="is", tag="file"):
    """How far the server is with a file of the page.

    Attributes:
        number: of the file.
        state: more of it is awaited, it is being read, it has been used, or it is refused.
        received: how much has come, [B].
        why: it is refused: a sentence in the page's language; else empty.
    """

    number: int
    state: Literal["awaited", "reading", "used", "refused"]
    received: int = 0
    why: str = ""


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
