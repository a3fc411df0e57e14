"""Random robots as URDF files."""

from __future__ import annotations

import numpy as np


def random_arm(seed: int, joints: int = 5) -> str:
    """An arm with frames, axes and inertias in any direction, and one joint that slides.

    Fixed joints lie between the others, and a hand with fingers hangs beside the tip.
    """
    rng = np.random.default_rng(seed)

    def numbers(count: int, size: float) -> str:
        return " ".join(f"{x:.6g}" for x in size * rng.normal(size=count))

    def origin(size: float) -> str:
        return f'<origin xyz="{numbers(3, size)}" rpy="{numbers(3, 1.0)}"/>'

    def link(name: str) -> str:
        spread = rng.normal(size=(3, 3)) * 0.03
        square = spread @ spread.T
        inertia = np.trace(square) * np.eye(3) - square + 1e-3 * np.eye(3)
        keys = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2)}
        entries = " ".join(f'{k}="{inertia[at]:.6g}"' for k, at in (keys | {"izz": (2, 2)}).items())
        mass = rng.uniform(0.3, 2)
        return (
            f'<link name="{name}"><inertial>{origin(0.05)}<mass value="{mass:.4g}"/>'
            f"<inertia {entries}/></inertial></link>"
        )

    def joint(name: str, kind: str, parent: str, child: str, size: float = 0.15) -> str:
        limit = '<limit lower="-2.5" upper="2.5" effort="50" velocity="5"/>'
        return (
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'{origin(size)}<axis xyz="{numbers(3, 1.0)}"/>{limit}'
            f'<dynamics damping="{rng.uniform(0, 0.5):.3g}"/></joint>'
        )

    parts, before = [link("base")], "base"
    for i in range(1, joints + 1):
        kind = "prismatic" if i == 3 else "revolute"
        parts += [link(f"link{i}"), joint(f"joint{i}", kind, before, f"link{i}")]
        parts += [link(f"cover{i}"), joint(f"fixed{i}", "fixed", f"link{i}", f"cover{i}", 0.05)]
        before = f"cover{i}"
    parts += [link("tip"), joint("flange", "fixed", before, "tip", 0.1)]
    return "<robot name='random'>\n" + "\n".join(parts) + "\n</robot>\n"
