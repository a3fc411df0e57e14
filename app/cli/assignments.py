"""Reads options that give values by name, such as `--set name=value`."""

from __future__ import annotations

import json
from pathlib import Path


def assignments(
    pairs: tuple[str, ...], option: str = "--set", form: str = "name=value"
) -> dict[str, str]:
    """The values of such an option by name.

    In the place of pairs, `--set` also takes @FILE, what `onpath identify --json` has printed.

    Args:
        form: of a pair, for the message.

    Raises:
        ValueError: a pair is not of this form, a name is given twice, or a file is not such a one.
        OSError: a file cannot be read.
    """
    values = dict[str, str]()
    files = [pair for pair in pairs if option == "--set" and pair.startswith("@")]
    read = [each for file in files for each in _identified(file)]
    for pair in [*read, *(pair for pair in pairs if pair not in files)]:
        name, equals, value = (part.strip() for part in pair.partition("="))
        if not equals or not name or not value:
            raise ValueError(f"{option} {pair}: expected {form}")
        if name in values:
            raise ValueError(f"{option} {name}: it is given twice, and may be given once only")
        values[name] = value
    return values


def _identified(file: str) -> list[str]:
    """The settings in a file of `onpath identify --json`, as name=value.

    Raises:
        ValueError, OSError: see `assignments`.
    """
    from onpath.app.common.user_files import user_file
    from onpath.app.exports.identification import SETTINGS

    try:
        found = json.loads(user_file(Path(file[1:])).read_text("utf-8"))[SETTINGS]
        return [f"{name}={float(value):g}" for name, value in found.items()]
    except (ValueError, LookupError, TypeError, AttributeError):
        raise ValueError(f"--set {file}: expected a file of onpath identify --json") from None
