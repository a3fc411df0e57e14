"""Takes the robots' pictures for the menu: python -m tests.support.robot_pictures [NAME ...]"""

from __future__ import annotations

import io
import sys
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.models.systems.catalogue import ROBOTS
from tests.support import browser
from tests.support.browser import CHROMIUM, PLAIN, Tab, wait_for
from tests.support.checkout import ROOT

WINDOW: Any = {"width": 1280, "height": 800}
SCENE: Any = {"x": 475, "y": 60, "width": 470, "height": 510}
"""The part of the window with the right robot."""
WIDTH, QUALITY = 320, 82  # [px] of a picture
SHOWN = 2.6  # [s], simulated time in the picture
ALONE = "body > :not(#root) { visibility: hidden !important; }"
"""Hides what stands around the scene."""


def take_picture(tab: Tab, name: str) -> None:
    """Save the scene with a robot as the picture that its entry names."""
    if name != tab.simulation.entry.name:
        tab.ask(c.ChooseRobot(name))
        wait_for(lambda: tab.is_built() and tab.is_framed())
    tab.ask(c.SetRunning(False))
    tab.elapse(SHOWN)
    tab.settle()
    picture = Image.open(io.BytesIO(tab.page.screenshot(clip=SCENE))).convert("RGB")
    height = round(WIDTH * picture.height / picture.width)
    small = picture.resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.save(ROOT / "assets" / ROBOTS[name].picture, quality=QUALITY, method=6)


def main(names: list[str]) -> None:
    """Take the pictures of some robots, or of all."""
    browser.COARSE = ""  # every pixel
    server = LabServer("127.0.0.1", 0, LoopCache())
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=PLAIN)
        tab = Tab(server, chromium.new_context(viewport=WINDOW))
        tab.page.add_style_tag(content=ALONE)
        for name in names or ROBOTS:
            take_picture(tab, name)
        chromium.close()
    server.stop()


if __name__ == "__main__":
    main(sys.argv[1:])
