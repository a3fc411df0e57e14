"""`onpath lessons names` lists every name that a lesson may use."""

from __future__ import annotations

import pytest

from onpath.app.cli.main import run_command
from onpath.lessons.record import PLOTS, QUANTITIES
from onpath.lessons.symbols import SYMBOLS
from onpath.lessons.vocabulary.lists import names_markdown
from onpath.lessons.vocabulary.names import CONTROLS, DRAWINGS, EVENTS
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS


def test_nothing_is_left_out() -> None:
    known = [
        *ROBOTS,
        *presets(),
        *LAWS,
        *PLOTS,
        *DRAWINGS,
        *CONTROLS,
        *QUANTITIES,
        *EVENTS,
        *SYMBOLS,
    ]
    known += [name for entry in ROBOTS.values() for name in specs(entry.parameters)]
    listed = names_markdown()
    assert [name for name in known if f"`{name}`" not in listed] == []


def test_the_command_prints_them(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["lessons", "names"]) == 0
    assert capsys.readouterr().out == names_markdown()
