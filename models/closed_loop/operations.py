"""CasADi's scalar operations in the languages to which loops are translated.

In LLVM and C each gives the same bits as in CasADi's virtual machine, since all call the same C
library.
In WebAssembly all but the functions of `LIBRARY` do; those are the browser's, and may differ in the
last bit, hypot in the last two. `fmod` and `remainder` are exact everywhere.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

import casadi as ca

from onpath.models.errors import CodedError


@dataclass(frozen=True, slots=True)
class Operation:
    """An operation in all three languages.

    Attributes:
        llvm: instructions; {0} and {1} are the operands, {v} is the result.
        wasm: stack code; 0 and 1 are the operands, =x is a constant. Empty: there is none.
        c: an expression in C99; {0} and {1} are the operands.
    """

    llvm: str
    wasm: str
    c: str

    @property
    def operands(self) -> int:
        """Number of operands, one or two."""
        return 2 if "{1}" in self.llvm else 1


_CIRCULAR = ("sin", "cos", "tan", "asin", "acos", "atan")
_OTHERS = ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "expm1", "log1p", "erf")
_OF_TWO = ("atan2", "pow", "hypot", "fmod", "remainder")
LIBRARY = {**{name: 1 for name in (*_CIRCULAR, *_OTHERS)}, **{name: 2 for name in _OF_TWO}}
"""Function of the C library -> number of its arguments."""
MATHEMATICS = tuple(name for name in LIBRARY if name != "erf")
"""The functions that a page provides to WebAssembly: assets/web/simulation/mathematics.ts."""


def _called(name: str) -> Operation:
    """A call of a function of the library."""
    operands = range(LIBRARY[name])
    given = ", ".join(f"double {{{i}}}" for i in operands)
    stack = " ".join([*map(str, operands), name]) if name in MATHEMATICS else ""
    arguments = ", ".join(f"{{{i}}}" for i in operands)
    return Operation(f"{{v}} = call double @{name}({given})", stack, f"{name}({arguments})")


def _rounded(name: str, wasm: str) -> Operation:
    """An operation of one operand that is exact, or rounded in the only right way."""
    return Operation(f"{{v}} = call double @llvm.{name}.f64(double {{0}})", wasm, f"{name}({{0}})")


def _compared(llvm: str, wasm: str, c: str) -> Operation:
    """A comparison, 0 or 1."""
    truth = f"{{v}}.is = fcmp {llvm}\n  {{v}} = uitofp i1 {{v}}.is to double"
    return Operation(truth, f"{wasm} f64.convert_i32_u", f"{c} ? 1.0 : 0.0")


def _connected(word: str) -> Operation:
    """Two operands connected by "and" or "or"; all numbers but 0 are true, and so is NaN."""
    llvm = [f"{{v}}.{i} = fcmp une double {{{i}}}, 0.0" for i in (0, 1)]
    llvm += [f"{{v}}.is = {word} i1 {{v}}.0, {{v}}.1", "{v} = uitofp i1 {v}.is to double"]
    c = f"({{0}} != 0.0) {_IN_C[word]} ({{1}} != 0.0) ? 1.0 : 0.0"
    return Operation("\n  ".join(llvm), f"0 =0 f64.ne 1 =0 f64.ne i32.{word} f64.convert_i32_u", c)


_IN_C = {"and": "&&", "or": "||"}
_SIGN = """{v}.up = fcmp ogt double {0}, 0.0
  {v}.down = fcmp olt double {0}, 0.0
  {v}.not = select i1 {v}.up, double 1.0, double {0}
  {v} = select i1 {v}.down, double -1.0, double {v}.not"""
_IF_ELSE_ZERO = """{v}.is = fcmp une double {0}, 0.0
  {v} = select i1 {v}.is, double {1}, double 0.0"""

OPERATIONS = {
    ca.OP_ADD: Operation("{v} = fadd double {0}, {1}", "0 1 f64.add", "{0} + {1}"),
    ca.OP_SUB: Operation("{v} = fsub double {0}, {1}", "0 1 f64.sub", "{0} - {1}"),
    ca.OP_MUL: Operation("{v} = fmul double {0}, {1}", "0 1 f64.mul", "{0} * {1}"),
    ca.OP_DIV: Operation("{v} = fdiv double {0}, {1}", "0 1 f64.div", "{0} / {1}"),
    ca.OP_NEG: Operation("{v} = fneg double {0}", "0 f64.neg", "-{0}"),
    ca.OP_INV: Operation("{v} = fdiv double 1.0, {0}", "=1 0 f64.div", "1.0 / {0}"),
    ca.OP_SQ: Operation("{v} = fmul double {0}, {0}", "0 0 f64.mul", "{0} * {0}"),
    ca.OP_TWICE: Operation("{v} = fadd double {0}, {0}", "0 0 f64.add", "{0} + {0}"),
    ca.OP_SQRT: _rounded("sqrt", "0 f64.sqrt"),
    ca.OP_FABS: _rounded("fabs", "0 f64.abs"),
    ca.OP_FLOOR: _rounded("floor", "0 f64.floor"),
    ca.OP_CEIL: _rounded("ceil", "0 f64.ceil"),
    ca.OP_COPYSIGN: Operation(
        "{v} = call double @llvm.copysign.f64(double {0}, double {1})",
        "0 1 f64.copysign",
        "copysign({0}, {1})",
    ),
    ca.OP_SIGN: Operation(
        _SIGN,
        "=-1 =1 0 =0 0 f64.lt select 0 =0 f64.lt select",
        "{0} > 0.0 ? 1.0 : {0} < 0.0 ? -1.0 : {0}",
    ),
    # of a NaN and a number, the number; of equal ones, the first
    ca.OP_FMIN: Operation(
        "{v} = call double @llvm.minnum.f64(double {0}, double {1})",
        "0 1 0 1 f64.le 1 1 f64.ne i32.or select",
        "{0} <= {1} || {1} != {1} ? {0} : {1}",
    ),
    ca.OP_FMAX: Operation(
        "{v} = call double @llvm.maxnum.f64(double {0}, double {1})",
        "0 1 1 0 f64.le 1 1 f64.ne i32.or select",
        "{0} >= {1} || {1} != {1} ? {0} : {1}",
    ),
    ca.OP_LT: _compared("olt double {0}, {1}", "0 1 f64.lt", "{0} < {1}"),
    ca.OP_LE: _compared("ole double {0}, {1}", "0 1 f64.le", "{0} <= {1}"),
    ca.OP_EQ: _compared("oeq double {0}, {1}", "0 1 f64.eq", "{0} == {1}"),
    ca.OP_NE: _compared("une double {0}, {1}", "0 1 f64.ne", "{0} != {1}"),
    ca.OP_NOT: _compared("oeq double {0}, 0.0", "0 =0 f64.eq", "{0} == 0.0"),
    ca.OP_AND: _connected("and"),
    ca.OP_OR: _connected("or"),
    ca.OP_IF_ELSE_ZERO: Operation(
        _IF_ELSE_ZERO, "1 =0 0 =0 f64.ne select", "{0} != 0.0 ? {1} : 0.0"
    ),
    ca.OP_CONSTPOW: _called("pow"),
    **{getattr(ca, f"OP_{name.upper()}"): _called(name) for name in LIBRARY},
}
"""CasADi's number of an operation -> the operation: all on scalars except erfinv and printme."""


CALLED = {getattr(ca, f"OP_{name.upper()}"): name for name in LIBRARY} | {ca.OP_CONSTPOW: "pow"}
"""CasADi's number of an operation -> the function of the C library that it calls."""


@cache
def widened(llvm: str, lanes: int) -> str:
    """Instructions of an operation that calls no library, for vectors of so many numbers."""
    if lanes == 1:
        return llvm
    wide = llvm.replace("double", f"<{lanes} x double>").replace(".f64(", f".v{lanes}f64(")
    wide = re.sub(r"\bi1\b", f"<{lanes} x i1>", wide)
    return re.sub(r"(?<=[ ])-?[01]\.0\b", r"splat (double \g<0>)", wide)


def no_translation(owner: str, operation: int, target: str) -> CodedError:
    """The error of an operation that cannot be translated.

    Args:
        owner: the law or function that contains it.
        operation: its number in CasADi, one of `ca.OP_*`.
        target: language to which it would be translated.
    """
    names = (name for name, code in vars(ca).items() if name[:3] == "OP_" and code == operation)
    name = next(names, str(operation))
    return CodedError("error.no_translation", owner=owner, operation=name, target=target)
