"""The classes of a server, one for each teacher's key that it is given.

Every server with the same key and database can serve the class of a key. Keys are passed in the
environment, because command lines are visible to all users. A server that is given none has the
class of this computer, whose key is kept in a file, so that the class outlives the process.
"""

from __future__ import annotations

import os
from pathlib import Path

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import new_code, normalised, shown
from onpath.app.common.error_log import log_warning
from onpath.app.storage.private_files import make_private_file
from onpath.app.storage.records import default_file

KEY = "ONPATH_TEACHER_KEY"
MOST = 100


def given_keys() -> list[str]:
    """The teachers' keys of this process. Child processes do not inherit them.

    Raises:
        ValueError: one is malformed.
    """
    typed = os.environ.pop(KEY, "").replace(",", " ").split()
    try:
        return list(dict.fromkeys(normalised(key) for key in typed))
    except ValueError:
        raise ValueError(f"{KEY}: a key has 12 letters and digits without 0, 1, i, l, o") from None


def key_file() -> Path:
    """The file with the key of this computer's class, which only its owner can read."""
    return default_file().with_name("teacher.key")


def own_key() -> str:
    """The key of this computer's class. It is made at the first start, and if the file is broken.

    If the file cannot be written, a warning is logged, and the key lasts as long as the process.
    """
    file, new = key_file(), new_code()
    try:
        make_private_file(file)
        text = file.read_text("utf-8", errors="replace")
        try:
            return normalised(text)
        except ValueError:
            if text:
                log_warning("%s has no teacher's key: there is a new one", file)
            file.write_text(f"{shown(new)}\n", "utf-8")
    except OSError as error:
        log_warning("the class ends with the server: %s: %s", file, error.strerror or error)
    return new


def open_classes(keys: list[str]) -> list[Classroom]:
    """The classes of a server with these keys.

    Raises:
        ValueError: there are too many keys, or two have the same class code.
    """
    if len(keys) > MOST:
        raise ValueError(f"{KEY}: at most {MOST} keys")
    rooms = [Classroom(key=key) for key in keys or [own_key()]]
    if len({room.code for room in rooms}) < len(rooms):
        raise ValueError(f"{KEY}: two keys lead to the same class code; choose another one")
    return rooms
