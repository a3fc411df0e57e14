"""The shadows of the robots' bases on the ground, as one picture that is drawn quickly.

A browser that draws in software would spend a third of its time on looking up a real shadow at
every point of the ground, and a sixth on a ground that is more than its shadows.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from onpath.app.scene.meshes import Mesh
from onpath.app.viser_adapter.images import png_of

RADIUS = 1.6
"""Of the visible ground, up to the horizon [m]."""
FADING = 1.6
"""Exponent with which the ground fades towards the horizon."""
KEY_LIGHT = (-0.9, -0.7, 1.25)
"""Where the light that casts shadows is, as seen from the origin."""
PIXELS = 320
SAMPLES = 24
"""Points along each edge of a triangle that cast a shadow."""
SOFT, DARKEST = 0.014, 0.3
"""Blur of a shadow [m], and the share of light that it takes."""


def shadow(solids: Sequence[Mesh], origins: np.ndarray, floor: float) -> np.ndarray:
    """Share of the key light that solids take from the ground, shape (PIXELS, PIXELS), 0 to 1.

    The picture is a square of 2 RADIUS about the middle of the origins, with y upwards.

    Args:
        solids: in the robots' frames.
        origins: of the robots' frames in the world, shape (k, 3), [m].
        floor: height of the ground [m].
    """
    corners = np.concatenate([mesh.vertices[mesh.faces] for mesh in solids])
    first, second = np.meshgrid(*[np.linspace(0.0, 1.0, SAMPLES)] * 2)
    inside = first + second <= 1.0
    shares = np.stack([first[inside], second[inside], 1.0 - first[inside] - second[inside]])
    points = np.einsum("sn,tsd->tnd", shares, corners).reshape(-1, 3)
    x, y, z = KEY_LIGHT
    fallen = points[:, :2] - (points[:, 2:] - floor) / z * np.array([x, y])
    places = (origins[:, None, :2] - origins[:, :2].mean(axis=0) + fallen).reshape(-1, 2)
    hit, *_ = np.histogram2d(*places.T, bins=PIXELS, range=[(-RADIUS, RADIUS)] * 2)
    frequency = 2 * np.pi * np.fft.fftfreq(PIXELS, 2 * RADIUS / PIXELS)
    blur = np.exp(-0.5 * (SOFT * frequency) ** 2)
    spread = np.fft.ifft2(np.fft.fft2((hit > 0).T[::-1]) * np.outer(blur, blur)).real
    return np.clip(spread, 0.0, 1.0)


@lru_cache(maxsize=32)
def painted_shadow(
    solids: tuple[Mesh, ...], origins: tuple[tuple[float, ...], ...], floor: float
) -> tuple[bytes, tuple[float, float]]:
    """A PNG of `shadow`, cut to what is dark and still about its middle, and its two sizes, [m]."""
    dark = np.round(255.0 * DARKEST * shadow(solids, np.array(origins), floor)).astype(np.uint8)
    top, left = (
        np.minimum(at, PIXELS - 1 - at).min(initial=PIXELS // 2 - 1) for at in np.nonzero(dark)
    )
    alpha = dark[top : PIXELS - top, left : PIXELS - left]
    picture = np.zeros((*alpha.shape, 4), np.uint8)
    picture[..., 3] = alpha
    height, width = 2 * RADIUS / PIXELS * np.array(alpha.shape)
    return png_of(picture), (width, height)
