"""MJCF files are checked before MuJoCo reads them, in a process that may end without harm."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onpath.models.errors import CodedError
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.mjcf_check import LEFT_OUT, PASSED, REFUSED, checked_model
from onpath.models.robot_files.mjcf_file import read_mjcf
from onpath.models.robot_files.mujoco_process import read_model
from onpath.models.robot_files.xml_elements import FileFault, root_of
from onpath.models.systems.robot_file import read_robot
from tests.support.mangled_robots import ROBOTS, mangled, mjcf_seeds, robot_or_line

ARM = (ROBOTS / "gripper_arm.xml").read_text()
TETRAHEDRON = (ROBOTS / "meshes" / "tetrahedron.obj").read_bytes()
MESH = '<mesh file="tetrahedron.obj"/>'
GEOM = '<geom type="cylinder" size="0.02 0.05" density="800"/>'


def written(folder: Path, text: str) -> Path:
    """A file of a robot, with its meshes beside it."""
    (folder / "meshes").mkdir(exist_ok=True)
    (folder / "meshes" / "tetrahedron.obj").write_bytes(TETRAHEDRON)
    file = folder / "arm.xml"
    file.write_text(text)
    return file


def refusal(folder: Path, text: str) -> str:
    """Why a file is refused."""
    with pytest.raises(CodedError) as caught:
        read_robot(written(folder, text), Options(tip="tool"))
    assert all(caught.value.message.text(language) for language in ("en", "de"))
    return str(caught.value)


@pytest.mark.parametrize("tag", sorted({*REFUSED, "geom"}))
def test_what_reads_files_runs_code_or_multiplies_is_refused_by_its_line(
    tmp_path: Path, tag: str
) -> None:
    before = ARM[: ARM.index(GEOM)]
    intruder = '<geom type="hfield"/>' if tag == "geom" else f'<{tag} file="/etc/passwd"/>'
    line = before.count("\n") + 2
    said = refusal(tmp_path, ARM.replace(GEOM, f"{GEOM}\n{intruder}"))
    assert said.startswith(f"arm.xml, line {line}, {tag}: ") and "is not read" in said


@pytest.mark.parametrize("place", ["../a.obj", "/etc/passwd", "linked.obj", "other.txt", "no.obj"])
@pytest.mark.parametrize("folder", ["meshes", "", "../outside", "/tmp"])
def test_a_mesh_from_elsewhere_is_left_out(tmp_path: Path, place: str, folder: str) -> None:
    robot = tmp_path / "robot"
    for each in (robot, tmp_path / "outside"):
        each.mkdir()
        (each / "a.obj").write_bytes(TETRAHEDRON)
    (robot / "meshes").mkdir()
    for each in (robot, robot / "meshes", tmp_path / "outside"):
        (each / "linked.obj").symlink_to(tmp_path / "outside" / "a.obj")
        (each / "other.txt").write_bytes(TETRAHEDRON)
    if (folder, place) == ("meshes", "../a.obj"):
        place = "../../outside/a.obj"
    text = ARM.replace('meshdir="meshes"', f'meshdir="{folder}"')
    file = written(robot, text.replace(MESH, f'<mesh name="tetrahedron" file="{place}"/>'))
    model = checked_model(file, root_of(file.read_bytes()), {})
    assert model.meshes == {} and model.lacking == [Path(place).name]
    assert 'mesh="tetrahedron"' in ARM and "tetrahedron" not in model.text


@pytest.mark.parametrize(
    ("compiler", "address"),
    [
        ('assetdir="meshes"', "tetrahedron.obj"),
        ('assetdir="no" meshdir="meshes/"', "tetrahedron.obj"),
        ('meshdir="meshes" strippath="true"', "C:\\models\\tetrahedron.obj"),
        ("", "meshes\\tetrahedron.obj"),
    ],
)
def test_the_folder_of_meshes_is_found_as_mujoco_does(
    tmp_path: Path, compiler: str, address: str
) -> None:
    text = ARM.replace('meshdir="meshes"', compiler).replace("tetrahedron.obj", address)
    file = written(tmp_path, text)
    model = checked_model(file, root_of(file.read_bytes()), {})
    assert list(model.meshes.values()) == [TETRAHEDRON]
    assert 'name="tetrahedron"' in model.text and address not in model.text


def test_every_element_stays_in_its_line(tmp_path: Path) -> None:
    file = written(tmp_path, ARM)
    text = checked_model(file, root_of(file.read_bytes()), {}).text
    for number, line in enumerate(text.split("\n")):
        for name in re.findall(r'<(?:body|joint|geom|site|key)[^>]* name="(\w+)"', line):
            assert f'name="{name}"' in ARM.split("\n")[number]


def test_unknown_elements_and_attributes_are_refused_by_their_line(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    line = ARM[: ARM.index(GEOM)].count("\n") + 1
    said = refusal(tmp_path, ARM.replace(GEOM, GEOM.replace("geom", "goem")))
    assert said.startswith(f"arm.xml, line {line}, goem: there is no such element in <body>")
    said = refusal(tmp_path, ARM.replace(GEOM, GEOM.replace("density", "denisty")))
    assert "arm.xml" in said and "denisty" in said and f"line {line}" in said


def test_an_actuator_of_a_tendon_is_no_motor_of_the_joint_with_its_number(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    file = written(tmp_path, ARM)
    read = read_mjcf(file, root_of(file.read_bytes()), Options(tip="tool"))
    assert [joint.effort for joint in read.chain.joints] == [87.0, 87.0, 12.0, 12.0]
    assert read.home["joint3"] == pytest.approx(1.2)
    (told,) = read.remarks
    assert told.code == "robot_file.left_out"


def schema() -> dict[str, set[str]]:
    """The elements that the installed MuJoCo knows, by the element in which they are."""
    api: Any = pytest.importorskip("mujoco")
    found, path = dict[str, set[str]](), list[str]()
    for line in api.mj_printSchema(False, False).splitlines():
        if match := re.match(r"( *)([()\w]+) \([!?*R]\)", line):
            depth, tag = len(match[1]) // 3, match[2].replace("(world)body", "body")
            path = [*path[:depth], tag]
            if depth:
                found.setdefault(path[-2], set()).add(tag)
    return found


def test_every_element_that_mujoco_knows_is_passed_on_left_out_or_refused() -> None:
    """So that a new version's elements are refused until somebody has looked at them."""
    known = schema()
    known["mujoco"] = (known["mujoco"] - {"body"}) | {"worldbody"}
    known["frame"] = known["worldbody"] = known["body"]
    for parent, children in PASSED.items():
        said = {*children, *LEFT_OUT.get(parent, ()), *REFUSED}
        strange = known[parent] - said
        assert strange == set(), f"{parent}: {strange}"
        assert not {*children} & ({*LEFT_OUT.get(parent, ())} | {*REFUSED})


BEHAVIOURS: dict[str, tuple[str, str]] = {
    "crashes": ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "crashed"),
    "ends": ("import os; os._exit(0)", "crashed"),
    "hangs": ("while True: pass", "took more than 1 s"),
    "takes all memory": ("import numpy; numpy.ones(1 << 33)", "crashed|allocate"),
    "talks": (
        "print('x' * 100_000); raise ValueError('no\\nlines')",
        "cannot read arm.xml: no lines",
    ),
}


@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_whatever_mujoco_does_is_one_clear_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, behaviour: str
) -> None:
    """A library in its place that does it when a model is read."""
    code, words = BEHAVIOURS[behaviour]
    (tmp_path / "mujoco.py").write_text(
        "class MjSpec:\n"
        "    @staticmethod\n"
        "    def from_string(*_, **__):\n"
        f"        {code}\n"
        "def set_mju_user_warning(_): pass\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(CodedError) as caught:
        read_model("<mujoco/>", {}, "arm.xml", seconds=1)
    said = str(caught.value)
    assert re.search(words, said) and "arm.xml" in said and "\n" not in said


@pytest.mark.thorough
def test_a_model_that_hangs_mujoco_is_ended(tmp_path: Path) -> None:
    """One that the checks would refuse."""
    pytest.importorskip("mujoco")
    inner = '<replicate count="1000" offset="1 0 0"><geom size="1"/></replicate>'
    text = f'<mujoco><worldbody><replicate count="100000">{inner}</replicate></worldbody></mujoco>'
    with pytest.raises(CodedError, match=r"arm\.xml"):
        read_model(text, {}, "arm.xml", seconds=5)


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=6
)
@given(mangled(mjcf_seeds()))
def test_a_mangled_file_is_a_robot_or_refused_in_a_line(tmp_path: Path, data: bytes) -> None:
    pytest.importorskip("mujoco")
    written(tmp_path, ARM)
    robot_or_line(tmp_path / "arm.xml", data, Options(tip="tool", armature=0.01))


@pytest.mark.thorough
@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60
)
@given(mangled(mjcf_seeds()), st.sampled_from(["tool", "", "link2"]))
def test_many_mangled_files_are_robots_or_refused_in_a_line(
    tmp_path: Path, data: bytes, tip: str
) -> None:
    pytest.importorskip("mujoco")
    written(tmp_path, ARM)
    robot_or_line(tmp_path / "arm.xml", data, Options(tip=tip, armature=0.01))


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=5000, max_examples=40
)
@given(mangled(mjcf_seeds()))
def test_the_check_takes_any_file(tmp_path: Path, data: bytes) -> None:
    """It writes out a model, or refuses the file by its line."""
    file = written(tmp_path, ARM)
    try:
        model = checked_model(file, root_of(data), {})
    except FileFault:
        return
    again = root_of(model.text.encode())
    assert not {"include", "replicate", "model"} & {each.tag for each in again.children}
    assert all("/" not in name and ".." not in name for name in model.meshes)
