"""Makes the README's moving picture: both robots on their circle, held back, and let go.

`make picture` writes assets/lab.webp. Time is advanced by hand, so that the picture is the same
however slowly the machine draws.
"""

from __future__ import annotations

import io

from PIL import Image
from playwright.sync_api import ViewportSize, sync_playwright

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.assets import asset_path
from tests.support import browser
from tests.support.browser import CHROMIUM, PLAIN, Tab

FRAMES_A_SECOND = 12
SHOTS = (("free", 1.25), ("held", 3.75), ("free", 1.25))
"""What happens, and for how long [s]."""
WINDOW: ViewportSize = {"width": 1280, "height": 800}
WIDTH = 880  # of the picture, [px]
QUALITY = 72


def photograph(tab: Tab) -> list[Image.Image]:
    """The pictures, one after the other."""
    pictures: list[Image.Image] = []
    for what, seconds in SHOTS:
        tab.ask(c.Hold(what == "held"))
        for _ in range(round(seconds * FRAMES_A_SECOND)):
            tab.elapse(1.0 / FRAMES_A_SECOND)
            tab.settle()
            picture = Image.open(io.BytesIO(tab.page.screenshot())).convert("RGB")
            height = round(WIDTH * picture.height / picture.width)
            pictures.append(picture.resize((WIDTH, height), Image.Resampling.LANCZOS))
    return pictures


def main() -> None:
    """Write the picture."""
    browser.COARSE = ""  # every pixel
    server = LabServer("127.0.0.1", 0, LoopCache(at_once=True))
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=PLAIN)
        tab = Tab(server, chromium.new_context(viewport=WINDOW))
        tab.ask(c.SetRunning(False), c.Set("speed", 3.0), c.Reset())
        tab.elapse(4.0)
        first, *others = photograph(tab)
        chromium.close()
    server.stop()
    first.save(
        asset_path("page").parent / "lab.webp",
        save_all=True,
        append_images=others,
        duration=round(1000 / FRAMES_A_SECOND),
        loop=0,
        quality=QUALITY,
        method=6,
    )


if __name__ == "__main__":
    main()
