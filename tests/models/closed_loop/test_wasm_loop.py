"""The form of the WebAssembly modules; what they compute is tested in a browser."""

from __future__ import annotations

import casadi as ca
import pytest

from onpath.models.closed_loop.operations import OPERATIONS
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.closed_loop.wasm_loop import wasm_of
from onpath.models.closed_loop.wasm_module import _signed, _whole
from onpath.models.control.laws.registry import NAMES
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.scalar_operations import applied


def test_an_operation_without_a_translation_is_named() -> None:
    x = ca.SX.sym("x")
    with pytest.raises(CodedError, match=r"^f uses .*OP_ERF.* WebAssembly$"):
        wasm_of({"f": ca.Function("f", [x], [ca.SX.unary(ca.OP_ERF, x)])}, {})


def test_every_operation_can_be_written_and_the_same_input_gives_the_same_bytes() -> None:
    x = ca.SX.sym("x", 2)
    results = [applied(code, x[0], x[1]) for code, each in OPERATIONS.items() if each.wasm]
    function = ca.Function("f", [x], [ca.vertcat(*results)])
    module = wasm_of({"f": function}, {})
    assert module[:8] == b"\0asm\x01\0\0\0"
    assert module == wasm_of({"f": function}, {})


def test_a_loop_is_small() -> None:
    parameters = FIVE_BAR.parameters()
    robot = FIVE_BAR.make(parameters)
    for law in NAMES:
        kernel = kernel_of(robot, kind_of(law, parameters, circle(0.05)))
        assert len(wasm_of({}, {law: kernel})) < 20_000


@pytest.mark.parametrize("number", [0, 1, 63, 64, 127, 128, 8191, 8192, 1 << 20])
def test_numbers_are_read_back(number: int) -> None:
    for written, signed in ((_whole(number), False), (_signed(number), True)):
        read = sum((byte & 0x7F) << 7 * i for i, byte in enumerate(written))
        assert read - (signed and written[-1] & 0x40 and 1 << 7 * len(written)) == number
        assert all(byte & 0x80 for byte in written[:-1]) and not written[-1] & 0x80
