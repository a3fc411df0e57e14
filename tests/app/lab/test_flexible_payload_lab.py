"""A payload of the flexible robot in the lab: another robot, which starts anew."""

from __future__ import annotations

import numpy as np

from onpath.app.lab import commands as c
from tests.support.lab import FOLLOWER, assert_sound, do, new_lab, replayed, run


def test_a_payload_is_put_on_and_taken_off() -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"))
    run(lab, 0.3)
    unloaded, runs = lab.session.robot, lab.session.run_number
    do(lab, c.SetParameter("payload", 0.02))
    assert lab.session.robot is not unloaded and lab.session.run_number == runs + 1
    do(lab, c.SetParameter("payload", 0.05))
    assert lab.session.run_number == runs + 1  # another mass is another number only
    run(lab, 1.0)
    assert_sound(lab)
    heights = replayed(lab.session)[FOLLOWER].fields["y"][:, 2]
    sagged = np.abs(heights).max()
    do(lab, c.SetParameter("payload", 0.0))
    assert lab.session.robot is unloaded
    run(lab, 1.0)
    assert np.abs(replayed(lab.session)[FOLLOWER].fields["y"][:, 2]).max() < sagged
