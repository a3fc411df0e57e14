"""How often strategies for options that read no physics are right, compared with chance.

A strategy marks some options of a question by their form. Where it marks k of n options, 0 < k < n,
and takes one of those at random, it is right with probability 1/k or 0. If the right option
has nothing to do with the form, that has the mean 1/n and the variance 1/(k n) - 1/n². Questions in
which it marks no option, or every one, say nothing about it. Predictions, quizzes, second tries and
each concept test are counted separately, as is each language.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import unescape

from onpath.lessons.course import Course
from onpath.lessons.option_order import LETTERS
from onpath.lessons.schema import Choice, Lesson, Option, Quiz

ALLOWED = 1.5
"""How many standard deviations a strategy may be from chance."""
FEWEST = 4
"""With fewer questions, nobody can learn a strategy."""

_TAG = re.compile(r"<[^>]*>")
_WORD = re.compile(r"\w+")
_NUMBER = re.compile(r"(?<!\w)\d+(?:[.,]\d+)?")
_ABSOLUTE = {
    "en": r"\b(?:never|always|ever|every\w*|all|any|none|nothing|nobody|only|whatever|at all)\b",
    "de": r"\b(?:nie|niemals|immer|stets|jede[mnrs]?|alle[mnrs]?|keine[mnrs]?|nichts|niemand|nur"
    r"|überhaupt)\b",
}
_REASON = {
    "en": r":|\b(?:because|since|so that)\b|, (?:so|for|as) ",
    "de": r":|\b(?:weil|denn|damit|sodass)\b|, (?:also|da) ",
}
"""What tells a reason; most wrong options give theirs after a colon."""


@dataclass(frozen=True, slots=True)
class Rate:
    """How often a strategy is right in some questions.

    Attributes:
        group: the questions, such as "en predictions".
        strategy: its name.
        count: number of questions in which it prefers some options to others.
        right: expected number of right answers to those.
        chance: that of somebody who takes any option.
        deviation: standard deviation of `right` if it were chance.
    """

    group: str
    strategy: str
    count: int
    right: float
    chance: float
    deviation: float

    @property
    def suspicious(self) -> bool:
        """Whether it is right more or less often than chance can explain."""
        enough = self.count >= FEWEST
        return enough and abs(self.right - self.chance) > ALLOWED * self.deviation + 1e-9

    def __str__(self) -> str:
        mark = "!" if self.suspicious else " "
        return f"{self.right:.1f} ({self.chance:.1f} ± {ALLOWED * self.deviation:.1f}){mark}"


def rates(course: Course) -> list[Rate]:
    """The rates of all strategies, in each language and kind of question."""
    return [
        rate(group, name, [(picks(each.options, language), _right(each)) for each in questions])
        for language in course.languages()
        for group, questions in _groups(course, language)
        for name, picks in STRATEGIES.items()
    ]


def rate(group: str, strategy: str, marked: Iterable[tuple[Sequence[bool], int]]) -> Rate:
    """The rate of a strategy.

    Args:
        marked: for each question, which options the strategy marks, and the index of the right one.
    """
    telling = [(marks, at) for marks, at in marked if 0 < sum(marks) < len(marks)]
    variances = (1 / (sum(marks) * len(marks)) - 1 / len(marks) ** 2 for marks, _ in telling)
    return Rate(
        group=group,
        strategy=strategy,
        count=len(telling),
        right=math.fsum(marks[at] / sum(marks) for marks, at in telling),
        chance=math.fsum(1 / len(marks) for marks, _ in telling),
        deviation=math.sqrt(math.fsum(variances)),
    )


def _groups(course: Course, language: str) -> Iterator[tuple[str, list[Choice | Quiz]]]:
    """The questions that are counted together, with their names."""
    lessons = [v[language] for v in course.lessons.values() if language in v]
    asked = [each for lesson in lessons for each in _asked(lesson)]
    yield f"{language} predictions", [each for each in asked if isinstance(each, Choice)]
    yield f"{language} quizzes", [each for each in asked if isinstance(each, Quiz)]
    tries = [each.second.asked for each in asked if each.second is not None]
    yield f"{language} second tries", [each for each in tries if isinstance(each, Quiz)]
    tests = [versions[language] for versions in course.tests.values() if language in versions]
    forms = {tuple(_asked(test)): test.name for test in reversed(tests)}
    yield from ((f"{language} {name}", list(form)) for form, name in reversed(forms.items()))


def _asked(lesson: Lesson) -> Iterator[Choice | Quiz]:
    for step in lesson.steps:
        yield from (block for block in step.blocks if isinstance(block, Choice | Quiz))


def _right(asked: Choice | Quiz) -> int:
    return next(at for at, option in enumerate(asked.options) if option.right)


Strategy = Callable[[Sequence[Option], str], list[bool]]
"""Which options it marks: of the options of a question, in a language."""


def _text(option: Option) -> str:
    return unescape(_TAG.sub("", option.text)).strip()


def _lengths(options: Sequence[Option]) -> list[int]:
    return [len(_text(option)) for option in options]


def _largest(values: Sequence[float]) -> list[bool]:
    return [value == max(values) for value in values]


def _shortest(options: Sequence[Option], language: str) -> list[bool]:
    return _largest([-length for length in _lengths(options)])


def _longest(options: Sequence[Option], language: str) -> list[bool]:
    return _largest(_lengths(options))


def _middle(options: Sequence[Option], language: str) -> list[bool]:
    lengths = _lengths(options)
    return [min(lengths) < length < max(lengths) for length in lengths]


def _most_numbers(options: Sequence[Option], language: str) -> list[bool]:
    return _largest([len(_NUMBER.findall(_text(option))) for option in options])


def _absolute(options: Sequence[Option], language: str) -> list[bool]:
    return _having(_ABSOLUTE, options, language)


def _reason(options: Sequence[Option], language: str) -> list[bool]:
    return _having(_REASON, options, language)


def _having(words: dict[str, str], options: Sequence[Option], language: str) -> list[bool]:
    """Which options have one of the words; none in a language without a list."""
    if language not in words:
        return [False] * len(options)
    pattern = re.compile(words[language], re.IGNORECASE)
    return [bool(pattern.search(_text(option))) for option in options]


def _odd(options: Sequence[Option], language: str) -> list[bool]:
    """The options of which the smallest share of words occurs in another one."""
    words = [set(_WORD.findall(_text(option).lower())) for option in options]
    spread = Counter(word for each in words for word in each)
    return _largest([-sum(spread[w] > 1 for w in each) / max(1, len(each)) for each in words])


def _place(at: int) -> Strategy:
    return lambda options, language: [i == at for i in range(len(options))]


STRATEGIES: dict[str, Strategy] = {
    "shortest": _shortest,
    "longest": _longest,
    "middle": _middle,
    "most numbers": _most_numbers,
    "never/always": _absolute,
    "odd one out": _odd,
    "with a reason": _reason,
    **{f"place {LETTERS[at]}": _place(at) for at in range(4)},
}
"""The strategies by their names."""
