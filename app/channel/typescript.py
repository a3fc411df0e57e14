"""Makes assets/web/channel/messages.ts: the types of all messages of this folder.

Those of forms, and what else pages without a server have, too, are in assets/web/core/form_data.ts
and shared_data.ts.

Run `python -m onpath.app.channel.typescript` after a change of messages or commands.
"""

from __future__ import annotations

import re
import textwrap
import typing
from collections.abc import Mapping, Sequence
from inspect import getdoc
from typing import Any

import msgspec
from msgspec import inspect

from onpath.app.channel.form_messages import FORMS as FORM_MESSAGES
from onpath.app.channel.messages import BY_CHANGES, LabMessage, PageMessage
from onpath.app.lab.commands.command_codec import command_structs
from onpath.app.lab.plot_rows import RowData
from onpath.app.steps.block_data import Curves
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL
from onpath.assets import asset_path
from onpath.lessons.checks import Verdict
from onpath.lessons.given import Given

FILE, FORMS = "web/channel/messages.ts", "web/core/form_data.ts"
SHARED = "web/core/shared_data.ts"
WIDTH = 120
HEAD = """\
// The messages of the channel between a page and its lab, made by app/channel/typescript.py from
// app/channel and app/lab/commands: change them there.
"""
HEAD_OF_FORMS = """\
// The settings that a place shows, as data; made by app/channel/typescript.py from
// app/channel/form_messages.py: change them there.
"""
HEAD_OF_SHARED = """\
// What pages with and without a server have: a student's answers, how tasks are judged, curves and
// what can be plotted; made by app/channel/typescript.py from lessons/given.py, lessons/checks.py,
// app/steps/block_data.py and app/lab/plot_rows.py: change them there.
"""
CHANGES = """\
/** A message with only the fields that have changed. */
export type Changes<Message extends { is: string }> = Pick<Message, "is"> & Partial<Message>
"""
IMPORTED = {
    "../core/lesson_data": ("ChartData", "StepData"),
    "../lessons/notes": ("Notes",),
}
"""Types that are written by hand, by file."""
PLAIN: dict[type[inspect.Type], str] = {
    inspect.AnyType: "unknown",
    inspect.BoolType: "boolean",
    inspect.BytesType: "string",
    inspect.FloatType: "number",
    inspect.IntType: "number",
    inspect.NoneType: "null",
    inspect.StrType: "string",
}


def files() -> dict[str, str]:
    """The texts of the files, by their names in assets."""
    forms = _Writer(reads=False)
    own = [forms.type(each) for each in inspect.multi_type_info(FORM_MESSAGES)]
    head = [HEAD_OF_FORMS, *forms.interfaces]
    given, shared = _Writer(reads=True), _Writer(reads=False)
    given.type(inspect.type_info(Given))
    told = [shared.type(inspect.type_info(each)) for each in (Curves, RowData, Verdict)]
    elsewhere = {"../core/form_data": tuple(own), "../core/shared_data": tuple(told)}
    return {
        FORMS: "\n".join(head),
        SHARED: "\n".join([HEAD_OF_SHARED, *given.interfaces, *shared.interfaces]),
        FILE: _messages_file(elsewhere),
    }


def _messages_file(elsewhere: dict[str, tuple[str, ...]]) -> str:
    """The text of `FILE`.

    Args:
        elsewhere: further types that are imported, by file.
    """
    imported = {**elsewhere, **IMPORTED}
    page, lab = _Writer(reads=True), _Writer(reads=False, elsewhere=imported)
    commands = [page.command(each) for each in inspect.multi_type_info(command_structs())]
    from_page = [page.type(each) for each in _kinds(PageMessage)]
    to_page = [lab.type(each) for each in _kinds(LabMessage)]
    partial = {each.__name__ for each in BY_CHANGES}
    parts = [
        HEAD,
        "".join(
            f'import type {{ {", ".join(names)} }} from "{file}"\n'
            for file, names in imported.items()
        ),
        f'export const PROTOCOL = "{SUBPROTOCOL}"\n',
        *page.interfaces,
        _union("Command", "What changes the lab; see app/lab/commands.", commands),
        _union("PageMessage", "What a page sends besides commands.", from_page),
        *lab.interfaces,
        CHANGES,
        _union(
            "LabMessage",
            "What the server sends.",
            [f"Changes<{name}>" if name in partial else name for name in to_page],
        ),
    ]
    return "\n".join(parts)


def _kinds(union: Any) -> tuple[inspect.Type, ...]:
    return inspect.multi_type_info(typing.get_args(union))


def _union(name: str, doc: str, members: list[str]) -> str:
    lines = [f"/** {doc} */", f"export type {name} =", *(f"    | {each}" for each in members)]
    return "\n".join(lines) + "\n"


class _Writer:
    """Writes types, and collects the interfaces that they name.

    Args:
        reads: whether Python reads the messages: it then fills in what has a default.
        elsewhere: interfaces that are imported, by file.
    """

    def __init__(self, reads: bool, elsewhere: Mapping[str, Sequence[str]] = {}) -> None:
        self._reads, self._known = reads, dict[str, str]()
        self._elsewhere = {name for names in elsewhere.values() for name in names}

    @property
    def interfaces(self) -> list[str]:
        """The declarations of all structs so far, each after those that it uses."""
        return list(self._known.values())

    def command(self, kind: inspect.Type) -> str:
        """A command as an object type without a name."""
        assert isinstance(kind, inspect.StructType)
        fields = [self._field(each, self._reads) for each in kind.fields]
        return "{ " + "; ".join([f'{kind.tag_field}: "{kind.tag}"', *fields]) + " }"

    def type(self, kind: inspect.Type) -> str:
        """A type as TypeScript."""
        if (plain := PLAIN.get(kind.__class__)) is not None:
            return plain
        match kind:
            case inspect.Metadata(type=inner, extra=extra):
                return extra["typescript"] if extra else self.type(inner)
            case inspect.LiteralType(values=values):
                return " | ".join(msgspec.json.encode(value).decode() for value in values)
            case inspect.UnionType(types=members):
                return " | ".join(dict.fromkeys(self.type(each) for each in members))
            case inspect.TupleType(item_types=items):
                return f"[{', '.join(self.type(each) for each in items)}]"
            case inspect.ListType(item_type=item) | inspect.VarTupleType(item_type=item):
                inner = self.type(item)
                return f"({inner})[]" if " | " in inner else f"{inner}[]"
            case inspect.DictType(value_type=value):
                return f"Record<string, {self.type(value)}>"
            case inspect.CustomType():  # an array: a point, or a list of points
                return "number[] | number[][]"
            case inspect.StructType() | inspect.DataclassType():
                return self._interface(kind)
            case _:
                raise TypeError(f"no TypeScript for {kind}")

    def _interface(self, kind: inspect.StructType | inspect.DataclassType) -> str:
        name = kind.cls.__name__
        if name in self._known or name in self._elsewhere:
            return name
        about, docs = _described(kind.cls)
        lines, fills = list[str](), self._reads
        if isinstance(kind, inspect.StructType):
            fills |= kind.cls.__struct_config__.omit_defaults
            lines += [f'{kind.tag_field}: "{kind.tag}"'] if kind.tag_field else []
        for each in kind.fields:
            lines += [*_comment(docs.get(each.name, "")), self._field(each, fills)]
        body = "".join(f"    {line}\n" for line in lines)
        head = "".join(f"{line}\n" for line in _comment(about))
        self._known[name] = f"{head}export interface {name} {{\n{body}}}\n"
        return name

    def _field(self, field: inspect.Field, fills: bool) -> str:
        is_unset = field.default is msgspec.NODEFAULT and field.default_factory is msgspec.NODEFAULT
        may_lack = not field.required and (fills or is_unset)
        return f"{field.encode_name}{'?' if may_lack else ''}: {self.type(field.type)}"


def _described(kind: type) -> tuple[str, dict[str, str]]:
    """What a class is, and its attributes, from its docstring."""
    about, _, listed = (getdoc(kind) or "").partition("\n\nAttributes:\n")
    docs = dict[str, str]()
    for entry in re.split(r"\n(?=\S)", textwrap.dedent(listed)):
        names, _, text = entry.partition(": ")
        docs |= dict.fromkeys(names.split(", "), " ".join(text.split()))
    return about, docs


def _comment(text: str) -> list[str]:
    """A text as a comment, wrapped; no lines for none."""
    paragraphs = [" ".join(each.split()) for each in text.split("\n\n") if each]
    if not paragraphs:
        return []
    lines = [line for each in paragraphs for line in (*textwrap.wrap(each, WIDTH), "")][:-1]
    text = "\n".join(["/** " + lines[0], *(f" * {line}".rstrip() for line in lines[1:])]) + " */"
    return text.split("\n")


if __name__ == "__main__":
    for name, text in files().items():
        asset_path(name).write_text(text, "utf-8")
