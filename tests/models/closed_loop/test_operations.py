"""The table of CasADi's operations is complete, and LLVM computes what the virtual machine does."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.operations import LIBRARY, MATHEMATICS, OPERATIONS
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.paths.curves import circle
from tests.support.scalar_operations import PAIRS, applied, logging_kernel

NO_OPERATIONS = {"OP_CONST", "OP_INPUT", "OP_OUTPUT"}
NOT_TRANSLATED = {"OP_ERFINV", "OP_PRINTME"}
EVERY: dict[str, int] = {name: code for name, code in vars(ca).items() if name[:3] == "OP_"}
TRANSLATED = {name: code for name, code in EVERY.items() if code in OPERATIONS}


def test_every_operation_on_scalars_is_in_the_table_or_known_to_be_lacking() -> None:
    """CasADi's own list says which there are; its other ones are on matrices and functions."""
    x, found = ca.SX.sym("x", 2), set[str]()
    for name, code in EVERY.items():
        function = ca.Function("f", [x], [applied(code, x[0], x[1])])
        places = range(function.n_instructions())
        if code in [function.instruction_id(i) for i in places]:
            found.add(name)
    assert found - NO_OPERATIONS == TRANSLATED.keys() | NOT_TRANSLATED
    assert len(TRANSLATED) == len(OPERATIONS)


def test_only_erf_has_no_webassembly() -> None:
    assert [name for name, code in TRANSLATED.items() if not OPERATIONS[code].wasm] == ["OP_ERF"]
    assert {*LIBRARY} - {*MATHEMATICS} == {"erf"}


@pytest.mark.thorough
@pytest.mark.parametrize("name", TRANSLATED)
def test_llvm_computes_the_virtual_machine_s_bits(name: str) -> None:
    x = ca.SX.sym("x", 2)
    rows = [applied(TRANSLATED[name], x[0], x[1])]
    if name == "OP_CONSTPOW":
        rows += [x[0] ** power for power in (-1.5, 0.5, 1 / 3, 3, 7.25)]
    kernel = logging_kernel(rows, x)
    assert TRANSLATED[name] in [
        kernel.advance.instruction_id(i) for i in range(kernel.advance.n_instructions())
    ]
    loops = InterpretedLoop(kernel), translate_loop(kernel)
    for pair in PAIRS:
        given = np.array(pair), np.zeros(1), circle(0.05).table(), 1
        (interpreted,), (translated,) = (loop.run(*given)[1] for loop in loops)
        assert np.array_equal(interpreted, translated, equal_nan=True), pair
        numbers = ~np.isnan(interpreted)
        assert np.array_equal(np.signbit(interpreted)[numbers], np.signbit(translated)[numbers])
