"""Formulas read from untrusted text: what is read means what Python means; all else is refused."""

from __future__ import annotations

import ast
import gc
import math
import string
import sys
import threading
from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from onpath.models.control.laws import expressions
from onpath.models.control.laws.expressions import FUNCTIONS, LONGEST, Formulas, read
from onpath.models.control.laws.own import own_law
from onpath.models.control.laws.registry import law_name
from onpath.models.errors import CodedError

NAMES: tuple[str, ...] = ("xi", "dxi", "theta", "dtheta", "e1", "speed", "t", "K1", "K5")
TARGETS = ("across", "along", "u1", "u2")
VALID = (
    "across = -K1*xi - K2*dxi\nalong = -K5*(dtheta - speed)".replace("K2", "K5"),
    "u1 = sin(t)**2; u2 = min(xi, dxi, 3) if not xi > 0 and t != 1 or theta <= 2 else .5e-1",
    "across = tanh(abs(sqrt(sign(max(xi, +1)))))/2",
)
MEANINGS: dict[str, object] = {
    "sin": math.sin,
    "cos": math.cos,
    "sqrt": math.sqrt,
    "tanh": math.tanh,
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
}


def refusal(text: str) -> CodedError:
    with pytest.raises(CodedError) as refused:
        read(text, NAMES, TARGETS)
    return refused.value


def values_of(formulas: Formulas, numbers: Mapping[str, float]) -> dict[str, float]:
    results = formulas({name: ca.SX(numbers[name]) for name in NAMES})
    return {name: float(result) for name, result in results.items()}


# What is read has Python's meaning.


LEAVES = (*NAMES, "0", "1", "2.5", ".5", "3e-2", "1E1", "400.")
ONE = [name for name, (count, _) in FUNCTIONS.items() if count == 1]


@st.composite
def made(draw: st.DrawFn, deep: int = 4) -> str:
    """An expression, with parts that are nested at most `deep` deep."""
    if deep == 0 or draw(st.integers(0, 3)) == 0:
        return draw(st.sampled_from(LEAVES))
    form = draw(st.sampled_from(FORMS))
    parts = [draw(made(deep - 1)) for _ in range(form.count("{}"))]
    return form.format(
        *parts,
        f=draw(st.sampled_from(ONE)),
        m=draw(st.sampled_from(["min", "max"])),
        o=draw(st.sampled_from("+-*/")),
        n=draw(st.integers(0, 4)),
        c=draw(st.sampled_from(["<", "<=", ">", ">=", "==", "!="])),
        b=draw(st.sampled_from(["and", "or"])),
    )


FORMS = (
    *("{} {o} {}", "{} {o} {}", "({} {o} {})", "-{}", "({})**{n}", "{f}({})"),
    *("{m}({}, {})", "{m}({}, {}, {})", "({} if {} {c} {} else {})"),
    *("({} if not {} {c} {} else {})", "({} if 1 < {} <= {} else {})"),
    *("({} if {} {c} {} {b} 0 != t else {})", "({} if (t > 0) {b} not {} {c} {} else {})"),
)


def pythons(text: str, numbers: Mapping[str, float]) -> float:
    """The value by Python's own evaluation; NaN where it refuses."""
    try:
        value = complex(eval(text, {"__builtins__": {}, **MEANINGS}, dict(numbers)))
    except (ValueError, ArithmeticError):
        return math.nan
    return value.real if value.imag == 0 else math.nan


@pytest.mark.thorough
@given(made(), st.integers(0, 2**32 - 1))
@example("-xi**2", 0)
@example("xi - dxi - theta / e1 / speed", 1)
@example("( xi if 0 < xi <= 3 else -1 )", 2)
def test_a_formula_has_the_value_that_python_gives_it(text: str, seed: int) -> None:
    assume(len(text) < LONGEST - 9)
    drawn = np.random.default_rng(seed).uniform(-2, 2, len(NAMES))
    numbers = dict(zip(NAMES, drawn.tolist(), strict=True))
    wanted = pythons(text, numbers)
    nearby = [pythons(text, {n: x * (1 + f) for n, x in numbers.items()}) for f in (1e-9, -1e-9)]
    assume(math.isfinite(wanted))
    assume(nearby == pytest.approx([wanted] * 2, rel=1e-6, abs=1e-6))  # not at a jump or pole
    try:
        formulas = read(f"across = {text}", NAMES, TARGETS)
    except CodedError as error:  # a part that is not used is 1/0, or there are too many parts
        reason = error.message.arguments["reason"]
        assert getattr(reason, "code", "") in ("error.law_not_finite", "error.law_too_complex")
        assume(False)
    assert values_of(formulas, numbers)["across"] == pytest.approx(wanted, rel=1e-6, abs=1e-6)


def test_lines_are_separated_by_breaks_or_semicolons() -> None:
    numbers = dict.fromkeys(NAMES, 2.0)
    for text in (
        "across = xi\nalong = t*3",
        "across=xi;along=t*3",
        ";\r\n across =xi\r\n;along= t*3;\n",
    ):
        formulas = read(text, NAMES, TARGETS)
        assert formulas.targets == ("across", "along") and formulas.names == ("xi", "t")
        assert values_of(formulas, numbers) == {"across": 2.0, "along": 6.0}


def test_the_minus_of_a_typesetter_is_a_minus() -> None:
    typed, plain = (read(text, NAMES, TARGETS) for text in ("u1 = 3 − −xi\n", "u1 = 3 - -xi\n"))
    numbers = dict.fromkeys(NAMES, 0.7)
    assert values_of(typed, numbers) == values_of(plain, numbers) == {"u1": 3.7}
    assert own_law("across = −xi; along = 0").gains == ()
    assert law_name("across = −xi\nalong = 0") == "across = -xi; along = 0"


def test_nothing_is_a_law_without_lines() -> None:
    assert read(" \n;\t", NAMES, TARGETS).targets == ()


# Everything else is refused with a place and a reason.


@pytest.mark.parametrize(
    ("text", "line", "column", "said"),
    [
        ("across = -K1*xii", 1, 14, "there is no 'xii': did you mean xi?"),
        ("across = -k1*xi", 1, 11, "there is no 'k1': did you mean K1?"),
        ("across = xi\nalong = dthetta", 2, 9, "there is no 'dthetta': did you mean dtheta?"),
        ("across = xi;  along = Speed", 1, 23, "did you mean speed?"),
        ("across = qqqq", 1, 10, "there are xi, dxi"),
        ("acros = xi", 1, 1, "there is no 'acros': did you mean across?"),
        ("  xi + 3", 1, 3, "a line begins with one of across, along, u1, u2, and then ="),
        ("across", 1, 1, "a line begins with"),
        ("across == xi", 1, 1, "a line begins with"),
        ("across = 1\nacross = 2", 2, 1, "there is a line for across already"),
        ("across = xi^2", 1, 12, "write ** instead of '^'"),
        ("across = 2·xi", 1, 11, "write * instead of '·'"),
        ("across = –xi", 1, 10, "write - instead of '–'"),
        ("across = −K1*xi\nalong = 0,5*speed", 2, 9, "write 0.5 instead of '0,5'"),
        ("across = xi, 5", 1, 12, "something is missing"),
        ("across = 2xi", 1, 10, "'2xi' is not a number"),
        ("across = 0x10", 1, 10, "'0x10' is not a number"),
        ("across = 1_000", 1, 10, "is not a number"),
        ("across = 1j", 1, 10, "is not a number"),
        ("across = 1.2.3", 1, 10, "is not a number"),
        ("across = 1e400", 1, 10, "a number is at most 1e+12"),
        ("across = " + "9" * 400, 1, 10, "a number is at most 1e+12"),
        ("across = 1/0", 1, 10, "this is not a finite number"),
        ("across = xi + sqrt(-1)", 1, 15, "this is not a finite number"),
        ("across = 1e12**4", 1, 10, None),
        ("across = 9**9**9", 1, 13, "an exponent is a whole number from 0 to 4"),
        ("across = xi**5", 1, 14, "an exponent"),
        ("across = xi**0.5", 1, 14, "an exponent"),
        ("across = xi**-1", 1, 14, "an exponent"),
        ("across = xi**True", 1, 14, "there is no 'True'"),
        ("across = xi**xi", 1, 14, "an exponent"),
        ("across = sin", 1, 10, "sin is a function: write sin(…)"),
        ("across = sin(xi, xi)", 1, 10, "sin takes one value in its brackets"),
        ("across = sin()", 1, 10, "sin takes one value in its brackets"),
        ("across = min(xi)", 1, 10, "min takes 2 values or more in its brackets"),
        ("across = K1(xi)", 1, 10, "K1 is not a function"),
        ("across = sin(xi)(xi)", 1, 10, "something is missing or out of place here"),
        ("across = sin(*xi)", 1, 14, "something is missing or out of place here"),
        ("across = xi < 3", 1, 10, "a comparison stands only in a condition"),
        ("across = not xi", 1, 10, "a comparison stands only in a condition"),
        ("across = 1 if xi else 2", 1, 15, "a condition compares, such as xi > 0"),
        ("across = 1 if xi < 1", 1, 10, "something is missing or out of place here"),
        ("across = (xi", 1, 10, "something is missing or out of place here"),
        ("across = xi)", 1, 12, "something is missing or out of place here"),
        ("across = 1) + (xi", 1, 11, "something is missing or out of place here"),
        ("across = ", 1, 10, "something is missing or out of place here"),
        ("across = xi dxi", 1, None, "something is missing or out of place here"),
        ("across = (xi, dxi)", 1, 10, "something is missing or out of place here"),
        ("across = xi // 2", 1, 10, "something is missing or out of place here"),
        ("across = 007", 1, None, "something is missing or out of place here"),
        ("across = xi = 3", 1, 13, "'=' means nothing here"),
        ("across = sin(xi=3)", 1, 16, "'=' means nothing here"),
        ("across = (t := xi)", 1, 13, "':' means nothing here"),
        ("across = lambda: xi", 1, 10, "there is no 'lambda'"),
        ("across = [xi]", 1, 10, "'[' means nothing here"),
        ("across = xi.real", 1, 12, "'.' means nothing here"),
        ("across = xi.__class__", 1, 12, "'.' means nothing here"),
        ("across = f'{xi}'", 1, 10, "there is no 'f'"),
        ("across = 'a'", 1, 10, '"\'" means nothing here'),
        ("across = __import__('os')", 1, 10, "there is no '__import__'"),
        ("across = open(xi)", 1, 10, "there is no 'open'"),
        ("across = yield", 1, 10, "there is no 'yield'"),
        ("across = xi in dxi", 1, 13, "there is no 'in'"),
        ("across = xi is dxi", 1, 13, "there is no 'is'"),
        ("across = xi # note", 1, 13, "'#' means nothing here"),
        ("across = xi\\\n+ 3", 1, 12, "means nothing here"),
        ("across = \x00", 1, 10, "U+0000 means nothing here"),
        ("across = \ufeffxi", 1, 10, "U+FEFF means nothing here"),
        ("across = хi", 1, 10, "'х' means nothing here"),  # Cyrillic
        ("across = ｘi", 1, 10, "'ｘ' means nothing here"),  # Python itself would read xi
        ("across = ٣", 1, 10, "'٣' means nothing here"),  # a digit, but not one of ours
        ("acroSS = xi", 1, 1, "did you mean across?"),
        ("__class__ = xi", 1, 1, "there is no '__class__'"),
        ("across = xi\x0balong = xi", 1, 12, "U+000B means nothing here"),
        ("across = xi\u2028along = xi", 1, 12, "U+2028 means nothing here"),
        ("across = " + "-" * 480 + "xi", 1, 10, "the law is too complicated"),
        ("across = " + "xi+" * 150 + "xi", 1, 10, "the law is too complicated"),
        ("across = " + "sin(" * 70 + "xi" + ")" * 70, 1, None, "the law is too complicated"),
        ("across = 1 if " + "not " * 90 + "xi > 0 else 2", 1, None, "the law is too complicated"),
        ("across = " + "(" * 240 + "xi" + ")" * 240, 1, None, None),
    ],
)
def test_a_refusal_names_the_place_and_the_reason(
    text: str, line: int, column: int | None, said: str | None
) -> None:
    if said is None:  # either answer will do, as long as there is one
        assert isinstance(outcome(text), Formulas | CodedError)
        return
    error = refusal(text)
    assert error.message.code == "error.law"
    assert said in str(error)
    assert error.message.arguments["line"] == line
    assert column is None or error.message.arguments["column"] == column


def test_a_text_that_is_too_long_is_not_even_looked_at() -> None:
    for text in ("across = " + "xi+" * 200 + "xi", "(" * 10_000_000, "\x00" * 10_000_000):
        assert refusal(text).message.code == "error.law_too_long"


def test_the_longest_law_is_read() -> None:
    text = "across = xi" + " " * (LONGEST - 11)
    assert len(text) == LONGEST and read(text, NAMES, TARGETS).targets == ("across",)
    assert refusal(text + " ").message.code == "error.law_too_long"


def test_deep_nesting_is_refused_even_when_the_stack_is_nearly_full() -> None:
    """A law is read at any depth of calls, or refused with a code; nothing breaks."""
    text = "across = " + "sin(" * 50 + "xi" + ")" * 50

    def deep(frames: int) -> Formulas | CodedError:
        if frames:
            return deep(frames - 1)
        try:
            return read(text, NAMES, TARGETS)
        except CodedError as error:
            return error

    def called(frames: int) -> None:
        try:
            found.append(deep(frames))
        except RecursionError as error:
            found.append(error)

    found = list[object]()
    for frames in range(0, sys.getrecursionlimit() - 80, 20):
        thread = threading.Thread(target=called, args=(frames,))  # each with a stack of its own
        thread.start()
        thread.join()
    assert isinstance(found[0], Formulas)
    assert {type(each) for each in found} == {Formulas, CodedError}


def test_a_law_is_read_while_another_thread_reads_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python 3.11.7 raises `SystemError` then, from `ast.parse`."""

    def read_another(phase: str, _: object) -> None:
        if phase == "start" and not meanwhile:
            other = threading.Thread(target=lambda: meanwhile.append(outcome(VALID[0])))
            other.start()
            other.join()

    def interrupted(text: str, mode: str) -> ast.AST:
        monkeypatch.undo()
        gc.callbacks.append(read_another)
        gc.set_threshold(1)  # a collection, and with it the other thread, amid making the tree
        try:
            return ast.parse(text, mode=mode)
        finally:
            gc.set_threshold(*before)
            gc.callbacks.remove(read_another)

    meanwhile, before = list[object](), gc.get_threshold()
    monkeypatch.setattr(ast, "parse", interrupted)
    assert {type(each) for each in (outcome(VALID[1]), *meanwhile)} == {Formulas} and meanwhile


# Fuzz: whatever the text is, there is a law or a refusal with a code.


def outcome(text: str) -> Formulas | CodedError:
    try:
        formulas = read(text, NAMES, TARGETS)
    except CodedError as error:
        assert error.message.code in ("error.law", "error.law_too_long") and str(error)
        if error.message.code == "error.law":
            line, column = (error.message.arguments[n] for n in ("line", "column"))
            assert isinstance(line, int) and 1 <= line <= text.count("\n") + 1
            own = text.split("\n")[line - 1]
            assert isinstance(column, int) and 1 <= column <= len(own) + 1
        return error
    assert set(formulas.targets) <= set(TARGETS) and set(formulas.names) <= set(NAMES)
    values_of(formulas, dict.fromkeys(NAMES, 0.5))
    return formulas


TOKENS = (
    *NAMES,
    *FUNCTIONS,
    *("across", "along", "=", "==", "!=", "<", "<=", "+", "-", "*", "/", "**", "//", "%", "@"),
    *("(", ")", ",", ";", "\n", " ", "if", "else", "and", "or", "not", "in", "is", "lambda", ":"),
    *(
        "1",
        "2.5",
        "1e9",
        "0",
        "9" * 30,
        "0x1f",
        "1j",
        "'",
        '"',
        "f'",
        "[",
        "]",
        "{",
        "}",
        ".",
        "\\",
    ),
    *("None", "True", "await", "for", "yield", "_", "__", ":=", "->", "~", "&", "#", "ξ", "\x00"),
)


@given(st.text(max_size=LONGEST + 5))
@example("across=1;along=\x0c1")
def test_random_text_is_a_law_or_is_refused(text: str) -> None:
    outcome(text)


@given(st.text(string.printable, max_size=60), st.sampled_from(["across=", "u1 = ", ""]))
def test_printable_text_is_a_law_or_is_refused(text: str, head: str) -> None:
    outcome(head + text)


@given(st.lists(st.sampled_from(TOKENS), max_size=80), st.sampled_from(["", " "]))
def test_a_soup_of_tokens_is_a_law_or_is_refused(tokens: list[str], between: str) -> None:
    outcome("across =" + between.join(tokens))


@given(
    st.sampled_from(VALID),
    st.lists(
        st.tuples(
            st.integers(0, 100), st.integers(0, 3), st.sampled_from(TOKENS) | st.characters()
        ),
        min_size=1,
        max_size=4,
    ),
)
def test_a_valid_law_with_a_few_changes_is_a_law_or_is_refused(
    text: str, changes: list[tuple[int, int, str]]
) -> None:
    for at, removed, added in changes:
        text = text[:at] + added + text[at + removed :]
    outcome(text)


@pytest.mark.parametrize("text", VALID)
def test_the_laws_that_are_changed_are_valid(text: str) -> None:
    assert isinstance(outcome(text), Formulas)


def test_nothing_of_a_text_is_executed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The text is parsed by `ast.parse` alone, which does not compile it."""
    seen = list[tuple[str, str]]()
    parse: Callable[..., object] = expressions.ast.parse

    def watched(text: str, mode: str) -> object:
        seen.append((text, mode))
        return parse(text, mode=mode)

    monkeypatch.setattr(expressions.ast, "parse", watched)
    for text in (
        *VALID,
        "across = __import__('os').system('true')",
        "across = xi.a; along = f'{xi}'",
    ):
        outcome(text)
    assert seen and {mode for _, mode in seen} == {"eval"}
    allowed = set(string.ascii_letters + string.digits + "_ .,+-*/()<>=!\t\r")
    assert all(set(text) <= allowed for text, _ in seen)
