"""The brake's guide at an end-point, and a label with the size of the force on it."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

import numpy as np
from viser import transforms

from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene import meshes
from onpath.app.scene.stage import ChangingText, Stage, add_copies
from onpath.app.viser_adapter.frame_channel import move_node
from onpath.lessons.words import Words

if TYPE_CHECKING:
    import viser

FORCE_SHOWN = 0.05
"""Forces below this are not drawn [N]."""
CLEAR = 0.034
"""Distance of a force's label from the path, above or below it [m]."""
WIDE = 0.13
"""Width of such a label [m]."""
STAYS = 0.03
"""How far an end-point moves before the label of its force follows it [m]."""


class ContactNodes:
    """Brakes and labels of forces, of all robots.

    A brake leaves an end-point free in one direction, so it is drawn as a guide in which the
    end-point slides, where the brake was applied: it does not move.

    Args:
        labelled: whether forces have labels.
    """

    def __init__(
        self, scene: viser.SceneApi, stage: Stage, words: Words, labelled: bool = True
    ) -> None:
        self._scene, self._bases, self._words = scene, stage.bases, words
        self._metal = stage.tones.metal
        self._brakes = dict[str, np.ndarray]()
        self._guides: list[viser.BatchedMeshHandle] = []
        sides = stage.bases if labelled else ()
        self._labels = {side: ForceLabel(scene, stage, side, words) for side in sides}

    def update(self, snapshot: Snapshot) -> None:
        """Show a snapshot; sends nothing if nothing has changed."""
        path = snapshot.path.points
        for side, robot in snapshot.robots.items():
            if side in self._labels:
                self._labels[side].show(hypot(*robot.force.tolist()), robot.tip, path)
        if not _same(snapshot.brakes, self._brakes):
            self._brakes = snapshot.brakes
            self._draw_guides()

    def _draw_guides(self) -> None:
        for node in self._guides:
            node.remove()
        self._guides = []
        for side, (place, blocked, free) in self._brakes.items():
            slides = bool(free.any())
            across = free if slides else np.cross([0.0, 1.0, 0.0], blocked)
            turn = np.column_stack([blocked, np.cross(across, blocked), across])
            node = add_copies(
                self._scene,
                f"/brakes/{side}",
                meshes.part("guide" if slides else "clamp"),
                (self._bases[side] + place)[None],
                self._metal,
            )
            node.batched_wxyzs = transforms.SO3.from_matrix(turn).wxyz[None]
            self._guides.append(node)


class ForceLabel:
    """The size of the force on one end-point, above or below the path there.

    It stays where it is while the end-point moves a little, so that it can be read.
    """

    def __init__(self, scene: viser.SceneApi, stage: Stage, side: str, words: Words) -> None:
        self._words = words
        self._at: np.ndarray | None = None
        self._base = stage.bases[side]
        self._leftmost, self._rightmost = stage.low[0] + WIDE / 2, stage.high[0] - WIDE / 2
        self._text = ChangingText(scene, f"/force_labels/{side}", np.zeros(3))

    def show(self, force: float, tip: np.ndarray, path: np.ndarray) -> None:
        """Show a force [N] on an end-point at `tip`, shape (3,), in the robot's frame [m]."""
        if force <= FORCE_SHOWN:
            self._text.show("")
            self._at = None
            return
        if self._at is None or np.linalg.norm(tip - self._at) >= STAYS:
            self._at = tip.copy()
            low, high = path[:, 2].min(), path[:, 2].max()
            above = tip[2] > (low + high) / 2
            height = max(high, tip[2]) + CLEAR if above else min(low, tip[2]) - CLEAR
            x = np.clip(tip[0], self._leftmost, self._rightmost)
            move_node(self._text.label, self._base + [x, tip[1], height])
        self._text.show(self._words("scene.force", force=f"{force:.{int(force < 1.0)}f}"))


def _same(some: dict[str, np.ndarray], others: dict[str, np.ndarray]) -> bool:
    return some.keys() == others.keys() and all(
        brake is others[side] or np.array_equal(brake, others[side]) for side, brake in some.items()
    )
