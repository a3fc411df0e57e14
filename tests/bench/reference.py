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
LANES = (1, 4, 8)
"""Numbers of robots that may advance together: without SIMD, with AVX2, with AVX-512."""
FLAGS = (
    *("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fno-strict-aliasing"),
    "-ffp-contract=off",  # rounds as the generated loops do
    *("-fPIC", "-fno-semantic-interposition", "-shared"),
)


def reference_loop(kernel: Kernel, folder: Path, lanes: int = 1) -> CompiledLoop | None:
    """Compile the hand-written loop; None without a C compiler, or a processor with such lanes.

    Args:
        kernel: of the rigid five-bar, path following, closed path, distance, ideal sensors and
            motors; the C code assumes its layouts.
        folder: the library is written to it.
        lanes: robots that advance together, one of `LANES`. `run_many` takes multiples of this
            number, and `run` is for one lane only.
    """
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        return None
    library = folder / f"reference_loop_{lanes}.so"
    libraries = ["-lmvec"] * (lanes > 1) + ["-lm"]
    command = [compiler, *FLAGS, f"-DLANES={lanes}", str(SOURCE), "-o", str(library), *libraries]
    made = subprocess.run(command, capture_output=True, check=lanes == 1)
    if made.returncode:
        return None
    code = ctypes.CDLL(str(library))
    address = ctypes.cast(code.onpath_run, ctypes.c_void_p).value
    assert address is not None
    return CompiledLoop(kernel.layouts, address, code)
