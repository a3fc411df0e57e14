"""Random numbers inside the closed loop: the same for the same seed, interpreted or compiled.

They are a function of the seed and the number of the tick, so that there is no state of a
generator. The function is a Feistel network; its rounds take the middle of a square:

    (L, R) -> (R, L + mid((R + k)²)),   k the key of the round, mid(x) = floor(x / 2^13),

all modulo 2^26. Squares of such words are exact in double precision, so that both kinds of loop
agree.

Source: Widynski, Squares: a fast counter-based RNG, 2020, for the idea; the words are shorter here.
"""

from __future__ import annotations

from math import pi

import casadi as ca

WORD = 2.0**26
HALF = 2.0**13
ROUNDS = 10
MULTIPLIER, WEYL = 0x2D2C68D, 0x278DDE7  # odd: of the seed, and added to the key in every round
STREAMS = 64  # independent pairs of numbers of one tick


def standard_normal(seed: ca.SX, tick: ca.SX, count: int) -> ca.SX:
    """Independent numbers with the standard normal distribution, (count, 1).

    By the method of Box and Muller, in pairs from pairs of uniform numbers; none exceeds 6.1.

    Args:
        seed: whole number from 0 to 2^26 - 1.
        tick: whole number from 0 on.
        count: at most 2 STREAMS.
    """
    found = list[ca.SX]()
    for stream in range((count + 1) // 2):
        one, two = uniform_pair(seed, tick, stream)
        radius, angle = ca.sqrt(-2 * ca.log(one)), 2 * pi * two
        found += [radius * ca.cos(angle), radius * ca.sin(angle)]
    return ca.vertcat(*found[:count])


def uniform_pair(seed: ca.SX, tick: ca.SX, stream: int) -> tuple[ca.SX, ca.SX]:
    """Two independent numbers with the uniform distribution on (0, 1).

    Args:
        seed, tick: see `standard_normal`.
        stream: less than STREAMS; different ones are independent.
    """
    turns = ca.floor(tick / WORD)
    left, right = tick - WORD * turns, STREAMS * turns + stream
    key = _word(MULTIPLIER * seed)
    for _ in range(ROUNDS):
        middle = ca.floor(_word(right + key) ** 2 / HALF)
        left, right = right, _word(left + middle)
        key = _word(key + WEYL)
    return (left + 0.5) / WORD, (right + 0.5) / WORD


def _word(x: ca.SX) -> ca.SX:
    """x modulo 2^26, exactly."""
    return x - WORD * ca.floor(x / WORD)
