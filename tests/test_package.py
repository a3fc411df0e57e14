"""The package as a checkout has it, and on systems other than Linux."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.checkout import FOLDERS, ROOT
from tests.support.lab_process import WAIT, LabProcess, free_ports
from tests.support.waiting import wait_for

ELSEWHERE = ("-m", "tests.support.elsewhere")
FILES = """
import importlib, json, sys
from tests.support.checkout import modules
for name in modules():
    importlib.import_module(name)
files = {name: getattr(module, "__file__", None) for name, module in list(sys.modules.items())}
print(json.dumps({name: file for name, file in files.items() if file}))
"""


def test_the_checkout_has_no_links() -> None:
    """Git for Windows writes a link as a text file, and tools count what it leads to twice."""
    folders = [ROOT / name for name in (*FOLDERS, "onpath", "tests")]
    found = [path for folder in folders for path in (folder, *folder.rglob("*"))]
    assert len(found) > 1000
    links = [path for path in found if path.is_symlink()]
    assert [path for path in links if "node_modules" not in path.parts] == []


@pytest.mark.thorough
def test_each_file_is_one_module_under_its_real_path() -> None:
    """Else each class would exist twice; and tracebacks name the files that git knows."""
    command = [sys.executable, "-c", FILES]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    files = {name: Path(file) for name, file in json.loads(told).items()}
    ours = {name: file for name, file in files.items() if file.is_relative_to(ROOT)}
    ours = {name: file for name, file in ours.items() if ".venv" not in file.parts}
    ours = {name: file for name, file in ours.items() if not name.startswith("tests")}
    assert len(ours) > 300 and len(set(ours.values())) == len(ours)
    for name, file in ours.items():
        module = file.relative_to(ROOT).with_suffix("").parts
        place = module[1:] if module[0] == "onpath" else module
        assert name == ".".join(("onpath", *place)).removesuffix(".__init__")
        assert file.resolve() == file


@pytest.mark.thorough
def test_it_is_imported_and_serves_where_linuxs_parts_are_missing(tmp_path: Path) -> None:
    database = f"sqlite:///{tmp_path / 'labs.db'}"
    (port,) = free_ports(1)
    program, log = (*ELSEWHERE, "serve"), tmp_path / "log"
    lab = LabProcess(port, ["--database", database], program=program, log=log)
    try:
        lab.wait_until_well()
        wait_for(lambda: "OnPath is ready" in lab.said, WAIT)
    finally:
        lab.process.terminate()
        assert lab.process.wait(60) == 0


@pytest.mark.thorough
def test_a_socket_that_a_system_does_not_have_is_refused_in_one_line(tmp_path: Path) -> None:
    command = [sys.executable, *ELSEWHERE, "serve", "--socket", str(tmp_path / "lab.sock")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "this system has no Unix sockets" in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr


def test_what_is_missing_would_be_noticed() -> None:
    code = "import tests.support.elsewhere as e; e.leave_linux('win32')\n"
    for line in ("import resource", "import os; os.fork", "import signal; signal.SIGPROF"):
        ours = f"{code}exec({line!r}, {{'__name__': 'onpath.app.x'}})"
        theirs = f"{code}exec({line!r}, {{'__name__': 'asyncio.x'}})"
        assert subprocess.run([sys.executable, "-c", ours], cwd=ROOT, stderr=-3).returncode == 1
        assert subprocess.run([sys.executable, "-c", theirs], cwd=ROOT).returncode == 0
