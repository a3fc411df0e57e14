"""Modules that are slow to import are not needed for the first picture."""

from __future__ import annotations

import subprocess
import sys

FIRST_PICTURE = """
import sys
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server import lab_server
from onpath.app.scene.stage_catalogue import stage_of

lab = Lab(LoopCache())
take_page_snapshot(lab, 1.0)
stage_of(lab.session.robot).parts()
print(*sorted({"scipy", "trimesh", "matplotlib"} & sys.modules.keys()))
"""


def test_the_first_picture_needs_no_slow_module() -> None:
    run = subprocess.run([sys.executable, "-c", FIRST_PICTURE], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert run.stdout.split() == []
