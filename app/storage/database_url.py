"""The database's URL from the environment, because all users of a machine see command lines."""

from __future__ import annotations

import os

DATABASE = "ONPATH_DATABASE"  # environment variable


def database_url(option: str | None) -> str | None:
    """The URL of the command line or else of the environment.

    Child processes do not inherit the variable: the URL may hold a password.
    """
    inherited = os.environ.pop(DATABASE, "")
    return option or inherited or None
