"""A derivation line by line: an own wrong value is carried on, and known mistakes are named."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest

from onpath.lessons.derivation.judged import judged
from onpath.lessons.schema import Derivation

CHAINS: dict[str, Any] = json.loads(Path(__file__).with_name("chains.json").read_text("utf-8"))
"""A derivation, and rows with the verdict on each line's answers, and which lines are closed.
tests/assets/web/lessons/typed.test.ts judges the same ones."""


@pytest.mark.parametrize(("rows", "wanted"), CHAINS["cases"])
def test_rows_are_judged_in_their_order(rows: list[str], wanted: list[str]) -> None:
    block = msgspec.convert(CHAINS["derivation"], Derivation)
    found = [
        " ".join(
            [
                *(f"{t.verdict}{'' if t.known is None else t.known}" for t in state.tries),
                *(["closed"] if state.closed else []),
            ]
        )
        for state in judged(block, "\n".join(rows))
    ]
    assert found == wanted
