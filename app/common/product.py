"""The version of OnPath."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version


@cache
def product_version() -> str:
    """The installed version; empty in a checkout that is not installed."""
    try:
        return version("onpath")
    except PackageNotFoundError:
        return ""
