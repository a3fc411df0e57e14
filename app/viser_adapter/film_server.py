"""A server's scene without the server, to be written to a file."""

from __future__ import annotations

import asyncio
import threading

import viser
from viser import _messages
from viser.infra import WebsockServer
from viser.infra._async_message_buffer import AsyncMessageBuffer


class FilmServer(viser.ViserServer):
    """A server's scene without the server: no socket, no thread, no clients.

    Scene messages accumulate in a queue, from which they can be serialised.
    """

    def __init__(self) -> None:
        loop = asyncio.new_event_loop()
        loop.close()  # no consumer to wake
        self._websock_server = WebsockServer("", 0, _messages.Message)
        self._websock_server._broadcast_buffer = AsyncMessageBuffer(loop, persistent_messages=True)
        self._initial_camera = viser.InitialCameraConfig(self._websock_server.queue_message)
        self._scene_lifecycle_lock = threading.RLock()
        self.scene = viser.SceneApi(self, thread_executor=None, event_loop=loop)  # type: ignore[arg-type]
        self.scene.reset()
        self.scene.set_up_direction("+z")
