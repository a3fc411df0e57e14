"""Files for their owner alone: a lab is opened by its code, and the database holds all codes."""

from __future__ import annotations

import logging
import os
import stat
from contextlib import suppress
from pathlib import Path

log = logging.getLogger(__name__)

JOURNALS = ("-wal", "-shm")  # SQLite's, by the ends of their names
OWNER_S_FILE, OWNER_S_FOLDER = 0o600, 0o700
OTHERS = 0o077  # permissions of everybody else


def make_private_file(file: Path) -> None:
    """Create an empty database file for its owner alone, in a folder like that.

    A file that exists is withdrawn from other users, with its journals; where that is not allowed,
    a warning is logged. A folder that exists is left alone. SQLite gives new journals the
    permissions of the file.

    Raises:
        OSError: it cannot be created.
    """
    file.parent.mkdir(OWNER_S_FOLDER, parents=True, exist_ok=True)
    with suppress(FileExistsError):
        os.close(os.open(file, os.O_CREAT | os.O_EXCL | os.O_WRONLY, OWNER_S_FILE))
    for tail in ("", *JOURNALS):
        _withdraw(file.with_name(file.name + tail))


def make_private_folder(folder: Path) -> None:
    """Withdraw a folder from other users, if it exists; see `make_private_file`."""
    _withdraw(folder)


def _withdraw(path: Path) -> None:
    try:
        mode = path.stat().st_mode
        if mode & OTHERS:
            path.chmod(OWNER_S_FOLDER if stat.S_ISDIR(mode) else OWNER_S_FILE)
    except FileNotFoundError:
        return
    except OSError as error:
        log.warning("other users of this machine may read %s: %s", path, error.strerror)
