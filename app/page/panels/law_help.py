"""The help page about the control laws, and about the names that a typed law may use."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from onpath.app.common.templates import render
from onpath.lessons.sides import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.closed_loop.kernel import INTEGRAL_REACH
from onpath.models.control.laws.expressions import FUNCTIONS, LARGEST_EXPONENT
from onpath.models.control.laws.own import MEANINGS, SPACE_MEANINGS, NamedValue
from onpath.models.control.laws.registry import LAWS


def law_help(laws: Iterable[str], spatial: bool, own_first: bool, words: Words) -> str:
    """What each law does, its strength and weakness, what its authors would say, and its source.

    Args:
        laws: names in the registry.
        spatial: whether to explain the names for space curves, too.
        own_first: whether the page begins with the typed laws.
    """
    descriptions = [
        (
            law_label(name, words),
            law_text(name, words),
            words.get(f"law.{name}.good", LAWS[name].good),
            words.get(f"law.{name}.limits", LAWS[name].limits),
            words.get(f"law.{name}.objection", LAWS[name].objection),
            words("laws.source", source=LAWS[name].source),
        )
        for name in laws
    ]
    functions = ", ".join(FUNCTIONS)
    return render(
        "panel/law_help.html",
        laws=descriptions,
        own_first=own_first,
        bounds=words("laws.bounds", reach=f"{1e3 * INTEGRAL_REACH:.0f}"),
        own=words("laws.own"),
        text=words("laws.own_text"),
        space=words("laws.own_space") if spatial else "",
        language=words("laws.own_language", functions=functions, most=LARGEST_EXPONENT),
        headings=[words(f"laws.{column}") for column in ("name", "meaning", "unit")],
        names=_rows((*MEANINGS, *(SPACE_MEANINGS if spatial else ())), words),
    )


def _rows(values: Sequence[NamedValue], words: Words) -> list[tuple[str, str, str]]:
    return [
        (", ".join(v.names), words.get(f"law.own.{v.names[0]}", v.meaning), v.unit) for v in values
    ]
