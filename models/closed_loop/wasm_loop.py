"""Translates kernels and other CasADi functions to WebAssembly, for pages without a server.

The scalar instructions are translated one by one, like those of `translated_loop.py`; see
`operations.py`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import casadi as ca

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.operations import MATHEMATICS, OPERATIONS, no_translation
from onpath.models.closed_loop.wasm_module import Part, WasmFunction, wasm_module
from onpath.models.paths.projection import windowed
from onpath.models.paths.spline_curves import WINDOW

DOUBLE = 8  # bytes
_CODES = {code: each.wasm.split() for code, each in OPERATIONS.items() if each.wasm}
_PLACES = (ca.OP_CONST, ca.OP_INPUT, ca.OP_OUTPUT)  # instructions that are not operations


@dataclass(frozen=True, slots=True)
class Scan:
    """A function that is repeated along rows of numbers.

    Attributes:
        step: (state, constants, rows) -> (state, result row).
        stride: distance between the beginnings of the rows of consecutive steps, in numbers.
        where: (state, constants) -> indices of the rows at which `step` begins to read, one for
            each of its inputs from the third on; None: it has one, and reads from the first row on.
        row: numbers in a row of which `where` gives the index.
    """

    step: ca.Function
    stride: int
    where: ca.Function | None = None
    row: int = 0


def wasm_of(
    functions: Mapping[str, ca.Function],
    loops: Mapping[str, Kernel],
    scans: Mapping[str, Scan] = MappingProxyType({}),
) -> bytes:
    """A module of functions on doubles in memory.

    A function takes the addresses of its inputs, then of its outputs, all dense matrices stored by
    columns. A loop takes (state, settings, curve table, log, ticks): it advances the state and
    writes a row of the log for each of the ticks. It needs the state's leading `Kernel.changed`
    numbers only, and at least one tick. A scan takes (state, constants, rows, results, steps), at
    least one step; results may be the rows themselves.

    Raises:
        CodedError: an operation has no translation; the message names it and its law or function.
    """
    repeated = {name: _loop(kernel) for name, kernel in loops.items()} | dict(scans)
    laws = {name: kernel.law for name, kernel in loops.items()}  # their faults are reported first
    steps = {
        name: _translated(f"{name}.step", scan.step, laws.get(name, name))
        for name, scan in repeated.items()
    }
    translated = [_translated(name, function, name) for name, function in functions.items()]
    for name, scan in repeated.items():
        number = len(MATHEMATICS) + len(translated)
        translated.append(steps[name])
        if scan.where is not None:
            translated.append(_translated(f"{name}.where", scan.where, laws.get(name, name)))
        translated.append(_repeated(name, number, scan))
    return wasm_module(translated)


def _loop(kernel: Kernel) -> Scan:
    """The ticks of a kernel, with the curve's product in them. A spline is read from a piece on."""
    state, settings = (ca.SX.sym("given", *kernel.advance.size_in(i)) for i in (0, 1))
    basis, *pieces = kernel.basis.call([state, settings])
    if not kernel.spline:
        tables = [ca.SX.sym("curve", *kernel.table_shape)]
        values = tables[0] @ basis
    else:
        size = kernel.table_shape[0], WINDOW
        tables = [ca.SX.sym("window", *size) for _ in range(pieces[0].numel())]
        values = windowed(tables, basis)
    after, row, *_ = kernel.advance.call([state, settings, values])
    step = ca.Function("tick", [state, settings, *tables], [after, row])
    if not kernel.spline:
        return Scan(step, 0)
    where = ca.Function("where", [state, settings], pieces)
    return Scan(step, 0, where=where, row=kernel.table_shape[0])


def _translated(name: str, function: ca.Function, owner: str) -> WasmFunction:
    """Translate a function. All inputs are read before any output is written: they may overlap.

    A value that is used once is computed in place; all others are kept in local variables.

    Args:
        owner: name of the law or function, for messages.
    """
    for i in range(function.n_instructions()):
        if (code := function.instruction_id(i)) not in (*_PLACES, *_CODES):
            raise no_translation(owner, code, "WebAssembly")
    inputs = function.n_in()
    pointers, uses = inputs + function.n_out(), _uses(function)
    values, body = dict[int, list[Part]](), list[Part]()
    results, stores, numbers = list[Part](), list[Part](), 0
    for i in range(function.n_instructions()):
        code, into = function.instruction_id(i), function.instruction_output(i)
        operands = function.instruction_input(i)
        if code == ca.OP_CONST:
            values[into[0]] = [("f64.const", function.instruction_constant(i))]
            continue
        if code == ca.OP_OUTPUT:
            results += [("local.get", inputs + into[0]), *values[operands[0]]]
            stores.append(("f64.store", DOUBLE * into[1]))
            continue
        if code == ca.OP_INPUT:
            found: list[Part] = [("local.get", operands[0]), ("f64.load", DOUBLE * operands[1])]
        else:
            found = _filled(code, [values[operand] for operand in operands])
        if uses[i] > 1:
            index, numbers = pointers + numbers, numbers + 1
            body += [*found, ("local.set", index)]
            found = [("local.get", index)]
        values[into[0]] = found
    return WasmFunction(name, pointers, numbers, [*body, *results, *reversed(stores)])


def _filled(code: int, operands: list[list[Part]]) -> list[Part]:
    """The stack code of an operation on operands."""
    result = list[Part]()
    for word in _CODES[code]:
        if word.isdigit():
            result += operands[int(word)]
        elif word[0] == "=":
            result.append(("f64.const", float(word[1:])))
        else:
            called = word in MATHEMATICS
            result.append(("call", MATHEMATICS.index(word)) if called else word)
    return result


def _uses(function: ca.Function) -> Counter[int]:
    """Number of an instruction -> how often its result is used."""
    made, uses = dict[int, int](), Counter[int]()  # register -> the instruction that made it
    for i in range(function.n_instructions()):
        code, operands = function.instruction_id(i), function.instruction_input(i)
        if code == ca.OP_OUTPUT:
            uses[made[operands[0]]] += 1
            continue
        if code not in _PLACES:
            uses.update(made[operands[int(word)]] for word in _CODES[code] if word.isdigit())
        made[function.instruction_output(i)[0]] = i
    return uses


def _repeated(name: str, step: int, scan: Scan) -> WasmFunction:
    """The loop that calls the function `step` repeatedly, see `wasm_of`."""
    state, constants, rows, results, left = (("local.get", i) for i in range(5))
    each: list[Part] = [state, constants, rows, state, results, ("call", step)]
    if scan.where is not None:  # the row of results, not yet written, holds the indices
        each = [state, constants, results, ("call", step + 1), state, constants]
        for k in range(scan.where.numel_out(0)):
            index: list[Part] = [results, ("f64.load", DOUBLE * k), "i32.trunc_f64_s"]
            each += [rows, *index, ("i32.const", DOUBLE * scan.row), "i32.mul", "i32.add"]
        each += [state, results, ("call", step)]
    on = list[Part]()
    for pointer, numbers in ((2, scan.stride), (3, scan.step.numel_out(1))):
        if numbers:
            by = [("i32.const", DOUBLE * numbers), "i32.add", ("local.set", pointer)]
            on += [("local.get", pointer), *by]
    count = [left, ("i32.const", 1), "i32.sub", ("local.set", 4)]
    again = [left, ("i32.const", 0), "i32.gt_s", ("br_if", 0)]
    return WasmFunction(name, 5, 0, ["loop", *each, *on, *count, *again, "end"])
