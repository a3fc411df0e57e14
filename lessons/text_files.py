"""Reads the text files of lessons; messages tell the author how to mend a faulty one."""

from __future__ import annotations

import codecs
import re
import stat
import tomllib
from pathlib import Path
from typing import Any

from onpath.lessons.problems import Problem

LARGEST = 1_000_000
"""Largest size of a file of a lesson, [B]."""
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
STRING = re.compile(
    r"""\"{3}(?P<long>(?:[^\\]|\\.)*?)\"{3}|'{3}.*?'{3}|"(?P<short>(?:[^"\\\n]|\\.)*)"|'[^'\n]*'|#[^\n]*""",
    re.DOTALL,
)
"""A string or a comment in TOML."""
CURLY = re.compile("[“”„‟‘’‚‛«»]")
BACKSLASH = "in TOML a backslash is written \\\\, or the text stands between single quotes"


class FileError(ValueError):
    """A file that cannot be read."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__(str(problem))


def read_text(file: Path) -> str:
    """The text of a file, with or without a byte-order mark and with any line endings.

    Raises:
        FileError: it cannot be read, is too large, or is not in UTF-8.
    """
    try:
        found = file.stat()
        if not stat.S_ISREG(found.st_mode) and not stat.S_ISDIR(found.st_mode):
            raise FileError(Problem(str(file), 1, "no file but a device, which may never end"))
        if found.st_size > LARGEST:
            raise FileError(Problem(str(file), 1, f"larger than {LARGEST // 1000} kB"))
        content = file.read_bytes()
    except OSError as error:
        text = error.strerror or "cannot be read"
        raise FileError(Problem(str(file), 1, text)) from None
    save = "save it as UTF-8 (in an editor: Save as…, Encoding)"
    if content.startswith(UTF_16) or b"\0" in content[:4]:
        raise FileError(Problem(str(file), 1, f"this is UTF-16 and not UTF-8: {save}"))
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        text = f"a letter of this line is not in UTF-8: {save}"
        raise FileError(Problem(str(file), line, text)) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def load_toml(content: str) -> dict[str, Any]:
    """The contents of a TOML text.

    Raises:
        tomllib.TOMLDecodeError: it cannot be read for any reason; `tomllib.loads` may raise others.
    """
    try:
        return tomllib.loads(content)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise tomllib.TOMLDecodeError("nested too deeply") from None
    except ValueError:  # thousands of digits
        raise tomllib.TOMLDecodeError("a number is too long") from None


def toml_fault(error: tomllib.TOMLDecodeError, content: str) -> tuple[int, str]:
    """The fault of TOML that cannot be read: the number of lines before it, and a description."""
    bare = STRING.sub(lambda text: re.sub(r"[^\n]", " ", text[0]), content)
    if curly := CURLY.search(bare):
        line = content.count("\n", 0, curly.start())
        return line, f'{curly[0]}: in TOML a text stands between straight quotes, "…"'
    place = re.search(r" \(at line (\d+), column (\d+)\)", str(error))
    message = str(error).replace(place[0], f" (column {place[2]})") if place else str(error)
    hint = f"; {BACKSLASH}" if re.search("escape|hex", message, re.I) else ""
    return int(place[1]) - 1 if place else content.count("\n"), f"TOML: {message}{hint}"
