"""Frames hold what viser's messages hold, however much of them comes from earlier frames."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from viser import _messages
from viser.infra import Message

from onpath.app.viser_adapter.frame_packing import MOST_TEMPLATES, Templates, _wire
from onpath.app.viser_adapter.frame_packing import packed as packed_frame
from tests.bench.client_protocol import unpacked

NODE, PANEL = _messages.SceneNodeUpdateMessage, _messages.GuiUpdateMessage
TWO = (np.arange(3.0), np.zeros((0, 3), dtype=np.float32))


@pytest.mark.parametrize(
    "message",
    [
        NODE("/links", {"batched_positions": TWO[1], "visible": True}),
        NODE("/links", {"points": np.eye(3)[:, ::2]}),  # not one piece of memory
        NODE("/links", {"points": TWO[0], "position": (np.float64(1.0), 2, "x")}),
        PANEL("a", {"data": TWO}),
        PANEL("a", {"content": "text", "value": 3, "visible": None, "step": 0.5}),
        PANEL("a", {"value": np.bool_(True), "more": TWO[0]}),
        _messages.SetSceneNodeVisibilityMessage("/links", False),
    ],
)
def test_messages_are_put_as_viser_puts_them(message: Message) -> None:
    theirs: list[memoryview] = [memoryview(b"before")]
    ours = theirs.copy()
    as_they_do = message.as_serializable_dict(theirs)
    put = msgspec.msgpack.encode(_wire(message, ours))
    assert msgspec.msgpack.decode(put) == msgspec.msgpack.decode(msgspec.msgpack.encode(as_they_do))
    assert [bytes(array) for array in ours] == [bytes(array) for array in theirs]


@pytest.mark.parametrize("points", [1, 3, 100])
@pytest.mark.parametrize("extra", [0, 1, 60])
def test_later_frames_of_the_same_form_hold_their_own_numbers(points: int, extra: int) -> None:
    """Whether they are compressed or not, and wherever the arrays begin."""
    templates = Templates()
    for shift in range(3):
        numbers = np.arange(3 * points, dtype=np.float32).reshape(-1, 3) + shift
        turned = {"batched_wxyzs": np.full((points, 4), shift, np.float32)}
        messages = [
            NODE("/links", {"batched_positions": numbers, **turned}, owner="1"),
            NODE("/parts", {"batched_positions": -numbers}, owner="1"),
            PANEL("plot", {"data": (numbers[0].copy(), -numbers[0])}),
            *(PANEL(f"{i}", {"content": f"text {shift} " * 5}) for i in range(extra)),
        ]
        theirs: list[memoryview] = []
        wanted = [message.as_serializable_dict(theirs) for message in messages]
        got = unpacked(packed_frame(messages, templates))
        assert [m | {"updates": 0} for m in got] == [m | {"updates": 0} for m in wanted]
        arrays = [v for m in got[:2] for v in m["updates"].values()] + got[2]["updates"]["data"]
        assert [each.tobytes() for each in arrays] == [bytes(each) for each in theirs]
        assert [m["updates"]["content"] for m in got[3:]] == [f"text {shift} " * 5] * extra
    assert len(templates.frames) == (extra == 0)


def test_frames_of_other_nodes_owners_or_sizes_are_other_frames() -> None:
    templates = Templates()
    two = np.zeros((2, 3), np.float32)
    for name, field, value, owner in [
        ("/a", "points", two, "1"),
        ("/b", "points", two, "1"),
        ("/a", "batched_positions", two, "1"),
        ("/a", "points", two[:1], "1"),
        ("/a", "points", two.astype(float), "1"),
        ("/a", "points", two, "2"),
    ]:
        (told,) = unpacked(packed_frame([NODE(name, {field: value}, owner=owner)], templates))
        assert (told["name"], told["owner"]) == (name, owner)
        assert told["updates"][field].dtype == value.dtype
        assert told["updates"][field].size == value.size
    assert len(templates.frames) == 6
    for number in range(3 * MOST_TEMPLATES):
        packed_frame([NODE(f"/{number}", {"points": two}, owner="1")], templates)
        assert len(templates.frames) <= MOST_TEMPLATES >= len(templates.messages)
