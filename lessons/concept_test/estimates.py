"""Numbers about a class with their intervals of 95 %, from twenty students on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array

FEWEST = 20
"""With fewer students, no number is told: its interval would say next to nothing."""
NORMAL = 1.959964
"""The standard normal distribution is within ± this with a probability of 95 %."""
DRAWS = 1000
"""Number of resamples of a bootstrap."""


@dataclass(frozen=True, slots=True)
class Estimated:
    """A number with its interval of 95 %.

    Attributes:
        count: number of students.
    """

    value: float
    low: float
    high: float
    count: int


def share(right: int, count: int) -> Estimated | None:
    """The share of right answers, [%], with Wilson's interval.

    Its ends are the p with |x - p| = z √(p (1 - p) / n), where x is the share in n answers:
    (x + z²/2n ± z √(x (1 - x)/n + z²/4n²)) / (1 + z²/n), z = `NORMAL`.

    Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.

    Returns:
        None if there are fewer than `FEWEST`.
    """
    if count < FEWEST:
        return None
    x, more = right / count, NORMAL**2 / count
    half = NORMAL * math.sqrt(x * (1 - x) / count + more / (4 * count))
    low, high = ((x + more / 2 + sign * half) / (1 + more) for sign in (-1, 1))
    return Estimated(100 * x, 100 * max(low, 0.0), 100 * min(high, 1.0), count)


def bootstrapped(
    sizes: Sequence[int], statistic: Callable[[Sequence[Array]], Array]
) -> list[Estimated | None]:
    """Statistics of some groups of students, with percentile intervals of a bootstrap.

    From each group of n students n are drawn with replacement, `DRAWS` times; the interval is from
    the 2.5th to the 97.5th percentile of the statistic. The draws are the same at each call.

    Source: B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap (1993), chapter 13.

    Args:
        sizes: number of students in each group, at least 1.
        statistic: of how often each student counts, an array (draws, size) for each group; returns
            an array (draws, statistics), not a number where it is not defined.

    Returns:
        Each statistic; None if it is not defined, or there are fewer than `FEWEST` students.
    """
    count, random = sum(sizes), np.random.default_rng(0)
    once = statistic([np.ones((1, size)) for size in sizes])[0].tolist()
    if count < FEWEST:
        return [None] * len(once)
    weights = [random.multinomial(n, np.full(n, 1 / n), DRAWS).astype(float) for n in sizes]
    found = list[Estimated | None]()
    for value, drawn in zip(once, statistic(weights).T, strict=True):
        defined = drawn[np.isfinite(drawn)]
        if not math.isfinite(value) or not len(defined):
            found.append(None)
            continue
        low, high = np.percentile(defined, (2.5, 97.5)).tolist()
        found.append(Estimated(value, low, high, count))
    return found
