"""Robots' files open no others than those of their folder, their package and the folders given."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from onpath.models.errors import CodedError
from onpath.models.robot_files import limited_process
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.file_reading import read_file
from onpath.models.robot_files.mesh_folders import LEVELS, MeshFolders
from onpath.models.robot_files.xml_elements import FileFault
from tests.support.robot_files import PLANAR, urdf

ARM = urdf("arm", PLANAR)
MESH = (
    "solid a\nfacet normal 0 0 1\nouter loop\n"
    + "".join(f"vertex {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)))
    + "endloop\nendfacet\nendsolid a\n"
)
WATCHER = """import os, sys
def hook(event, values):
    if event == "open" and isinstance(values[0], str):
        os.write(2, ("OPENED " + os.path.realpath(values[0]) + "\\n").encode())
sys.addaudithook(hook)
"""
BODY = """<body name="{0}"><inertial pos="0 0 0.1" mass="1" diaginertia=".01 .01 .01"/>
<joint name="{0}j" axis="0 1 0" range="-1 1"/>{1}</body>"""


class Opened:
    """Files that this process and those that it starts open, in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.files, self.robot = str(folder.resolve()), set[str](), folder

    def add(self, path: str) -> None:
        if path.startswith(self.folder):
            self.files.add(path)


WATCHING = list[Opened]()


def _watch(event: str, values: tuple[Any, ...]) -> None:
    if event == "open" and WATCHING and isinstance(values[0], str | os.PathLike):
        path = os.path.realpath(os.fspath(values[0]))
        for each in WATCHING:
            each.add(path)


sys.addaudithook(_watch)


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    watcher = tmp_path / "watcher"
    watcher.mkdir()
    (watcher / "sitecustomize.py").write_text(WATCHER)
    monkeypatch.syspath_prepend(str(watcher))
    run, found = subprocess.run, Opened(tmp_path / "world")

    def watched(*arguments: Any, **options: Any) -> Any:
        ended = run(*arguments, **{**options, "check": False})
        for line in ended.stderr.decode(errors="replace").splitlines():
            if line.startswith("OPENED "):
                found.add(line.removeprefix("OPENED "))
        if options.get("check"):
            ended.check_returncode()
        return ended

    monkeypatch.setattr(limited_process.subprocess, "run", watched)
    found.robot = world(tmp_path)
    WATCHING.append(found)
    yield found
    WATCHING.remove(found)


def world(folder: Path) -> Path:
    """A robot's folder, beside another one with files that it must not read."""
    robot, outside = folder / "world" / "robot", folder / "world" / "outside"
    for each in (robot, outside):
        each.mkdir(parents=True)
        (each / "a.stl").write_text(MESH)
        (each / "part.xml").write_text(
            f"<mujoco><worldbody>{BODY.format('b', '')}</worldbody></mujoco>"
        )
        part = f'<robot><link name="{each.name}"/></robot>'
        (each / "part.xacro").write_text(part)
    for name in ("a.stl", "part.xml", "part.xacro"):
        (robot / f"linked_{name}").symlink_to(outside / name)
    (robot / "linked").symlink_to(outside)
    return robot


def addresses(folder: Path, name: str) -> list[str]:
    outside = folder / "world" / "outside" / name
    return [
        f"../outside/{name}",
        str(outside),
        f"file://{outside}",
        f"linked_{name}",
        f"linked/{name}",
        f"package://outside/{name}",
        f"package://robot/../outside/{name}",
        f"$(find outside)/{name}",
        f"$(find robot)/../outside/{name}",
        f"./././../robot/../outside/{name}",
    ]


def try_to_read(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8")
    with suppress(FileFault, CodedError):
        read_file(file, Options())


def assert_inside(opened: Opened, robot: Path, file: Path) -> None:
    """At least the file itself was seen, and nothing outside of the robot's folder."""
    assert str(file.resolve()) in opened.files
    assert [
        each for each in opened.files if not each.startswith(f"{robot.resolve()}{os.sep}")
    ] == []


def test_a_urdf_file_weighs_and_draws_no_mesh_from_elsewhere(
    tmp_path: Path, opened: Opened
) -> None:
    robot = opened.robot
    shapes = "".join(
        f'<{kind}><geometry><mesh filename="{address}"/></geometry></{kind}>'
        for address in [*addresses(tmp_path, "a.stl"), "a.stl"]
        for kind in ("visual", "collision")
    )
    bare = ARM[: ARM.index("<inertial>")] + ARM[ARM.index("</inertial>") + len("</inertial>") :]
    try_to_read(
        robot / "arm.urdf", bare.replace('<link name="link1">', f'<link name="link1">{shapes}')
    )
    assert_inside(opened, robot, robot / "arm.urdf")
    assert str(robot.resolve() / "a.stl") in opened.files


@pytest.mark.thorough
def test_an_mjcf_file_includes_and_draws_nothing_from_elsewhere(
    tmp_path: Path, opened: Opened
) -> None:
    pytest.importorskip("mujoco")
    robot = opened.robot
    for k, address in enumerate(addresses(tmp_path, "part.xml")):
        (robot / f"inner{k}.xml").write_text(f'<mujoco><include file="{address}"/></mujoco>')
        for text in (f'<include file="{address}"/>', f'<include file="inner{k}.xml"/>'):
            try_to_read(robot / "arm.xml", f"<mujoco>{text}</mujoco>")
    for address in addresses(tmp_path, "a.stl"):
        mesh = f'<asset><mesh name="m" file="{address}"/></asset>'
        geom = '<geom type="mesh" mesh="m"/>'
        arm = f"<worldbody>{BODY.format('a', geom)}</worldbody>"
        try_to_read(robot / "arm.xml", f"<mujoco>{mesh}{arm}</mujoco>")
    assert_inside(opened, robot, robot / "arm.xml")


@pytest.mark.thorough
def test_a_file_that_includes_another_is_that_robot(tmp_path: Path) -> None:
    """As in MuJoCo: the scene and the file give the same chain; a change of the part renames it."""
    pytest.importorskip("mujoco")
    arm = BODY.format("a", BODY.format("b", BODY.format("c", '<site name="tip" pos="0 0 1"/>')))
    part, scene = tmp_path / "arm.xml", tmp_path / "scene.xml"
    part.write_text(f"<mujoco><worldbody>{arm}</worldbody></mujoco>")
    scene.write_text(
        '<mujoco>\n<include file="arm.xml"/><worldbody><light pos="0 0 1"/>'
        '<geom type="plane" size="1 1 1"/></worldbody></mujoco>'
    )
    (own, _), (whole, _) = read_file(part, Options()), read_file(scene, Options())
    assert [body.mass for body in own.chain.bodies] == [body.mass for body in whole.chain.bodies]
    assert own.rests == "" != whole.rests
    part.write_text(part.read_text().replace('mass="1"', 'mass="2"'))
    assert read_file(scene, Options())[0].rests != whole.rests
    part.write_text('<mujoco><include file="scene.xml"/></mujoco>')
    with pytest.raises(FileFault) as caught:
        read_file(scene, Options())
    assert str(caught.value.in_file(scene)).startswith("scene.xml, line 2, include: scene.xml")


HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="a">'
GRAB = HEAD + '<xacro:include filename="{}"/>' + ARM[ARM.index("<link") :]


def test_a_xacro_file_includes_nothing_from_elsewhere(tmp_path: Path) -> None:
    """The part in the robot's own folder is read, and the one outside is refused."""
    pytest.importorskip("xacro")
    robot = world(tmp_path)
    file = robot / "arm.urdf.xacro"
    for k, address in enumerate(["part.xacro", *addresses(tmp_path, "part.xacro")[::3]]):
        inner = f'{HEAD}<xacro:include filename="{address}"/></robot>'
        (robot / f"inner{k}.xacro").write_text(inner)
        file.write_text(GRAB.format(f"inner{k}.xacro"))
        with pytest.raises((CodedError, FileFault)) as caught:
            read_file(file, Options())
        error = caught.value
        assert isinstance(error, FileFault) == (k == 0)
        if isinstance(error, FileFault):  # a link that no joint leads to
            assert error.reason.arguments["name"] == "robot"


def test_a_missing_package_of_a_xacro_file_is_named(tmp_path: Path) -> None:
    """Its own package is found by the name in its package.xml, whatever its folder is called."""
    pytest.importorskip("xacro")
    (tmp_path / "package.xml").write_text("<package><name>arm_support</name></package>")
    part = ARM[ARM.index("<link") :]
    (tmp_path / "part.xacro").write_text(HEAD + part)
    file = tmp_path / "arm.xacro"
    include = '<xacro:include filename="$(find {})/part.xacro"/></robot>'
    file.write_text(HEAD + include.replace("{}", "arm_support"))
    assert read_file(file, Options())[0].chain.n == 3
    file.write_text(HEAD + include.replace("{}", "arm_resources"))
    with pytest.raises(CodedError, match="--package arm_resources=FOLDER"):
        read_file(file, Options())


def test_an_argument_without_a_value_is_given_one_in_the_file(tmp_path: Path) -> None:
    pytest.importorskip("xacro")
    file = tmp_path / "arm.xacro"
    rest = ARM[ARM.index("<link") :].replace('mass value="0.6"', 'mass value="$(arg load)"')
    file.write_text(HEAD + rest)
    with pytest.raises(CodedError) as caught:
        read_file(file, Options())
    (line,) = re.findall(r"<.*/>", str(caught.value))
    file.write_text(HEAD + line.replace("…", "0.7") + rest)
    assert read_file(file, Options())[0].chain.bodies[0].mass == pytest.approx(0.7)


FORBIDDEN = {
    "network": "import socket; socket.socket()",
    "programs": "import os; os.system('true')",
    "processes": "import subprocess; subprocess.run(['true'])",
    "writing": "open('{}/secret.txt', 'w')",
    "reading": "open('{}/secret.txt').read()",
    "listing": "import os; os.listdir('{}')",
    "removing": "import os; os.remove('{}/secret.txt')",
    "linking": "import os; os.symlink('{}/secret.txt', '{}/robot/link')",
    "libraries": "import ctypes; ctypes.CDLL(None)",
}


@pytest.mark.parametrize("attempt", FORBIDDEN)
def test_code_in_a_file_can_do_nothing_to_the_system(tmp_path: Path, attempt: str) -> None:
    """Even if an expression gets at all of Python; reading in the robot's folder is allowed."""
    secret, robot = tmp_path / "secret.txt", tmp_path / "robot"
    robot.mkdir()
    for file in (secret, robot / "own.txt"):
        file.write_text("secret")
    code = FORBIDDEN[attempt].replace("{}", str(tmp_path))
    program = (
        "import socket, subprocess, ctypes\n"
        "from pathlib import Path\n"
        "from onpath.models.robot_files.xacro_process import guard\n"
        f"guard((Path({str(robot)!r}),))\n"
        f"assert open({str(robot / 'own.txt')!r}).read()\n"
        f"try:\n    {code}\nexcept PermissionError:\n    print('refused')\n"
    )
    path = os.pathsep.join(filter(None, sys.path))
    ended = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.stdout == "refused\n", ended.stderr
    assert secret.read_text() == "secret" and not (robot / "link").exists()


def test_a_xacro_file_is_the_robot_that_it_expands_to_and_it_is_said(tmp_path: Path) -> None:
    pytest.importorskip("xacro")
    text = HEAD + '<xacro:property name="m" value="0.3"/>' + ARM[ARM.index("<link") :]
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(text.replace('mass value="0.6"', 'mass value="${2*m}"'))
    read, data = read_file(file, Options())
    assert [body.mass for body in read.chain.bodies] == pytest.approx([0.6, 0.4, 0.2])
    assert [remark.code for remark in read.remarks] == ["robot_file.xacro_ran"]
    assert b"xacro:property" not in data


def test_a_package_is_at_most_some_levels_above_and_never_a_home(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for levels in (LEVELS, LEVELS + 1):
        top = tmp_path / f"top{levels}"
        deep = top.joinpath(*"abcdefgh"[:levels])
        deep.mkdir(parents=True)
        (top / "package.xml").write_text("<package/>")
        (top / "a.stl").write_text(MESH)
        found = MeshFolders(deep / "arm.urdf", {}, (".stl",)).mesh("package://any/a.stl")
        assert (found is not None) == (levels == LEVELS)
    home = tmp_path / f"top{LEVELS}"
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setattr(Path, "home", lambda: home)
    deep = home.joinpath(*"abcde")
    assert MeshFolders(deep / "arm.urdf", {}, (".stl",)).mesh("package://any/a.stl") is None
