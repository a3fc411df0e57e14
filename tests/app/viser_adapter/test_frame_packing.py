"""Frames hold what viser's messages hold, whether their messages are kept or made anew."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from viser import _messages
from viser.infra import Message

from onpath.app.viser_adapter.frame_packing import (
    MOST_STORED,
    GroupForm,
    GroupUpdate,
    expanded,
    packed,
    stored,
)
from tests.bench.client_protocol import unpacked

NODE, PANEL = _messages.SceneNodeUpdateMessage, _messages.GuiUpdateMessage
SINGLE: list[Message] = [
    NODE("/links", {"points": np.arange(6.0, dtype=np.float32).reshape(2, 3)}, owner="1"),
    NODE("/links", {"points": np.eye(3)[:, ::2]}),  # not one piece of memory
    PANEL("plot", {"data": (np.arange(3.0), np.zeros((0, 3), np.float32))}),
    PANEL("text", {"content": "text", "value": 3, "visible": None, "step": 0.5}),
    _messages.SetSceneNodeVisibilityMessage("/links", False),
]


def forms() -> st.SearchStrategy[GroupForm]:
    """Groups of some nodes, each with some properties of any sizes, one behind the other."""
    nodes = st.lists(st.lists(st.integers(0, 9), min_size=1, max_size=3), min_size=1, max_size=4)

    def group(sizes: list[list[int]], owner: str) -> GroupForm:
        properties, end = list[tuple[str, str, slice]](), 0
        for node, own in enumerate(sizes):
            for number, size in enumerate(own):
                span = slice(end, end := end + size)
                properties.append((f"/{node}", f"property {number}", span))
        return GroupForm(properties, owner)

    return st.builds(group, nodes, st.sampled_from(["0", "17"]))


@st.composite
def frames(draw: st.DrawFn) -> list[Message | GroupUpdate]:
    """Updates of groups among other messages."""

    def update(form: GroupForm) -> GroupUpdate:
        size = max(own.stop for _, _, own in form.properties)
        seed = draw(st.integers(0, 2**16))
        return GroupUpdate(form, np.random.default_rng(seed).random(size).astype(np.float32))

    some = st.one_of(forms(), st.sampled_from(SINGLE))
    chosen = draw(st.lists(some, min_size=1, max_size=6))
    return [update(each) if isinstance(each, GroupForm) else each for each in chosen]


def plain(value: Any) -> Any:
    """A received value, its arrays as bytes."""
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [plain(each) for each in value]
    return (value.dtype.str, value.tobytes()) if isinstance(value, np.ndarray) else value


@given(frames(), st.integers(1, 3))
def test_a_frame_holds_what_visers_messages_hold(
    messages: list[Message | GroupUpdate], times: int
) -> None:
    arrays: list[memoryview] = []
    wire = [message.as_serializable_dict(arrays) for message in expanded(messages)]
    window = msgspec.msgpack.encode({"messages": wire, "binaryBufferLengths": []})
    theirs = with_arrays(msgspec.msgpack.decode(window)["messages"], arrays)
    for _ in range(times):  # what is kept of a frame does not change the next one
        frame = packed(messages)
        assert frame is not None
        assert [plain(each) for each in unpacked(frame)] == theirs


def with_arrays(value: Any, arrays: list[memoryview]) -> Any:
    """As `plain`, from viser's messages and their arrays."""
    if isinstance(value, list):
        return [with_arrays(each, arrays) for each in value]
    if not isinstance(value, dict):
        return value
    if "__binary_index" in value:
        array = np.frombuffer(arrays[value["__binary_index"]].tobytes(), value["dtype"])
        return array.dtype.str, array.tobytes()
    return {key: with_arrays(each, arrays) for key, each in value.items()}


def test_long_messages_are_left_to_viser() -> None:
    for size in (0, MOST_STORED // 2, MOST_STORED, 10 * MOST_STORED):
        frame = packed([PANEL("text", {"content": "x" * size})])
        assert (frame is None) == (size >= MOST_STORED)


@pytest.mark.parametrize("size", [0, 1, 255, 256, 5000, MOST_STORED])
def test_what_is_stored_is_a_zstd_frame(size: int) -> None:
    assert zstandard.decompress(stored(bytes(size))) == bytes(size)
