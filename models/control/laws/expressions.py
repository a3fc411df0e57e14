"""Reads formulas that a user types, from untrusted text, as CasADi expressions.

A text has lines `name = expression`, separated by line breaks or semicolons. It is checked four
times: its length; its characters, numbers and names; the syntax tree of each expression, made by
Python's `ast`; and the form of every node of the tree. Nothing is ever executed. An error is a
`CodedError` that names the line and the column.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import reduce

import casadi as ca

from onpath.models.errors import CodedError, Message
from onpath.models.systems.parameter_specs import MINUS

LONGEST = 500  # [characters]
MOST_NODES = 200  # names, numbers and operations
DEEPEST = 60  # nesting of the syntax tree
MOST_TRIES = 20  # to make a syntax tree while other threads make theirs
LARGEST_EXPONENT = 4
LARGEST_NUMBER = 1e12
TOO_COMPLEX = Message("error.law_too_complex", {"most": MOST_NODES, "deepest": DEEPEST})


def _sign(x: ca.SX) -> ca.SX:
    return (x > 0) - (x < 0)


FUNCTIONS: Mapping[str, tuple[int, Callable[..., ca.SX]]] = {
    "sin": (1, ca.sin),
    "cos": (1, ca.cos),
    "sqrt": (1, ca.sqrt),
    "abs": (1, ca.fabs),
    "tanh": (1, ca.tanh),
    "sign": (1, _sign),
    "min": (2, ca.fmin),
    "max": (2, ca.fmax),
}
"""Name -> number of arguments (`min` and `max` also take more) and function."""

INSTEAD: Mapping[str, str] = {
    "^": "**",
    **dict.fromkeys("×·⋅", "*"),
    "÷": "/",
    "≤": "<=",
    "≥": ">=",
    "≠": "!=",
    **dict.fromkeys("\N{EN DASH}\N{EM DASH}\N{NON-BREAKING HYPHEN}", "-"),
}
"""Signs that are usual elsewhere -> their form here."""

_KEYWORDS = ("if", "else", "and", "or", "not")
_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?P<rest>[A-Za-z0-9_.]*))"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)|[ \t\r]+|\*\*|[<>=!]=|[-+*/()<>,]"
)
_HEAD = re.compile(r"[ \t\r]*(?P<name>[A-Za-z_][A-Za-z0-9_]*)[ \t\r]*=(?!=)[ \t\r]*")
_BINARY: Mapping[type[ast.operator], Callable[[ca.SX, ca.SX], ca.SX]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
_COMPARISONS: Mapping[type[ast.cmpop], Callable[[ca.SX, ca.SX], ca.SX]] = {
    ast.Lt: lambda a, b: a < b,
    ast.LtE: lambda a, b: a <= b,
    ast.Gt: lambda a, b: a > b,
    ast.GtE: lambda a, b: a >= b,
    ast.Eq: lambda a, b: a == b,
    ast.NotEq: lambda a, b: a != b,
}


@dataclass(frozen=True, slots=True)
class Formulas:
    """Formulas that have been read.

    Attributes:
        text: as typed.
        targets: names on the left-hand sides, in the order of the text.
        names: names that occur on the right-hand sides.
    """

    text: str
    targets: tuple[str, ...]
    names: tuple[str, ...]
    _function: ca.Function = field(repr=False, compare=False)

    def __call__(self, values: Mapping[str, ca.SX]) -> dict[str, ca.SX]:
        """The right-hand sides by target, each (1, 1), given every one of `names`, each (1, 1)."""
        results = self._function.call([values[name] for name in self.names])
        return dict(zip(self.targets, results, strict=True))


def read(text: str, known: Sequence[str], targets: Sequence[str]) -> Formulas:
    """Read formulas from untrusted text.

    An expression consists of numbers, known names, + - * /, ** with a whole number from 0 to 4 as
    the exponent, the `FUNCTIONS`, and `a if c else b`, where c has comparisons, `and`, `or`, `not`.

    Args:
        known: names that may occur on the right-hand sides.
        targets: names that may stand on the left-hand sides, each once.

    Raises:
        ValueError: with code "error.law", the line and the column; or "error.law_too_long".
    """
    if len(text) > LONGEST:
        raise CodedError("error.law_too_long", most=LONGEST, count=len(text))
    typed, text = text, text.replace(MINUS, "-")
    symbols = {name: ca.SX.sym(name) for name in known}
    found: dict[str, ca.SX] = {}
    trees = list[ast.expr]()
    for start, line in _lines(text):
        reader = _LineReader(text, start, symbols)
        target, tree = reader.line(line, targets, tuple(found))
        trees.append(tree)
        if sum(_size(tree) for tree in trees) > MOST_NODES:
            raise reader.error(tree.col_offset, TOO_COMPLEX)
        try:
            found[target] = reader.value(tree)
        except RecursionError:  # the caller's own calls are nested deeply
            raise reader.error(tree.col_offset, TOO_COMPLEX) from None
    used = {node.id for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Name)}
    names = tuple(name for name in known if name in used)
    function = ca.Function("formulas", [symbols[name] for name in names], list(found.values()))
    return Formulas(typed, tuple(found), names, function)


def syntax_tree(expression: str) -> ast.expr:
    """The syntax tree of one expression.

    Python 3.11.7 counts the depth of the trees of all threads together, and raises `SystemError` if
    another thread makes one at the same moment: then this function tries again.

    Raises:
        SyntaxError, ValueError, MemoryError, RecursionError: as `ast.parse`.
    """
    for _ in range(MOST_TRIES):
        with suppress(SystemError):
            return ast.parse(expression, mode="eval").body
    raise MemoryError  # refused like an expression for which Python has no memory


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """Beginning in the text, and contents, of each line that is not blank."""
    for line in re.finditer(r"[^\n;]+", text):
        if line[0].strip(" \t\r"):
            yield line.start(), line[0]


def _size(tree: ast.expr) -> int:
    return sum(isinstance(node, ast.expr) for node in ast.walk(tree))


class _LineReader:
    """Reads one line.

    Args:
        text: the whole text.
        start: the position in it at which the line begins.
        symbols: known name -> its symbol.
    """

    def __init__(self, text: str, start: int, symbols: Mapping[str, ca.SX]) -> None:
        self._text, self._start, self._symbols = text, start, symbols

    def error(self, offset: int, reason: Message) -> CodedError:
        """The error at an offset from the present start."""
        before = self._text[: self._start + offset]
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        return CodedError("error.law", line=line, column=column, reason=reason)

    def line(self, line: str, targets: Sequence[str], given: Sequence[str]) -> tuple[str, ast.expr]:
        """The target of a line, and the syntax tree of its expression."""
        head = _HEAD.match(line)
        if head is None:
            self._check_tokens(line, given=(*targets, *self._symbols))
            offset = len(line) - len(line.lstrip())
            raise self.error(
                offset, Message("error.law_without_target", {"names": ", ".join(targets)})
            )
        if head["name"] not in targets:
            raise self._unknown(head.start("name"), head["name"], targets)
        if head["name"] in given:
            raise self.error(head.start("name"), Message("error.law_twice", {"name": head["name"]}))
        self._start += head.end()
        expression = line[head.end() :].rstrip(" \t\r")
        self._check_tokens(expression, given=tuple(self._symbols))
        try:
            return head["name"], syntax_tree(expression)
        except SyntaxError as error:
            offset = min(max((error.offset or 1) - 1, 0), len(expression))
            raise self.error(offset, Message("error.law_unreadable")) from None
        except (ValueError, MemoryError, RecursionError):
            raise self.error(0, TOO_COMPLEX) from None

    def _check_tokens(self, expression: str, given: Sequence[str]) -> None:
        """Refuse unknown characters, bad numbers and unknown names."""
        known, at, depth = (*given, *FUNCTIONS), 0, 0
        while at < len(expression):
            token = _TOKEN.match(expression, at)
            depth += (expression[at] == "(") - (expression[at] == ")")
            if expression[at] == "," and not depth:
                self._refuse_comma(expression, at)
            if token is None and expression[at] in INSTEAD:
                shown, instead = repr(expression[at]), INSTEAD[expression[at]]
                raise self.error(
                    at, Message("error.law_instead", {"text": shown, "instead": instead})
                )
            if token is None:
                raise self.error(
                    at, Message("error.law_character", {"character": _shown(expression[at])})
                )
            if token["rest"]:
                raise self.error(
                    at, Message("error.law_not_a_number", {"text": repr(token[0][:20])})
                )
            if token["number"] and float(token[0]) > LARGEST_NUMBER:
                raise self.error(
                    at, Message("error.law_large_number", {"most": f"{LARGEST_NUMBER:g}"})
                )
            if token["name"] and token[0] not in (*known, *_KEYWORDS):
                raise self._unknown(at, token[0], known)
            at = token.end()

    def _refuse_comma(self, expression: str, at: int) -> None:
        """Refuse a comma that does not separate arguments, and is probably a decimal comma."""
        before, after = (
            re.search(r"[0-9]+$", expression[:at]),
            re.match("[0-9]+", expression[at + 1 :]),
        )
        if before is None or after is None:
            raise self.error(at, Message("error.law_unreadable"))
        shown, instead = f"'{before[0]},{after[0]}'", f"{before[0]}.{after[0]}"
        raise self.error(
            before.start(), Message("error.law_instead", {"text": shown, "instead": instead})
        )

    def _unknown(self, offset: int, name: str, known: Sequence[str]) -> CodedError:
        near = [other for other in known if other.lower() == name.lower()]
        near = near or get_close_matches(name[:40], known, n=1, cutoff=0.5)
        names = ", ".join(near or known)
        hint = Message("error.did_you_mean" if near else "error.there_are", {"names": names})
        return self.error(
            offset, Message("error.law_unknown_name", {"name": repr(name[:20]), "hint": hint})
        )

    def value(self, node: ast.expr, depth: int = 0) -> ca.SX:
        """The expression of a node, (1, 1)."""
        if depth > DEEPEST:
            raise self.error(node.col_offset, TOO_COMPLEX)
        value = self._value(node, depth + 1)
        if value.is_constant() and not math.isfinite(float(value)):
            raise self.error(node.col_offset, Message("error.law_not_finite"))
        return value

    def _value(self, node: ast.expr, depth: int) -> ca.SX:
        match node:
            case ast.Constant(value=int() | float() as number):
                return ca.SX(float(number))
            case ast.Name(id=name) if name in self._symbols:
                return self._symbols[name]
            case ast.Name(id=name):
                raise self.error(
                    node.col_offset, Message("error.law_function_alone", {"name": name})
                )
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.value(operand, depth)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.value(operand, depth)
            case ast.BinOp(op=ast.Pow(), left=base, right=exponent):
                return self._power(self.value(base, depth), exponent)
            case ast.BinOp(left=left, op=operation, right=right) if type(operation) in _BINARY:
                return _BINARY[type(operation)](self.value(left, depth), self.value(right, depth))
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self._call(node, name, [self.value(each, depth) for each in arguments])
            case ast.IfExp(test=test, body=yes, orelse=no):
                condition = self._condition(test, depth)
                return ca.if_else(condition, self.value(yes, depth), self.value(no, depth))
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                raise self.error(node.col_offset, Message("error.law_condition_alone"))
            case _:
                pass
        raise self.error(node.col_offset, Message("error.law_unreadable"))

    def _power(self, base: ca.SX, exponent: ast.expr) -> ca.SX:
        if isinstance(exponent, ast.Constant) and type(exponent.value) is int:
            n = exponent.value
            if 0 <= n <= LARGEST_EXPONENT:
                return reduce(lambda a, b: a * b, [base] * n, ca.SX(1))
        raise self.error(
            exponent.col_offset, Message("error.law_exponent", {"most": LARGEST_EXPONENT})
        )

    def _call(self, node: ast.Call, name: str, values: Sequence[ca.SX]) -> ca.SX:
        if name not in FUNCTIONS:
            raise self.error(node.col_offset, Message("error.law_not_a_function", {"name": name}))
        wanted, function = FUNCTIONS[name]
        if len(values) < wanted or len(values) > wanted == 1:
            raise self.error(
                node.col_offset, Message("error.law_arguments", {"name": name, "count": wanted})
            )
        return reduce(function, values) if wanted > 1 else function(*values)

    def _condition(self, node: ast.expr, depth: int) -> ca.SX:
        """1 where the condition holds, else 0."""
        if depth > DEEPEST:
            raise self.error(node.col_offset, TOO_COMPLEX)
        match node:
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return 1 - self._condition(operand, depth + 1)
            case ast.BoolOp(op=operation, values=values):
                parts = [self._condition(value, depth + 1) for value in values]
                return reduce(ca.fmin if isinstance(operation, ast.And) else ca.fmax, parts)
            case ast.Compare(left=left, ops=operations, comparators=others) if all(
                type(operation) in _COMPARISONS for operation in operations
            ):
                values = [self.value(each, depth + 1) for each in (left, *others)]
                pairs = zip(operations, values, values[1:], strict=False)
                return reduce(ca.fmin, [_COMPARISONS[type(o)](a, b) for o, a, b in pairs])
            case _:
                raise self.error(node.col_offset, Message("error.law_not_a_condition"))


def _shown(character: str) -> str:
    """A character for a message: in quotation marks if it is printable, else its number."""
    return repr(character) if character.isprintable() else f"U+{ord(character):04X}"
