"""The command line: its output and files, and one clear line for every error."""

from __future__ import annotations

import errno
import json
import os
import re
import subprocess
import sys
import tomllib
import warnings
from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.app.common import atomic_file
from onpath.app.notebook.path_files import path_from
from onpath.app.notebook.simulate import simulate
from onpath.app.storage.database_url import DATABASE
from onpath.app.storage.records import Records, file_url
from onpath.models.control.laws.registry import NAMES
from onpath.models.control.settable import specs
from onpath.models.path_files.placing import RADIUS
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from tests.support.checkout import ROOT
from tests.support.csv_columns import read_csv
from tests.support.robot_files import PLANAR, urdf
from tests.support.suitable_laws import laws_for

SHORT = ["experiment", "obstruction", "--set", "duration=0.2"]


def onpath(*arguments: str) -> subprocess.CompletedProcess[str]:
    """A real process."""
    command = [sys.executable, "-c", "from onpath.app.cli.main import main; main()", *arguments]
    root = str(ROOT)
    environment = {**os.environ, "PYTHONPATH": root}
    return subprocess.run(
        command, capture_output=True, text=True, env=environment, timeout=60, check=False
    )


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert run_command(["--version"]) == 0
    assert capsys.readouterr().out == f"onpath {stated}\n"


def test_summary_is_json_with_both_laws(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command([*SHORT, "--json"]) == 0
    out = capsys.readouterr()
    result = json.loads(out.out)
    assert result["experiment"] == "obstruction" and set(result["laws"]) == set(NAMES)
    assert out.err == ""


@pytest.mark.parametrize("name", NAMES)
def test_one_law_alone_gives_the_same_numbers_as_beside_another(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    summaries = []
    for choice in (name, "both"):
        assert run_command([*SHORT, "--json", "--law", choice]) == 0
        summaries.append(json.loads(capsys.readouterr().out)["laws"])
    assert list(summaries[0]) == [name] and summaries[0][name] == summaries[1][name]


def test_laws_are_chosen_by_name_in_the_order_given(capsys: pytest.CaptureFixture[str]) -> None:
    chosen = {"all": laws_for(), ",".join(reversed(NAMES)): list(reversed(NAMES))}
    for text, names in chosen.items():
        assert run_command([*SHORT, "--json", "--law", text]) == 0
        result = json.loads(capsys.readouterr().out)
        assert list(result["laws"]) == names


def test_a_path_may_be_read_from_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "path.json"
    file.write_text('{"points": [[0.06, 0], [0, 0.05], [-0.05, 0], [0, -0.04]]}')
    outputs = []
    for text in (f"@{file}", file.read_text(), "closed 0.06 0, 0 0.05, -0.05 0, 0 -0.04"):
        assert run_command([*SHORT, "--json", "--path", text]) == 0
        outputs.append(capsys.readouterr().out)
    assert outputs[0] == outputs[1] == outputs[2]
    assert json.loads(outputs[0])["laws"]["path_following"]["max_distance_m"] < 1e-4


FILES = {
    "my points.csv": ("x_mm;y_mm\n50;0\n0;40\n-50,0;0\n0;-40\n", "smooth", RADIUS),
    "slot.nc": ("G0 X-40 Y-20\nG1 X30\nG3 Y20 J20\nG1 X-40\nY-20\n", "round", 0.014),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", FILES)
def test_a_path_of_another_program_is_the_same_in_every_command(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / name
    content, corners, radius = FILES[name]
    file.write_text(content, "utf-8")
    text = f"@{file} fit=0.09 centre=0,0.01 corners={corners} radius={radius}"
    page = str(tmp_path / "a.html")
    assert run_command([*SHORT, "--json", "--path", text]) == 0
    experiment = json.loads(capsys.readouterr().out)["laws"]["path_following"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        curve = path_from(file, fit=0.09, centre=(0, 0.01), corners=corners, radius=radius)
    run = simulate(path=curve, duration=0.2)
    assert experiment["max_distance_m"] == pytest.approx(run.distance.max(), rel=1e-6)
    brief = ["--law", "path_following", "--obstruction", "wall", "--json"]
    assert run_command(["compare", "--path", text, *brief]) == 0
    assert json.loads(capsys.readouterr().out)["laws"]["path_following"]
    assert run_command(["figure", page, "--path", text, "--law", "set_point"]) == 0
    assert Path(name).stem in Path(page).read_text("utf-8")


def test_what_cannot_be_followed_is_told_and_the_nearest_path_is_taken_if_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "large.nc"
    file.write_text("G0 X-200 Y-200\nG1 X200\nY200\nX-200\nY-200\n", "utf-8")
    assert run_command([*SHORT, "--path", f"@{file}"]) == 2
    told = capsys.readouterr().err
    assert "leaves the workspace" in told and "add the word nearest" in told
    assert run_command([*SHORT, "--json", "--path", f"@{file} nearest"]) == 0
    said = capsys.readouterr()
    assert "follow the nearest path" in said.err and json.loads(said.out)["laws"]
    file.write_text("G0 X0 Y0\nG1 X30\nG41\n", "utf-8")
    assert run_command([*SHORT, "--path", f"@{file}"]) == 2
    assert f"@{file}: line 3, column 1: G41 moves the path aside" in capsys.readouterr().err


@pytest.mark.thorough
def test_a_figure_of_a_robot_from_a_file_is_exported(tmp_path: Path) -> None:
    file, page = tmp_path / "own.urdf", tmp_path / "own.html"
    file.write_text(urdf("own", PLANAR), "utf-8")
    pose = [f"--pose=joint{i}={x}" for i, x in enumerate((2.0, -1.3, -0.9), 1)]
    assert run_command(["figure", str(page), "--robot", str(file), *pose]) == 0
    assert page.stat().st_size > 1e5


def test_cut_corners_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command([*SHORT, "--json", "--path", "closed 0.05 0 0 0.05 -0.05 0 0 -0.05"]) == 0
    said = capsys.readouterr()
    assert "13.3 mm away from the lines" in said.err and said.err.count("\n") == 1
    assert json.loads(said.out)["laws"]


def test_the_same_is_printed_once(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command([*SHORT, "--json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == {"experiment", "laws"}


def test_table_for_a_reader_names_both_and_says_why_one_stopped(
    capsys: pytest.CaptureFixture[str],
) -> None:
    unstable = ["--set", "K1=2500", "--set", "K2=0", "--set", "control_rate=50"]
    assert run_command(["experiment", "obstruction", *unstable]) == 0
    text = capsys.readouterr().out
    for words in (
        "trajectory tracking",
        "path following",
        "stopped at",
        "the linkage has collapsed",
    ):
        assert words in text
    assert re.search(r"max distance +stopped\n", text) and "None" not in text and "inf" not in text
    assert run_command(["experiment", "obstruction", *unstable, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["laws"]
    assert all(values["stopped_at_s"] > 0 for values in found.values())
    assert {values["max_distance_m"] for values in found.values()} == {None}


@pytest.mark.thorough
def test_all_files_are_the_same_to_the_byte(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written: list[list[bytes]] = []
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        files = [tmp_path / folder / f"out.{kind}" for kind in ("csv", "png", "svg", "pdf")]
        table, *plots = map(str, files)
        for options in (["--csv", table, "--plot", plots[0]], *(["--plot", f] for f in plots[1:])):
            assert run_command([*SHORT, "--json", *options]) == 0
        written.append([file.read_bytes() for file in files])
        written[-1].append(capsys.readouterr().out.encode())
        assert sorted((tmp_path / folder).iterdir()) == sorted(files)  # no scratch files
    assert written[0] == written[1]
    magic = (b"t_s,law,", b"\x89PNG", b"<?xml", b"%PDF")
    assert all(data.startswith(start) for data, start in zip(written[0], magic, strict=False))
    assert min(len(data) for data in written[0]) > 200


def test_csv_follows_what_was_set(tmp_path: Path) -> None:
    file = tmp_path / "out.csv"
    assert run_command([*SHORT, "--set", "r=0.03", "--csv", str(file)]) == 0
    with file.open() as text:
        columns = read_csv(text)
    assert set(columns) == set(NAMES)
    for values in columns.values():
        assert len(values["t_s"]) == 200
        assert (values["y1_m"][0], values["y2_m"][0]) == pytest.approx((0.03, 0.0))
    assert file.stat().st_mode & 0o777 == 0o644


def test_a_value_given_twice_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    for values in (["--set", "K1=1", "--set", "K1=200"], ["--set", "K1=1,K1=200"]):
        assert run_command(["experiment", "position", *values]) == 2
        assert "K1: it is given twice" in capsys.readouterr().err


def test_every_parameter_can_be_set(capsys: pytest.CaptureFixture[str]) -> None:
    settings = []
    for name, spec in specs(FiveBarParameters).items():
        value = spec.options[-1] if spec.options else spec.low + 0.4 * (spec.high - spec.low)
        settings += ["--set", f"{name}={value}"]
    assert run_command(["experiment", "obstruction", *settings, "--set", "duration=0.02"]) == 0


BAD = [
    ["bogus"],
    [""],
    ["-x"],
    ["--port", "abc"],
    ["--privacy-url", "javascript:alert(1)"],
    ["--course-url", "javascript:alert(1)"],
    ["--privacy-url", "https://"],
    ["--origin", "lab.example.org"],
    ["--origin", "https://lab.example.org/onpath"],
    ["--origin", "https://lab.example.org:port"],
    ["--origin", "null"],
    ["--privacy-url", "school.example/privacy"],
    ["--privacy-url", "https://school.example/a b"],
    ["serve", "--log-level", "loud"],
    ["forget", "--slow"],
    ["experiment"],
    ["experiment", ""],
    ["experiment", "obstructoin"],
    ["experiment", "obstruction", "position"],
    ["experiment", "obstruction", "--bogus"],
    ["experiment", "obstruction", "--law", "pid"],
    ["experiment", "obstruction", "--law", "path_following,pid"],
    ["experiment", "obstruction", "--law", ""],
    ["experiment", "obstruction", "--path", ""],
    ["experiment", "obstruction", "--path", "elipse"],
    ["experiment", "obstruction", "--path", "circle 0.05 nan 0"],
    ["experiment", "obstruction", "--path", "circle 0.3"],
    ["experiment", "obstruction", "--path", "[" * 40_000],
    ["experiment", "obstruction", "--path", "@missing.json"],
    ["experiment", "obstruction", "--path", "@file"],
    ["experiment", "obstruction", "--path", "circle", "--set", "r=0.04"],
    ["experiment", "obstruction", "--profile", "fast"],
    ["experiment", "obstruction", "--profile", "1:2, 0:1"],
    ["experiment", "obstruction", "--profile", "0:0, 1:99"],
    ["experiment", "obstruction", "--profile", "0:0, 1:6", "--set", "reverse_at=2"],
    ["experiment", "obstruction", "--set", "hold_direction=sideways"],
    ["experiment", "obstruction", "--set", "hold_at=7"],
    ["experiment", "obstruction", "--set", "start_z1=0.39", "--set", "start_z2=0.39"],
    ["experiment", "obstruction", "--set", "start_along=nan"],
    ["experiment", "obstruction", "--json", "yes"],
    ["experiment", "obstruction", "--csv"],
    ["experiment", "obstruction", "--set"],
    ["experiment", "obstruction", "--set", ""],
    ["experiment", "obstruction", "--set", "K1"],
    ["experiment", "obstruction", "--set", "K1="],
    ["experiment", "obstruction", "--set", "=1"],
    ["experiment", "obstruction", "--set", "K1=1=2"],
    ["experiment", "obstruction", "--set", "K1=nan"],
    ["experiment", "obstruction", "--set", "K1=-1"],
    ["experiment", "obstruction", "--set", "K1=1e400"],
    ["experiment", "obstruction", "--set", "K1=1\n2"],
    ["experiment", "obstruction", "--set", "duration=0"],
    ["experiment", "obstruction", "--set", "duration=1e9"],
    ["experiment", "obstruction", "--set", "duration=nan"],
    ["experiment", "obstruction", "--set", "r=0"],
    ["experiment", "obstruction", "--set", "r=inf"],
    ["experiment", "obstruction", "--set", "hold_from=5", "--set", "hold_to=4"],
    ["experiment", "obstruction", "--set", "control_rate=999"],
    ["experiment", "obstruction", "--set", "task=dance"],
    ["experiment", "obstruction", "--plot", "x.txt"],
    ["experiment", "obstruction", "--plot", "x"],
    ["experiment", "obstruction", "--plot", "missing/x.png"],
    ["experiment", "obstruction", "--csv", "missing/x.csv"],
    ["experiment", "obstruction", "--csv", "."],
    ["experiment", "obstruction", "--csv", ""],
    ["experiment", "obstruction", "--csv", "file/x.csv"],
    ["--port", "99999"],
    ["--port", "-1"],
    ["--socket", "missing/x"],
    ["--socket", "x" * 200],
    ["--host", "256.0.0.1"],
    ["zero-dynamics", "--set", "K1=3"],
    ["zero-dynamics", "--set", "alpha=0.5"],
    ["zero-dynamics", "--set", "bogus=3"],
]


@pytest.mark.parametrize("arguments", BAD, ids=repr)
def test_bad_input_gives_one_line_and_code_two(
    arguments: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("not a folder")
    assert run_command(arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("onpath: ") and len(said.err) > 20
    assert said.err.count("\n") == 1 and said.err.endswith("\n")
    assert "Traceback" not in said.err and "---" not in said.err and "\u2500" not in said.err
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["experiment", "obstructoin"], "obstruction"),
        (["experiment", "obstruction", "--set", "k1=1"], "did you mean K1"),
        (["experiment", "obstruction", "--set", "holdfrom=1"], "hold_from"),
        (["experiment", "flexible", "--set", "law=redefined"], "did you mean output?"),
        (["experiment", "obstruction", "--controller", "both"], "--controller is called --law now"),
        (["experiment", "obstruction", "--law", "pid"], "unknown law 'pid'"),
        (["experiment", "obstruction", "--law", "path_folowing"], "did you mean path_following"),
        (["experiment", "obstruction", "--path", "elipse"], "did you mean ellipse"),
        (["experiment", "obstruction", "--path", "circle 1 2"], "circle RADIUS [Z1 Z2]"),
        (["experiment", "obstruction", "--path", "@no.json"], "no.json: there is no such file"),
        (["experiment", "obstruction", "--path", "circle 0.3"], "leaves the workspace"),
        (["experiment", "obstruction", "--profile", "0:0, 1:99"], "between -20 and 20 rad/s"),
        (["experiment", "obstruction", "--set", "hold_direction=up"], "along, across, both"),
        (["experimnt"], "experiment"),
        (["experiment", "obstruction", "--set", "task=dance"], "speed, position"),
        (["experiment", "obstruction", "--set", "K1=9999"], "0 and 2500 1/s²"),
        (["experiment", "obstruction", "--set", "K1=900,5"], "K1: write 900.5 instead of 900,5"),
        (["experiment", "obstruction", "--set", "hold_from=0,5"], "write 0.5 instead of 0,5"),
        (["experiment", "obstruction", "--path", "circle 0,05"], "write 0.05 instead of 0,05"),
        (["experiment", "obstruction", "--law", "across=xi^2;along=0"], "write ** instead of '^'"),
        (["experiment", "obstruction", "--plot", "x.txt"], ".png, .svg or .pdf"),
        (["--port", "99999"], "port 99999: expected 0 to 65535"),
        (["--socket", "missing/x"], "missing/x"),
        (["zero-dynamics", "--set", "K1=3"], "plant, rho, frequency, zeta"),
    ],
)
def test_complaint_names_what_was_expected(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(arguments) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        [*SHORT, "--csv", "{}.csv"],
        [*SHORT, "--plot", "{}.png"],
        ["paper", "rank", "--plot", "{}.svg"],
        ["figure", "{}.html", "--path", "circle"],
    ],
)
def test_a_file_that_cannot_be_written_is_named_as_it_was_typed(
    arguments: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(dir: Path, suffix: str) -> tuple[int, str]:
        raise OSError(errno.EROFS, "Read-only file system", f"{dir}/tmpq3x{suffix}")

    monkeypatch.setattr(atomic_file.tempfile, "mkstemp", refuse)
    name = str(tmp_path / "out")
    assert run_command([each.format(name) for each in arguments]) == 2
    told = capsys.readouterr().err
    assert name in told and "tmpq3x" not in told and "Read-only" in told


@pytest.mark.thorough
@pytest.mark.parametrize("arguments", [["lessons", "names"], ["paper", "2"]])
@pytest.mark.parametrize("encoding", ["cp1252", "ascii", ""])
def test_output_is_printed_whatever_the_encoding_of_the_machine(
    arguments: list[str], encoding: str
) -> None:
    chosen = {"PYTHONIOENCODING": encoding} if encoding else {}
    others = {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "LC_ALL": "en_US.ISO-8859-1"}
    done = subprocess.run(
        [sys.executable, "-m", "onpath", *arguments],
        env=os.environ | others | chosen,
        cwd=ROOT,
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    text = done.stdout.decode(encoding or "utf-8")
    assert len(text) > 200 and (encoding or not text.isascii())


def test_an_existing_file_is_kept_when_a_run_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "out.csv"
    file.write_text("precious")
    assert run_command([*SHORT, "--set", "K1=nan", "--csv", str(file)]) == 2

    def fail(*_: object, **__: object) -> None:
        file.parent.joinpath("seen").write_text("the failure came while writing")
        raise OSError("no space left on device")

    monkeypatch.setattr("onpath.models.closed_loop.trajectory.write_csv", fail)
    assert run_command([*SHORT, "--csv", str(file)]) == 2
    assert capsys.readouterr().err.endswith("no space left on device\n")
    assert file.read_text() == "precious"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.csv", "seen"]


def test_an_unwritable_file_is_refused_before_simulating(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "onpath.models.studies.experiments.run", lambda *_: pytest.fail("simulated in vain")
    )
    for option, name in (("--csv", "x.csv"), ("--plot", "x.png")):
        assert run_command([*SHORT, option, str(tmp_path / "missing" / name)]) == 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_folder_without_write_permission_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    assert run_command([*SHORT, "--csv", str(tmp_path / "x.csv")]) == 2


def test_real_process_succeeds_and_fails_as_promised(tmp_path: Path) -> None:
    good = onpath(*SHORT, "--json", "--csv", str(tmp_path / "x.csv"))
    assert good.returncode == 0 and good.stderr == ""
    assert json.loads(good.stdout)["experiment"] == "obstruction"
    assert (tmp_path / "x.csv").read_text().count("\n") == 1 + 2 * 200
    bad = onpath("experiment", "obstruction", "--set", "K9=1")
    assert bad.returncode == 2 and bad.stdout == "" and bad.stderr.count("\n") == 1
    assert "did you mean K" in bad.stderr and "Traceback" not in bad.stderr


def test_help_is_given_on_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, words in ((["--help"], "experiment"), (["experiment", "--help"], "--set")):
        assert run_command(arguments) == 0 and words in capsys.readouterr().out


def test_the_database_may_be_given_in_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    records = Records(file_url(tmp_path / "labs.db"))
    records.save("a", {})
    records.close()
    monkeypatch.setenv(DATABASE, f"sqlite:///{tmp_path / 'labs.db'}")
    assert run_command(["forget"]) == 0 and "deleted: 1 labs" in capsys.readouterr().out


@pytest.mark.parametrize(
    "url", ["postgresql+psycopg://me:secret@host/labs", "postgresql+psycopg:///?password=secret"]
)
@pytest.mark.parametrize("command", ["serve", "forget"])
def test_a_password_on_the_command_line_is_refused(
    command: str, url: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command([command, "--database", url]) == 2
    said = capsys.readouterr()
    assert DATABASE in said.err and "secret" not in said.err + said.out


def test_help_says_how_long_labs_are_kept() -> None:
    text = " ".join(onpath("serve", "--help").stdout.split())
    assert "--keep-days" in text and "(default: 365)" in text
    assert "--most-labs" in text and DATABASE in text


def test_a_controller_is_written_with_its_header_and_replay(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "my law.c"
    command = ["export", "controller", str(file), "--path", "circle,ellipse", "--fastest", "20"]
    assert run_command([*command, "--set", "torque_limit=2", "--at-fault", "damp"]) == 0
    said = capsys.readouterr()
    assert "operations in a tick" in said.out and f"'{file}'" in said.out and said.err == ""
    names = {each.name for each in tmp_path.iterdir()}
    assert names == {"my law.c", "my law.h", "my law_replay.c"}
    assert "MY_LAW_PATHS 2 /* circle, ellipse */" in (tmp_path / "my law.h").read_text("utf-8")
    assert run_command(["export", "controller", str(tmp_path / "law.txt")]) == 2
    assert "expected a name ending in .c" in capsys.readouterr().err
    assert {each.name for each in tmp_path.iterdir()} == names
