"""The hand-written C loop of reference_loop.c behind the interface of `closed_loop.loops.Loop`."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import CompiledLoop

SOURCE = Path(__file__).with_name("reference_loop.c")
FLAGS = (
    *("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math"),
    "-ffp-contract=off",  # rounds as the generated loops do
    *("-fPIC", "-fno-semantic-interposition", "-shared"),
)


def reference_loop(kernel: Kernel, folder: Path) -> CompiledLoop | None:
    """Compile the hand-written loop; None if there is no C compiler.

    Args:
        kernel: of the rigid five-bar, path following, closed path, distance, no encoder; the C
            code assumes its layouts.
        folder: the library is written to it.
    """
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        return None
    library = folder / "reference_loop.so"
    command = [compiler, *FLAGS, str(SOURCE), "-o", str(library), "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    code = ctypes.CDLL(str(library))
    address = ctypes.cast(code.onpath_run, ctypes.c_void_p).value
    assert address is not None
    return CompiledLoop(kernel, address, code)
