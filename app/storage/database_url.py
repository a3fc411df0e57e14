"""The database's URL from the environment, because all users of a machine see command lines."""

from __future__ import annotations

import os

from onpath.app.storage.engine import parsed

DATABASE = "ONPATH_DATABASE"  # environment variable


def database_url(option: str | None) -> str | None:
    """The URL from the command line, or else from the environment.

    Child processes do not inherit the variable: the URL may hold a password.

    Raises:
        ValueError: the URL on the command line is malformed or contains a password.
    """
    inherited = os.environ.pop(DATABASE, "")
    if option:
        url = parsed(option)
        if url.password or "password" in url.query:
            raise ValueError(
                f"--database: all users of this machine see a password there; use {DATABASE}"
            )
    return option or inherited or None
