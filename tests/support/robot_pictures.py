"""Takes the robots' pictures for the menu: python -m tests.support.robot_pictures [NAME ...]"""

from __future__ import annotations

import sys
from typing import Any

from playwright.sync_api import sync_playwright

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.models.systems.catalogue import ROBOTS
from tests.support.browser import CHROMIUM, PLAIN, Tab, wait_for
from tests.support.checkout import ROOT

WINDOW: Any = {"width": 1280, "height": 800}
SCENE: Any = {"x": 0, "y": 55, "width": 945, "height": 620}
"""The part of the window beside the panel."""
WIDTH = 400  # [px], of a picture
SHOWN = 2.6  # [s], simulated time in the picture


def take_picture(tab: Tab, name: str) -> None:
    """Save the scene with a robot as the picture that its entry names."""
    if name != tab.simulation.entry.name:
        tab.ask(c.ChooseRobot(name))
        wait_for(lambda: tab.is_built() and tab._framed())
    tab.ask(c.SetRunning(False))
    tab.elapse(SHOWN)
    tab.settle()
    tab.page.screenshot(path=ROOT / "assets" / ROBOTS[name].picture, clip=SCENE)


def main(names: list[str]) -> None:
    """Take the pictures of some robots, or of all."""
    server = LabServer("127.0.0.1", 0, LoopCache())
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=PLAIN)
        scale = WIDTH / SCENE["width"]
        tab = Tab(server, browser.new_context(viewport=WINDOW, device_scale_factor=scale))
        for name in names or ROBOTS:
            take_picture(tab, name)
        browser.close()
    server.stop()


if __name__ == "__main__":
    main(sys.argv[1:])
