"""Reads `--law`."""

from __future__ import annotations

from collections.abc import Sequence


def laws_named(texts: Sequence[str], suitable: Sequence[str], *, calls: bool = True) -> list[str]:
    """The names of laws; the user's own are added to the laws.

    Args:
        texts: each a name, a typed law, FILE.py:NAME, "all", or "both", which are trajectory
            tracking and path following.
        suitable: what "all" are.
        calls: whether a law may be a Python function, which is called in every control interval.

    Raises:
        ValueError: an unknown name, or a law that has an error.
        OSError: a file cannot be read.
    """
    from onpath.app.common.own_laws import compiled_law, law_given
    from onpath.models.control.laws.own import is_text
    from onpath.models.control.laws.python_law import IN_FILE
    from onpath.models.control.laws.registry import LAWS, NAMES
    from onpath.models.systems.parameter_specs import unknown_name

    names = list[str]()
    for text in texts:
        if text in ("all", "both"):
            names += suitable if text == "all" else NAMES
        elif text in LAWS or is_text(text) or IN_FILE.fullmatch(text) or text.endswith(".py"):
            names.append(law_given(text) if calls else compiled_law(text))
        else:
            raise unknown_name(text, [*LAWS, "all", "both"], "law")
    return names
