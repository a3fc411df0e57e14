"""Compares a course's sentences about the lab with its list of those that no mark plays."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from onpath.app.lab.dry_runs.behaviour_check import (
    name_faults,
    page_fault,
    played,
    played_fault,
)
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.setups.step_setup import setup_from
from onpath.assets.messages import DEFAULT, catalogue
from onpath.lessons.behaviour.marks import read_behaviour
from onpath.lessons.behaviour.sentences import (
    FILE,
    Sentence,
    found_sentences,
    list_faults,
    read_sentences,
)
from onpath.lessons.concept_test.concept_test import FOLDERS, form_of
from onpath.lessons.course import BUILT_IN, Course
from onpath.lessons.problems import Problem
from onpath.lessons.text_files import read_text
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import LAWS
from onpath.models.systems.catalogue import FIVE_BAR

README = BUILT_IN.parents[1] / "README.md"
GROUPS = ("help", "key", "guide", "laws")
"""Groups of the catalogue's texts that say what the lab does."""
OF_LAW = ("text", "good", "limits", "objection")


def sentence_faults(course: Course, folder: Path, loop_cache: LoopCache) -> Iterator[Problem]:
    """Problems of the sentences that no mark plays; none if the folder has no list of them.

    The built-in course's list includes README, help, the guide and the laws' texts.
    """
    listed, problems = read_sentences(folder)
    yield from problems
    if listed is None:
        return
    texts = dict(_texts(course, folder))
    for where in sorted({each.where for each in listed} - {where for where, _ in texts}):
        if not (folder / where).is_dir():  # a lesson that is not read now
            yield Problem(str(folder / FILE), 1, f"there is no text {where!r}")
    for (where, language), (file, text) in texts.items():
        for line, fault in list_faults(listed, where, language, text, _of_law(where)):
            yield Problem(file, line, fault)
        if where not in (*course.played, *FOLDERS):
            yield from (Problem(file, *fault) for fault in name_faults(text, language))
    for each in listed:
        if fault := _fault(each, loop_cache):
            yield Problem(str(folder / FILE), 1, f"{each.where}: {each.en or each.de!r}: {fault}")


def unplayed(course: Course, folder: Path) -> int:
    """How many sentences of a course without a list say what the lab does, and nobody plays."""
    if read_sentences(folder)[0] is not None:
        return 0
    texts = _texts(course, folder)
    return sum(len(list(found_sentences(text, language))) for (_, language), (_, text) in texts)


def _of_law(where: str) -> bool:
    return where.startswith("law.")


def _texts(course: Course, folder: Path) -> Iterator[tuple[tuple[str, str], tuple[str, str]]]:
    """Name and language of each text, with its file and its words."""
    homes = [*course.played, *(FOLDERS[form_of(name)] for name in course.tests)]
    for home in dict.fromkeys(homes):
        for file in sorted((folder / home).glob("??.md")):
            yield (home, file.stem), (str(file), read_text(file))
    if folder.resolve() != BUILT_IN.resolve():
        return
    if README.exists():
        yield (README.name, "en"), (str(README), read_text(README))
    keys = [key for group in GROUPS for key in catalogue(DEFAULT).keys(group)]
    for language in course.languages():
        words = Words(language)
        for key in keys:
            yield (key, language), (key, catalogue(language).text(key, defaultdict(lambda: "…")))
        for name, law in LAWS.items():
            for part in OF_LAW:
                key = f"law.{name}.{part}"
                yield (key, language), (key, words.get(key, getattr(law, part)))


def _fault(each: Sentence, loop_cache: LoopCache) -> str:
    """Why an entry of the list is not as it should be; empty if it is."""
    if bool(each.plays) == bool(each.reason):
        return "an entry has either a reason or `plays`"
    if not each.plays:
        return ""
    try:
        said = read_behaviour(1, each.en, each.plays)
    except ValueError as error:
        return str(error)
    if said.verb in ("plot", "drawing", "control", "label"):
        return page_fault(said, each.setup, Words("en"), FIVE_BAR.name)
    if each.script is None:
        return "a play needs a script"
    seen = played(setup_from(each.setup, FIVE_BAR.name), each.script, loop_cache)
    return played_fault(said, seen)
