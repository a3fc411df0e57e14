"""Reads options that give values by name, such as `--set name=value`."""

from __future__ import annotations


def assignments(
    pairs: tuple[str, ...], option: str = "--set", form: str = "name=value"
) -> dict[str, str]:
    """The values of such an option by name.

    Args:
        form: of a pair, for the message.

    Raises:
        ValueError: a pair is not of this form, or a name is given twice.
    """
    values = dict[str, str]()
    for pair in pairs:
        name, equals, value = (part.strip() for part in pair.partition("="))
        if not equals or not name or not value:
            raise ValueError(f"{option} {pair}: expected {form}")
        if name in values:
            raise ValueError(f"{option} {name}: it is given twice, and may be given once only")
        values[name] = value
    return values
