"""What tests send over a page's data channel."""

from __future__ import annotations

import msgspec

from onpath.app.viser_adapter.data_channel import Hello


def hello(ticket: str) -> str:
    """The first message of a page with a ticket."""
    return msgspec.json.encode(Hello(ticket)).decode()
