"""Files that pages send in parts: whole, bounded in size, time and number, or refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel import file_inbox
from onpath.app.channel.file_inbox import FILES, SECONDS, FileInbox
from onpath.app.channel.file_messages import DropFile, PathFile, SendFile, SendPart
from onpath.models.errors import CodedError

LARGEST = 1000


class Clock:
    """Time that passes when told."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def sent(number: int, size: int) -> SendFile:
    return SendFile(number, "a.csv", size, PathFile())


@pytest.fixture(autouse=True)
def alone() -> Iterator[None]:
    file_inbox._inboxes.clear()
    yield
    file_inbox._inboxes.clear()


ACTS = st.one_of(
    st.builds(sent, st.integers(1, 3), st.integers(0, LARGEST + 100)),
    st.builds(SendPart, st.integers(1, 3), st.binary(max_size=600)),
    st.builds(DropFile, st.integers(1, 3)),
    st.floats(0, 2 * SECONDS),
)


@pytest.mark.thorough
@settings(max_examples=300, deadline=None)
@given(st.lists(ACTS, max_size=30))
def test_a_file_is_whole_or_refused_and_never_larger_than_announced(acts: list[Any]) -> None:
    """Against a model: the parts since the last file that was begun."""
    clock = Clock()
    inbox = FileInbox(LARGEST, clock)
    begun: SendFile | None = None
    parts, since = b"", 0.0
    for act in acts:
        if begun is not None and clock.now > since + SECONDS:
            begun = None
        if isinstance(act, float):
            clock.now += act
            continue
        if isinstance(act, DropFile):
            inbox.drop(act)
            if begun is not None and begun.number == act.number:
                begun = None
            continue
        try:
            content = inbox.begin(act) if isinstance(act, SendFile) else inbox.take(act)
        except CodedError as error:
            assert error.message.code.startswith("error.file_")
            if isinstance(act, SendPart) and begun is not None and begun.number == act.number:
                assert len(parts) + len(act.content) > begun.size or not act.content
                begun = None
            continue
        if isinstance(act, SendFile):
            assert begun is None and act.size <= LARGEST
            if act.size:
                begun, parts, since = act, b"", clock.now
            else:
                assert content == b""
            continue
        assert begun is not None and begun.number == act.number
        parts += act.content
        assert len(parts) <= begun.size
        assert (content is not None) == (len(parts) == begun.size)
        if content is not None:
            assert content == parts
            begun = None


def refusal(inbox: FileInbox, file: SendFile) -> str:
    with pytest.raises(CodedError) as refused:
        inbox.begin(file)
    return refused.value.message.code


def test_why_a_file_is_refused() -> None:
    clock = Clock()
    inbox = FileInbox(LARGEST, clock)
    assert refusal(inbox, sent(1, LARGEST + 1)) == "error.file_size"
    for number in range(FILES):
        inbox.begin(sent(number, 0))
    assert refusal(inbox, sent(1, 0)) == "error.file_often"
    clock.now += 1e3
    inbox.begin(sent(1, 5))
    assert refusal(inbox, sent(2, 5)) == "error.file_busy"
    clock.now += SECONDS + 1
    with pytest.raises(CodedError, match="too long"):
        inbox.take(SendPart(1, b"12345"))
    inbox.begin(sent(3, 5))


def test_all_pages_together_announce_no_more_than_there_is_memory_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(file_inbox, "MOST_TOGETHER", 1500)
    first, second = FileInbox(LARGEST), FileInbox(LARGEST)
    first.begin(sent(1, LARGEST))
    assert refusal(second, sent(1, LARGEST)) == "error.file_often"
    first.drop(DropFile(1))
    second.begin(sent(1, LARGEST))
