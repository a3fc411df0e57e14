"""Images in the scene that are encoded beforehand, in another thread.

viser encodes an image for every node, in the thread that adds it. This uses private parts of viser,
which tests pin.
"""

from __future__ import annotations

import numpy as np
import viser
from viser import _messages, _scene_api


def png_of(picture: np.ndarray) -> bytes:
    """A picture as PNG.

    Args:
        picture: shape (rows, columns, 3 or 4), uint8.
    """
    return _scene_api._encode_image_binary(picture, "png")[1]


def add_png(
    scene: viser.SceneApi,
    name: str,
    data: bytes,
    size: tuple[float, float],
    position: np.ndarray,
    wxyz: np.ndarray,
) -> viser.ImageHandle:
    """Add a PNG in a rectangle whose local axes are x to the right and y downward, without shadows.

    Args:
        size: width and height, [m].
        position: of the middle, shape (3,), [m].
        wxyz: orientation, a unit quaternion, scalar first.
    """
    props = _messages.ImageProps(
        _format="png",
        _data=data,
        render_width=size[0],
        render_height=size[1],
        cast_shadow=False,
        receive_shadow=False,
        scale=1.0,
    )
    message = _messages.ImageMessage(name=name, props=props)
    return viser.ImageHandle._make(scene, message, name, wxyz, position, True)
