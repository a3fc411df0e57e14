"""Runs loops that were translated to WebAssembly, in Node."""

from __future__ import annotations

from base64 import b64decode, b64encode

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.wasm_loop import Scan, wasm_of
from tests.support.checkout import ROOT
from tests.support.node_page import NodePage

_MATHEMATICS = ROOT / "assets" / "web" / "simulation" / "mathematics.ts"
_RUN = """async ([module, vectors, row, ticks]) => {
    MATHEMATICS
    const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0))
    const memory = new WebAssembly.Memory({initial: 100})
    const imports = {Math: {memory, ...mathematics}}
    const {instance} = await WebAssembly.instantiate(bytes(module), imports)
    const numbers = new Float64Array(memory.buffer)
    let end = 0
    const places = vectors.map(text => {
        const vector = new Float64Array(bytes(text).buffer), place = end
        numbers.set(vector, place)
        end += vector.length
        return 8 * place
    })
    instance.exports.loop(...places, 8 * end, ticks)
    const result = new Uint8Array(memory.buffer, 8 * end, 8 * row * ticks)
    let text = ""
    for (const byte of result) text += String.fromCharCode(byte)
    return btoa(text)
}"""


def rows_in_node(
    page: NodePage, kernel: Kernel, state: Array, settings: Array, table: Array, ticks: int
) -> Array:
    """The log rows of `Loop.run`."""
    vectors = state, settings, table
    return _rows(page, wasm_of({}, {"loop": kernel}), vectors, kernel.log.size, ticks)


def scanned_in_node(
    page: NodePage, scan: Scan, state: Array, constants: Array, table: Array, steps: int
) -> Array:
    """The rows of results of a scan."""
    module, size = wasm_of({}, {}, {"loop": scan}), scan.step.numel_out(1)
    return _rows(page, module, (state, constants, table), size, steps)


def _rows(
    page: NodePage, module: bytes, given: tuple[Array, Array, Array], size: int, count: int
) -> Array:
    vectors = [_text(vector.tobytes()) for vector in given]
    own = _MATHEMATICS.read_text("utf-8").replace(": number", "").replace("export ", "")
    rows = page.evaluate(_RUN.replace("MATHEMATICS", own), [_text(module), vectors, size, count])
    return np.frombuffer(b64decode(rows)).reshape(count, -1)


def _text(data: bytes) -> str:
    return b64encode(data).decode()
