"""The part of WebAssembly's binary format that functions of numbers in memory need.

A function is a list of `Part`s in the textual format's words: "f64.add", ("local.get", 3).

Source: WebAssembly core specification, version 1.0, chapter 5.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from onpath.models.closed_loop.operations import LIBRARY, MATHEMATICS

Part = str | tuple[str, int | float]
"""An instruction, and its number: of a local variable, a function, a depth, or a constant. Those of
f64.load and f64.store are offsets in bytes."""

_PLAIN = {
    "end": 0x0B,
    "select": 0x1B,
    "i32.gt_s": 0x4A,
    "f64.eq": 0x61,
    "f64.ne": 0x62,
    "f64.lt": 0x63,
    "f64.le": 0x65,
    "i32.add": 0x6A,
    "i32.sub": 0x6B,
    "i32.mul": 0x6C,
    "i32.and": 0x71,
    "i32.or": 0x72,
    "f64.abs": 0x99,
    "f64.neg": 0x9A,
    "f64.ceil": 0x9B,
    "f64.floor": 0x9C,
    "f64.sqrt": 0x9F,
    "f64.add": 0xA0,
    "f64.sub": 0xA1,
    "f64.mul": 0xA2,
    "f64.div": 0xA3,
    "f64.copysign": 0xA6,
    "i32.trunc_f64_s": 0xAA,
    "f64.convert_i32_u": 0xB8,
}
_NUMBERED = {"br_if": 0x0D, "call": 0x10, "local.get": 0x20, "local.set": 0x21}
_MEMORY = {"f64.load": 0x2B, "f64.store": 0x39}
_I32, _F64, _NOTHING, _FUNCTION = b"\x7f", b"\x7c", b"\x40", b"\x60"
_ALIGNED = b"\x03"  # to 2³ bytes


@dataclass(frozen=True, slots=True)
class WasmFunction:
    """A function without a result.

    Attributes:
        name: under which it is exported.
        pointers: number of its arguments, all i32; they are the local variables from 0 on.
        numbers: number of further local variables, all f64.
        body: its instructions.
    """

    name: str
    pointers: int
    numbers: int
    body: Sequence[Part]


def wasm_module(functions: Sequence[WasmFunction]) -> bytes:
    """A module that exports these functions and works on imported memory.

    It imports "memory" and the functions `MATHEMATICS` from "Math": the first numbers of ("call",
    number). Its own functions have the numbers after those, in their order.
    """
    kinds = sorted({function.pointers for function in functions})
    unary = _FUNCTION + _list([_F64]) + _list([_F64])
    binary = _FUNCTION + _list([_F64, _F64]) + _list([_F64])
    taken = [_FUNCTION + _list([_I32] * count) + _list([]) for count in kinds]
    memory = _name("Math") + _name("memory") + b"\x02\x00" + _whole(1)
    imports = [
        _name("Math") + _name(name) + b"\x00" + _whole(LIBRARY[name] - 1) for name in MATHEMATICS
    ]
    signatures = [_whole(2 + kinds.index(function.pointers)) for function in functions]
    exports = [
        _name(function.name) + b"\x00" + _whole(len(MATHEMATICS) + i)
        for i, function in enumerate(functions)
    ]
    types, bodies = [unary, binary, *taken], map(_code, functions)
    sections = {1: types, 2: [*imports, memory], 3: signatures, 7: exports, 10: bodies}
    parts = (bytes([number]) + _sized(_list(content)) for number, content in sections.items())
    return b"\0asm\x01\0\0\0" + b"".join(parts)


def _code(function: WasmFunction) -> bytes:
    locals_ = [_whole(function.numbers) + _F64] if function.numbers else []
    return _sized(_list(locals_) + b"".join(map(_encoded, function.body)) + b"\x0b")


def _encoded(part: Part) -> bytes:
    """The bytes of an instruction."""
    if isinstance(part, str):
        return b"\x03" + _NOTHING if part == "loop" else bytes([_PLAIN[part]])
    name, number = part
    if name == "f64.const":
        return b"\x44" + struct.pack("<d", number)
    whole = int(number)
    if name == "i32.const":
        return b"\x41" + _signed(whole)
    if name in _MEMORY:
        return bytes([_MEMORY[name]]) + _ALIGNED + _whole(whole)
    return bytes([_NUMBERED[name]]) + _whole(whole)


def _whole(number: int) -> bytes:
    """A whole number in LEB128, seven bits a byte, the lowest first."""
    result = bytearray()
    while number > 0x7F:
        result.append(number & 0x7F | 0x80)
        number >>= 7
    return bytes([*result, number])


def _signed(number: int) -> bytes:
    """The same with a sign, for numbers that are not negative: the last byte is below 0x40."""
    plain = bytearray(_whole(number))
    if plain[-1] < 0x40:
        return bytes(plain)
    plain[-1] |= 0x80
    return bytes([*plain, 0])


def _sized(content: bytes) -> bytes:
    return _whole(len(content)) + content


def _name(text: str) -> bytes:
    return _sized(text.encode())


def _list(parts: Iterable[bytes]) -> bytes:
    every = list(parts)
    return _whole(len(every)) + b"".join(every)
