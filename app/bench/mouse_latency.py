"""From a real mouse in Chromium to the changed pose that comes back. Needs Playwright."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from onpath.app.bench.client_protocol import unpacked
from onpath.app.lab import commands as c
from onpath.app.scene.stage_catalogue import RIGID
from onpath.app.server.lab_server import LabServer
from onpath.app.simulation.simulation_thread import ScheduledLab

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
ARGUMENTS = (
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    "--no-first-run",
)
NO_TRIANGLES = """
    for (const what of ["Elements", "Arrays", "ElementsInstanced", "ArraysInstanced"])
        WebGL2RenderingContext.prototype["draw" + what] = () => {}
"""
WINDOW = {"width": 1000, "height": 700}
ROBOT = "path_following"
STEP = 30.0  # [px]
MOVED = 1e-4  # [m]


def find_browser() -> str | None:
    """Path of a Chromium, or None; None too when Playwright is not installed."""
    try:
        import playwright.sync_api  # noqa: F401
    except ImportError:
        return None
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def seen_at(camera: viser.CameraHandle, box: dict[str, float], point: np.ndarray) -> np.ndarray:
    """Where a point of the world, shape (3,), [m], is seen on a canvas at `box`; (2,), [px]."""
    forward = camera.look_at - camera.position
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    way = point - camera.position
    scale = box["height"] / 2 / np.tan(camera.fov / 2) / (way @ forward)
    middle = np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])
    return middle + scale * np.array([way @ right, -(way @ np.cross(right, forward))])


def mouse_latency(server: LabServer, browser: str, times: int, draws: bool = True) -> np.ndarray:
    """Delays of `times` moves of an end-point that the mouse holds, [s].

    The robots stand still, with a position for a task, so that the first changed pose is the
    answer to the move. Measured from the order to move the mouse to the arrival of the frame.

    Args:
        draws: whether triangles are drawn; without a GPU that is most of the browser's work, and
            a mouse event waits for it.
    """
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser, args=ARGUMENTS)
        page = chromium.new_page(viewport=WINDOW)  # type: ignore[arg-type]
        if not draws:
            page.add_init_script(NO_TRIANGLES)
        watch = _Watch()
        page.on("websocket", lambda socket: socket.on("framereceived", watch.frame))
        page.goto(server.address)

        def until(condition: Callable[[], Any], seconds: float = 30.0) -> None:
            end = time.monotonic() + seconds
            while not condition():
                if time.monotonic() > end:
                    raise TimeoutError("the browser or the lab does not answer")
                page.wait_for_timeout(2)

        until(lambda: watch.tip is not None and any(lab.view for lab in server.simulation.labs))
        lab = next(lab for lab in server.simulation.labs if lab.view is not None)
        lab.lab.post(c.SetParameter("task", "position"))
        lab.lab.post(c.SetParameter("target", 0.4))  # between two control points
        page.wait_for_timeout(3000)
        page.get_by_role("alert").get_by_role("button").click()  # "software rendering"
        box = page.locator("canvas").first.bounding_box()
        assert box is not None
        (client,) = server.server.get_clients().values()
        start = seen_at(client.camera, dict(box.items()), _tip(lab))  # type: ignore[arg-type]
        delays = _moves(page, watch, start, times, until)
        page.mouse.up()
        chromium.close()
    return np.array(delays)


def _moves(
    page: Any, watch: _Watch, start: np.ndarray, times: int, until: Callable[..., None]
) -> list[float]:
    """Take hold of what is at `start`, (2,), [px], and move it to and fro; delays, [s]."""
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(start[0] + STEP / 3, start[1], steps=3)  # now it is a drag, not a click
    delays: list[float] = []
    for number in range(times):
        page.wait_for_timeout(600)
        watch.rest = watch.tip
        watch.moved_at = None
        begun = time.monotonic()
        page.mouse.move(start[0] - STEP * (1 - number % 2), start[1])
        until(lambda: watch.moved_at is not None)
        assert watch.moved_at is not None
        delays.append(watch.moved_at - begun)
    return delays


class _Watch:
    """Sees where the end-point is in the frames that come in."""

    def __init__(self) -> None:
        self.tip: np.ndarray | None = None
        self.rest: np.ndarray | None = None
        self.moved_at: float | None = None

    def frame(self, raw: bytes | str) -> None:
        now = time.monotonic()
        for message in unpacked(raw) if isinstance(raw, bytes) else ():
            tips = message.get("updates", {}).get("batched_positions")
            if message.get("name") == "/grips" and tips is not None:
                self.tip = np.reshape(tips, (-1, 3))[list(RIGID.bases).index(ROBOT)]
                if self.rest is None or np.abs(self.tip - self.rest).max() > MOVED:
                    self.moved_at = self.moved_at or now


def _tip(lab: ScheduledLab) -> np.ndarray:
    """The end-point in the world, shape (3,), [m]."""
    session = lab.session
    return RIGID.bases[ROBOT] + session.robot.place(session.runs[ROBOT].shown()["y"])
