"""The page for authors lists every name that a lesson may use."""

from __future__ import annotations

from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.app.page.overlays import Switches
from onpath.app.page.panels.show_panel import SWITCHES
from onpath.lessons.record import PLOTS, QUANTITIES
from onpath.lessons.vocabulary.lists import BEGIN, END, names_markdown, with_names
from onpath.lessons.vocabulary.names import CONTROLS, DRAWINGS, EVENTS
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import specs
from tests.support.checkout import ROOT

README = ROOT / "lessons" / "README.md"


def test_the_readme_s_lists_are_those_of_today() -> None:
    """`onpath lessons names --into lessons/README.md` makes them."""
    text = README.read_text("utf-8")
    assert with_names(text) == text


def test_nothing_is_left_out() -> None:
    known = [*ROBOTS, *presets(), *LAWS, *PLOTS, *DRAWINGS, *CONTROLS, *QUANTITIES, *EVENTS]
    known += [name for entry in ROBOTS.values() for name in specs(entry.parameters)]
    listed = names_markdown()
    assert [name for name in known if f"`{name}`" not in listed] == []


def test_drawings_are_the_switches_of_the_page() -> None:
    assert set(DRAWINGS) == set(SWITCHES) == set(Switches.__dataclass_fields__)


def test_the_command_prints_and_writes_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["lessons", "names"]) == 0
    assert capsys.readouterr().out == names_markdown()
    file = tmp_path / "page.md"
    file.write_text(f"before\n{BEGIN}former\n{END}after\n", "utf-8")
    assert run_command(["lessons", "names", "--into", str(file)]) == 0
    text = file.read_text("utf-8")
    assert names_markdown() in text and "former" not in text
    assert text.startswith("before\n") and text.endswith("after\n")
    file.write_text("nothing", "utf-8")
    assert run_command(["lessons", "names", "--into", str(file)]) == 2
    assert "names: begin" in capsys.readouterr().err
