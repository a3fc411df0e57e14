"""Everything the interface says comes from the catalogue, in every language."""

from __future__ import annotations

import ast
import dataclasses
import json
import pickle
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from jinja2 import Environment, nodes

from onpath.app.exports.site.step_figures import HERE, STANDS_FOR
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.plot_rows import ROWS
from onpath.app.storage.records import NotKept
from onpath.app.view.keys import KEYS
from onpath.app.view.lab_form import GROUPS, PULLS, SECTIONS
from onpath.app.view.page_words import words_message
from onpath.assets import asset_path
from onpath.assets.messages import catalogue, identifier, languages
from onpath.lessons.labels import (
    option_label,
    parameter_help,
    parameter_label,
    robot_label,
)
from onpath.lessons.record import PLOTS
from onpath.lessons.vocabulary.names import CONTROLS
from onpath.lessons.words import ELSEWHERE, ENGLISH, Words
from onpath.models import systems
from onpath.models.closed_loop.lab_settings import SETTINGS, lab_specs
from onpath.models.control.laws.own import MEANINGS, SPACE_MEANINGS
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.poles import channels
from onpath.models.control.settable import specs
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.errors import CodedError, Message, message_of
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.curves import circle
from onpath.models.paths.path_design import presets
from onpath.models.robot_files.file_chain import some_names
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS, found_robots
from onpath.models.systems.chain_robot import LimitedSpatialParameters
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.flexible_robot import BENT, BENT_OR_UNSTABLE, UNSTABLE
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import declared
from onpath.models.systems.robots import AT_A_LIMIT, RobotEntry
from tests.support.catalogues import COMPLETE, arguments, counts, messages
from tests.support.checkout import ROOT
from tests.support.lab import do, loop_cache, run

SOURCES = sorted(file for folder in ("app", "lessons") for file in (ROOT / folder).rglob("*.py"))
CODED = [*SOURCES, *sorted((ROOT / "models").rglob("*.py"))]
PAGE = sorted(
    [
        *(ROOT / "app" / "view").glob("*.py"),
        *(ROOT / "app" / "classroom" / "teaching").glob("*.py"),
        ROOT / "app" / "exports" / "exporter.py",
    ]
)
KEYS_MADE = (
    *("form.group_", "form.section_"),
    "start.",
    *(
        "quantity.",
        "stat.",
        "during.",
        "event.",
        "robot.",
        "kind.",
        "language.",
        "report.",
        "sure.",
    ),
    *("caption.", "invite.", "spoken."),
    *("side.", "laws.", "obstruction.", "aim.", "key.", "keyname.", "pull.", "plot.", "axis."),
    *("check.above", "check.below", "gains.across", "gains.along"),
    *("lesson.back", "lesson.again", "lesson.close", "site.control.", "symbol.", "show."),
    *("standalone.recorded_", "arena.", "site.why.", "figure."),
    *("search.kind_", "search.of_", "aid.", "robots.differs_", "export.", "form."),
    *ELSEWHERE,
)
"""Keys, or their beginnings, that are put together from what the program knows by other names."""
PREFIXES = tuple(identifier(key) for key in KEYS_MADE)
OTHERS = [language for language in languages() if language != "en"]
TRANSLATED = [language for language in COMPLETE if language != "en"]


@cache
def parsed(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def text_of(node: ast.AST) -> str | None:
    """A string's text, "{}" where an f-string has a value; None if it is no string."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(str(v.value) if isinstance(v, ast.Constant) else "{}" for v in node.values)
    return None


def calls(tree: ast.AST) -> Iterator[tuple[str, ast.Call]]:
    """Every call with the last part of the name that is called."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", None) or getattr(node.func, "id", "")
            yield name, node


# All text comes from the catalogue.

SHOWN = {"label", "help", "hint", "text", "title", "unit", "rest", "asks", "summary", "voice"}


def said_literally(tree: ast.AST) -> Iterator[str]:
    """Strings with letters that are given to a field, a title or a label as they stand."""
    for _, call in calls(tree):
        yield from (t for k in call.keywords if k.arg in SHOWN for t in literals(k.value))
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            targets = {getattr(target, "attr", "") for target in node.targets}
            if targets & SHOWN:
                yield from literals(node.value)


def literals(node: ast.AST) -> Iterator[str]:
    """Strings with letters in an expression, but for those that choose a key or name a node."""
    if isinstance(node, ast.Call | ast.Compare | ast.Subscript):
        return
    text = text_of(node)
    if text is None:
        for child in ast.iter_child_nodes(node):
            yield from literals(child)
    elif re.search(r"[^\W\d_]{2}", re.sub(r"<[^>]*>|\{\}", "", text)) and text[:1] != "/":
        yield text


def sentences(tree: ast.AST) -> Iterator[str]:
    """Strings of two words or more that are neither documentation nor markup nor an error's."""
    skipped: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise | ast.Assert):
            skipped.update(ast.walk(node))
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            skipped.add(node.value)
        elif isinstance(node, ast.JoinedStr):
            skipped.update(node.values)
    for node in ast.walk(tree):
        text = None if node in skipped else text_of(node)
        if text is not None:
            bare = re.sub(r"<style>.*?</style>|<[^>]*>?", "", text, flags=re.DOTALL)
            if re.search(r"[^\W\d_]{2,} [^\W\d_]{2,}", bare) and not re.search(r"\w:\S", bare):
                yield text


@pytest.mark.parametrize("file", PAGE, ids=lambda file: str(file.relative_to(ROOT)))
def test_a_page_says_nothing_but_from_the_catalogue(file: Path) -> None:
    said = [*said_literally(parsed(file)), *sentences(parsed(file))]
    assert [text for text in said if text not in PULLS] == []


def test_what_is_said_literally_would_be_noticed() -> None:
    bad = ast.parse(
        "Field(label='Run')\nField(name='a', help=words('a.b') + 'Faster')\nx.label = f'Now {y}'\n"
        "Group(rest='one' if a else 'two')\nHELP = 'do this'\nOption(text=f'in {ms}')\n"
    )
    assert len([*said_literally(bad)]) == 6 and [*sentences(bad)] == ["do this"]
    fine = ast.parse(
        "'''A module.'''\nField(label='', text=words('a.b'))\nField(help=b if a == 'it' else '')\n"
    )
    assert [*said_literally(fine), *sentences(fine)] == []


# Code and catalogue know the same keys.


def asked_for() -> Iterator[str]:
    """What the code asks a catalogue for; "{}" where a key has a part that varies."""
    for file in SOURCES:
        for name, call in calls(parsed(file)):
            asks = name.lower().endswith("words") or name == "ENGLISH"
            if asks and call.args and name not in ("Words", "_stat_words"):
                first = call.args[0]
                branches = [first.body, first.orelse] if isinstance(first, ast.IfExp) else [first]
                yield from (text for node in branches if (text := text_of(node)))


def asked_for_in_templates() -> Iterator[tuple[str, dict[str, nodes.Expr]]]:
    """What the templates ask for, and the arguments that they give.

    A key with a part that varies stands for those that the template's other strings make of it.
    """
    for file in sorted((ROOT / "assets" / "templates").rglob("*.html")):
        tree = Environment().parse(file.read_text(encoding="utf-8"))
        strings = {str(const.value) for const in tree.find_all(nodes.Const)}
        for call in tree.find_all(nodes.Call):
            name = getattr(call.node, "name", "")
            if name in ("words", "phrase"):
                first = call.args[1 if name == "phrase" else 0]
                both = isinstance(first, nodes.CondExpr)
                given = {keyword.key: keyword.value for keyword in call.kwargs}
                for node in [first.expr1, first.expr2] if both else [first]:
                    key = key_of(node)
                    made = {key.replace("{}", string) for string in strings}
                    found = {each for each in made if identifier(each) in messages("en")}
                    keys = found if "{}" in key and found else {key}
                    yield from ((each, given) for each in keys)


def key_of(node: nodes.Node | None) -> str:
    """A key in a template, "{}" where it has a part that varies."""
    if isinstance(node, nodes.Concat):
        return "".join(map(key_of, node.nodes))
    return str(node.value) if isinstance(node, nodes.Const) else "{}"


def test_every_key_that_is_asked_for_exists() -> None:
    asked = {*asked_for(), *(key for key, _ in asked_for_in_templates())}
    assert len(asked) > 100
    known = messages("en")
    assert {key for key in asked if "{}" not in key and identifier(key) not in known} == set()
    for key in asked:
        if "{}" in key:
            pattern = ".+".join(re.escape(identifier(part)) for part in key.split("{}"))
            found = [own for own in known if re.fullmatch(pattern, own)]
            assert key.startswith(ELSEWHERE) or any(own.startswith(PREFIXES) for own in found), key


def test_every_key_is_used() -> None:
    texts = {text_of(node) for file in CODED for node in ast.walk(parsed(file))}
    texts |= {key for key, _ in asked_for_in_templates()}
    written = {identifier(text) for text in texts if text and len(text) < 80}
    unused = {key for key in messages("en") if key not in written}
    assert {key for key in unused if not key.startswith(PREFIXES)} == set()


# Keys that are composed exist in every language.


@pytest.mark.parametrize("words", [Words(language) for language in languages()])
def test_what_the_program_names_has_words(words: Words) -> None:
    assert {row.name for row in ROWS} == {"distance", *PLOTS} - {"phase"}
    for row in ROWS:
        assert words(f"plot.{row.name}") and words(f"axis.{row.name}")
    for name in CONTROLS:
        assert name in (*HERE, *STANDS_FOR) or words(f"site.control.{name}")
    for key in KEYS:
        assert key.does(words) and key.shown(words)
    for channel in channels(FiveBarParameters()):
        assert words(f"gains.{channel.name}")
    assert all(words(f"form.group_{group}") for group in GROUPS)
    assert all(words(f"form.section_{section}") for section in (*SECTIONS, "model"))


def keys_of(entry: RobotEntry) -> Iterator[str]:
    """What a language that knows the robot has words for, besides units."""
    yield from (f"machine.{entry.name}.{part}" for part in ("label", "text"))
    yield from keys_of_settings(declared(entry.parameters))


def keys_of_settings(settings: Mapping[str, Spec]) -> Iterator[str]:
    """What a language has words for, besides units."""
    for name, spec in settings.items():
        yield from (f"parameter.{name}.{part}" for part in ("label", "help"))
        if spec.kind == "choice" and not isinstance(spec.options[0], int):
            yield from (f"parameter.{name}.option.{option}" for option in spec.options)


@pytest.mark.parametrize("words", [Words(language) for language in TRANSLATED])
def test_what_stands_in_models_is_translated(words: Words) -> None:
    """The paths, and all of the robots and laws that the language knows; others are in English."""
    known = catalogue(words.language)
    assert [name for name in presets() if f"path.{name}" not in known] == []
    laws = [f"law.{name}" for name in LAWS if f"law.{name}.label" in known]
    assert {f"law.{name}" for name in DEFAULT_LAWS.values()} <= {*laws}
    parts = ("text", "good", "limits", "objection")
    assert [law for law in laws for part in parts if f"{law}.{part}" not in known] == []
    own = [
        gain.name for law in LAWS.values() if f"law.{law.name}" in laws for gain in law.own_gains
    ]
    parts = ("label", "help")
    assert [n for n in own for part in parts if f"parameter.{n}.{part}" not in known] == []
    own = [f"law.own.{value.names[0]}" for value in (*MEANINGS, *SPACE_MEANINGS)]
    assert [key for key in ("law.own.label", *own) if key not in known] == []
    told = [entry for entry in ROBOTS.values() if f"machine.{entry.name}.label" in known]
    assert {FIVE_BAR.name, FLEXIBLE.name} <= {entry.name for entry in told}
    for entry in told:
        assert [key for key in keys_of(entry) if key not in known] == []
    own = keys_of_settings({name: setting.spec for name, setting in SETTINGS.items()})
    assert [key for key in own if key not in known] == []


@pytest.mark.parametrize("words", [Words(language) for language in languages()])
def test_every_robot_has_labels_in_every_language(words: Words) -> None:
    for entry in ROBOTS.values():
        assert robot_label(entry.name, words)
        labels = [
            parameter_label(n, spec, words) for n, spec in lab_specs(entry.parameters).items()
        ]
        assert sorted(set(labels)) == sorted(labels)  # no name is used twice
        for name, spec in lab_specs(entry.parameters).items():
            assert parameter_label(name, spec, words) and parameter_help(name, spec, words)
            shown = [option_label(name, option, words) for option in spec.options]
            assert len(set(shown)) == len(shown)


NEW_ROBOT = """
from dataclasses import dataclass
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.parameter_specs import choice, number
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.parameters import declared
from onpath.models.systems.robots import AT_A_LIMIT, RobotEntry

@dataclass(frozen=True, slots=True)
class CraneParameters(Parameters):
    rope: float = number(1.0, "m", (0.5, 2, 0.1), "length of the rope", group="robot", label="Rope")
    hook: str = choice("light", ("light", "heavy"), "which hook", group="robot", label="Hook")

ROBOT = RobotEntry(name="crane", label="Crane", text="A load on a rope.",
    parameters=CraneParameters, make=lambda _: RIGID_FIVE_BAR)
"""


@pytest.fixture
def crane(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RobotEntry]:
    """A robot that is one more file, without words in any catalogue."""
    (tmp_path / "crane.py").write_text(NEW_ROBOT)
    monkeypatch.setattr(systems, "__path__", [*systems.__path__, str(tmp_path)])
    monkeypatch.setitem(ROBOTS, "crane", found_robots()["crane"])
    yield ROBOTS["crane"]
    sys.modules.pop("onpath.models.systems.crane", None)


def test_a_new_robot_speaks_english_until_it_is_translated(crane: RobotEntry) -> None:
    for language in languages():
        words, known = Words(language), specs(crane.parameters)
        assert robot_label("crane", words) == "Crane"
        assert parameter_label("rope", known["rope"], words) == "Rope"
        assert parameter_help("hook", known["hook"], words) == "which hook"
        assert option_label("hook", "heavy", words) == "heavy"
        test_every_robot_has_labels_in_every_language(words)
        if language in TRANSLATED:
            assert parameter_label("K1", known["K1"], words) != known["K1"].label  # as every robot
            test_what_stands_in_models_is_translated(words)
            test_no_language_translates_anything_that_does_not_exist(language)


@pytest.mark.parametrize("language", OTHERS)
def test_no_language_translates_anything_that_does_not_exist(language: str) -> None:
    there_are = {f"language.{language}", *(f"path.{name}" for name in presets())}
    for entry in ROBOTS.values():
        there_are |= {f"machine.{entry.name}.{part}" for part in ("label", "text")}
    kinds = (*(entry.parameters for entry in ROBOTS.values()), LimitedSpatialParameters)
    lab = {name: setting.spec for name, setting in SETTINGS.items()}
    for known in (lab, *map(specs, kinds)):
        for name, spec in known.items():
            parts = ("label", "help", "unit", *(f"option.{option}" for option in spec.options))
            there_are |= {f"parameter.{name}.{part}" for part in parts}
    parts = ("label", "text", "good", "limits", "objection")
    there_are |= {f"law.{name}.{part}" for name in LAWS for part in parts} | {"law.own.label"}
    there_are |= {f"law.own.{value.names[0]}" for value in (*MEANINGS, *SPACE_MEANINGS)}
    only_here = messages(language).keys() - messages("en").keys()
    assert only_here <= {identifier(key) for key in there_are}


# Errors and reasons have a code in every language.

HANDED_ON = {"models/errors.py", "models/robot_files/file_chain.py"}
"""Modules that make messages of codes that others have chosen."""


def said_in_code() -> Iterator[tuple[str, set[str], str]]:
    """The code, the arguments and the file of every error and reason in the source."""
    for file in CODED:
        where = str(file.relative_to(ROOT))
        for name, call in calls(parsed(file)):
            if name in ("CodedError", "Message", "NotKept") and where not in HANDED_ON:
                first = call.args[0]
                branches = [first.body, first.orelse] if isinstance(first, ast.IfExp) else [first]
                given = {keyword.arg or "**" for keyword in call.keywords}
                if len(call.args) > 1:
                    given |= set(names_in(call.args[1], where))
                yield from ((str(text_of(branch)), given, where) for branch in branches)


def names_in(arguments: ast.expr, where: str) -> Iterator[str]:
    """The names of a message's arguments, which are written out or made by `some_names`."""
    if isinstance(arguments, ast.Call):
        assert isinstance(arguments.func, ast.Name) and arguments.func.id == "some_names", where
        yield from some_names([])
        return
    assert isinstance(arguments, ast.Dict), where
    for key, value in zip(arguments.keys, arguments.values, strict=True):
        if key is None:
            yield from names_in(value, where)
        else:
            yield str(text_of(key))


def test_every_code_has_words_and_exactly_its_arguments() -> None:
    said = list(said_in_code())
    assert len(said) > 50
    for code, given, where in said:
        known = messages("en").get(identifier(code))
        assert known is not None, (code, where)
        assert given == arguments(known), (code, where)


@pytest.mark.thorough
@pytest.mark.parametrize("language", TRANSLATED)
def test_an_error_is_told_by_its_code_whatever_its_english_is(language: str) -> None:
    for code, given, _ in said_in_code():
        error = CodedError(code, **dict.fromkeys(given, "7"))
        own = Words(language).sentence(error)
        assert own == error.message.text(language) and "{" not in own
        assert str(error) == ENGLISH.sentence(error) == error.message.text(), code
        assert own != str(error) or not re.search("[a-z]", own), code  # a list has no words


def test_a_changed_english_text_keeps_its_translation(monkeypatch: pytest.MonkeyPatch) -> None:
    error = CodedError("error.class_full")
    before = Words("de").sentence(error)
    monkeypatch.setitem(catalogue("en")._messages, "error-class_full", "no seat is left")
    assert str(error) == "no seat is left" and Words("de").sentence(error) == before


def test_an_unknown_code_and_a_missing_argument_are_noticed() -> None:
    for message in (Message("error.nobody_wrote_this"), Message("error.no_point", {"index": 3})):
        with pytest.raises(KeyError):
            str(message)


def test_what_cannot_be_kept_is_told_in_german_too() -> None:
    refused = NotKept("error.database", reason="disk full")
    assert isinstance(refused, OSError) and not isinstance(refused, ValueError)
    assert str(refused) == "the database reports: disk full" and refused.errno is None
    assert Words("de").sentence(refused) == "die Datenbank meldet: disk full"
    assert message_of(refused) == refused.message == pickle.loads(pickle.dumps(refused)).message
    whole = Message("say.lab_kept", {"reason": NotKept("error.lab_newer").message})
    assert whole.text("de").endswith(
        "nicht öffnen: dieses Labor hat ein neueres OnPath gespeichert"
    )


def test_an_error_survives_a_process_and_one_without_a_code_stays_as_it_is() -> None:
    error = CodedError("error.no_point", index=7, count=4)
    copied = pickle.loads(pickle.dumps(error))
    assert str(copied) == str(error) and copied.message == error.message
    assert Words("de").sentence(ValueError("never heard {of} it")) == "never heard {of} it"


def reasons() -> Iterator[Message]:
    """Why runs stop and paths are refused."""
    robot = RIGID_FIVE_BAR
    for curve in (presets()["figure of eight"].curve, circle(0.19), circle(0.004), circle(0.3)):
        faults = curve_faults(robot.margin, curve) + ambiguities(curve)
        yield from (fault.reason for fault in faults)
    v = np.zeros((1, 2))
    for q, rates in ((v * np.nan, v), (v, v + 1e4)):
        found = robot.fault(q, rates, FiveBarParameters())
        assert found is not None
        yield found[1]
    collapsed = robot.fault(v, v, FiveBarParameters())
    assert collapsed is not None
    yield from (collapsed[1], AT_A_LIMIT, UNSTABLE, BENT, BENT_OR_UNSTABLE)


def behaviours() -> Iterator[Message]:
    for changes in (
        {"K1": 0.0, "K2": 0.0},
        {"K2": 0.0, "K3": 0.0},
        {"K2": 5.0, "K3": 0.0},
        {"K3": 8000.0, "K2": 10.0},
        {"K3": 0.0},
        {},
    ):
        for channel in channels(dataclasses.replace(FiveBarParameters(), **changes)):
            yield channel.behaviour()


@pytest.mark.parametrize("words", [Words(language) for language in TRANSLATED])
def test_reasons_and_behaviours_are_translated(words: Words) -> None:
    said = [*reasons(), *behaviours()]
    assert len({str(message) for message in said}) > 10
    for message in said:
        own, english = words.sentence(message), str(message)
        assert own != english and "{" not in own
        numbers = [words.written(number) for number in re.findall(r"\d[\d.]*\d", english)]
        assert re.findall(r"\d[\d.,]*\d", own) == numbers
        assert ENGLISH.sentence(message) == english


def test_messages_inside_a_message_are_translated_too() -> None:
    kind = Message("behaviour.no_overshoot")
    settles = Message("behaviour.settles", {"seconds": "0.2", "kind": kind})
    assert str(settles) == "settles in 0.2 s, no overshoot"
    assert Words("de").sentence(settles) == "klingt in 0,2 s ab, ohne Überschwingen"
    two = (Message("fault.cusp"), Message("fault.crosses"))
    refused = CodedError("error.cannot_follow", robot="R", reasons=two)
    assert Words("de").sentence(refused).count("; die Bahn") == 1


# Plurals and numbers.


def test_counts_have_plurals_in_every_language() -> None:
    said = {"en": ("Sent to 1 student.", "2 students."), "de": ("An 1 Person ", "2 Personen ")}
    for language, (one, two) in said.items():
        words = Words(language)
        assert one in words("class.sent", count=1) and two in words("class.sent", count=2)
    for language in languages():
        words = Words(language)
        for key, message in messages(language).items():
            others = dict.fromkeys(arguments(message), "x")
            for count in counts(message):
                assert words(key, **others | {count: 1}) != words(key, **others | {count: 2}), key


@pytest.mark.parametrize("language", languages())
def test_what_the_page_shows_as_plain_text_is_one_line_without_markdown(language: str) -> None:
    told = json.loads(words_message(language))["words"]
    assert not {key: text for key, text in told.items() if re.search(r"\n|[*_]{2}|`", text)}


@pytest.mark.thorough
def test_a_count_is_given_as_a_number() -> None:
    """A plural of a text would always be the general one."""
    counted: dict[str, set[str]] = {}
    for language in languages():
        for key, message in messages(language).items():
            if counts(message):
                counted.setdefault(key, set()).update(counts(message))
    given = list[tuple[str, dict[str, object]]]()
    for file in CODED:
        for _, call in calls(parsed(file)):
            if call.args and (key := text_of(call.args[0])):
                given.append((key, {str(word.arg): word.value for word in call.keywords}))
    given += [(key, dict(values)) for key, values in asked_for_in_templates()]
    for key, values in given:
        for name in counted.get(identifier(key), set()):
            value = values.get(name)
            assert not isinstance(value, ast.JoinedStr | nodes.Concat), key
            if isinstance(value, ast.Constant | nodes.Const):
                assert isinstance(value.value, int), key
    assert {identifier(key) for key, _ in given} >= counted.keys()


def test_numbers_are_written_plainly_in_every_language() -> None:
    """Without grouping, and without marks for the direction of the text."""
    for language in languages():
        shown = Words(language)("class.forgotten", count=12345)
        assert "12345" in shown and shown.isprintable()


# A lab that speaks German.


def test_a_german_lab_speaks_german() -> None:
    lab = Lab(loop_cache(), FLEXIBLE)
    do(lab, c.SetLanguage("de"), c.ChoosePath("figure of eight"))
    assert lab.message.startswith("Hinweis: die Bahn kreuzt sich selbst")
    do(lab, c.Undo(), c.Undo())
    assert "keine Änderung rückgängig zu machen" in lab.message
    do(lab, c.RemovePoint())
    assert lab.message.startswith("Wähle erst einen Kontrollpunkt")
    do(lab, c.Set("output", "redefined"), c.Set("alpha", 0.95))
    run(lab, 3.0)
    assert "regelung: stehen geblieben" in lab.message and "Nulldynamik" in lab.message
    do(lab, c.SetLanguage("en"))
    assert "stopped at" in lab.message and str(UNSTABLE) in lab.message


def test_a_parameter_without_words_has_those_of_its_declaration() -> None:
    spec = specs(FiveBarParameters)["K1"]
    assert (
        parameter_label("K1", spec, ENGLISH)
        == spec.label
        != parameter_label("K1", spec, Words("de"))
    )


def test_plots_call_eta_what_the_paper_does() -> None:
    """eta_2 = (theta, theta') with components eta_2^1 and eta_2^2; eta_1 is the motion inside."""
    symbols = {"place": "η₂¹ = θ", "rate": "η₂² = θ'", "modes": "η₁"}
    symbols |= {"across": "ξ₁", "across_rate": "ξ₂"}
    for language in languages():
        said = Words(language)
        for name, symbol in symbols.items():
            title = said(f"axis.{name}")
            assert title.startswith(symbol) and re.search(r"\[.+\]$", title)
            assert said(f"plot.{name}").startswith(symbol)


@pytest.mark.parametrize("language", languages())
def test_no_message_is_defined_twice(language: str) -> None:
    text = asset_path(f"words/{language}.ftl").read_text(encoding="utf-8")
    keys = re.findall(r"^([a-z][\w-]*) =", text, re.MULTILINE)
    assert [key for key, count in Counter(keys).items() if count > 1] == []


NAMED_KEY = re.compile(
    r"\b(?:keys?|Tasten?|Ctrl|Strg|press|drücke) [A-Z]\b(?! ?\()|\bTab\b|\barrow keys|Pfeiltasten",
    re.IGNORECASE,
)
ABOUT_KEYS = ("site.draw_keys", "help.own_keys")
"""What a touch screen hides, and the list of keys."""


@pytest.mark.parametrize("language", COMPLETE)
def test_no_text_of_a_page_names_a_key(language: str) -> None:
    """Whoever touches the page has none; a title, which only a mouse shows, may name one."""
    texts = json.loads(words_message(language))["words"]
    said = {key: text for key, text in texts.items() if not key.endswith(("_hint", *ABOUT_KEYS))}
    files = (ROOT / "lessons" / "course").glob(f"*/{language}.md")
    said |= {str(file): file.read_text("utf-8") for file in files}
    assert {
        key: NAMED_KEY.findall(text) for key, text in said.items() if NAMED_KEY.search(text)
    } == {}
