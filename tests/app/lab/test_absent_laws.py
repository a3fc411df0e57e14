"""A kept lab whose law is not here any more opens without it, and says so; a code is refused."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import to_data
from onpath.app.storage.lab_state import put_back
from onpath.lessons.progress import Progress
from onpath.models.control.sides import DEFAULT_LAWS, LEFT
from tests.support.lab import assert_sound, loop_cache

KEPT = Setup(robots={"five_bar": RobotSetup({"reach": 4.0, "K1": 500.0})}, laws={LEFT: "sliding"})


def kept(**changes: Any) -> Any:
    setup = to_data(msgspec.structs.replace(KEPT, **changes))
    return {"setup": setup, "lessons": msgspec.to_builtins(Progress()), "before": setup}


def test_a_kept_lab_opens_without_them_and_says_so() -> None:
    lab = Lab(loop_cache())
    put_back(lab, kept())
    assert lab.simulation.parameters.K1 == 500.0 and not lab.simulation.parameters.own_gains
    assert lab.simulation.laws == DEFAULT_LAWS
    assert "sliding, reach" in lab.message and lab.message_level == "warning"
    assert_sound(lab)


def test_nothing_is_said_if_nothing_is_lacking() -> None:
    lab = Lab(loop_cache())
    robots = {"five_bar": RobotSetup({"clock_gain": 20.0})}
    put_back(lab, kept(robots=robots, laws={LEFT: "waiting_clock"}))
    assert lab.message == "" and lab.simulation.parameters.own_gains == (("clock_gain", 20.0),)
    assert lab.simulation.laws[LEFT] == "waiting_clock"


@pytest.mark.parametrize("setup", [Setup(robots=KEPT.robots), Setup(laws=KEPT.laws)])
def test_a_share_code_says_what_does_not_fit(setup: Setup) -> None:
    with pytest.raises(ValueError, match=r"does not fit .*(unknown parameter 'reach'|unknown law)"):
        decode(encode(setup))
