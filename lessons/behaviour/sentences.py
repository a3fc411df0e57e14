"""Sentences that say what the lab does: found by their words, and played or listed with a reason.

The list `sentences.toml` of a course names those that no mark plays, and why.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path

import msgspec

from onpath.lessons.action_schema import Data, Script, StepSetup
from onpath.lessons.problems import Problem
from onpath.lessons.text_files import FileError, load_toml, read_text, toml_fault
from onpath.lessons.vocabulary.fences import FENCES, KNOWN

FILE = "sentences.toml"
SUBJECTS = {
    "en": r"labs?|pages?|plots?|sliders?|buttons?|menus?|folders?|maps?|robots?|arms?|paths?|bends?"
    r"|strands?|tracker|follower|clock",
    "de": r"labors?|seiten?|diagramme?s?|verläufe?|verlauf|schieber|regler|knopf|menü|ordner"
    r"|karte|roboters?|arme?|bahn(?:en)?|kurven?|bögen|bogen|stränge|nachläufer|bahnfolger|uhr",
}
VERBS = {
    "en": r"refuse[sd]?|stopped|stops|says?|said|hides?|hidden|shows?|shown|warns?|warned|allows?"
    r"|allowed|accepts?|accepted",
    "de": r"lehnt|abgelehnt|ablehnt|verweigert|hält(?=.*\ban\b)|anhält|angehalten|stoppt|gestoppt"
    r"|sagt|gesagt|verbirgt|verborgen|blendet|ausgeblendet|zeigt|gezeigt|warnt|gewarnt|erlaubt"
    r"|zugelassen|angenommen",
}
ROBOTS = {
    "en": r"robots?|arms?|tracker|follower|tips?|end-points?|clock|both|(?:left|right|other) one",
    "de": r"roboters?|arme?|nachläufer|bahnfolger|spitzen?|endpunkte?|uhr|beide",
}
MOTIONS = {
    "en": r"waits|not wait|torn|dragged|thrown|carried|leaves|stays?|falls|(?:not hurry|hurries)"
    r"|(?<!the )jumps|returns?|continues?|(?:goes|runs) on|(?:comes?|springs?) (?:back|off|to rest)"
    r"|gives? way|resists|stands? still|swings|slides|slips|sticks|creeps|turns back|catches up"
    r"|lags|lost|diverges|oscillates|overshoots",
    "de": r"wartet|(?:weg|ab|mit)?(?:gerissen|geworfen)|verlässt|verlassen(?! sich)|bleibt|bleiben"
    r"|fällt|eilt|springt|kehr(?:t|en)(?=.*\b(?:um|zurück)\b)|(?:läuft|geht)(?=.*\bweiter\b)"
    r"|holt(?=.*\b(?:auf|ein)\b)|(?:kommt|kommen|federt)(?=.*\b(?:ab|zurück|zur Ruhe)\b)"
    r"|(?:gibt|geben)(?=.*\bnach\b)|(?:steht|stehen)(?=.*\bstill\b)|schwingt|gleitet|rutscht"
    r"|klebt|kriecht|verloren",
}
"""What a robot or its clock does, rather than the lab, within `APART` words of it."""
APART = 3
NAMED = {
    "en": r"press|set|change|open|slider|button|folder|menu",
    "de": r"drücke?|stelle|ändere|öffne|schieber|knopf|ordner|menü",
}
"""What stands before the bold name of a button or another control."""
NOT_SAID = ("summary", "needs", "goals", "misconception", "usual")
"""What is said of the student, or believed by many."""
SAYING = tuple(name for name in ("", *KNOWN) if name not in ("scene", "script", "step"))
"""Blocks with sentences; the empty name is that of the text outside blocks."""
OPTION = re.compile(r"""\btext = ("(?:[^"\\]|\\.)*"|'[^']*'),""")
"""The text of an option in a question: what a student may believe."""
RIGHT = "right = true"
FENCE = re.compile(r"\s*(`{3,}|~{3,})\s*(\S*)")
END = re.compile(r"(?<=[.!?;:|])(?:[\"”“)*]*)\s+")


class Sentence(Data, frozen=True, rename={"where": "in", "setup": "scene"}):
    """A sentence that says what the lab does, and that no mark in its text plays.

    Attributes:
        where: name of the lesson, or of another text.
        en, de: a part of the sentence, without line breaks; empty if it is not found in a language.
        reason: why it is not played.
        plays: what the lab does, as in a mark; instead of a reason.
        setup: set-up of the lab that plays it.
        script: what happens there.
    """

    where: str
    en: str = ""
    de: str = ""
    reason: str = ""
    plays: str = ""
    setup: StepSetup = StepSetup()
    script: Script | None = None

    def part(self, language: str) -> str:
        """The part of the sentence in a language."""
        return {"en": self.en, "de": self.de}.get(language, "")


class _File(Data, frozen=True):
    sentence: tuple[Sentence, ...] = ()


def read_sentences(folder: Path) -> tuple[tuple[Sentence, ...] | None, list[Problem]]:
    """The list of a course, or None if it has none, and the problems of its file."""
    file = folder / FILE
    if not file.exists():
        return None, []
    content = ""
    try:
        content = read_text(file)
        return msgspec.convert(load_toml(content), _File).sentence, []
    except FileError as error:
        return (), [error.problem]
    except tomllib.TOMLDecodeError as error:
        below, fault = toml_fault(error, content)
        return (), [Problem(str(file), 1 + below, fault)]
    except msgspec.ValidationError as error:
        return (), [Problem(str(file), 1, str(error))]


def found_sentences(text: str, language: str, of_law: bool = False) -> Iterator[tuple[int, str]]:
    """Lines and sentences of a text that say what the lab does, and contain no mark.

    A sentence is found by a subject (the lab, the page, a robot, a path, a button) and a verb
    (refuses, stops, says, hides, shows, warns, allows), or by a robot and, a few words away, what
    it does (waits, is torn off, leaves, stays, comes back). Questions, and their wrong
    options, say nothing.

    Args:
        text: in one language.
        language: whose words are looked for; in others nothing is found.
        of_law: whether the text is of one control law, whose name need not be repeated.
    """
    if language not in SUBJECTS:
        return
    subject, verb = _words(SUBJECTS[language]), _words(VERBS[language])
    robot, motion = f"(?:{ROBOTS[language]})", f"(?:{MOTIONS[language]})"
    gap = rf"(?:\W+[\w'’-]+){{0,{APART}}}?\W+"
    moves = _words(motion if of_law else f"{robot}{gap}{motion}|{motion}{gap}{robot}")
    for line, sentence in _sentences(text):
        says = (subject.search(sentence) and verb.search(sentence)) or moves.search(sentence)
        if says and "{{" not in sentence and not sentence.rstrip('*_"”“),').endswith("?"):
            yield line, sentence


def _words(pattern: str) -> re.Pattern[str]:
    return re.compile(rf"(?<!\w)(?:{pattern})(?!\w)", re.IGNORECASE)


def _sentences(text: str) -> Iterator[tuple[int, str]]:
    for first, paragraph in _paragraphs(text):
        begin = 0
        for end in [*(match.end() for match in END.finditer(paragraph)), len(paragraph)]:
            line = first + paragraph.count("\n", 0, begin)
            yield line, " ".join(paragraph[begin:end].split())
            begin = end


def _paragraphs(text: str) -> Iterator[tuple[int, str]]:
    """First lines and texts of the paragraphs; a line of TOML is one."""
    block, inside, kept = "", False, list[str]()
    for number, line in enumerate([*text.split("\n"), ""], 1):
        mark = FENCE.match(line)
        if mark:
            inside = not inside
            block = (mark[2] or "code") if inside else ""
        elif line.strip() and block in SAYING and not line.startswith(NOT_SAID):
            kept.append(line if RIGHT in line else OPTION.sub("", line))
            if block not in FENCES:
                continue
            yield number, kept.pop()
        if kept:
            yield number - len(kept), "\n".join(kept)
            kept = []


def named_controls(text: str, language: str) -> Iterator[tuple[int, str]]:
    """Lines and bold names of the controls that a text tells its reader to use."""
    if language in NAMED:
        pattern = rf"(?<!\w)(?:{NAMED[language]})\s+\*\*([^*\n]+)\*\*"
        for match in re.finditer(pattern, text, re.IGNORECASE):
            yield text.count("\n", 0, match.start(1)) + 1, match[1].strip()


def list_faults(
    listed: Sequence[Sentence], where: str, language: str, text: str, of_law: bool = False
) -> Iterator[tuple[int, str]]:
    """Lines and faults of a text's sentences that are neither played nor listed.

    Args:
        listed: the course's list.
        where: name of the text in the list.
        language: that of the text.
        text: in one language.
        of_law: whether it is of one control law.
    """
    entries = [each for each in listed if each.where == where and each.part(language)]
    found = list(found_sentences(text, language, of_law))
    plain = " ".join(text.split())
    for line, sentence in found:
        if not any(each.part(language) in sentence for each in entries):
            yield line, f"nobody plays {sentence!r}: mark it, or list it in {FILE} with a reason"
    for each in entries:
        part = each.part(language)
        within = [plain] if each.plays else [sentence for _, sentence in found]
        if not any(part in sentence for sentence in within):
            yield 1, f"{FILE} lists {part!r} of {where}, which says so no longer"
