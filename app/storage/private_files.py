"""Files that only their owner can read: the database holds the codes that open the labs."""

from __future__ import annotations

import logging
import os
import stat
from contextlib import suppress
from pathlib import Path

log = logging.getLogger(__name__)

JOURNALS = ("-wal", "-shm")  # suffixes of SQLite's journal files
OWNER_FILE, OWNER_FOLDER = 0o600, 0o700  # permissions of the owner alone
OTHERS = 0o077  # permissions of everybody else


def make_private_file(file: Path) -> None:
    """Create an empty database file, and its folder, that only their owner can use.

    The permissions of an existing file and its journals are restricted to the owner; if that is not
    allowed, a warning is logged. An existing folder is left unchanged. SQLite gives new journals
    the permissions of the file.

    Raises:
        OSError: it cannot be created.
    """
    file.parent.mkdir(OWNER_FOLDER, parents=True, exist_ok=True)
    with suppress(FileExistsError):
        os.close(os.open(file, os.O_CREAT | os.O_EXCL | os.O_WRONLY, OWNER_FILE))
    for tail in ("", *JOURNALS):
        _restrict(file.with_name(file.name + tail))


def make_private_folder(folder: Path) -> None:
    """Restrict an existing folder to its owner; see `make_private_file`."""
    _restrict(folder)


def _restrict(path: Path) -> None:
    try:
        mode = path.stat().st_mode
        if mode & OTHERS:
            path.chmod(OWNER_FOLDER if stat.S_ISDIR(mode) else OWNER_FILE)
    except FileNotFoundError:
        return
    except OSError as error:
        log.warning("other users of this machine may read %s: %s", path, error.strerror)
