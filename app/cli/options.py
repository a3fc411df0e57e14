"""Reads the options of a command: the same rules for all of them.

A command is a frozen dataclass; tyro makes an option of each field, and its help of the field's
docstring. An option that may be repeated is a tuple with `UseAppendAction`: it takes repetitions
and commas. Any other is refused when it is given twice. `~` stands for the home folder.
"""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from textwrap import dedent
from typing import Annotated, Any, TypeGuard, TypeVar, get_args, get_origin, get_type_hints

import tyro

from onpath.models.systems.parameter_specs import unknown_name

C = TypeVar("C")
Repeated = Annotated[tuple[str, ...], tyro.conf.UseAppendAction]
"""The type of an option that may be repeated."""
FORMER = {"--controller": "--law", "--folder": "--lessons"}
"""Options that have another name now."""
PLAIN = tyro.conf.DisallowNone, tyro.conf.FlagCreatePairsOff
"""What keeps {None}|TEXT and --no-json out of the help."""
FOLDERS = "folder", "lessons", "target"
METAVARS = {Path: "FILE", int: "NUMBER", float: "NUMBER", str: "TEXT"}


@dataclass(frozen=True)
class CommandOption:
    """An option of a command.

    Attributes:
        flag: how it is written, such as --json.
        repeated: whether it may be given more than once.
        help: what it does.
    """

    flag: str
    repeated: bool
    help: str


def parsed(command: type[C], prog: str, arguments: list[str]) -> C:
    """A command with the options of a command line.

    Raises:
        ValueError: an option is unknown, is given twice, or has another name now.
        SystemExit: after the help; or with tyro's complaint on stderr.
    """
    _check_flags(command, arguments)
    given = tyro.cli(described(command), prog=prog, args=arguments, config=PLAIN)
    return _finished(command, given)


def options(command: type) -> list[CommandOption]:
    """The options of a command, without its positional arguments."""
    found = list[CommandOption]()
    for field, hint, text in _fields(command):
        marks = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
        kind = _kind(hint)
        if _is_command(kind):
            found += options(kind)
        elif tyro.conf.Positional not in marks:
            flag = f"--{field.name.replace('_', '-')}"
            found.append(CommandOption(flag, tyro.conf.UseAppendAction in marks, text))
    return found


@cache
def described(command: type[C]) -> type[C]:
    """A command as tyro takes it, with a help in plain English.

    tyro by itself keeps the line breaks of docstrings, and writes "default: None".
    """
    fields = list[tuple[str, Any, Any]]()
    for field, hint, text in _fields(command):
        kind = _kind(hint)
        if _is_command(kind):
            described_kind = described(kind)
            field_type = Annotated[described_kind, tyro.conf.arg(name="")]
            fields.append((field.name, field_type, described_kind()))
            continue
        positional = tyro.conf.Positional in get_args(hint)
        metavar = field.name.upper() if positional else _metavar(field.name, kind)
        plain = tyro.conf.arg(help=text, help_behavior_hint=_hint(field), metavar=metavar)
        again = dataclasses.field(default=field.default)
        fields.append((field.name, Annotated[hint, plain], again))
    return dataclasses.make_dataclass(
        command.__name__,
        fields,
        bases=(command,),
        namespace={"__doc__": command.__doc__, "__module__": command.__module__},
        frozen=True,
    )


def _metavar(name: str, kind: Any) -> str | None:
    if name in FOLDERS:
        return "FOLDER"
    if kind in METAVARS:
        return METAVARS[kind]
    inner = [each for each in get_args(kind) if each not in (type(None), ...)]
    words = [_metavar("", each) for each in inner if not isinstance(each, str)]
    return " ".join(word for word in words if word) or None


def _hint(field: dataclasses.Field[Any]) -> str:
    if field.default in (None, "", (), False) or field.default is dataclasses.MISSING:
        return ""
    return f"(default: {field.default})"


def _fields(command: type) -> Iterator[tuple[dataclasses.Field[Any], Any, str]]:
    """Each field of a command with its type and docstring."""
    hints, texts = get_type_hints(command, include_extras=True), _docstrings(command)
    for field in dataclasses.fields(command):
        yield field, hints[field.name], texts.get(field.name, "")


@cache
def _docstrings(command: type) -> dict[str, str]:
    (tree,) = ast.parse(dedent(inspect.getsource(command))).body
    assert isinstance(tree, ast.ClassDef)
    found = dict[str, str]()
    for declared, text in zip(tree.body, tree.body[1:], strict=False):
        match declared, text:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(ast.Constant(str(doc))):
                found[name] = " ".join(doc.split())
    return found


def _is_command(kind: Any) -> TypeGuard[type]:
    """Whether a field of a command has options of its own."""
    return isinstance(kind, type) and dataclasses.is_dataclass(kind)


def _kind(hint: Any) -> Any:
    return get_args(hint)[0] if get_origin(hint) is Annotated else hint


def _check_flags(command: type, arguments: list[str]) -> None:
    known = {option.flag: option for option in options(command)}
    seen = set[str]()
    for word in arguments:
        if word == "--":
            return
        flag = word.partition("=")[0].replace("_", "-")
        if flag in FORMER and flag not in known:
            raise ValueError(f"{flag} is called {FORMER[flag]} now")
        if flag.startswith("--") and flag not in (*known, "--help"):
            raise unknown_name(flag, [*known], "option")
        if flag in seen and not known[flag].repeated:
            raise ValueError(f"{flag}: it is given twice, and may be given once only")
        seen |= {flag} & known.keys()


def _finished(command: type[C], given: Any) -> C:
    """A command with its lists taken apart and its paths expanded."""
    values = dict[str, Any]()
    for field, hint, _ in _fields(command):
        value, kind = getattr(given, field.name), _kind(hint)
        if _is_command(kind):
            value = _finished(kind, value)
        elif isinstance(value, Path):
            value = value.expanduser()
        elif get_args(kind) == (str, ...):
            value = tuple(item for text in value for item in items(text))
        values[field.name] = value
    return command(**values)


def items(text: str) -> list[str]:
    """The items of a list with commas.

    A comma does not part the numbers of a path, as in "closed 0.05 0, 0 0.04, ...", the arguments
    of a function in a law, or the values of one name, as in profile=0:0,1:6.28.

    >>> items("five_bar,two_link_arm"), items("K1=9,profile=0:0,1:2,K2=3")
    (['five_bar', 'two_link_arm'], ['K1=9', 'profile=0:0,1:2', 'K2=3'])
    """
    if re.match(r"\s*(\{|\[|implicit)", text) or re.search(r"[;\n]", text):
        return [text]
    found = list[str]()
    for part in re.split(r",\s*(?=@)", text):  # files, whose options may have commas
        if part.startswith("@"):
            comma = None
        elif "=" in part:
            comma = r",\s*(?=[^,=\s]+=)"
        elif " " in part:
            comma = r",(?!\s*[-+.]?\d)"
        else:
            comma = ","
        found += [part] if comma is None else re.split(comma, part)
    return [item.strip() for item in found]
