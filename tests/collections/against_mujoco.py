"""Compares robots of public files with MuJoCo: M, c, the tip and a closed loop, null space and all.

    python -m tests.collections.against_mujoco FOLDER... > table.md

The folders hold the unpacked packages example-robot-data and rtb-data; see `__main__.py`. MuJoCo
reads the same file, without what is drawn and with the joints fixed that our robot holds.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from onpath.models.arrays import Array
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.robot_file import RobotFile, read_robot
from tests.collections.__main__ import found
from tests.support.mujoco_peer import MuJoCo, equation_errors, loop_error

FILES = (
    *("panda.urdf", "ur5_robot.urdf", "kinova.urdf", "baxter.urdf", "talos_left_arm.urdf"),
    *("g1_29dof_rev_1_0.urdf", "a1.urdf", "z1.urdf", "tiago_pro.urdf", "so101.urdf"),
)
"""Files that state all masses and inertias: nine redundant arms of 5 to 8 joints, and a leg."""
LAWS = ("path_following", "trajectory_tracking")
STATES = 50
LOST = ("visual", "collision", "transmission", "gazebo", "mujoco")


def peer_of(file: Path, robot: RobotFile, folder: Path) -> MuJoCo:
    """The file in MuJoCo."""
    source = robot.entry.source
    assert source is not None
    text = file.read_text("utf-8", errors="replace")
    root = ElementTree.fromstring(re.sub(r"<\?xml.*?\?>", "", text))
    moving = {joint.name for joint in source.chain.joints}
    for parent in [*root.iter()]:
        for child in [*parent]:
            if child.tag in LOST:
                parent.remove(child)
    for joint in root.iter("joint"):
        if joint.get("name") not in moving and joint.get("type"):
            joint.set("type", "fixed")
            for mimic in joint.findall("mimic"):
                joint.remove(mimic)
    extension = ElementTree.SubElement(root, "mujoco")
    ElementTree.SubElement(extension, "compiler", balanceinertia="true")
    bare = folder / "bare.urdf"
    bare.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
    return MuJoCo(bare, robot.tips[0], 1e-3 / source.substeps)


def states(robot: RobotFile) -> list[tuple[Array, Array]]:
    """Random states within the limits."""
    source = robot.entry.source
    assert source is not None
    rng, (low, high) = np.random.default_rng(0), source.chain.limits
    low, high = np.maximum(low, -np.pi), np.minimum(high, np.pi)
    return [(rng.uniform(low, high), rng.normal(size=len(low))) for _ in range(STATES)]


def row(file: Path) -> str:
    """A row of the table."""
    robot = read_robot(file, Options())
    source = robot.entry.source
    assert source is not None
    with tempfile.TemporaryDirectory() as folder:
        peer: Callable[[], MuJoCo] = lambda: peer_of(file, robot, Path(folder))  # noqa: E731
        errors = equation_errors(robot.entry, peer(), states(robot))
        apart = [loop_error(robot.entry, peer(), law, source.radius) for law in LAWS]
    numbers = " | ".join(f"{each:.0e}" for each in (*errors, *apart))
    return f"| {file.name} | {source.chain.n} | {robot.tips[0]} | {numbers} |"


def main(*folders: str) -> None:
    """Print the table."""
    print(
        "| file | joints | tip | M, kg m² | c, share | tip, m | following, rad | tracking, rad |\n"
        "|---|---|---|---|---|---|---|---|"
    )
    for name in FILES:
        file = found(f"/{name}", [Path(each) for each in folders])
        print(f"| {name} | not found |" if file is None else row(file), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
