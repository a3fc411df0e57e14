"""Files that are refused, by line and element, and mangled ones: never a traceback or a hang."""

from __future__ import annotations

import re
import time
import tracemalloc
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onpath.models.errors import CodedError, Message
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.xml_elements import FileFault, root_of, safe_name
from onpath.models.systems.robot_file import RobotFile, read_robot
from tests.support.mangled_robots import mangled, robot_or_line, urdf_seeds
from tests.support.robot_files import PLANAR, urdf

ARM = urdf("arm", PLANAR)
POSE = {f"joint{i + 1}": x for i, x in enumerate((2.0, -1.3, -0.9))}
LINK3 = 8  # line of its element in ARM


def refused(folder: Path, text: str | bytes, options: Options | None = None) -> CodedError:
    file = folder / "arm.urdf"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(CodedError) as caught:
        read_robot(file, options or Options(pose=POSE))
    for language in ("en", "de"):
        assert caught.value.message.text(language)
    return caught.value


def changed(old: str, new: str, count: int = 1) -> str:
    assert old in ARM
    return ARM.replace(old, new, count)


def joint(child: str) -> str:
    ends = f'<parent link="tip"/><child link="{child}"/>'
    return f'<joint name="to_{child}" type="fixed">{ends}</joint>'


def link(name: str) -> str:
    return f'{joint(name)}<link name="{name}"/>'


def added(text: str) -> str:
    return ARM.replace("</robot>", f"{text}\n</robot>")


MASS = '<mass value="0.6"/>'
CASES = {
    "doctype": ('<!DOCTYPE robot [<!ENTITY a "b">]>\n' + ARM.split("\n", 1)[1], 1, "!DOCTYPE"),
    "root": ("<sdf/>", 1, "sdf"),
    "xacro": (changed(MASS, '<mass value="${m}"/>'), 5, "mass"),
    "without": (changed(MASS, "<mass/>"), 5, "mass"),
    "numbers": (changed(MASS, '<mass value="0,6"/>'), 5, "mass"),
    "large": (changed(MASS, '<mass value="1e400"/>'), 5, "mass"),
    "no_link": (changed('child link="link2"', 'child link="link9"'), 6, "child"),
    "two_parents": (added(joint("link3")), 12, "joint to_link3"),
    "loop": (changed('<parent link="base"/>', '<parent link="tip"/>'), 5, "link link1"),
    "apart": (added('<link name="lonely"/>'), 12, "link lonely"),
    "twice": (added('<link name="tip"/>'), 12, "link tip"),
    "many": (added("\n".join(link(f"more{i}") for i in range(1000))), 0, "link more"),
    "type": (changed('type="revolute"', 'type="magic"'), 4, "joint joint1"),
    "mass": (changed(MASS, '<mass value="-0.6"/>'), 5, "mass"),
    "negative": (changed('damping="0.02"', 'damping="-1"'), 4, "dynamics"),
    "limits": (changed('lower="-3"', 'lower="4"'), 4, "limit"),
    "axis": (changed('axis xyz="0 -1 0"', 'axis xyz="0 0 0"'), 4, "axis"),
    "elements": (added("<a>" * 40 + "</a>" * 40), 12, "a"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_fault_is_named_with_its_line_and_element(tmp_path: Path, case: str) -> None:
    text, line, element = CASES[case]
    error = refused(tmp_path, text)
    said = error.message.arguments
    assert error.message.code == "robot_file.at" and said["file"] == "arm.urdf"
    assert isinstance(reason := said["reason"], Message) and reason.code == f"robot_file.{case}"
    assert said["line"] == line or not line
    assert str(said["element"]).startswith(element)


@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e999", "1_0", "0x10", "", "1 2", "é"])
def test_only_finite_decimal_numbers_are_read(tmp_path: Path, number: str) -> None:
    said = refused(tmp_path, changed(MASS, f'<mass value="{number}"/>')).message.arguments
    assert isinstance(reason := said["reason"], Message)
    assert reason.code in ("robot_file.numbers", "robot_file.large")


def code_of(error: CodedError) -> str:
    return error.message.code.removeprefix("robot_file.")


def test_options_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    assert code_of(refused(tmp_path, ARM, Options(tip="nose"))) == "no_tip"
    assert code_of(refused(tmp_path, ARM, Options(pose={"knee": 0}))) == "no_joint"
    assert code_of(refused(tmp_path, ARM, Options(pose={"joint1": 99}))) == "pose_outside"
    assert code_of(refused(tmp_path, ARM, Options(pose={"joint1": float("nan")}))) == "pose"
    assert code_of(refused(tmp_path, ARM, Options(armature=-1))) == "armature"
    stretched = {"joint1": 0.0, "joint2": 0.0, "joint3": 0.0}
    assert code_of(refused(tmp_path, ARM, Options(pose=stretched))) == "singular"
    still = {"joint1": 0.5, "joint2": 0.5}
    assert code_of(refused(tmp_path, ARM, Options(lock=still))) == "single"


def test_files_that_are_none_or_too_large_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CodedError) as caught:
        read_robot(tmp_path / "nothing.urdf", Options())
    assert code_of(caught.value) == "absent"
    with pytest.raises(CodedError) as caught:
        read_robot(tmp_path, Options())
    assert code_of(caught.value) == "absent"
    assert code_of(refused(tmp_path, b" " * 1_000_001)) == "size"
    for data in (b"", b"\x00\xff", b"<?xml version='1.0' encoding='klingon'?><robot/>"):
        error = refused(tmp_path, data)
        assert error.message.code == "robot_file.at_line"
        assert str(error).startswith("arm.urdf, line 1: this is not XML: ")
    assert refused(tmp_path, ARM.replace("</robot>", "<link")).message.arguments["line"] == 12


def test_stiff_friction_is_given_an_armature_that_suffices_and_is_said(tmp_path: Path) -> None:
    """Its line makes the same robot, without the guess."""
    text = re.sub('damping="[^"]*"', 'damping="8"', ARM)
    (tmp_path / "arm.urdf").write_text(text, "utf-8")
    guessed = read_robot(tmp_path / "arm.urdf", Options(pose=POSE))
    (line,) = (guess.line for guess in guessed.guesses if guess.kind == "inertia")
    option, value = line.split()
    assert option == "--armature"
    said = read_robot(tmp_path / "arm.urdf", Options(pose=POSE, armature=float(value)))
    assert said.guesses == ()
    sources = said.entry.source, guessed.entry.source
    assert sources[0] is not None and sources[1] is not None and sources[0].is_as(sources[1])
    assert sources[0].substeps == 1


LOOKS = {
    "zero box": '<geometry><box size="0 0 0"/></geometry>',
    "two numbers": '<geometry><box size="1 1"/></geometry>',
    "no size": "<geometry><sphere/></geometry>",
    "unknown": "<geometry><torus/></geometry><magic/>",
    "nothing": "",
    "missing mesh": '<geometry><mesh filename="a.stl"/></geometry>',
    "xacro": '<geometry><mesh filename="$(find other)/a.stl" scale="${s}"/></geometry>',
    "package": '<geometry><mesh filename="package://other/a.stl"/></geometry>',
}


@pytest.mark.parametrize("case", LOOKS)
def test_looks_never_refuse_a_robot(tmp_path: Path, case: str) -> None:
    """However often they are wrong, they are one remark, or one missing package."""
    file = tmp_path / "arm.urdf"
    shapes = f"<visual>{LOOKS[case]}</visual><collision>{LOOKS[case]}</collision>" * 20
    stray = '<xacro:property name="a" value="${b}"/><gazebo value="$(find x)"/>'
    shown = re.sub('(<link name="[^"]*">)', rf"\1{shapes}", ARM).replace(
        "</robot>", stray + "</robot>"
    )
    file.write_text(shown.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" '))
    read = read_robot(file, Options(pose=POSE))
    assert [body.shapes for body in chain_of(read).bodies] == [()] * 3
    assert len([*read.remarks, *read.guesses]) <= 1
    if case == "package":
        assert [guess.line for guess in read.guesses] == ["--package other=FOLDER"]


NAMES = ("a/b", "<b>x</b>", "=1+1", "\u202egnp", "x" * 10_000, "../etc", "{x}", "é", "a b")


@pytest.mark.parametrize("name", NAMES)
def test_names_never_refuse_a_robot_and_are_short_and_printable(tmp_path: Path, name: str) -> None:
    file = tmp_path / "arm.urdf"
    text = ARM.replace('"link1"', quoteattr(name)).replace('"joint1"', quoteattr(name))
    file.write_text(text, "utf-8")
    pose = {safe_name(name) if key == "joint1" else key: x for key, x in POSE.items()}
    joint, *_ = chain_of(read_robot(file, Options(pose=pose))).joints
    assert joint.name.isprintable() and len(joint.name) <= 128
    assert joint.name == name or len(name) > 128 or not name.isprintable()


def chain_of(read: RobotFile) -> Chain:
    assert read.entry.source is not None
    return read.entry.source.chain


PLACES = ("other/link.stl", "../link.stl", "/etc/passwd", "file:///etc/hosts", "http://a/b.stl")
PLACES += ("package://x/../../../link.stl", "package://x/link.txt", "link\x00.stl", "~/link.stl")


@pytest.mark.parametrize("place", [p for p in PLACES if "\x00" not in p])
def test_a_mesh_from_elsewhere_is_left_out_with_a_remark(tmp_path: Path, place: str) -> None:
    inside = tmp_path / "robot"
    inside.mkdir()
    (tmp_path / "link.stl").write_bytes(b"solid")
    (inside / "link.txt").write_bytes(b"solid")
    (inside / "package.xml").write_text("<package/>")
    (inside / "linked.stl").symlink_to(tmp_path / "link.stl")
    for address in (place, "linked.stl"):
        visual = f'<visual><geometry><mesh filename="{address}"/></geometry></visual>'
        file = inside / "arm.urdf"
        file.write_text(changed('<link name="base">', f'<link name="base">{visual}'))
        read = read_robot(file, Options(pose=POSE))
        said = [remark.code for remark in read.remarks] + [guess.line for guess in read.guesses]
        assert said in (["robot_file.not_drawn"], ["--package x=FOLDER"])
        assert read.entry.source is not None and read.entry.source.chain.base == ()


def test_a_package_is_the_nearest_folder_with_its_file_or_one_that_is_named(tmp_path: Path) -> None:
    deep, other = tmp_path / "arm" / "urdf" / "deep", tmp_path / "other"
    deep.mkdir(parents=True)
    (tmp_path / "arm" / "meshes").mkdir()
    other.mkdir()
    (tmp_path / "arm" / "package.xml").write_text("<package/>")
    own, foreign = tmp_path / "arm" / "meshes" / "a.stl", other / "b.STL"
    own.write_bytes(b"solid")
    foreign.write_bytes(b"solid")
    visuals = "".join(
        f'<visual><geometry><mesh filename="{address}" scale="0.001 0.001 0.001"/>'
        "</geometry></visual>"
        for address in ("package://arm/meshes/a.stl", "package://other/b.STL")
    )
    file = deep / "arm.urdf"
    file.write_text(changed('<link name="base">', f'<link name="base">{visuals}'))
    read = read_robot(file, Options(pose=POSE, packages={"other": other}))
    assert read.remarks == () and read.entry.source is not None
    shapes = read.entry.source.chain.base
    assert [shape.file for shape in shapes] == [str(own), str(foreign)]
    assert shapes[0].size == (0.001,) * 3


@pytest.mark.thorough
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(mangled(urdf_seeds()), st.sampled_from(["tip", "tool0", ""]))
def test_a_mangled_file_is_read_or_refused(tmp_path: Path, data: bytes, tip: str) -> None:
    """In less than two seconds of processor time and 30 MB, without any other error."""
    tracemalloc.start()
    began = time.process_time()
    try:
        read_urdf(tmp_path / "arm.urdf", root_of(data), Options(tip=tip))
    except (FileFault, CodedError):
        pass
    finally:
        assert tracemalloc.get_traced_memory()[1] < 30e6
        assert time.process_time() - began < 2
        tracemalloc.stop()


MJCF = """<mujoco><compiler angle="radian"/><worldbody><body name="link1" pos="0 0 0.17">
<inertial pos="0.075 0 0" mass="0.6" diaginertia="0.004 0.005 0.005"/>
<joint name="joint1" axis="0 -1 0" range="-3 3" damping="0.02" armature="0.01"/>
<body name="link2" pos="0.15 0 0"><joint name="joint2" axis="0 -1 0" damping="0.01"/>
<geom type="capsule" fromto="0 0 0 0.22 0 0" size="0.02"/>
<site name="tip" pos="0.22 0 0"/></body></body></worldbody></mujoco>
"""
TWICE = '<joint name="again" axis="0 -1 0"/><joint name="joint2"'
STRANGE = {
    "mass": ('mass="0.6"', 'mass="nan"', "line 2, inertial: mass nan"),
    "place": ('pos="0.15 0 0"', 'pos="0.15 1e308 0"', "line 4, body link2: pos 0.15 1e308 0"),
    "damping": ('damping="0.01"', 'damping="-1"', "line 4, joint joint2: damping"),
    "include": ("<worldbody>", '<include file="a.xml"/><worldbody>', "line 1, include"),
    "range": ('range="-3 3"', 'range="3 -3"', "line 3, joint joint1: the lower limit 3"),
}


@pytest.mark.parametrize("case", STRANGE)
def test_what_is_wrong_in_an_mjcf_file_is_named_with_its_line(tmp_path: Path, case: str) -> None:
    pytest.importorskip("mujoco")
    old, new, words = STRANGE[case]
    assert words in str(refused(tmp_path, MJCF.replace(old, new), Options()))


def test_warnings_of_mujoco_are_remarks_and_no_file_in_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two joints about one axis have a singular mass matrix; a mass is then added to one."""
    pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    again = MJCF.replace('<joint name="joint2"', TWICE)
    file = tmp_path / "arm.xml"
    file.write_text(again)
    options = Options(armature=0.01, pose={"joint1": 1.2, "again": 0.0, "joint2": -1.4})
    codes = [remark.code for remark in read_robot(file, options).remarks]
    assert codes == ["robot_file.mujoco_warns"]
    assert [each.name for each in tmp_path.iterdir()] == ["arm.xml"]


@pytest.mark.thorough
@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=100
)
@given(mangled(urdf_seeds()), st.sampled_from(["tip", "tool0", ""]))
def test_many_mangled_files_are_robots_or_refused_in_a_line(
    tmp_path: Path, data: bytes, tip: str
) -> None:
    robot_or_line(tmp_path / "arm.urdf", data, Options(tip=tip, armature=0.01))


NUMBERS = st.sampled_from(["0", "-1", "1e9", "1e-9", "-1e9", "3.14159", "1e-300", "1000"])


@pytest.mark.thorough
@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=25
)
@given(st.lists(st.tuples(st.integers(0, 60), NUMBERS), min_size=1, max_size=4))
def test_a_file_with_strange_numbers_is_a_robot_or_refused(
    tmp_path: Path, changes: list[tuple[int, str]]
) -> None:
    """Whatever the numbers: a sentence in both languages, or a robot that stands still at home."""
    pieces = re.split(r'(?<=[" ])(-?\d[\d.e-]*)(?=[" ])', ARM)
    for at, number in changes:
        pieces[2 * (at % (len(pieces) // 2)) + 1] = number
    file = tmp_path / "arm.urdf"
    file.write_text("".join(pieces))
    try:
        entry = read_robot(file, Options(pose=POSE)).entry
    except CodedError as error:
        assert all(error.message.text(language) for language in ("en", "de"))
        return
    robot = entry.make(entry.parameters())
    assert entry.source is not None
    assert robot.margin(np.zeros(2)) == pytest.approx(1)
