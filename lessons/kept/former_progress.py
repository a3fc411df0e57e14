"""Progress as earlier versions stored it: the answers that counted, beside those that were given.

Today only the latter are kept, as `Given`, and `Notes` reads everything from them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

import msgspec
from msgspec.structs import replace

from onpath.lessons.given import Answer, Given, Index, Key, Written
from onpath.lessons.kept.option_keys import second_key, why_key


class FormerNotes(msgspec.Struct, frozen=True):
    """The fields of which there are none any more, and those from which they are understood."""

    answers: dict[Key, Answer] = {}
    second: dict[Key, Answer] = {}
    quiz: dict[Key, Index] = {}
    numbers: dict[Key, float] = {}
    written: dict[Key, Written] = {}
    tasks: dict[Key, float] = {}
    ways: dict[Key, Index] = {}
    twice: tuple[Key, ...] = ()
    marks: dict[Key, Key] = {}
    unknown: tuple[Key, ...] = ()
    asked_again: tuple[Key, ...] = ()
    hints: dict[Key, Index] = {}
    given: tuple[Given, ...] = ()


KEPT = {"asked_again", "hints", "given"}
FORMER = set(FormerNotes.__struct_fields__) - KEPT


def progress_of_today(data: object) -> object:
    """Decoded JSON of any version, as it would be stored today; unchanged if it is no object."""
    if not isinstance(data, dict):
        return data
    progress = dict(cast("dict[str, Any]", data))
    progress.pop("presenting", None)  # one of the lab's own settings now
    if isinstance(notes := progress.get("notes"), dict):
        each = cast("dict[str, Any]", notes).items()
        progress["notes"] = {name: _notes_of_today(known) for name, known in each}
    return progress


def _notes_of_today(notes: Any) -> Any:
    if not isinstance(notes, dict) or FORMER.isdisjoint(cast("dict[str, Any]", notes)):
        return cast("object", notes)
    known = cast("dict[str, Any]", notes)
    given = msgspec.to_builtins(_all_given(msgspec.convert(known, FormerNotes)))
    return {name: value for name, value in known.items() if name not in FORMER} | {"given": given}


def _all_given(former: FormerNotes) -> list[Given]:
    """All answers: those that were given, and those of which only the result was kept."""
    found = dict[str, list[Given]]()
    for each in former.given:
        found.setdefault(each.item, []).append(each)
    for second, answers in enumerate((former.answers, former.second)):
        for item, answer in answers.items():
            counts = _predicted(former, item, answer, bool(second))
            _first(found.setdefault(item, []), counts)
    for counts in _asked(former):
        _last(found.setdefault(counts.item, []), counts)
    for given in found.values():
        given[:] = [replace(each, attempt=n) for n, each in enumerate(given, 1)]
    for item in former.twice:
        if item in found:
            found[item][-1] = replace(found[item][-1], attempt=max(2, len(found[item])))
    for task, value in former.tasks.items():
        way, hints = former.ways.get(task, 0), former.hints.get(task, 0)
        found[task] = [Given(task, number=value, right=True, way=way, hints=hints)]
    return [each for given in found.values() for each in given]


def _asked(former: FormerNotes) -> Iterator[Given]:
    """The last answers to questions."""
    for item, option in former.quiz.items():
        yield Given(item, answer=Answer(option=option), mark=former.marks.get(item, ""))
    for item, number in former.numbers.items():
        yield Given(item, number=number)
    for item, text in former.written.items():
        yield Given(item, text=text)
    for item in former.unknown:
        if "." in item and item not in former.quiz:
            yield Given(item, answer=Answer(), lost=True)


def _predicted(former: FormerNotes, item: str, answer: Answer, second: bool) -> Given:
    key = second_key(item) if second else item
    return Given(
        item,
        round=former.asked_again.count(item) if second else 0,
        answer=answer,
        lost=answer.skipped and key in former.unknown,
        mark=former.marks.get(key, ""),
        why_mark=former.marks.get(why_key(key), ""),
    )


def _first(given: list[Given], counts: Given) -> None:
    """The answer that counts is the first of its round that was not skipped."""
    of_round = [each for each in given if each.round == counts.round]
    made = next((each for each in of_round if not each.is_skipped), None)
    if made is None and of_round and counts.is_skipped:
        same = replace(of_round[0], answer=counts.answer, lost=counts.lost)
        given[given.index(of_round[0])] = same
    elif made is None or made.answer != counts.answer:
        at = next((i for i, each in enumerate(given) if each.round >= counts.round), len(given))
        given.insert(at, counts)


def _last(given: list[Given], counts: Given) -> None:
    """The answer that counts is the last one."""
    said = (counts.answer, counts.number, counts.text)
    if counts.lost and given:
        given[-1] = replace(given[-1], answer=counts.answer, lost=True)
    elif not given or (given[-1].answer, given[-1].number, given[-1].text) != said:
        given.append(counts)
