"""The robot of the README: one new file in the folder of the robots, and nothing else."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from onpath.models import systems
from onpath.models.systems import catalogue
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import RobotEntry
from tests.support.checkout import ROOT

README = (ROOT / "models/systems/README.md").read_text("utf-8")
(GANTRY,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


@contextmanager
def new_robot(folder: Path, patch: pytest.MonkeyPatch, text: str = GANTRY) -> Iterator[RobotEntry]:
    """The robot of a file `gantry.py` in a folder, in the catalogue."""
    (folder / "gantry.py").write_text(text, "utf-8")
    patch.setattr(systems, "__path__", [*systems.__path__, str(folder)])
    try:
        for name, entry in catalogue.found_robots().items():
            patch.setitem(ROBOTS, name, entry)
        yield ROBOTS["gantry"]
    finally:
        sys.modules.pop("onpath.models.systems.gantry", None)
