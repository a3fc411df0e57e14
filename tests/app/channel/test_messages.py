"""The messages of the data channel: what a page sends is read by its form, or refused."""

from __future__ import annotations

import contextlib
import json
import random
from typing import Any, get_args

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.messages import (
    LabMessage,
    PageMessage,
    Refused,
    Resized,
    changes,
    encoded,
    encoded_changes,
)
from onpath.app.channel.reading import NoPageMessage, read_message
from onpath.app.channel.state_messages import Said, StateMessage
from onpath.app.channel.symbol_messages import Light
from onpath.app.channel.typescript import files
from onpath.app.lab.commands import Hold
from onpath.app.lab.commands.command_codec import LONGEST, MOST_WHY
from onpath.app.lab.lab import Command
from onpath.assets import asset_path
from tests.bench.hostile_messages import ASKED, wild_message

SENT = [
    '{"is": "hello", "page": "00112233445566778899aabbccddeeff", "dark": true}',
    '{"is": "resized"}',
    '{"is": "skip"}',
    '{"is": "make", "file": "table"}',
    '{"is": "send", "number": 1, "name": "a", "size": 2, "use": {"kind": "path"}}',
    '{"is": "part", "number": 1, "content": "AAAA"}',
    '{"is": "light", "symbol": "rho"}',
    '{"do": "Hold", "on": true, "side": "left"}',
    '{"do": "Grab", "side": "right", "target": [0.1, 0.2]}',
    '{"do": "Predict", "times": [0, 1], "values": [2, 3], "sure": "fairly"}',
    '{"do": "Act", "actions": [{"set": {"K1": 900}}]}',
]


def test_the_types_of_the_pages_script_are_those_of_the_messages() -> None:
    """Else: `python -m onpath.app.channel.typescript`."""
    for name, text in files().items():
        assert asset_path(name).read_text("utf-8") == text


@pytest.mark.parametrize("union", [PageMessage, LabMessage])
def test_every_message_has_a_kind_of_its_own(union: Any) -> None:
    configs = [each.__struct_config__ for each in get_args(union)]
    assert {config.tag_field for config in configs} == {"is"}
    assert len({config.tag for config in configs}) == len(configs)


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(SENT), st.randoms(use_true_random=False))
def test_neither_order_nor_spaces_of_the_fields_matter(text: str, chance: random.Random) -> None:
    fields = list(json.loads(text).items())
    chance.shuffle(fields)
    again = json.dumps(dict(fields), indent=chance.choice([None, 1]))
    first, second = read_message(text), read_message(again)
    assert type(first) is type(second) and str(first) == str(second)


def test_messages_and_commands_are_read() -> None:
    assert read_message('{"is": "resized"}') == Resized()
    assert read_message('{"symbol": "", "is": "light"}') == Light("")
    assert read_message('{"on": true, "do": "Hold"}') == Hold(True)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('{"is": "dance"}', "Invalid value"),
        ('{"is": "resized", "by": 3}', "unknown field"),
        ('{"is": "resized", "do": "Hold"}', "unknown field"),
        ('{"is": 3}', "Expected `str`"),
        ('{"is": "light", "symbol": "lambda"}', "Invalid enum value"),
        ('{"do": "Dance"}', "no such command"),
        ("[]", "Expected `object`"),
        ("", "truncated"),
        (" " * (LONGEST + 1), "characters"),
        ('{"is": ' + "[" * 100_000, "Expected `str`"),
    ],
)
def test_what_is_no_message_is_refused_with_a_reason(text: str, why: str) -> None:
    with pytest.raises(NoPageMessage, match=why) as refused:
        read_message(text)
    assert 0 < len(str(refused.value)) <= MOST_WHY


def mutated(text: str, chance: random.Random) -> str:
    """A message with some of its characters changed, doubled, moved or lost."""
    letters = list(text)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(letters)) if letters else 0
        match chance.randrange(5):
            case 0:
                letters[at : at + 1] = []
            case 1:
                letters.insert(at, chance.choice('{}[]",:0e-\\u\0\ud800ü '))
            case 2:
                letters[at : at + 1] = [chance.choice(SENT)]
            case 3:
                letters[at:at] = letters[at : at + chance.randint(1, 20)]
            case _:
                letters = letters[at:] + letters[:at]
    return "".join(letters)


@settings(max_examples=500, deadline=None)
@given(st.sampled_from(SENT), st.randoms(use_true_random=False))
def test_a_mutated_message_is_read_or_refused(text: str, chance: random.Random) -> None:
    try:
        read = read_message(mutated(text, chance))
    except NoPageMessage as error:
        assert str(error)
        assert msgspec.json.decode(encoded(Refused(str(error))))["is"] == "refused"
    else:
        assert isinstance(read, (Command, *get_args(PageMessage)))


VALUES: dict[str, st.SearchStrategy[Any]] = {
    name: st.text(max_size=2)
    for name in ("language", "robot", "message", "level", "frozen", "waits", "shared", "machine")
} | {name: st.integers(0, 2) for name in ("rate", "achieved", "messages", "height", "arrow")}
VALUES |= {name: st.booleans() for name in ("undo", "presenting", "own", "drawn")}
VALUES |= {
    name: st.lists(st.text(max_size=1))
    for name in ("titles", "names", "texts", "captions", "laws", "sent")
}
VALUES |= {name: st.lists(st.booleans()) for name in ("clocks", "stopped")}
VALUES |= {
    "said": st.builds(Said, voice=st.text(max_size=1)),
    "above": st.lists(st.floats(0, 1)),
    "cameras": st.lists(st.lists(st.lists(st.floats(0, 1)))),
    "rows": st.lists(st.fixed_dictionaries({"name": st.text(max_size=1)}), max_size=2),
}


STATES = st.fixed_dictionaries(VALUES)


@pytest.mark.thorough
@settings(max_examples=50, deadline=None)
@given(STATES, STATES, st.lists(st.sets(st.sampled_from(sorted(VALUES)))))
def test_a_page_that_is_told_changes_knows_everything(
    some: dict[str, Any], others: dict[str, Any], turns: list[set[str]]
) -> None:
    """Whichever fields change from one value to another and back."""
    known, before = dict[str, Any](), None
    for turn in [set[str](), *turns]:
        some, others = (
            one | {name: other[name] for name in turn}
            for one, other in ((some, others), (others, some))
        )
        state = StateMessage(**some)
        if news := changes(state, before):
            told = msgspec.json.decode(encoded_changes(StateMessage, news))
            assert told["is"] == "state"
            known |= told
            before = state
        assert known == msgspec.json.decode(encoded(state))


def test_there_is_an_honest_example_of_every_message_of_a_page() -> None:
    kinds = {form.__struct_config__.tag: form for form in get_args(PageMessage)}
    assert kinds.keys() == ASKED.keys()
    for kind, fields in ASKED.items():
        assert isinstance(read_message(json.dumps({"is": kind, **fields})), kinds[kind])


@given(draw=st.randoms(use_true_random=False))
def test_whatever_comes_by_a_pages_own_websocket_is_read_or_refused(draw: random.Random) -> None:
    message = wild_message(draw)
    if isinstance(message, str):
        with contextlib.suppress(NoPageMessage):
            read_message(message)
