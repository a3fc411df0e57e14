"""Reads options that may be repeated, such as `--set name=value`."""

from __future__ import annotations


def assignments(
    pairs: tuple[str, ...], option: str = "--set", form: str = "name=value"
) -> dict[str, str]:
    """The values of such an option by name.

    Args:
        form: of a pair, for the message.

    Raises:
        ValueError: a pair is not of this form.
    """
    values = dict[str, str]()
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals or not name or not value:
            raise ValueError(f"{option} {pair}: expected {form}")
        values[name.strip()] = value.strip()
    return values
