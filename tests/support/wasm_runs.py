"""Runs loops that were translated to WebAssembly, in Node."""

from __future__ import annotations

from base64 import b64decode, b64encode

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.wasm_loop import wasm_of
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
    vectors = [_text(vector.tobytes()) for vector in (state, settings, table)]
    module = _text(wasm_of({}, {"loop": kernel}))
    own = _MATHEMATICS.read_text("utf-8").replace(": number", "").replace("export ", "")
    rows = page.evaluate(
        _RUN.replace("MATHEMATICS", own), [module, vectors, kernel.log.size, ticks]
    )
    return np.frombuffer(b64decode(rows)).reshape(ticks, -1)


def _text(data: bytes) -> str:
    return b64encode(data).decode()
