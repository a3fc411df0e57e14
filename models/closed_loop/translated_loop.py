"""Compiles a kernel to machine code in this process, with LLVM.

The scalar instructions of a tick are translated one by one to LLVM's intermediate language. The
product of the curve's table and its basis functions, up to half of all operations, uses vector
instructions, which sum the rows of the table in parallel. Each operation rounds exactly as
in CasADi's virtual machine, and sums are taken in its order, so that both loops agree bit by bit.

A batch advances 4 or 8 robots with the same instructions, whose numbers are vectors with one lane
for each robot. It calls sin, cos and so on of glibc's libmvec, whose last bits differ, and those
that libmvec lacks lane by lane.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Sequence
from functools import cache
from math import prod
from typing import TYPE_CHECKING

import casadi as ca

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import (
    BatchedLoop,
    CompiledLoop,
    InterpretedLoop,
    Loop,
    ManyLoop,
)
from onpath.models.closed_loop.operations import (
    CALLED,
    LIBRARY,
    OPERATIONS,
    no_translation,
    widened,
)
from onpath.models.errors import CodedError
from onpath.models.paths.curves import ORDERS
from onpath.models.paths.spline_curves import WINDOW

if TYPE_CHECKING:
    from llvmlite.binding import TargetMachine

VECTOR_LIBRARY = "libmvec.so.1"
PREFIXES = {4: "_ZGVdN4", 8: "_ZGVeN8"}  # of its functions, for AVX2 and AVX-512
WIDE = '"min-legal-vector-width"="512"'  # passes eight lanes in one register, as the library does

_LOOP = """
{library}

define internal void @one_robot(ptr noalias %settings, ptr noalias %curve, ptr noalias %state,
                                ptr noalias %log, i64 %ticks) {attributes} {{
before:
  %basis = alloca [{basis} x double], align 64
  %values = alloca [{values} x double], align 64
  %pieces = alloca [{columns} x double], align 64
  %any = icmp sgt i64 %ticks, 0
  br i1 %any, label %tick, label %after
tick:
  %k = phi i64 [0, %before], [%later, %tick]
  %offset = mul i64 %k, {log}
  %row = getelementptr double, ptr %log, i64 %offset
  {tick}
  %later = add i64 %k, 1
  %again = icmp slt i64 %later, %ticks
  br i1 %again, label %tick, label %after
after:
  ret void
}}

define void @onpath_run(ptr %settings, ptr %curves, ptr %states, ptr %logs, i64 %ticks,
                        i64 %robots) {attributes} {{
before:
  %length = mul i64 %ticks, {log}
  %any = icmp sgt i64 %robots, 0
  br i1 %any, label %robot, label %after
robot:
  %i = phi i64 [0, %before], [%next, %robot]
  %i.settings = mul i64 %i, {settings}
  %i.curve = mul i64 %i, {curve}
  %i.state = mul i64 %i, {state}
  %i.log = mul i64 %i, %length
  %own.settings = getelementptr double, ptr %settings, i64 %i.settings
  %own.curve = getelementptr double, ptr %curves, i64 %i.curve
  %own.state = getelementptr double, ptr %states, i64 %i.state
  %own.log = getelementptr double, ptr %logs, i64 %i.log
  call void @one_robot(ptr %own.settings, ptr %own.curve, ptr %own.state, ptr %own.log, i64 %ticks)
  %next = add i64 %i, 1
  %more = icmp slt i64 %next, %robots
  br i1 %more, label %robot, label %after
after:
  ret void
}}
"""


def translate(kernel: Kernel, lanes: int = 1) -> str:
    """LLVM assembly of `onpath_run`, the loops around the kernel's tick; see `CompiledLoop`.

    Args:
        lanes: robots that advance together, 1, 4 or 8; if several, see `BatchedLoop`.

    Raises:
        CodedError: the tick contains an operation without a translation; the message names it and
            the law.
    """
    given = "%state", "%settings"
    rows, terms = kernel.table_shape
    columns = kernel.advance.size_in(2)[1]
    if kernel.spline:
        terms, product, found = WINDOW * ORDERS, _windowed, ("%basis", "%pieces")
    else:
        product, found = (_product if lanes == 1 else _products), ("%basis",)
    tick = instructions(kernel.basis, given, found, "b", kernel.law, lanes)
    tick += [line for k in range(columns) for line in product(rows, terms, k, lanes)]
    inputs, outputs = (*given, "%values"), ("%state", "%row")
    tick += instructions(kernel.tick(), inputs, outputs, "v", kernel.law, lanes)
    text = "\n  ".join(tick)
    return _LOOP.format(
        library="\n".join([*map(_declared, _functions(text)), *_vector_declarations(text)]),
        basis=lanes * terms * columns,
        values=lanes * kernel.advance.size1_in(2) * columns,
        columns=lanes * columns,
        settings=lanes * kernel.settings.size,
        curve=lanes * prod(kernel.table_shape),
        state=lanes * kernel.state.size,
        log=lanes * kernel.log.size,
        tick=text,
        attributes=WIDE if lanes == 8 else "",
    )


def instructions(
    function: ca.Function,
    inputs: Sequence[str],
    outputs: Sequence[str],
    prefix: str,
    owner: str,
    lanes: int = 1,
) -> list[str]:
    """LLVM instructions for an SX function.

    All inputs are read before any output is written, so that an output may overwrite an input.

    Args:
        inputs, outputs: names of pointers to dense matrices, stored by columns.
        prefix: of the names of all values.
        owner: name of the law or function, for messages.
        lanes: if several, each number of the matrices is a vector of so many.

    Raises:
        CodedError: see `translate`.
    """
    reads, works, writes = list[str](), list[str](), list[str]()
    values = dict[int, str]()  # what the function's registers hold
    number = _number(lanes)
    for i in range(function.n_instructions()):
        code, into = function.instruction_id(i), function.instruction_output(i)
        operands, v = function.instruction_input(i), f"%{prefix}{i}"
        if code == ca.OP_CONST:
            literal = _literal(function.instruction_constant(i))
            values[into[0]] = literal if lanes == 1 else f"splat (double {literal})"
        elif code == ca.OP_INPUT:
            reads += [
                _place(v, inputs[operands[0]], lanes * operands[1]),
                f"{v} = load {number}, ptr {v}.at, align 8",
            ]
            values[into[0]] = v
        elif code == ca.OP_OUTPUT:
            writes += [
                _place(v, outputs[into[0]], lanes * into[1]),
                f"store {number} {values[operands[0]]}, ptr {v}.at, align 8",
            ]
        else:
            given = [values[operand] for operand in operands]
            if code not in OPERATIONS:
                raise no_translation(owner, code, "LLVM")
            if lanes > 1 and code in CALLED:
                works += _called(CALLED[code], given, v, lanes)
            else:
                works.append(widened(OPERATIONS[code].llvm, lanes).format(*given, v=v))
            values[into[0]] = v
    return [*reads, *works, *writes]


def _product(rows: int, terms: int, column: int, _: int) -> list[str]:
    """LLVM instructions for a column of %values: the table %curve times the same column of %basis.

    The interpreter, too, begins with 0 and adds the terms in their order.
    """
    vector, v = f"<{rows} x double>", f"%sum{column}"
    lines, total = list[str](), "zeroinitializer"
    for k in range(terms):
        row, factor, each = f"{v}.row{k}", f"{v}.factor{k}", f"{v}.each{k}"
        lines += [
            _place(row, "%curve", rows * k),
            f"{row} = load {vector}, ptr {row}.at, align 8",
            _place(factor, "%basis", terms * column + k),
            f"{factor} = load double, ptr {factor}.at",
            f"{each}.first = insertelement {vector} poison, double {factor}, i64 0",
            f"{each} = shufflevector {vector} {each}.first, {vector} poison,"
            f" <{rows} x i32> zeroinitializer",
            f"{v}.term{k} = fmul {vector} {row}, {each}",
            f"{v}.{k} = fadd {vector} {total}, {v}.term{k}",
        ]
        total = f"{v}.{k}"
    return [
        *lines,
        _place(v, "%values", rows * column),
        f"store {vector} {total}, ptr {v}.at, align 8",
    ]


def _products(rows: int, terms: int, column: int, lanes: int) -> list[str]:
    """The same instructions as `_product` for each lane, one number of the column after another."""
    lines, number = list[str](), _number(lanes)
    for k in range(terms):
        factor = f"%factor{column}.{k}"
        lines += [
            _place(factor, "%basis", lanes * (terms * column + k)),
            f"{factor} = load {number}, ptr {factor}.at, align 8",
        ]
    for row in range(rows):
        v, total = f"%sum{column}.{row}", "zeroinitializer"
        for k in range(terms):
            entry = f"{v}.row{k}"
            lines += [
                _place(entry, "%curve", lanes * (rows * k + row)),
                f"{entry} = load {number}, ptr {entry}.at, align 8",
                f"{v}.term{k} = fmul {number} {entry}, %factor{column}.{k}",
                f"{v}.{k} = fadd {number} {total}, {v}.term{k}",
            ]
            total = f"{v}.{k}"
        lines += [
            _place(v, "%values", lanes * (rows * column + row)),
            f"store {number} {total}, ptr {v}.at, align 8",
        ]
    return lines


def _windowed(rows: int, terms: int, column: int, lanes: int) -> list[str]:
    """LLVM instructions for a column of %values of a spline: the points of a piece times %basis.

    The number of the piece, in %pieces, becomes an address in the table; each lane has its own.
    """
    lines, number = list[str](), _number(lanes)
    for lane in range(lanes):
        piece = f"%piece{column}.{lane}"
        lines += [
            _place(piece, "%pieces", lanes * column + lane),
            f"{piece} = load double, ptr {piece}.at",
            f"{piece}.whole = fptosi double {piece} to i64",
            f"{piece}.begin = mul i64 {piece}.whole, {lanes * rows}",
            f"{piece}.points = getelementptr double, ptr %curve, i64 {piece}.begin",
        ]
    for index in range(rows * WINDOW):
        whole = "poison"
        for lane in range(lanes):
            last = f"%point{column}.{index}"
            own, after = f"{last}.{lane}", last if lane == lanes - 1 else f"{last}.{lane}.whole"
            each = own if lanes > 1 else last
            points = f"%piece{column}.{lane}.points"
            lines += [
                _place(own, points, lanes * index + lane),
                f"{each} = load double, ptr {own}.at, align 8",
            ]
            if lanes > 1:
                lines.append(f"{after} = insertelement {number} {whole}, double {own}, i64 {lane}")
            whole = after
    for k in range(terms):
        factor = f"%factor{column}.{k}"
        lines += [
            _place(factor, "%basis", lanes * (terms * column + k)),
            f"{factor} = load {number}, ptr {factor}.at, align 8",
        ]
    for order in range(ORDERS):
        for row in range(rows):
            v, total = f"%sum{column}.{order}.{row}", "0.0" if lanes == 1 else "zeroinitializer"
            for k in range(WINDOW):
                point = f"%point{column}.{rows * k + row}"
                factor = f"%factor{column}.{WINDOW * order + k}"
                lines += [
                    f"{v}.term{k} = fmul {number} {point}, {factor}",
                    f"{v}.{k} = fadd {number} {total}, {v}.term{k}",
                ]
                total = f"{v}.{k}"
            lines += [
                _place(v, "%values", lanes * (rows * (ORDERS * column + order) + row)),
                f"store {number} {total}, ptr {v}.at, align 8",
            ]
    return lines


def _called(name: str, given: Sequence[str], v: str, lanes: int) -> list[str]:
    """LLVM instructions that apply a function of the C library to vectors."""
    number, together = _number(lanes), f"{PREFIXES[lanes]}{'v' * LIBRARY[name]}_{name}"
    if _is_found(together):
        arguments = ", ".join(f"{number} {each}" for each in given)
        return [f"{v} = call {number} @{together}({arguments})"]
    lines, whole = list[str](), "poison"
    for lane in range(lanes):
        own = f"{v}.lane{lane}"
        lines += [
            f"{own}.{i} = extractelement {number} {each}, i64 {lane}"
            for i, each in enumerate(given)
        ]
        arguments = ", ".join(f"double {own}.{i}" for i in range(len(given)))
        after = v if lane == lanes - 1 else f"{own}.whole"
        lines += [
            f"{own} = call double @{name}({arguments})",
            f"{after} = insertelement {number} {whole}, double {own}, i64 {lane}",
        ]
        whole = after
    return lines


@cache
def _is_found(name: str) -> bool:
    """Whether a function of libmvec can be called."""
    import llvmlite.binding as llvm

    try:
        llvm.load_library_permanently(VECTOR_LIBRARY)
    except RuntimeError:
        return False
    return llvm.address_of_symbol(name) is not None


def _vector_declarations(text: str) -> list[str]:
    """Declarations of the functions of libmvec that instructions call."""
    calls = sorted(set(re.findall(r"call (<(\d) x double>) @(_ZGV\w+?N\d(v+)_\w+)\(", text)))
    attributes = {"4": "", "8": WIDE}
    return [
        f"declare {number} @{name}({', '.join([number] * len(given))}) memory(none)"
        f" {attributes[lanes]}"
        for number, lanes, name, given in calls
    ]


def _number(lanes: int) -> str:
    """LLVM's type of a number."""
    return "double" if lanes == 1 else f"<{lanes} x double>"


def _functions(text: str) -> list[str]:
    """The functions of the C library that instructions call."""
    return [name for name in LIBRARY if f"@{name}(" in text]


def _declared(name: str) -> str:
    """A function that depends on its arguments only, so that sin and cos can be found together."""
    return f"declare double @{name}({', '.join(['double'] * LIBRARY[name])}) memory(none)"


def _place(v: str, matrix: str, index: int) -> str:
    return f"{v}.at = getelementptr double, ptr {matrix}, i64 {index}"


def _literal(value: float) -> str:
    """The number as LLVM's hexadecimal literal, which is exact."""
    return f"0x{struct.pack('>d', value).hex()}"


def translate_loop(kernel: Kernel) -> CompiledLoop:
    """Translate a kernel and compile it for this processor; takes 50 to 150 ms.

    Raises:
        CodedError: see `translate`.
        RuntimeError: LLVM does not support this machine.
    """
    return CompiledLoop(kernel.layouts, *_compiled(translate(kernel)))


def translate_batch(kernel: Kernel, lanes: int) -> BatchedLoop:
    """Translate a kernel for several robots at a time; takes half as long again.

    Args:
        lanes: robots that advance together, 4 or 8.

    Raises:
        CodedError: see `translate`.
        RuntimeError: LLVM does not support this machine, or it has no such lanes.
    """
    if lanes > most_lanes():
        raise RuntimeError(f"this processor has no vectors of {lanes} numbers")
    return BatchedLoop(kernel.layouts, *_compiled(translate(kernel, lanes)), lanes)


@cache
def most_lanes() -> int:
    """Robots that advance together: 8 with AVX-512, 4 with AVX2, else 1."""
    import llvmlite.binding as llvm

    features = llvm.get_host_cpu_features()
    return 8 if features.get("avx512f") else 4 if features.get("avx2") else 1


def _compiled(text: str) -> tuple[int, object]:
    """Address of `onpath_run`, and what keeps it in memory.

    Raises:
        RuntimeError: LLVM does not support this machine.
    """
    import llvmlite.binding as llvm  # takes 0.1 s, which must not delay the first frame

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    module = llvm.parse_assembly(text, llvm.create_context())
    code = _machine().emit_object(module)
    # The engine's own module is empty and in the global context: any other one is freed too early.
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    missing = [name for name in _functions(text) if llvm.address_of_symbol(name) is None]
    if missing:  # otherwise LLVM would abort the process
        raise RuntimeError(f"not found in this process: {', '.join(missing)}")
    engine.finalize_object()
    return engine.get_function_address("onpath_run"), engine


def fastest_loop(kernel: Kernel) -> Loop:
    """The compiled loop, or the interpreted one if that cannot be made."""
    try:
        return translate_loop(kernel)
    except (CodedError, RuntimeError):
        return InterpretedLoop(kernel)


def fastest_batch(kernel: Kernel) -> ManyLoop:
    """The loop that advances many robots in the shortest time."""
    lanes = most_lanes()
    try:
        return translate_batch(kernel, lanes) if lanes > 1 else translate_loop(kernel)
    except (CodedError, RuntimeError):
        return InterpretedLoop(kernel)


def _machine() -> TargetMachine:
    """A new compiler for this processor; one that has been used holds 0.8 MB."""
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten()
    )
