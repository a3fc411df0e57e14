"""The checkbox "Copy to both" shows what the lab does, also after a set-up has changed it."""

from __future__ import annotations

from typing import Any

from onpath.app.lab import commands as c
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.copy_box import CopyBox
from onpath.lessons.words import ENGLISH
from tests.support.gui import Gui
from tests.support.lab import new_lab


def test_a_set_up_ticks_and_clears_the_box() -> None:
    lab, gui = new_lab(), Gui()
    fake: Any = gui
    panel = CopyBox(fake, ENGLISH, lab.post, take_page_snapshot(lab, 1.0))
    (box,) = gui.named[ENGLISH("controls.copy")]

    def follow() -> None:
        lab.drain()
        for _ in range(2):
            panel.follow(take_page_snapshot(lab, 1.0))

    assert box.value and lab.simulation.settings.copy
    box.set(False)
    follow()
    assert not box.value and not lab.simulation.settings.copy
    for copy in (True, False):
        lab.post(c.TakeSetup(Setup(settings={"copy": copy})))
        follow()
        assert box.value == lab.simulation.settings.copy == copy
