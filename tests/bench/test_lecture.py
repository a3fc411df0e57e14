"""A minute of a class of twenty: no vote is lost or doubled, and nothing ends.

tests/app/server/test_killed_process.py is about processes that are killed.
"""

from __future__ import annotations

import pytest

from tests.bench.lecture import minute_of


@pytest.mark.thorough
def test_no_vote_of_twenty_is_lost_or_doubled(capsys: pytest.CaptureFixture[str]) -> None:
    minute_of(20)  # raises ValueError
    assert len(capsys.readouterr().out.splitlines()) >= 4  # the times of four rows
