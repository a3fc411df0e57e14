"""Latency from a real mouse in Chromium to the changed pose that comes back. Needs Playwright."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from onpath.app.lab import commands as c
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.lab_server import LabServer
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.models.control.sides import RIGHT, SIDES
from tests.bench.client_protocol import unpacked

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
STEP = 30.0  # [px]
MOVED = 1e-4  # [m]


def seen_at(camera: viser.CameraHandle, box: dict[str, float], point: np.ndarray) -> np.ndarray:
    """Pixel at which a point of the world is seen, shape (2,), [px].

    Args:
        camera: of the browser.
        box: position and size of the canvas, [px].
        point: shape (3,), [m].
    """
    forward = camera.look_at - camera.position
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    way = point - camera.position
    scale = box["height"] / 2 / np.tan(camera.fov / 2) / (way @ forward)
    middle = np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])
    return middle + scale * np.array([way @ right, -(way @ np.cross(right, forward))])


def mouse_latency(server: LabServer, browser: str, times: int, draws: bool = True) -> np.ndarray:
    """Latencies of `times` mouse moves that drag an end-point, shape (times,), [s].

    The robots rest at a position task, so that the first changed pose is the response to the move.
    Measured from the command to move the mouse to the arrival of the frame.

    Args:
        server: of a lab.
        browser: path of a Chromium.
        times: number of moves.
        draws: whether triangles are drawn. Without a GPU that is most of the browser's work, and
            mouse events wait for it.
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

        until(lambda: watch.tip is not None and any(lab.display for lab in server.thread.labs))
        lab = next(lab for lab in server.thread.labs if lab.display is not None)
        lab.lab.post(c.Set("task", "position"))
        lab.lab.post(c.Set("target", 0.4))  # between two control points
        page.wait_for_timeout(3000)
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
    """Grab what is at `start`, (2,), [px], and move it to and fro; latencies, [s]."""
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
    """Reads the end-point's position from the frames that arrive."""

    def __init__(self) -> None:
        self.tip: np.ndarray | None = None
        self.rest: np.ndarray | None = None
        self.moved_at: float | None = None

    def frame(self, raw: bytes | str) -> None:
        now = time.monotonic()
        for message in unpacked(raw) if isinstance(raw, bytes) else ():
            tips = message.get("updates", {}).get("batched_positions")
            if message.get("name") == "/grips" and tips is not None:
                self.tip = np.reshape(tips, (-1, 3))[SIDES.index(RIGHT)]
                if self.rest is None or np.abs(self.tip - self.rest).max() > MOVED:
                    self.moved_at = self.moved_at or now


def _tip(lab: ScheduledLab) -> np.ndarray:
    """The end-point in the world, shape (3,), [m]."""
    simulation = lab.simulation
    base = stage_of(simulation.robot).bases[RIGHT]
    return base + simulation.robot.position(simulation.runs[RIGHT].shown()["y"])
