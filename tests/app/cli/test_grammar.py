"""One grammar: every option of every command, Python's functions, the help and the completion."""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import inspect
import re
import shlex
import subprocess
import sys
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import tyro
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.cli.commands import COMMANDS, CommandGroup
from onpath.app.cli.help import EXAMPLES, OFTEN, top_help
from onpath.app.cli.main import parsed_command, run_command
from onpath.app.cli.options import PLAIN, described, items, options, parsed
from onpath.app.cli.paper import NAMES
from onpath.models.studies.paper_figures import FIGURES
from tests.support.checkout import ROOT

ORDER = "robot", "path", "law", "set"
READMES = [
    *(file for file in ROOT.glob("*.md") if file.name != "CHANGELOG.md"),
    *(ROOT / "models").rglob("*.md"),
    ROOT / "lessons" / "README.md",
]


def commands() -> Iterator[tuple[tuple[str, ...], type]]:
    """The words of each command, and its class."""
    for name, command in COMMANDS.items():
        if isinstance(command, CommandGroup):
            yield from (((name, second), each) for second, each in command.commands.items())
        else:
            yield (name,), command


LEAVES = dict(commands())


@cache
def as_tyro_says(words: tuple[str, ...]) -> list[argparse.Action]:
    """The options and positional arguments of a command, by tyro's own description."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        parser = tyro.extras.get_parser(described(LEAVES[words]), config=PLAIN)
    return [each for each in parser._actions if "--help" not in each.option_strings]


def values(action: argparse.Action) -> list[str]:
    """Values that an option takes, as tyro describes it."""
    if action.choices:
        return [str(next(iter(action.choices)))]
    count = action.nargs if isinstance(action.nargs, int) else 1
    if action.option_strings and action.nargs == 0:
        return []
    return ["1"] * max(count, 1)


def required_by(words: tuple[str, ...], action: argparse.Action) -> list[str]:
    """What a command needs besides an option."""
    others = [each for each in as_tyro_says(words) if each.required and each is not action]
    return [word for each in others for word in (*each.option_strings[:1], *values(each))]


OPTIONS = [
    (words, number)
    for words in LEAVES
    for number, action in enumerate(as_tyro_says(words))
    if action.option_strings
]


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(st.sampled_from(OPTIONS), st.booleans(), st.booleans())
def test_an_option_is_taken_once_and_appended_or_refused_twice(
    chosen: tuple[tuple[str, ...], int], joined: bool, underscores: bool
) -> None:
    """tyro's own description says which options there are, and which are appended."""
    words, number = chosen
    actions = as_tyro_says(words)
    action, command = actions[number], LEAVES[words]
    required = required_by(words, action)
    (flag,) = action.option_strings
    typed = "--" + flag[2:].replace("-", "_") if underscores else flag
    option = [f"{typed}={values(action)[0]}"] if joined and action.nargs == 1 else None
    option = option or [typed, *values(action)]
    once = parsed(command, " ".join(words), [*required, *option])
    name = flag[2:].replace("-", "_")
    appended = type(action).__name__ == "_AppendAction"
    if not appended:
        with pytest.raises(ValueError, match=f"{flag}: it is given twice"):
            parsed(command, " ".join(words), [*required, *option, *option])
        return
    twice = parsed(command, " ".join(words), [*required, *option, *option])
    commas = parsed(command, " ".join(words), [*required, flag, "1,1"])
    one, two, three = (_value(each, name) for each in (once, twice, commas))
    assert one == ("1",) and two == three == ("1", "1")


def _value(command: Any, name: str) -> Any:
    options = getattr(command, "file_options", None)
    return getattr(command if hasattr(command, name) else options, name)


def test_options_are_those_that_tyro_finds_and_plain() -> None:
    for words, command in LEAVES.items():
        found = {flag for each in as_tyro_says(words) for flag in each.option_strings}
        assert found == {option.flag for option in options(command)}, words
        assert not [flag for flag in found if flag.startswith("--no-") and flag != "--no-figures"]
        for each in as_tyro_says(words):
            assert each.help and "None" not in f"{each.metavar or ''} {each.help}", (words, each)


def test_robot_path_law_and_settings_come_in_one_order_and_take_files() -> None:
    for words, command in LEAVES.items():
        fields = [field.name for field in dataclasses.fields(command)]
        assert [name for name in fields if name in ORDER] == [n for n in ORDER if n in fields]
        assert ("robot" in fields) == ("file_options" in fields), words


def test_a_call_can_be_copied_from_one_function_to_the_other() -> None:
    """The same names and the same order: robot, path or file, law; settings come last."""
    functions = [getattr(onpath, name) for name in onpath.__all__]
    simulated = inspect.signature(onpath.simulate).parameters
    for function in filter(inspect.isfunction, functions):
        parameters = inspect.signature(function).parameters
        names = list(parameters)
        shared = [name for name in names if name in ("robot", "path", "law")]
        if len(shared) < 2 and "robot" not in shared:
            continue
        assert shared == [name for name in ("robot", "path", "law") if name in shared], function
        assert names[0] == "robot", function
        for name in names:
            kind = parameters[name].kind
            if kind is inspect.Parameter.VAR_KEYWORD:
                assert name == "settings", function
            elif name in simulated and name not in ("robot", "path", "law"):
                assert kind is inspect.Parameter.KEYWORD_ONLY, (function, name)


@given(st.lists(st.from_regex(r"[a-z_]{1,8}(\.py:[A-Z])?", fullmatch=True), min_size=1))
def test_names_are_joined_by_commas(names: list[str]) -> None:
    assert items(",".join(names)) == names


@given(
    st.lists(
        st.tuples(
            st.from_regex(r"[A-Za-z]\w{0,5}", fullmatch=True),
            st.from_regex(r"[0-9.:]{1,4}(,[0-9.:]{1,4}){0,2}", fullmatch=True),
        ),
        min_size=1,
    )
)
def test_assignments_are_joined_by_commas_whatever_commas_a_value_has(
    pairs: list[tuple[str, str]],
) -> None:
    texts = [f"{name}={value}" for name, value in pairs]
    assert items(",".join(texts)) == texts


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("circle,ellipse 0.07, 0.04,clover", ["circle", "ellipse 0.07, 0.04", "clover"]),
        ("closed 0.05 0, 0 0.04, -0.05 0", ["closed 0.05 0, 0 0.04, -0.05 0"]),
        ('{"points": [[0.05, 0], [0, 0.04]]}', ['{"points": [[0.05, 0], [0, 0.04]]}']),
        ("@a.svg centre=0,0.01,@b.svg fit=0.1", ["@a.svg centre=0,0.01", "@b.svg fit=0.1"]),
        ("circle,clover,@a.svg centre=0,0.01", ["circle", "clover", "@a.svg centre=0,0.01"]),
        ("across = atan2(xi, 1); along = 0", ["across = atan2(xi, 1); along = 0"]),
    ],
)
def test_a_comma_within_a_path_or_a_law_parts_nothing(text: str, found: list[str]) -> None:
    assert items(text) == found


def test_a_home_folder_is_expanded_wherever_there_is_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    for words, command in LEAVES.items():
        for action in as_tyro_says(words):
            if action.metavar in ("FILE", "FOLDER") and action.option_strings:
                (flag,) = action.option_strings
                found = parsed(command, "", [*required_by(words, action), f"{flag}=~/x"])
                assert _value(found, flag[2:]) == tmp_path / "x"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        *((["figure", name], f"onpath paper {name}") for name in NAMES),
        (["export", "figure", "held.html"], "onpath figure"),
        (["arena", "my_law.py:Law"], "--law my_law.py:Law"),
        (["experiment", "obstruction", "--controller", "both"], "--law"),
        (["lessons", "play", "1", "1", "--folder", "x"], "--lessons"),
    ],
)
def test_an_old_spelling_is_answered_with_the_right_one(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(arguments) == 2
    assert told in capsys.readouterr().err


def test_an_unknown_command_is_answered_with_the_nearest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run_command(["sweeep"]) == 2
    assert "did you mean sweep" in capsys.readouterr().err


def test_the_papers_figures_are_those_of_the_command() -> None:
    assert set(map(str, FIGURES)) < set(NAMES)


WRONG_ENDINGS = [
    ["experiment", "obstruction", "--csv", "x.txt"],
    ["experiment", "obstruction", "--plot", "x.csv"],
    ["compare", "--csv", "x.png"],
    ["arena", "--html", "x.csv"],
    ["arena", "--csv", "x"],
    ["figure", "x.txt"],
    ["lessons", "guide", "--html", "x.pdf"],
    ["lessons", "guide", "--pdf", "x.html"],
    ["lessons", "worksheet", "1", "--key", "x.zip"],
    ["export", "lesson", "1", "--scorm", "x.html"],
]


@pytest.mark.parametrize("arguments", WRONG_ENDINGS, ids=" ".join)
def test_a_wrong_ending_is_refused(
    arguments: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run_command(arguments) == 2
    assert "expected a name ending in" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


MISSING = [
    ["experiment", "obstruction", "--robot", "no.urdf"],
    ["experiment", "obstruction", "--path", "@no.svg"],
    ["experiment", "obstruction", "--law", "no.py:Law"],
    ["compare", "--law", "no.py:Law"],
    ["figure", "x.html", "--path", "@no.svg"],
    ["arena", "--robot", "no.urdf"],
    ["identify", "no.csv"],
    ["zero-dynamics", "--robot", "no.urdf"],
    ["--path", "@no.svg"],
]


@pytest.mark.parametrize("arguments", MISSING, ids=" ".join)
def test_a_missing_file_is_told_in_the_same_words(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(arguments) == 2
    assert re.search(r"no\.\w+: there is no such file", capsys.readouterr().err)


def test_the_first_help_shows_the_product(capsys: pytest.CaptureFixture[str]) -> None:
    helps = []
    for arguments in (["--help"], ["-h"], ["help"]):
        assert run_command(arguments) == 0
        helps.append(capsys.readouterr().out)
    assert helps[0] == helps[1] == helps[2] == f"{top_help()}\n"
    for name in (*COMMANDS, *OFTEN, "--version", "completion bash", "README.md"):
        assert name in helps[0]
    assert "(required)" not in helps[0]
    for line, _ in EXAMPLES:
        parsed_command(shlex.split(line)[1:])
    versions = []
    for arguments in (["--version"], ["-V"], ["version"]):
        assert run_command(arguments) == 0
        versions.append(capsys.readouterr().out)
    assert set(versions) == {f"onpath {onpath.__version__}\n"}


def test_every_help_and_group_is_reached_by_help(capsys: pytest.CaptureFixture[str]) -> None:
    for words in LEAVES:
        shown = []
        for arguments in ([*words, "--help"], ["help", *words]):
            assert run_command(arguments) == 0
            shown.append(capsys.readouterr().out)
        assert shown[0] == shown[1] and shown[0]
    for name, command in COMMANDS.items():
        if isinstance(command, CommandGroup):
            assert run_command([name, "--help"]) == 0
            told = capsys.readouterr().out
            assert all(second in told for second in command.commands)


def lines_of(text: str) -> Iterator[str]:
    """The command lines of `onpath` in a README: in code that is shown, and in `code`."""
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S):
        yield from (line for line in block.splitlines() if line.startswith("onpath "))
    prose = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    yield from re.findall(r"`(onpath [a-z-]+ [^`\n]*)`", prose)


@pytest.mark.parametrize("file", READMES, ids=lambda file: str(file.relative_to(ROOT)))
def test_command_lines_in_readmes_are_accepted(file: Path) -> None:
    """Names in capitals stand for anything; an option at the end stands for itself."""
    for line in lines_of(file.read_text("utf-8")):
        words = shlex.split(line, comments=True)[1:]
        if "..." in words or "|" in line:
            continue
        with contextlib.suppress(SystemExit):
            try:
                parsed_command(words)
            except ValueError as error:
                lacking = "Missing", "is not a whole number", "expected", "required"
                assert any(word in str(error) for word in lacking), (line, str(error))


@pytest.mark.thorough
def test_bash_completes_all_commands_and_options(tmp_path: Path) -> None:
    script = tmp_path / "completion"
    made = subprocess.run(
        [sys.executable, "-m", "onpath", "completion", "bash"], cwd=ROOT, capture_output=True
    )
    script.write_bytes(made.stdout)
    asked = {(): "", **{words: "--" for words in LEAVES}}
    calls = "".join(
        f"COMP_WORDS=({shlex.join(['onpath', *words, start])}); COMP_CWORD={len(words) + 1}\n"
        'COMPREPLY=(); _onpath; echo "${COMPREPLY[@]}"\n'
        for words, start in asked.items()
    )
    shown = subprocess.run(
        ["bash", "-c", f". {shlex.quote(str(script))}\n{calls}"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    offered = {words: set(line.split()) for words, line in zip(asked, shown, strict=True)}
    assert set(COMMANDS) | {option.flag for option in options(LEAVES["serve",])} <= offered[()]
    for words, command in LEAVES.items():
        assert {"--help"} | {option.flag for option in options(command)} == offered[words]
    for shell in ("zsh", "fish"):
        told = subprocess.run(
            [sys.executable, "-m", "onpath", "completion", shell],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        assert all(f"'{name}'" in told for words in LEAVES for name in words)


def test_what_is_public_is_listed() -> None:
    public = {name for name in dir(onpath) if not name.startswith("__")}
    assert public == set(onpath.__all__) and all(hasattr(onpath, name) for name in dir(onpath))
