"""CasADi's operations on scalars, applied to numbers of every kind."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.operations import OPERATIONS
from onpath.models.layout import Layout
from onpath.models.paths.curves import TABLE_SHAPE, TERMS

_EDGES = [0.0, 5e-324, 1e-310, 1e-9, 0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 7.0, 20.0, 710.0]
_EDGES += [1e3, 2.0**53, 1e300, 1.7e308, np.inf]
NUMBERS = [*_EDGES, *(-number for number in _EDGES), np.nan]


def _pairs() -> Array:
    """Pairs of numbers: the edges with each other, and random ones of every size."""
    random = np.random.default_rng(1)
    sizes = 10.0 ** random.uniform(-12, 4, (600, 2)) * random.choice([-1.0, 1.0], (600, 2))
    halves = random.integers(-12, 13, (200, 2)) / 2
    return np.vstack([list(product(NUMBERS, NUMBERS)), sizes, random.normal(size=(200, 2)), halves])


PAIRS = _pairs()
"""Shape (n, 2)."""


def applied(code: int, first: ca.SX, second: ca.SX) -> ca.SX:
    """The operation of this number, with the operands that it takes."""
    if code == ca.OP_CONSTPOW:
        return first**0.3
    one = code in OPERATIONS and OPERATIONS[code].operands == 1
    return ca.SX.unary(code, first) if one else ca.SX.binary(code, first, second)


def logging_kernel(rows: Sequence[ca.SX], x: ca.SX) -> Kernel:
    """Its state x stays as it is and its log is what is asked for."""
    settings, values = ca.SX.sym("settings"), ca.SX.sym("values", TABLE_SHAPE[0])
    still = ca.Function("bases", [x, settings], [ca.DM.ones(TERMS)])
    log = ca.vertcat(*rows)
    advance = ca.Function("advance", [x, settings, values], [x, log, ca.DM.ones(TERMS)])
    return Kernel(
        state=Layout((("x", x.numel()),)),
        settings=Layout((("s", 1),)),
        log=Layout((("row", len(rows)),)),
        changed=x.numel(),
        table_shape=TABLE_SHAPE,
        law="",
        basis=still,
        advance=advance,
    )
