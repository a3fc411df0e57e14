"""Every command of a page can be sent as JSON; everything else is refused with a reason."""

from __future__ import annotations

import dataclasses
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import (
    LARGEST,
    MOST_TEXT,
    MOST_WHY,
    NoCommand,
    command_from,
    page_commands,
)
from onpath.lessons.action_schema import Action, Laws, RunStart
from onpath.lessons.given import SURENESS

NUMBERS = st.floats(-LARGEST, LARGEST)
WHOLE = st.integers(-int(LARGEST), int(LARGEST))
TEXTS = st.text(st.characters(codec="utf-8"), max_size=40)
POINT = st.lists(NUMBERS, min_size=1, max_size=3).map(np.array)
STROKE = st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=9).map(np.array)
ACTIONS = st.sampled_from(
    [
        Action(hold=True, only="tracker"),
        Action(pull=(20.0, -3.5)),
        Action(set={"K1": 900.0, "friction": 1, "across": "level_set"}),
        Action(laws=Laws(left="set_point")),
        Action(start=RunStart(across=3.0)),
        Action(move=(2, 1.0, -4.0), at=0.5),
    ]
)
FIELDS: dict[str, st.SearchStrategy[Any]] = {
    "bool": st.booleans(),
    "int": WHOLE,
    "float": NUMBERS,
    "str": TEXTS,
    "Annotated[str, msgspec.Meta(max_length=LONGEST_TEXT)]": TEXTS,
    "Any": st.none() | st.booleans() | WHOLE | NUMBERS | TEXTS,
    "bool | None": st.none() | st.booleans(),
    "int | None": st.none() | WHOLE,
    "float | None": st.none() | NUMBERS,
    "str | None": st.none() | TEXTS,
    "tuple[float, ...]": st.lists(NUMBERS, max_size=5).map(tuple),
    "tuple[Action, ...]": st.lists(ACTIONS, max_size=3).map(tuple),
    "Sure": st.sampled_from(["", *SURENESS]),
    "Array": POINT,
    "Array | None": st.none() | POINT,
}


def values(command: type[Any], field: dataclasses.Field[Any]) -> st.SearchStrategy[Any]:
    return STROKE if command is c.DrawPath else FIELDS[str(field.type)]


def commands_of(command: type[Any]) -> st.SearchStrategy[c.Command]:
    fields = {field.name: values(command, field) for field in dataclasses.fields(command)}
    return st.fixed_dictionaries(fields).map(lambda given: command(**given))


def sent(command: Any) -> str:
    """The message of a command, as a script would write it."""
    names = [field.name for field in dataclasses.fields(command)]
    fields = {name: getattr(command, name) for name in names}
    message = {"do": type(command).__name__, **fields}
    return msgspec.json.encode(message, enc_hook=np.ndarray.tolist).decode()


def alike(one: Any, other: Any) -> bool:
    """Whether two commands are of one type, and all their fields have equal values."""
    same = (
        np.array_equal(getattr(one, field.name), getattr(other, field.name))
        if isinstance(getattr(one, field.name), np.ndarray)
        else getattr(one, field.name) == getattr(other, field.name)
        for field in dataclasses.fields(one)
    )
    return type(one) is type(other) and all(same)


@pytest.mark.parametrize("command", page_commands().values(), ids=page_commands())
@settings(max_examples=20, deadline=None)
@given(data=st.data())
def test_a_command_is_received_as_it_was_sent(command: type[Any], data: st.DataObject) -> None:
    made = data.draw(commands_of(command))
    assert alike(made, command_from(sent(made)))


def test_a_field_that_has_a_default_may_be_left_out() -> None:
    assert command_from('{"do": "Hold", "on": true}') == c.Hold(True)
    assert command_from('{"do": "Predict", "option": 2}') == c.Predict(option=2)


def test_no_command_of_a_teacher_is_a_pages() -> None:
    named = {name for name in c.__all__ if isinstance(getattr(c, name), type)} - {"Command"}
    assert named - page_commands().keys() == {
        name for name in named if getattr(c, name).from_teacher
    }
    assert "Freeze" not in page_commands() and "Hold" in page_commands()


REFUSED = {
    "": "truncated",
    "[]": "Expected `object`",
    "{}": "missing required field `do`",
    '{"do": "Dance"}': "there is no such command",
    '{"do": "Freeze", "on": true}': "there is no such command",
    '{"do": "hold", "on": true}': "there is no such command",
    '{"do": "Hold", "on": 1}': "got `int` - at `$.on`",
    '{"do": "Hold", "on": true, "by": 3}': "unknown field `by`",
    '{"do": "Set", "value": 2}': "missing required field `name`",
    '{"do": "LookBack", "by": "1"}': "got `str`",
    '{"do": "Set", "name": "rate", "value": NaN}': "malformed",
    '{"do": "Set", "name": "rate", "value": 1e10}': "<= 1000000000",
    '{"do": "Set", "name": "rate", "value": 1e999}': "out of range",
    '{"do": "SelectPoint", "index": 1.5}': "got `float`",
    '{"do": "SelectPoint", "index": 100000000000000000000000}': "<= 1000000000",
    '{"do": "Set", "name": "K1", "value": [1]}': "got `array`",
    '{"do": "LookBack", "by": true}': "got `bool`",
    '{"do": "Grab", "side": "left", "target": ["1", 2]}': "got `str`",
    '{"do": "Grab", "side": "left", "target": [[[1]]]}': "length 2",
    '{"do": "DrawPath", "stroke": [[1, 2], [3]]}': "length 2",
    '{"do": "Predict", "sure": "perhaps"}': "Invalid enum value",
    '{"do": "Act", "actions": [{"dance": true}]}': "unknown field `dance`",
    f'{{"do": "TypeLaw", "side": "left", "text": "{"x" * (MOST_TEXT + 1)}"}}': "length <= 2000",
    '{"do": "Hold", "on": ' + "[" * 100_000: "",
    f'{{"do": "{"x" * 100_000}"}}': "there is no such command",
    f'{{"do": "Hold", "{"x" * 100_000}": 1}}': "unknown field",
    '{"do": "\ud800"}': "",
}


@pytest.mark.parametrize("message", REFUSED, ids=range(len(REFUSED)))
def test_what_is_no_command_is_refused_with_a_reason(message: str) -> None:
    with pytest.raises(NoCommand) as refused:
        command_from(message)
    assert REFUSED[message] in str(refused.value)
    assert 0 < len(str(refused.value)) <= MOST_WHY


@settings(max_examples=200, deadline=None)
@given(
    st.recursive(
        st.none() | st.booleans() | WHOLE | NUMBERS | TEXTS,
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
        max_leaves=8,
    ),
    st.sampled_from([*page_commands(), ""]),
    st.sampled_from(["on", "side", "target", "name", "value", "index", "actions", "stroke", "x"]),
)
def test_nothing_but_a_refusal_comes_of_nonsense(value: Any, name: str, field: str) -> None:
    for message in (value, {"do": name, field: value}):
        try:
            command_from(msgspec.json.encode(message).decode())
        except NoCommand:
            continue
