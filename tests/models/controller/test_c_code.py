"""Each operation in C gives the bits of CasADi's virtual machine, and names are C's."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.closed_loop.operations import OPERATIONS
from onpath.models.controller.c_code import c_function, c_name, c_number, elements_of
from onpath.models.errors import CodedError
from tests.support.scalar_operations import PAIRS, applied

COMPILER = shutil.which("cc")


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
@pytest.mark.parametrize("optimized", ["-O0", "-O2"])
def test_c_computes_the_virtual_machine_s_bits(tmp_path: Path, optimized: str) -> None:
    x = ca.SX.sym("x", 2)
    rows = [applied(code, x[0], x[1]) for code in OPERATIONS if code != ca.OP_CONSTPOW]
    rows += [x[0] ** power for power in (-1.5, 0.3, 1 / 3, 3, 7.25)]
    function = ca.Function("f", [x], [ca.vertcat(*rows)])
    places = [elements_of("x")], [elements_of("result")]
    head = "void f(const double *x, double *result)"
    text = c_function(function, head, *places, owner="")
    (tmp_path / "f.c").write_text(f"#include <math.h>\n{text}\n", "utf-8")
    command = [str(COMPILER), "-std=c99", optimized, "-fPIC", "-shared", "f.c", "-lm", "-o", "f.so"]
    subprocess.run(command, check=True, cwd=tmp_path)
    library, result = ctypes.CDLL(str(tmp_path / "f.so")), np.zeros(len(rows))
    for pair in PAIRS:
        given = np.array(pair)
        library.f(*(ctypes.c_void_p(each.ctypes.data) for each in (given, result)))
        wanted = np.array(function(given))[:, 0]
        assert np.array_equal(result, wanted, equal_nan=True), pair
        numbers = ~np.isnan(wanted)
        assert np.array_equal(np.signbit(result)[numbers], np.signbit(wanted)[numbers]), pair


def test_an_operation_without_a_translation_is_named() -> None:
    x = ca.SX.sym("x")
    function = ca.Function("f", [x], [ca.SX.unary(ca.OP_ERFINV, x)])
    with pytest.raises(CodedError, match=r"^erring uses .*OP_ERFINV.* C$"):
        c_function(function, "f", [elements_of("x")], [elements_of("y")], "erring")


@given(st.text())
def test_any_text_becomes_an_identifier(text: str) -> None:
    assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", c_name(text))


@given(st.floats(allow_nan=False))
def test_a_number_is_read_as_it_was(value: float) -> None:
    text = c_number(value).strip("()").replace("INFINITY", "inf")
    assert float(text) == value and str(float(text)) == str(value)
