"""Marks the symbols of a lesson's texts, so that a page can show what they mean.

A lesson names its symbols (`symbols = ["lambda", "K_1"]`). Every place where one of them stands, in
a text or a formula, becomes an element with the attribute `data-symbol`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from functools import lru_cache
from xml.etree.ElementTree import Element, fromstring, tostring

from markupsafe import Markup

from onpath.lessons.safe_html import safe

SYMBOLS: Mapping[str, tuple[str, str, str]] = {
    "lambda": ("λ", "", "λ"),
    "xi_1": ("ξ", "1", "ξ₁"),
    "theta": ("θ", "", "θ"),
    "theta_r": ("θ", "r", "θᵣ"),
    "e": ("e", "", ""),
    "d": ("d", "", ""),
    "y": ("y", "", ""),
    "sigma": ("σ", "", "σ"),
    "N": ("N", "", ""),
    "T": ("T", "", ""),
    "F": ("F", "", ""),
    "q_1": ("q", "1", "q₁"),
    "q_2": ("q", "2", "q₂"),
    "delta": ("δ", "", "δ"),
    "rho": ("ρ", "", "ρ"),
    **{f"K_{i}": ("K", str(i), f"K{i}") for i in range(1, 6)},
}
"""Name -> letter and index in a formula, and how it is written in a text. A Latin letter alone
could be a word there, so it is marked only where it is emphasised: `*e*`."""
MATH = re.compile(r"<math[^>]*>.*?</math>", re.DOTALL)
TAG = re.compile(r"(<[^>]*>)")
XMLNS = ' xmlns="http://www.w3.org/1998/Math/MathML"'
DOTS = "[\u0300-\u036f]*"  # combining dots of a rate
LEFT_OUT = ("code", "pre", "a", "summary")
"""Elements whose words are not marked: they are no quantities, or can be pressed."""


def symbol_faults(names: Iterable[str]) -> Iterator[str]:
    """The faults of the symbols that a lesson names."""
    for name in names:
        if name not in SYMBOLS:
            near = get_close_matches(name, SYMBOLS, 1)
            hint = f"did you mean {near[0]}?" if near else f"one of {', '.join(SYMBOLS)}"
            yield f"symbol {name!r}: {hint}"


@lru_cache(maxsize=1024)
def marked_symbols(html: Markup, names: tuple[str, ...]) -> Markup:
    """A safe text in which the places of some symbols have the attribute `data-symbol`."""
    if not names or not html:
        return html
    formulas = list[str]()

    def taken(match: re.Match[str]) -> str:
        formulas.append(_marked_formula(match[0], names))
        return f"<math {len(formulas) - 1}>"

    outside = list[str]()
    without = _Words(names)
    for part in TAG.split(MATH.sub(taken, str(html))):
        is_formula = part.startswith("<math ")
        outside.append(formulas[int(part[6:-1])] if is_formula else without.marked(part))
    return safe("".join(outside))


class _Words:
    """Marks symbols in words, from the beginning of a text to its end."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self._named = {SYMBOLS[name][2]: name for name in names if SYMBOLS[name][2]}
        self._letters = {SYMBOLS[name][0]: name for name in names if not SYMBOLS[name][2]}
        written = "|".join(map(re.escape, sorted(self._named, key=len, reverse=True)))
        self._pattern = re.compile(rf"(?<!\w)({written}){DOTS}(?!\w)") if written else None
        self._open = list[str]()

    def marked(self, part: str) -> str:
        """A tag as it is, and the words between two tags with their symbols marked."""
        if part.startswith("<"):
            name = part.strip("</>").split()[0]
            if part.startswith("</"):
                if name in self._open:
                    del self._open[len(self._open) - 1 - self._open[::-1].index(name) :]
            elif name not in ("br", "hr", "img"):
                self._open.append(name)
            return part
        if any(name in LEFT_OUT for name in self._open):
            return part
        if self._open[-1:] == ["em"] and part in self._letters:
            return _span(self._letters[part], part)
        if self._pattern is None:
            return part
        return self._pattern.sub(lambda match: _span(self._named[match[1]], match[0]), part)


def _span(name: str, words: str) -> str:
    return f'<span data-symbol="{name}">{words}</span>'


def _marked_formula(mathml: str, names: tuple[str, ...]) -> str:
    formula = fromstring(mathml.replace(XMLNS, "", 1).replace("&nbsp;", "\u00a0"))
    _mark(formula, {SYMBOLS[name][:2]: name for name in names})
    return tostring(formula, encoding="unicode").replace("<math", f"<math{XMLNS}", 1)


def _mark(element: Element, names: Mapping[tuple[str, str], str]) -> None:
    """Mark the symbols in a formula; a letter with another index is another quantity."""
    if element.tag in ("msub", "msubsup"):
        key = "".join(element[0].itertext())[:1], "".join(element[1].itertext())
        if key in names:
            element.set("data-symbol", names[key])
        return
    if element.tag == "mi":
        key = element.text or "", ""
        if key in names and "mathvariant" not in element.attrib:
            element.set("data-symbol", names[key])
        return
    if element.tag == "msup" and element[0].text == "e" and not _is_power(element[1]):
        return _mark(element[1], names)
    for part in element:
        _mark(part, names)


def _is_power(exponent: Element) -> bool:
    """Whether an exponent is a number or a sign; with any other, e is Euler's number."""
    return not any(letter.isalpha() for letter in "".join(exponent.itertext()))
