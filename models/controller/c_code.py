"""Translates CasADi functions to C99.

The scalar instructions are translated one by one, like those of models/closed_loop/wasm_loop.py;
see `OPERATIONS`. A compiler must not contract a product and a sum (`-ffp-contract=off`, which
`-std=c99` implies) if the bits are to be CasADi's.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

import casadi as ca

from onpath.models.closed_loop.operations import OPERATIONS, no_translation
from onpath.models.layout import Layout

Place = Callable[[int], str]
"""Index of a number in a vector -> the C expression of it."""
KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while asm bool true false class new delete this template
"""


def c_function(
    function: ca.Function,
    head: str,
    inputs: Sequence[Place],
    outputs: Sequence[Place],
    owner: str,
) -> str:
    """The definition of a C function for an SX function.

    All inputs are read before any output is written, so that an output may overwrite an input.

    Args:
        head: its return type, name and parameters.
        owner: name of the law, for messages.

    Raises:
        CodedError: an operation has no translation; the message names it and its owner.
    """
    reads, works, writes = list[str](), list[str](), list[str]()
    values = dict[int, str]()  # what the function's registers hold
    for i in range(function.n_instructions()):
        code, into = function.instruction_id(i), function.instruction_output(i)
        operands = function.instruction_input(i)
        if code == ca.OP_CONST:
            values[into[0]] = c_number(function.instruction_constant(i))
        elif code == ca.OP_OUTPUT:
            writes.append(f"    {outputs[into[0]](into[1])} = {values[operands[0]]};")
        elif code == ca.OP_INPUT:
            reads.append(f"    const double v{i} = {inputs[operands[0]](operands[1])};")
            values[into[0]] = f"v{i}"
        elif code not in OPERATIONS:
            raise no_translation(owner, code, "C")
        else:
            expression = OPERATIONS[code].c.format(*(values[each] for each in operands))
            works.append(f"    const double v{i} = {expression};")
            values[into[0]] = f"v{i}"
    body = "\n".join([*reads, *works, *writes])
    taken = re.findall(r"(\w+)(?=[,)])", head)
    unused = [f"    (void){each};" for each in taken if not re.search(rf"\b{each}\b", body)]
    return "\n".join([head, "{", *unused, body, "}"])


def operations_in(function: ca.Function) -> int:
    """The number of operations on numbers in a call of an SX function."""
    moves = (ca.OP_CONST, ca.OP_INPUT, ca.OP_OUTPUT)
    codes = map(function.instruction_id, range(function.n_instructions()))
    return sum(code not in moves for code in codes)


def fields_of(layout: Layout, base: str) -> Place:
    """The places of a vector that is a C struct with a member for each field.

    Args:
        base: what stands before the member, such as "state->".
    """
    places = list[str]()
    for name, size in layout.fields:
        member = f"{base}{c_name(name)}"
        places += [member] if size == 1 else [f"{member}[{i}]" for i in range(size)]
    return places.__getitem__


def elements_of(array: str) -> Place:
    """The places of a vector that is a C array."""
    return lambda i: f"{array}[{i}]"


def c_name(text: str) -> str:
    """An identifier of C for any text.

    >>> c_name("K1"), c_name("joint 2/α"), c_name("double"), c_name("2nd")
    ('K1', 'joint_2__u3b1', 'double_', 'n2nd')
    """
    name = re.sub(r"[^A-Za-z0-9_]", lambda m: "_" if m[0].isascii() else f"_u{ord(m[0]):x}", text)
    name = name if re.match(r"[A-Za-z]", name) else f"n{name}"
    return f"{name}_" if name in KEYWORDS.split() else name


def c_number(value: float) -> str:
    """A number as C reads it, exactly.

    >>> c_number(0.1), c_number(-2.0), c_number(float("inf"))
    ('0.1', '(-2.0)', 'INFINITY')
    """
    if math.isnan(value):
        return "NAN"
    text = "INFINITY" if math.isinf(value) else repr(abs(float(value)))
    return text if math.copysign(1.0, value) > 0 else f"(-{text})"


def c_array(values: Sequence[float]) -> str:
    """The braces of an array's numbers, in lines of at most 100 characters."""
    lines, line = list[str](), ""
    for number in map(c_number, values):
        if len(line) + len(number) > 90:
            lines, line = [*lines, line.rstrip()], ""
        line += f"{number}, "
    return "{\n    " + "\n    ".join([*lines, line.rstrip(", ")]) + "\n}"
