"""Poles of a linear law for pages without a server: `channels` of models/control/poles.py.

With w = z - 1 the characteristic polynomial of a channel follows from the transfer functions of its
states, so that it is exact to rounding near w = 0, where the slow poles are. Its roots are found by
the method of Ehrlich and Aberth.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import casadi as ca
import numpy as np

from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.control.poles import LEAST_DECAY, NO_OSCILLATION
from onpath.models.layout import Layout
from onpath.models.standalone.fit import scan_of
from onpath.models.systems.parameters import Parameters, look_ahead_time

STEPS = 100
"""Steps of the method; a double root takes about 30."""
SLOW = 4
"""Most poles of a channel that are shown."""
ROUNDING = 1e-12
"""Imaginary parts of z below this are rounding errors."""
BEHAVIOURS = ("no_overshoot", "no_oscillation", "damping", "unstable", "swings", "not_stable")
"""The behaviours of a channel, of which `settling` gives the number in this list."""
Polynomial = Sequence[ca.SX | float]
"""Coefficients, beginning with the constant."""


def pole_functions(parameters: Parameters, settings: Layout) -> dict[str, ca.Function]:
    """The functions for a law whose channels are those of path following.

    polynomials: settings -> of the channels across and along, and first roots, see `roots_scan`
    settling: (roots, polynomial, sampling interval) -> number of slow poles; real and imaginary
        parts of `SLOW` of them, [1/s]; number in `BEHAVIOURS`, its time [s], and the damping ratio
    """
    size = _size(parameters)
    return {"polynomials": _polynomials(parameters, settings, size), "settling": _settling(size)}


def roots_scan(parameters: Parameters) -> Scan:
    """`STEPS` steps from first roots to those of a polynomial; state: real and imaginary parts."""
    size = _size(parameters)
    state, polynomial = ca.SX.sym("roots", 2 * size), ca.SX.sym("polynomial", size + 2)
    roots = [(state[i], state[size + i]) for i in range(size)]
    better = [_improved(roots, i, polynomial[2:]) for i in range(size)]
    after = ca.vertcat(*(x for x, _ in better), *(y for _, y in better))
    return scan_of(0, [state, polynomial, ca.SX.sym("rows", 0)], [after, ca.SX(0, 1)])


def _size(parameters: Parameters) -> int:
    """Number of roots: of position, velocity, integral and pending accelerations."""
    return 4 + int(parameters.delay)


def _polynomials(parameters: Parameters, settings: Layout, size: int) -> ca.Function:
    """The function "polynomials"; each begins with the number of its slow roots, and with 1 if it
    has an integral."""
    symbol, fields = settings.symbols("settings")
    k1, k2, k3, k4, k5 = (fields[f"K{i}"] for i in range(1, 6))
    with_integral = _padded(_characteristic(parameters, k1, k2, k3, kept=3), size)
    without = _padded(_characteristic(parameters, k1, k2, ca.SX(0), kept=2), size)
    on = k3 != 0
    across = [ca.if_else(on, a, b) for a, b in zip(with_integral, without, strict=True)]
    kept = 2 if parameters.task == "position" else 1
    along = _padded(_characteristic(parameters, k4, k5, ca.SX(0), kept=kept), size)
    angle = 2 * np.pi * (np.arange(size) + 0.3) / size
    first = np.concatenate([-0.5 + np.cos(angle), np.sin(angle)])
    results = [ca.vertcat(2 + on, on, *across), ca.vertcat(kept, 0, *along), ca.DM(first)]
    return ca.Function("polynomials", [symbol], [ca.densify(ca.SX(each)) for each in results])


def _characteristic(
    parameters: Parameters, k1: ca.SX, k2: ca.SX, k3: ca.SX, kept: int
) -> Polynomial:
    """The polynomial of a channel, without its leading 1.

    With l + f the delay, F = f + (1 - f) z and G = f (1 - f/2) + (1 - f)²/2 z, see `_sampled` in
    models/control/poles.py:

        w³ z^(l+1) + (k1 w + k3 t) X + k2 w² V = 0,
        X = t² F + t² w G + h t w F + h²/2 w²,   V = t F + h w.

    Args:
        kept: 3, or 2 without integral, or 1 without integral and position: then it is divided by w
            or by w².
    """
    t, h = 1 / parameters.control_rate, look_ahead_time(parameters)
    whole = int(parameters.delay)
    f = parameters.delay - whole
    early, late = [1.0, 1 - f], [f * (1 - f / 2) + (1 - f) ** 2 / 2, (1 - f) ** 2 / 2]
    delayed = reduce(_times, [[1.0, 1.0]] * (whole + 1))
    x = _sum(
        _times([t**2], early),
        _times([0.0, t**2], late),
        _times([0.0, h * t], early),
        [0.0, 0.0, h**2 / 2],
    )
    v = _sum(_times([t], early), [0.0, h])
    position = _times([k3 * t, k1], x) if kept == 3 else _times([k1], x)
    parts = [
        _times([0.0] * kept + [1.0], delayed),
        position if kept > 1 else [0.0],
        _times([0.0] * (kept - 1) + [k2], v),
    ]
    return _sum(*parts)[:-1]


def _padded(polynomial: Polynomial, size: int) -> list[ca.SX]:
    """The polynomial with further roots at z = 0, where they are fastest; without its leading 1."""
    full: Polynomial = [*polynomial, 1.0]
    while len(full) <= size:
        full = _times(full, [1.0, 1.0])
    return [ca.SX(each) for each in full[:-1]]


def _times(a: Polynomial, b: Polynomial) -> Polynomial:
    result: list[ca.SX | float] = [0.0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] = result[i + j] + x * y
    return result


def _sum(*each: Polynomial) -> Polynomial:
    longest = max(map(len, each))
    return [sum((p[i] for p in each if i < len(p)), 0.0) for i in range(longest)]


Complex = tuple[ca.SX, ca.SX]


def _improved(roots: Sequence[Complex], i: int, polynomial: ca.SX) -> Complex:
    """w - 1 / (p'/p - Σ 1 / (w - w_j)) = w - p / (p' - p Σ ...)."""
    w = roots[i]
    value, slope = (ca.SX(1), ca.SX(0)), (ca.SX(0), ca.SX(0))
    for coefficient in reversed(ca.vertsplit(polynomial)):
        slope = _plus(_product(slope, w), value)
        value = _plus(_product(value, w), (coefficient, ca.SX(0)))
    away = (ca.SX(0), ca.SX(0))
    for j, other in enumerate(roots):
        if j != i:
            away = _plus(away, _quotient((ca.SX(1), ca.SX(0)), _minus(w, other)))
    return _minus(w, _quotient(value, _minus(slope, _product(value, away))))


def _plus(a: Complex, b: Complex) -> Complex:
    return a[0] + b[0], a[1] + b[1]


def _minus(a: Complex, b: Complex) -> Complex:
    return a[0] - b[0], a[1] - b[1]


def _product(a: Complex, b: Complex) -> Complex:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _quotient(a: Complex, b: Complex) -> Complex:
    """a / b, and 0 for b = 0."""
    squared = ca.fmax(b[0] ** 2 + b[1] ** 2, 1e-300)
    over = _product(a, (b[0], -b[1]))
    return over[0] / squared, over[1] / squared


def _settling(size: int) -> ca.Function:
    """The function "settling", after `Channel.behaviour` and `Channel.pole_words`."""
    state, polynomial = ca.SX.sym("roots", 2 * size), ca.SX.sym("polynomial", size + 2)
    interval, count = ca.SX.sym("interval"), polynomial[0]
    poles = _sorted([_pole(state[i], state[size + i], interval) for i in range(size)])
    stable = ca.SX(1)
    for real, _ in poles:
        stable = ca.fmin(stable, real < -LEAST_DECAY)
    for number in range(1, size):  # one more if it is the conjugate of the last one
        (real, imaginary), (other, opposite) = poles[number - 1], poles[number]
        alike = ca.fabs(real - other) + ca.fabs(imaginary + opposite) <= 1e-6 * ca.fabs(real)
        pair = ca.fmin(alike, ca.fabs(imaginary) > 1e-6 * ca.fabs(real))
        count = ca.if_else(ca.logic_and(polynomial[0] == number, pair), number + 1, count)
    slow = poles[:SLOW]
    words = [ca.if_else(_damping(pole) >= NO_OSCILLATION, 0, pole[1]) for pole in slow]
    shown = [each for pole, y in zip(slow, words, strict=True) for each in (pole[0], y)]
    behaviour = _behaviour(slow, count, stable, polynomial[1])
    result = ca.densify(ca.vertcat(count, *shown, *behaviour))
    return ca.Function("settling", [state, polynomial, interval], [result])


def _behaviour(
    slow: Sequence[Complex], count: ca.SX, stable: ca.SX, integral: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The number of one of `BEHAVIOURS`, a time [s], and the damping ratio."""
    slowest, damping, swings = slow[0][0], ca.SX(1), ca.SX(0)
    for i, (real, imaginary) in enumerate(slow):
        counts = count > i
        damping = ca.fmin(damping, ca.if_else(counts, _damping((real, imaginary)), 1))
        lasting = ca.logic_and(counts, real > -LEAST_DECAY)
        swings = ca.fmax(swings, ca.logic_and(lasting, ca.fabs(imaginary) > LEAST_DECAY))
    calm = ca.if_else(damping >= NO_OSCILLATION, integral, 2)
    grows = slowest > LEAST_DECAY
    code = ca.if_else(stable, calm, ca.if_else(grows, 3, ca.if_else(swings, 4, 5)))
    return code, ca.if_else(stable, -4 / slowest, 1 / slowest), damping


def _pole(real: ca.SX, imaginary: ca.SX, interval: ca.SX) -> Complex:
    """ln(1 + w) / T, [1/s]."""
    imaginary = ca.if_else(ca.fabs(imaginary) < ROUNDING, 0, imaginary)
    squared = (1 + real) ** 2 + imaginary**2
    return ca.log(squared + 1e-300) / 2 / interval, ca.atan2(imaginary, 1 + real) / interval


def _damping(pole: Complex) -> ca.SX:
    return -pole[0] / ca.fmax(ca.sqrt(pole[0] ** 2 + pole[1] ** 2), 1e-300)


def _sorted(poles: Sequence[Complex]) -> list[Complex]:
    """The slowest first."""
    found = list(poles)
    for end in range(len(found) - 1, 0, -1):
        for i in range(end):
            (a, b), (c, d) = found[i : i + 2]
            swap = a < c
            found[i] = ca.if_else(swap, c, a), ca.if_else(swap, d, b)
            found[i + 1] = ca.if_else(swap, a, c), ca.if_else(swap, b, d)
    return found
