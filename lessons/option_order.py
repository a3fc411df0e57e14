"""The order in which a student is shown the options of a question.

Everything that is stored or counted has the author's numbering. Only what a student sees is in
another order, so that no position is always right and neighbours cannot copy letters.
"""

from __future__ import annotations

import hashlib

LETTERS = "ABCDEFGH"
"""Names of the positions of options; in records and statistics, of the options themselves."""


def option_order(count: int, question: str, student: str) -> tuple[int, ...]:
    """The author's indices of the options, in the order in which a student is shown them.

    The same arguments always give the same order, so that a page may be reloaded. For a random
    student each of the `count`! orders is equally likely.

    Args:
        count: number of options.
        question: identifies the question, in the same way in all languages.
        student: identifies the student, such as the code of the lab; empty for the
            author's order.
    """
    if not student:
        return tuple(range(count))

    def draw(option: int) -> bytes:
        return hashlib.sha256(f"{student} {question} {option}".encode()).digest()

    return tuple(sorted(range(count), key=draw))
