"""The hand-written C loop of reference_loop.c behind the interface of `models.loops.Loop`."""

from __future__ import annotations

import subprocess
from pathlib import Path

from models.kernel import Kernel
from models.loops import FLAGS, CompiledLoop, load_loop

SOURCE = Path(__file__).with_name("reference_loop.c")


def reference_loop(kernel: Kernel, folder: Path, compiler: str) -> CompiledLoop:
    """Compile the hand-written loop with the flags of the generated one.

    Args:
        kernel: of the rigid five-bar, path following, closed, distance, no encoder; whose layouts
            the C follows.
        folder: where the library goes.
    """
    library = folder / "reference_loop.so"
    command = [compiler, *FLAGS, str(SOURCE), "-o", str(library), "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return load_loop(kernel, library)
