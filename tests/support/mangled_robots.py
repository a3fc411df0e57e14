"""Robots' files that are real but for some changes, for tests with random search."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from hypothesis import strategies as st

from onpath.assets import asset_path
from onpath.models.errors import CodedError
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.robot_file import read_robot
from tests.support.some_chains import random_arm

ROBOTS = Path(__file__).parents[1] / "data" / "robots"
NUMBERS = ("0", "-1", "1e9", "1e-9", "-1e9", "3.14159", "1e-300", "1e308", "nan", "inf", "0x1", "")
NUMBERS += ("1 2", "1 0 0", "0 0 0 0", "1 " * 500, "1,5", "é")
NAMES = (
    "base",
    "tip",
    "link1",
    "joint2",
    "tool",
    "..",
    "/etc/passwd",
    "../a.stl",
    "<&>",
    "a" * 999,
)
KINDS = (
    "prismatic",
    "floating",
    "planar",
    "free",
    "ball",
    "hfield",
    "sdf",
    "mesh",
    "true",
    "false",
)
PIECES = (
    "<",
    ">",
    '"',
    "/",
    "]]>",
    "<!--",
    "&amp;",
    "&#0;",
    "\n",
    "\x00",
    "é",
    "</link>",
    "{}",
    "${x}",
)
INTRUDERS = (
    '<include file="/etc/passwd"/>',
    '<replicate count="100000000" offset="1 0 0"><geom size="1"/></replicate>',
    '<composite type="cable" count="1000000 1 1"/>',
    '<flexcomp name="f" type="grid" count="999 999 999" spacing="1 1 1"/>',
    '<attach model="m" body="b" prefix="p"/>',
    '<model name="m" file="/etc/passwd"/>',
    '<plugin plugin="mujoco.sdf.nut"/>',
    '<extension><plugin plugin="mujoco.elasticity.cable"/></extension>',
    '<hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/>',
    '<mesh name="m" file="/etc/passwd"/>',
    '<mesh name="m" builtin="supersphere" params="9999 1 1"/>',
    '<size memory="900G"/>',
    '<compiler meshdir="/etc" usethread="false"/>',
    '<geom type="hfield" hfield="h"/>',
    '<default class="x"><default class="x"/></default>',
    '<mimic joint="joint1"/>',
    '<inertial><mass value="-1"/></inertial>',
    "<a/>",
)

WHOLE = (
    "no_tip",
    "no_joint",
    "no_pose",
    "no_pose_package",
    "singular",
    "circle",
    "massless",
    "pose_outside",
    "pose",
)
WHOLE += ("single", "two_across", "no_joints", "hand")
"""Refusals of a robot as a whole, which belong to no line."""


def urdf_seeds() -> list[str]:
    """Those of this package, of reports, and random ones."""
    files = [*(asset_path("robots").glob("*.urdf")), *ROBOTS.glob("*.urdf")]
    return [*(file.read_text() for file in sorted(files)), random_arm(1)]


def mjcf_seeds() -> list[str]:
    """One as modelled by hand, and two as saved by MuJoCo."""
    return [file.read_text() for file in sorted(ROBOTS.glob("*.xml"))]


@st.composite
def mangled(draw: st.DrawFn, seeds: list[str]) -> bytes:
    """A file in which elements and attributes are deleted, repeated, moved or replaced.

    Sometimes also its text is, so that it may be no XML at all.
    """
    root = ElementTree.fromstring(draw(st.sampled_from(seeds)))
    for _ in range(draw(st.integers(1, 4))):
        _change(draw, root)
    text = ElementTree.tostring(root, "unicode")
    if draw(st.integers(0, 3)) == 0:
        a = draw(st.integers(0, len(text)))
        b = a + draw(st.sampled_from([0, 1, 5, 40, 400]))
        piece = draw(st.sampled_from(PIECES) | st.just("") | st.just(2 * text[a:b]))
        text = text[:a] + piece + text[b:]
    return text.encode("utf-8", "replace")


def _change(draw: st.DrawFn, root: ElementTree.Element) -> None:
    """Change one element or one attribute."""
    parents = [(parent, child) for parent in root.iter() for child in parent]
    if not parents:
        return
    parent, child = draw(st.sampled_from(parents))
    kind = draw(
        st.sampled_from(["value", "value", "value", "drop", "delete", "repeat", "move", "add"])
    )
    if kind in ("value", "drop") and child.attrib:
        name = draw(st.sampled_from(sorted(child.attrib)))
        if kind == "drop":
            del child.attrib[name]
        else:
            child.attrib[name] = draw(st.sampled_from([*NUMBERS, *NAMES, *KINDS]))
    elif kind == "delete":
        parent.remove(child)
    elif kind == "repeat":
        for _ in range(draw(st.sampled_from([1, 2, 300]))):
            parent.append(child)
    elif kind == "move":
        other, _ = draw(st.sampled_from(parents))
        if child not in other.iter() and other not in child.iter():
            parent.remove(child)
            other.append(child)
    else:
        child.append(ElementTree.fromstring(draw(st.sampled_from(INTRUDERS))))


def robot_or_line(file: Path, data: bytes, options: Options) -> None:
    """Assert that a file is a robot, or refused in one line that names the file and the line."""
    file.write_bytes(data)
    try:
        read_robot(file, options)
    except CodedError as error:
        texts = [error.message.text(language) for language in ("en", "de")]
        assert not any("\n" in text or "Traceback" in text for text in texts)
        code = error.message.code.removeprefix("robot_file.")
        assert code in WHOLE or file.name in texts[0], texts[0]
        if code in ("at", "at_line"):
            line = error.message.arguments["line"]
            assert isinstance(line, int) and 1 <= line <= data.count(b"\n") + 1
