"""A camera is placed as asked, whatever the browser reports meanwhile."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import websockets.sync.client
from viser import _messages
from websockets.typing import Subprotocol

from onpath.app.viser_adapter.camera import place_camera
from onpath.app.viser_adapter.secure_server import make_server
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, packed, unpacked
from tests.support.waiting import wait_for

POSE = {"position": [0.3, -1.2, 0.8], "look_at": [0.1, 0.0, 0.2], "up_direction": [0.0, 0.0, 1.0]}
FOV = 0.6


def test_a_browser_is_sent_the_whole_pose_even_if_it_reported_parts_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A report is taken in after each message but the last, as if the event loop were quicker."""
    server = make_server(port=0)
    with websockets.sync.client.connect(
        f"ws://127.0.0.1:{server.get_port()}",
        subprotocols=[Subprotocol(SUBPROTOCOL)],
        compression=None,
    ) as socket:
        socket.send(packed("ViewerCameraMessage", **CAMERA))
        wait_for(server.get_clients, 30.0)
        (client,) = server.get_clients().values()
        queue = client._websock_connection.queue_message

        def queue_and_report(message: Any) -> None:
            queue(message)
            if not isinstance(message, _messages.SetCameraLookAtMessage):
                for name, value in POSE.items():
                    setattr(client.camera._state, name, np.array(value))

        monkeypatch.setattr(client._websock_connection, "queue_message", queue_and_report)
        position, look_at, up = (np.array(each) for each in POSE.values())
        place_camera(client, position, look_at, up, FOV)
        told: dict[str, Any] = {}
        while "LookAt" not in told:
            raw = socket.recv(timeout=30)
            assert isinstance(raw, bytes)
            for message in unpacked(raw):
                kind = message["type"]
                if kind.startswith("SetCamera") and not message["initial"]:
                    told[kind.removeprefix("SetCamera").removesuffix("Message")] = message
    server.stop()
    assert told["Position"]["position"] == POSE["position"]
    assert told["LookAt"]["look_at"] == POSE["look_at"]
    assert told["UpDirection"]["position"] == POSE["up_direction"]
    assert told["Fov"]["fov"] == FOV
