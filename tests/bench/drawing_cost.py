"""What a picture costs in a browser without a GPU: pictures per second, and processor time of each.

Needs Playwright. The processor time of the process that draws depends much less on what else the
machine does than the number of pictures.
"""

from __future__ import annotations

from typing import Any

from msgspec import Struct

from onpath.app.server.lab_server import LabServer
from tests.bench.mouse_latency import ARGUMENTS

WINDOW = {"width": 1280, "height": 800}
SHARP = "fixedDpr=1"  # option of viser, which else draws fewer pixels when it is slow
COUNT = """
    window.pictures = 0
    let last = null  // the time of a frame is the same for all that happens in it
    for (const what of ["Elements", "Arrays", "ElementsInstanced", "ArraysInstanced"]) {
        const draw = WebGL2RenderingContext.prototype["draw" + what]
        WebGL2RenderingContext.prototype["draw" + what] = function (...how) {
            window.pictures += document.timeline.currentTime !== last
            last = document.timeline.currentTime
            return draw.apply(this, how)
        }
    }
"""
"""Counts frames in which something is drawn with WebGL."""


class DrawingCost(Struct, frozen=True):
    """Cost of the pictures of one browser.

    Attributes:
        pictures: per second.
        draw_ms: processor time of the process that draws, for each, [ms].
        main_ms: time of the page's main thread, for each, [ms].
    """

    pictures: float
    draw_ms: float
    main_ms: float


def drawing_cost(server: LabServer, browser: str, seconds: float = 15.0) -> DrawingCost:
    """The cost of drawing a running lab in a window of 1280 x 800 pixels.

    Args:
        server: of a lab.
        browser: path of a Chromium.
        seconds: duration of the measurement.
    """
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser, args=ARGUMENTS)
        processes = chromium.new_browser_cdp_session()
        page = chromium.new_page(viewport=WINDOW)  # type: ignore[arg-type]
        page.add_init_script(COUNT)
        page.goto(f"{server.address}?{SHARP}")
        page.wait_for_function("window.onpathLab?.lab?.scene > 0", timeout=60_000)
        page.wait_for_timeout(5000)  # until all pipelines are compiled
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable")

        def spent() -> tuple[float, float, float, float]:
            known = processes.send("SystemInfo.getProcessInfo")["processInfo"]
            draw = sum(each["cpuTime"] for each in known if each["type"] == "GPU")
            main: dict[str, Any] = {
                each["name"]: each["value"]
                for each in session.send("Performance.getMetrics")["metrics"]
            }
            now = page.evaluate("[performance.now() / 1000, window.pictures]")
            return now[0], now[1], draw, main["TaskDuration"]

        before = spent()
        page.wait_for_timeout(1000 * seconds)
        time, pictures, draw, main = (b - a for a, b in zip(before, spent(), strict=True))
        chromium.close()
    return DrawingCost(pictures / time, 1e3 * draw / pictures, 1e3 * main / pictures)
