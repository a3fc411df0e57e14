"""Places a browser's camera, whatever pose the browser last reported."""

from __future__ import annotations

import viser
from viser import _messages

from onpath.models.arrays import Array


def place_camera(
    client: viser.ClientHandle, position: Array, look_at: Array, up: Array, fov: float
) -> None:
    """Place the camera of a browser.

    viser's own setters omit values that the browser reported last, and move the target along with
    the position. If a report arrives between two assignments, viser may omit the target, and the
    camera ends up elsewhere. This function sends the whole pose.

    Args:
        position: of the camera, shape (3,), [m].
        look_at: point at which it looks, shape (3,), [m].
        up: upward direction of the picture, shape (3,).
        fov: vertical field of view, [rad].
    """
    for message in (
        _messages.SetCameraFovMessage(fov),
        _messages.SetCameraUpDirectionMessage(_vector(up)),
        _messages.SetCameraPositionMessage(_vector(position)),
        _messages.SetCameraLookAtMessage(_vector(look_at)),
    ):
        client._websock_connection.queue_message(message)


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z
