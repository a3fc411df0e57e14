"""The classes of a server, one for each teacher's key that it is given.

A server without keys has one class, in memory, with a new key. Otherwise each key has a class with
an address, which every server with the same key and database can serve. Keys are passed in the
environment, because command lines are visible to all users.
"""

from __future__ import annotations

import os

from onpath.app.classroom.classroom import Classroom, class_with_address
from onpath.app.common.access_codes import normalised

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


def open_classes(keys: list[str]) -> list[Classroom]:
    """The classes of a server with these keys.

    Raises:
        ValueError: there are too many keys, or two have the same class code.
    """
    if len(keys) > MOST:
        raise ValueError(f"{KEY}: at most {MOST} keys")
    rooms = [class_with_address(key) for key in keys] or [Classroom()]
    if len({room.code for room in rooms}) < len(rooms):
        raise ValueError(f"{KEY}: two keys lead to the same class code; choose another one")
    return rooms
