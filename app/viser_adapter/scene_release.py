"""Frees the objects of a scene as soon as its tab has closed or the scene is rebuilt.

Nodes refer to their API, which refers to them, and to callbacks, which refer to their owners.
Without this module, only the garbage collector would find the thousands of objects of a scene, and
tabs can come and go faster than it runs. This uses private parts of viser, which tests pin.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import viser


def clear_scene(client: viser.ClientHandle) -> None:
    """Remove all nodes of a scene, and forget their callbacks."""
    nodes = list(client.scene._handle_from_node_name.values())
    client.scene.reset()
    _forget_callbacks(nodes)


def release_scene(client: viser.ClientHandle) -> None:
    """Forget the nodes and unsent messages of a client that has disconnected."""
    scene = client.scene
    nodes: list[Any] = list(scene._handle_from_node_name.values())
    _forget_callbacks(nodes)
    for node in nodes:
        node._impl.drag_cb.clear()
    scene._handle_from_node_name.clear()
    scene._children_from_node_name.clear()
    connection = client._websock_connection
    buffer = connection.get_message_buffer()
    with buffer.buffer_lock:
        buffer.message_from_id.clear()
        buffer.id_from_redundancy_key.clear()
        buffer.ids_from_entity_state_key.clear()
    # Not cleared, since viser may be looking up the handlers of a message.
    connection._incoming_handlers = defaultdict(list)


def _forget_callbacks(nodes: list[Any]) -> None:
    """Forget all callbacks except those of drags, which viser calls when a drag ends."""
    for node in nodes:
        node._impl.click_cb.clear()
