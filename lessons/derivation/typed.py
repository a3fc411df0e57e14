"""Reads a formula as a student types it, perhaps on a telephone: `2K_1 sqrt(θ)/3`.

The grammar is that of typed laws (models/control/laws/expressions.py) without conditions, and with
what students write besides: products without a sign, `^` and `²`, `√`, Greek letters, subscripts,
and in some languages a decimal comma. What can be read in two ways, such as `1/2K`, is refused.
Nothing is ever executed. assets/web/lessons/typed.ts reads the same formulas.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws.expressions import FUNCTIONS, LARGEST_EXPONENT
from onpath.models.errors import CodedError, Message

LONGEST = 80  # [characters]
NUMPY = {name: getattr(np, name) for name, (count, _) in FUNCTIONS.items() if count == 1}
"""Name -> function of one argument."""
LETTERS = {
    "alpha": "α",
    "beta": "β",
    "delta": "δ",
    "epsilon": "ε",
    "eta": "η",
    "l": "ℓ",
    "lambda": "λ",
    "omega": "ω",
    "phi": "φ",
    "pi": "π",
    "psi": "ψ",
    "rho": "ρ",
    "theta": "θ",
    "xi": "ξ",
}
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
SIGNS = {
    **{sign: sign for sign in "+-*/^()√"},
    **dict.fromkeys("−–—\N{NON-BREAKING HYPHEN}", "-"),
    **dict.fromkeys("×·⋅∙", "*"),
    **dict.fromkeys("÷:", "/"),
}
"""A sign as it is typed -> what it means."""
BLANKS = (" ", "\t", "\N{NO-BREAK SPACE}")
POWERS = {"²": "^2", "³": "^3"}
STRENGTH = {"+": 1, "-": 1, "*": 2, "/": 2, "negative": 3}
"""How tightly operators bind."""

Formula = tuple[float | str, ...]
"""A formula in postfix form: numbers, names, functions, and the operators `+`, `-`, `*`, `/`,
`negative` and `^0` to `^4`."""
NAME = re.compile(r"([A-Za-z]+)([0-9]*)")
_POINT = re.compile(r"[0-9]+(?:\.[0-9]*)?|\.[0-9]+")
_COMMA = re.compile(r"[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+")


def spellings(names: Iterable[str]) -> dict[str, str]:
    """How names, functions and π may be typed -> what is meant; the longest come first.

    Args:
        names: letters, or the name of one in `LETTERS`, and digits: `K1`, `theta`.
    """
    found = dict[str, str]()
    for name in (*names, *NUMPY, "pi"):
        match = NAME.fullmatch(name)
        assert match is not None, name
        letters, digits = match[1], match[2]
        starts = (letters, LETTERS[letters]) if letters in LETTERS else (letters,)
        ends = (digits, f"_{digits}", digits.translate(SUBSCRIPTS)) if digits else ("",)
        found |= {start + end: name for start in starts for end in ends}
    return {text: found[text] for text in sorted(found, key=len, reverse=True)}


def read_formula(text: str, known: Mapping[str, str], point: str = ".") -> Formula:
    """Read a formula from untrusted text.

    Args:
        known: see `spellings`.
        point: the decimal sign of the language; a point is read in every language.

    Raises:
        CodedError: "formula.refused", with the `place` from which on it is not understood, from 1.
    """
    return _FormulaReader(text, known, point).formula()


def evaluated(formula: Formula, values: Mapping[str, Array], count: int) -> Array:
    """The values of a formula at some points, (count,); not finite where it has none.

    Args:
        values: name -> its values at the points, (count,).
    """
    stack = list[Array]()
    values = {**values, "pi": np.full(count, np.pi)}
    with np.errstate(all="ignore"):
        for item in formula:
            if isinstance(item, float | int):
                stack.append(np.full(count, item))
            elif item in values:
                stack.append(values[item])
            elif item in NUMPY:
                stack.append(NUMPY[item](stack.pop()))
            elif item == "negative":
                stack.append(-stack.pop())
            elif item.startswith("^"):
                stack.append(stack.pop() ** int(item[1:]))
            else:
                right, left = stack.pop(), stack.pop()
                stack.append(_BINARY[item](left, right))
    return stack.pop()


_BINARY = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}


class _FormulaReader:
    """Reads one formula from left to right; see `read_formula`."""

    def __init__(self, text: str, known: Mapping[str, str], point: str) -> None:
        self._text, self._known, self._at = text, known, 0
        self._number = _POINT if point == "." else _COMMA
        self._read = list[float | str]()
        self._waiting = list[str]()  # operators, functions and brackets that are still open
        self._ended = False  # whether an operand has just ended
        self._begins = True  # whether a sign may stand here
        self._power = False  # whether an exponent has just ended
        self._unclear = [False]  # in each bracket: whether a factor without a sign would be unclear

    def formula(self) -> Formula:
        """Read all of it.

        Raises:
            CodedError: see `read_formula`.
        """
        if len(self._text) > LONGEST:
            self._at = LONGEST
            raise self._refused(Message("formula.long", {"most": LONGEST}))
        while self._blanks() < len(self._text):
            self._next()
        if not self._ended:
            raise self._refused(Message("formula.missing"))
        while self._waiting:
            if self._waiting[-1] == "(":
                raise self._refused(Message("formula.bracket"))
            self._read.append(self._waiting.pop())
        return tuple(self._read)

    def _refused(self, reason: Message) -> CodedError:
        return CodedError("formula.refused", place=self._at + 1, reason=reason)

    def _blanks(self) -> int:
        while self._text[self._at : self._at + 1] in BLANKS:
            self._at += 1
        return self._at

    def _next(self) -> None:
        """Read one number, name or sign."""
        if number := self._number.match(self._text, self._at):
            if self._ended:
                raise self._refused(Message("formula.between"))
            self._operand(float(number[0].replace(",", ".")), number.end())
            return
        if typed := self._name():
            self._named(self._known[typed], self._at + len(typed))
            return
        if power := POWERS.get(self._text[self._at]):
            self._raise(power, self._at + 1)
            return
        sign = "^" if self._text.startswith("**", self._at) else SIGNS.get(self._text[self._at])
        if sign is None:
            names = ", ".join(dict.fromkeys(self._known.values()))
            raise self._refused(Message("formula.unknown", {"names": names}))
        self._sign(sign)

    def _name(self) -> str:
        """The longest known name that is typed here; with other capitals, if there is none."""
        here = self._text[self._at :]
        exact = (name for name in self._known if here.startswith(name))
        other = (name for name in self._known if here.lower().startswith(name.lower()))
        return next(exact, "") or next(other, "")

    def _operand(self, item: float | str, end: int) -> None:
        self._read.append(item)
        self._at, self._ended, self._begins, self._power = end, True, False, False

    def _named(self, name: str, end: int) -> None:
        if self._ended:
            self._factor()
        if name not in NUMPY:
            self._operand(name, end)
            return
        self._at = end
        if self._text[self._blanks() : self._at + 1] != "(":
            raise self._refused(Message("formula.function", {"name": name}))
        self._waiting.append(name)
        self._open()

    def _sign(self, sign: str) -> None:
        if sign == "(":
            if self._ended:
                self._factor()
            self._open()
        elif sign == ")":
            self._close()
        elif sign == "√":
            self._root()
        elif sign == "^":
            at = self._at + (2 if self._text[self._at] == "*" else 1)
            self._check_base()
            self._at = at
            digits = self._number.match(self._text, self._blanks())
            if digits is None or digits[0] not in map(str, range(LARGEST_EXPONENT + 1)):
                raise self._refused(Message("formula.exponent", {"most": LARGEST_EXPONENT}))
            self._raise(f"^{digits[0]}", digits.end())
        elif self._ended:
            self._unclear[-1] = sign == "/"
            self._operator(sign)
            self._at += 1
        elif self._begins and sign in "+-":
            self._waiting += ["negative"] if sign == "-" else []
            self._begins = False
            self._at += 1
        else:
            raise self._refused(Message("formula.missing"))

    def _open(self) -> None:
        self._waiting.append("(")
        self._unclear.append(False)
        self._at, self._ended, self._begins = self._at + 1, False, True

    def _close(self) -> None:
        if not self._ended:
            raise self._refused(Message("formula.missing"))
        if "(" not in self._waiting:
            raise self._refused(Message("formula.bracket"))
        while (item := self._waiting.pop()) != "(":
            self._read.append(item)
        if self._waiting and self._waiting[-1] in NUMPY:
            self._read.append(self._waiting.pop())
        self._unclear.pop()
        self._at, self._power = self._at + 1, False

    def _root(self) -> None:
        """A root of a bracket, or of a single number or name."""
        if self._ended:
            self._factor()
        self._at += 1
        if self._text[self._blanks() : self._at + 1] == "(":
            self._waiting.append("sqrt")
            self._open()
            return
        number, typed = self._number.match(self._text, self._at), self._name()
        if number is None and self._known.get(typed, "sqrt") in NUMPY:
            raise self._refused(Message("formula.function", {"name": "√"}))
        if number is not None:
            self._operand(float(number[0].replace(",", ".")), number.end())
        else:
            self._operand(self._known[typed], self._at + len(typed))
        self._read.append("sqrt")
        self._unclear[-1] = True

    def _check_base(self) -> None:
        if not self._ended:
            raise self._refused(Message("formula.missing"))
        if self._power:
            raise self._refused(Message("formula.unclear"))

    def _raise(self, power: str, end: int) -> None:
        """A power of what has just ended."""
        self._check_base()
        self._read.append(power)
        self._at, self._power = end, True

    def _factor(self) -> None:
        """A factor begins here without a sign before it."""
        if self._unclear[-1]:
            raise self._refused(Message("formula.unclear"))
        self._operator("*")

    def _operator(self, sign: str) -> None:
        while self._waiting and STRENGTH.get(self._waiting[-1], 0) >= STRENGTH[sign]:
            self._read.append(self._waiting.pop())
        self._waiting.append(sign)
        self._ended = self._begins = self._power = False
