"""Which class a server has: its own, or the one that it shares with others by the teacher's key.

The key comes by the environment, as the command line is for everybody to read.
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
    """The teacher's key that this process has been given; processes that it starts have it not.

    Raises:
        ValueError: it is none.
    """
    typed = os.environ.pop(KEY, None)
    try:
        return None if typed is None else normalised(typed)
    except ValueError:
        raise ValueError(f"{KEY}: a key has 12 letters and digits without 0, 1, i, l, o") from None


def open_class(records: Records, key: str | None) -> LocalClassroom | SharedClassroom:
    """The class of a server.

    Args:
        records: the database that others share.
        key: the teacher's; with none the class is this process's alone.

    Raises:
        ValueError: nobody can share this database.
        NotKept: it does not work.
    """
    if key is None:
        return LocalClassroom()
    if not records.is_shared:
        why = records.warning or "--database is in this process's memory"
        raise ValueError(f"a class of several processes needs a database that they share: {why}")
    return SharedClassroom(records, key)


@contextmanager
def class_of_workers(database: str | None) -> Iterator[tuple[SharedClassroom, bool]]:
    """A class while there are workers, and whether its key was made here: then it ends with them.

    Raises:
        ValueError: nobody can share this database, or the key that was given is none.
        NotKept: it does not work.
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
