"""Opens the class of a server: its own, or one that several servers share by the teacher's key.

The key is passed in the environment, because command lines are visible to all users.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager

from onpath.app.classroom.local_classroom import LocalClassroom
from onpath.app.classroom.shared_classroom import SharedClassroom
from onpath.app.common.access_codes import new_code, normalised
from onpath.app.storage.records import NotKept, Records

log = logging.getLogger(__name__)

KEY = "ONPATH_TEACHER_KEY"


def given_key() -> str | None:
    """The teacher's key of this process, or None. Child processes do not inherit the key.

    Raises:
        ValueError: it is malformed.
    """
    typed = os.environ.pop(KEY, None)
    try:
        return None if typed is None else normalised(typed)
    except ValueError:
        raise ValueError(f"{KEY}: a key has 12 letters and digits without 0, 1, i, l, o") from None


def open_class(records: Records, key: str | None) -> LocalClassroom | SharedClassroom:
    """The class of a server.

    Args:
        records: the shared database.
        key: the teacher's; None for a class of this process only.

    Raises:
        ValueError: the database cannot be shared.
        NotKept: the database cannot be used.
    """
    if key is None:
        return LocalClassroom()
    if not records.is_shared:
        why = records.warning or "--database is in this process's memory"
        raise ValueError(f"a class of several processes needs a database that they share: {why}")
    return SharedClassroom(records, key)


@contextmanager
def class_of_workers(database: str | None) -> Iterator[tuple[SharedClassroom, bool]]:
    """The class for as long as workers run, and whether its key was created here.

    If so, the class is deleted afterwards.

    Raises:
        ValueError: the database cannot be shared, or the given key is malformed.
        NotKept: the database cannot be used.
    """
    given, records = given_key(), Records(database)
    try:
        room = open_class(records, given or new_code())
        assert isinstance(room, SharedClassroom)
        try:
            yield room, given is None
        finally:
            if given is None:
                _dissolve(room)
    finally:
        records.close()


def _dissolve(room: SharedClassroom) -> None:
    try:
        room.dissolve()
    except NotKept as error:
        log.warning("the class is still in the database: %s", error)
