"""A real browser connected to a lab: user actions by mouse and keys, and access to the lab."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import pairwise
from typing import Any, ClassVar
from uuid import uuid4

import numpy as np
from playwright.sync_api import BrowserContext, ConsoleMessage, Locator, Page
from viser import ClientHandle
from viser import _messages as wire

from onpath.app.lab.commands import Command
from onpath.app.lab.lab import Lab
from onpath.app.lab.simulation import Simulation
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from onpath.app.simulation.frame_length import FRAME
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.view.first_minute import INVITATIONS, KEPT_AS
from onpath.models.systems.parameters import time_step
from tests.bench.mouse_latency import ARGUMENTS, NO_TRIANGLES
from tests.support import waiting
from tests.support.fingers import fingers

CHROMIUM = "/usr/bin/chromium"
PLAIN = (*ARGUMENTS, "--disable-gpu-rasterization", "--disable-gpu-compositing")
"""Arguments of a browser whose GPU is simulated; a page is then composed faster without it."""
SELDOM = "requestAnimationFrame = act => setTimeout(() => act(performance.now()), 50)"
"""Reduces the frame rate: drawing in software takes most of a browser's time, and picking by mouse
does not need it."""
COARSE = "fixedDpr=0.5"  # option of viser: half the pixels in each direction, for a simulated GPU
COARSER = "fixedDpr=0.1"  # for tabs whose picture is not checked
VISER_S_OWN = "glDrawElementsInstanced: Vertex shader input type does not match"
"""What WebGL says of a mesh that viser 1.1 draws once more after it has freed it; nothing is seen.

It happens now and then when a node is replaced under its name; see `ClientScene._rebuild`.
"""
WAIT = 60.0  # [s]; software rendering on a busy machine shows a few frames a second

SEEN = f'localStorage.setItem("viser-user:{KEPT_AS}", "{len(INVITATIONS)}")'
"""Makes a browser one that has seen the first minute."""
TOLD = "() => [onpathLab.lab.robot, onpathLab.lab.language, onpathLab.lesson?.version ?? 0]"
"""What the page has heard of its lab."""
TAKEN = "async () => { await onpathLab.ask('display') }"
"""Answered after everything that the lab has told before."""
Place = tuple[float, float]
"""In the window, [px]."""
NEAR = 1.5  # [px], from where the mouse is to where the lab has heard that it is
wait_for = partial(waiting.wait_for, seconds=WAIT)
THREE_FRAMES = """() => new Promise(done => {
    let left = 3
    const frame = () => left-- ? requestAnimationFrame(frame) : done()
    frame()
})"""

BLUR = """async () => {
    const frame = () => new Promise(requestAnimationFrame)
    do {
        document.activeElement?.blur()
        for (let i = 0; i < 3; i++) await frame()
    } while (document.activeElement !== document.body)
}"""


class Note(Command):
    """A command that only records that it has been applied; not counted as one of the user's."""

    from_teacher: ClassVar[bool] = True

    def __init__(self, done: list[bool]) -> None:
        self.done = done

    def apply(self, lab: Lab) -> None:
        self.done.append(True)


class Elapse(Command):
    """A command that advances simulated time, frame by frame, as fast as it can be computed.

    Attributes:
        left: simulated time that is left because loops are being made, [s].
    """

    def __init__(self, seconds: float) -> None:
        self.left = seconds

    def apply(self, lab: Lab) -> None:
        dt = time_step(lab.simulation.parameters)
        left, each = round(self.left / dt), round(FRAME / dt)
        while left > 0:
            lab.simulation.simulate(min(each, left))
            if lab.simulation.lacks_loops:
                break
            lab.lessons.follow(lab)  # tasks are judged every so many frames
            left -= each
        self.left = max(left, 0) * dt


class Tab:
    """A tab with its simulation, client and display in the lab.

    Args:
        context: a new context stands for another browser, a shared one for another tab.
        draws: whether triangles are drawn.
        newcomer: whether the invitations of the first minute are shown.
        path: of the page.
        site: where the page is, if not at the server's own address.
    """

    def __init__(
        self,
        server: LabServer,
        context: BrowserContext,
        draws: bool = True,
        newcomer: bool = False,
        path: str = "/",
        site: str = "",
    ) -> None:
        self.server = server
        if not newcomer:
            context.add_init_script(SEEN)
        if not draws:
            context.add_init_script(NO_TRIANGLES + SELDOM)
        context.set_default_timeout(WAIT * 1e3)
        self.page: Page = context.new_page()
        self.errors: list[str] = []
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", self._heard)
        address = f"{site or server.address}{path}?{COARSE if draws else COARSER}"
        self._join(lambda: self.page.goto(address))

    def _heard(self, message: ConsoleMessage) -> None:
        """Note what WebGL refuses to draw, and what has no effect; the browser only warns of it."""
        if VISER_S_OWN in message.text:
            return
        if "GL_INVALID" in message.text or "preventDefault" in message.text:
            self.errors.append(message.text)

    def reload(self) -> None:
        """Reload the page, as F5 does."""
        self._join(self.page.reload)

    def close(self) -> None:
        """Close the tab; return when the lab has noticed."""
        self.page.close()
        wait_for(lambda: self.client.client_id not in self.server.server.get_clients())
        wait_for(lambda: self.scheduled.display is not self.display)

    def _join(self, load: Callable[[], Any]) -> None:
        clients, views = self._clients(), {id(scheduled.display) for scheduled in self._looked_at()}
        load()
        self.client: ClientHandle = wait_for(
            lambda: next((c for i, c in self._clients().items() if i not in clients), None)
        )
        self.scheduled: ScheduledLab = wait_for(
            lambda: next(
                (
                    scheduled
                    for scheduled in self._looked_at()
                    if id(scheduled.display) not in views
                ),
                None,
            )
        )
        self.display = self.scheduled.display
        self._listen()
        self.page.get_by_role("button", name="Pause").or_(
            self.page.get_by_role("button", name="Run", exact=True)
        ).first.wait_for()
        self.page.locator("#op-panel .field").first.wait_for(state="attached")
        wait_for(self.is_framed)

    def _listen(self) -> None:
        """Note what the page tells the server."""
        connection = self.client._websock_connection
        self._dragged_to: list[tuple[float, float]] = []
        self._answered: list[str] = []

        def dragged(_: int, message: wire.SceneNodeDragMessage) -> None:
            self._dragged_to.append(message.end_screen_pos)

        def answered(_: int, message: wire.LocalStorageGetItemResponseMessage) -> None:
            self._answered.append(message.request_uuid)

        connection.register_handler(wire.SceneNodeDragMessage, dragged)
        connection.register_handler(wire.LocalStorageGetItemResponseMessage, answered)

    def _clients(self) -> dict[int, ClientHandle]:
        return self.server.server.get_clients()

    def _looked_at(self) -> list[ScheduledLab]:
        return [scheduled for scheduled in self.server.thread.labs if scheduled.display is not None]

    def is_framed(self) -> bool:
        """Whether the browser has applied the camera that the lab chose for its size."""
        camera = self.client.camera
        box = self._canvas()
        shape = camera.image_width / camera.image_height
        off = camera.image_width * box["height"] - camera.image_height * box["width"]
        same = abs(off) <= max(box["width"], box["height"])  # the browser rounds to whole pixels
        scene = self.display.scene if isinstance(self.display, LabFeed) else None
        return same and scene is not None and abs(scene._framed - shape) < 0.02 * shape

    @property
    def lab(self) -> Lab:
        """The lab shown in the tab."""
        return self.scheduled.lab

    @property
    def simulation(self) -> Simulation:
        """Simulation of the lab."""
        return self.lab.simulation

    def ask(self, *commands: Command) -> None:
        """Post commands directly to the lab; return when they have been applied."""
        done: list[bool] = []
        for command in commands:
            self.lab.post(command)
        self.lab.post(Note(done))
        wait_for(lambda: done)

    def elapse(self, seconds: float) -> None:
        """Advance the simulated time of a paused lab by an exact number of ticks."""
        elapse = Elapse(seconds)

        def has_elapsed() -> bool:
            self.ask(elapse)
            return elapse.left == 0

        wait_for(has_elapsed)

    # Positions.

    def pixel(self, name: str, point: np.ndarray) -> tuple[float, float]:
        """Position in the window of a point of a robot's frame, shape (3,), [m]."""
        return self._pixels(name, point[None])[0]

    def _pixels(self, name: str, points: np.ndarray) -> list[tuple[float, float]]:
        camera, box = self.client.camera, self._canvas()
        forward = camera.look_at - camera.position
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        seen = points + stage_of(self.simulation.robot).bases[name] - camera.position
        depth, scale = seen @ forward, box["height"] / 2 / np.tan(camera.fov / 2)
        x = box["width"] / 2 + scale * (seen @ right) / depth
        y = box["height"] / 2 - scale * (seen @ np.cross(right, forward)) / depth
        return [(box["x"] + a, box["y"] + b) for a, b in zip(x.tolist(), y.tolist(), strict=True)]

    def _canvas(self) -> dict[str, float]:
        """Position and size of the scene in the window, [px]."""
        box = self.page.locator("canvas[data-engine]").first.bounding_box()
        assert box is not None
        return {"x": box["x"], "y": box["y"], "width": box["width"], "height": box["height"]}

    def placed(self, name: str, z: np.ndarray) -> tuple[float, float]:
        """Position in the window of a point of the path's plane, shape (2,), [m]."""
        robot = self.simulation.robot
        return self.pixel(name, robot.position(robot.frame.lift(np.asarray(z, dtype=float))))

    def line(self, name: str, z: np.ndarray) -> list[tuple[float, float]]:
        """Positions in the window of points of the path's plane, shape (n, 2), [m]."""
        robot = self.simulation.robot
        return self._pixels(name, robot.position(robot.frame.lift(z)))

    def tip(self, name: str) -> np.ndarray:
        """Position of the end-point in the path's plane, shape (2,), [m]."""
        return self.simulation.robot.frame.planar(self.simulation.runs[name].shown()["y"]).copy()

    # User actions.

    @contextmanager
    def dragging(self, *way: Place, in_scene: bool = True) -> Iterator[Callable[[Place], None]]:
        """Press the mouse at the first place and move it through the others; release on exit.

        Gives what moves it further.

        Args:
            in_scene: whether it drags a node of the scene; the lab has then heard of each place.
        """
        mouse = self.page.mouse
        mouse.move(*way[0])
        self.settle()
        mouse.down()
        for place in way[1:]:
            mouse.move(*place, steps=2)
            if in_scene:
                self._until_dragged(place)
        yield lambda place: mouse.move(*place)
        mouse.up()

    @contextmanager
    def touching(self, *way: Place, in_scene: bool = True) -> Iterator[Callable[[Place], None]]:
        """Touch the first place and move the finger through the others; lift it on exit.

        Gives what moves it further.

        Args:
            in_scene: see `dragging`.
        """
        self.settle()
        with fingers(self.page) as tell:
            tell("touchStart", way[0])
            for begin, end in pairwise(way):
                for place in np.linspace(begin, end, 4)[1:].tolist():
                    tell("touchMove", place)
                if in_scene:
                    self._until_dragged(end)
            yield lambda place: tell("touchMove", place)
            tell("touchEnd")

    def _until_dragged(self, place: tuple[float, float]) -> None:
        """viser passes on twenty places a second, and drops those between."""
        box = self._canvas()
        size = np.array([box["width"], box["height"]])
        wanted = np.array(place) - [box["x"], box["y"]]
        wait_for(lambda: any(np.abs(z * size - wanted).max() < NEAR for z in self._dragged_to[-1:]))

    def settle(self) -> None:
        """Return when the page has drawn the lab as it is now."""
        self.ask()
        self.page.evaluate(TAKEN)
        self.answer()
        self.page.evaluate(THREE_FRAMES)

    def answer(self) -> None:
        """Return when the scene has dealt with what was sent, and the lab heard what it told."""
        question = uuid4().hex
        message = wire.LocalStorageGetItemRequestMessage("", question)
        self.client._websock_connection.queue_message(message)
        wait_for(lambda: question in self._answered)
        self.ask()

    def is_built(self) -> bool:
        """Whether the page is that of the current robot, language and step."""
        feed = self.scheduled.display
        scene = feed.scene if isinstance(feed, LabFeed) else None
        if scene is None or not scene.is_ready or scene.is_outdated:
            return False
        lab, (robot, language, version) = self.lab, self.page.evaluate(TOLD)
        lessons = lab.lessons
        is_read = lessons.lesson is None or version == lessons.version
        return is_read and (robot, language) == (lab.simulation.entry.name, lab.words.language)

    def wait_until_built(self) -> None:
        """Return when the browser has the whole page; a button of the page before does nothing."""
        wait_for(self.is_built)
        self.answer()
        if self.lab.lessons.lesson is not None:
            version = self.lab.lessons.version
            self.page.locator(f'#op-column[data-version="{version}"]').wait_for()

    def press(self, name: str) -> None:
        """Press a button once the page is built."""
        self.wait_until_built()
        self.button(name).click()

    def more(self, name: str) -> None:
        """Open what is in the menu of the head."""
        self.press("More")
        self.button(name).click()

    def button(self, name: str) -> Locator:
        """Return the button with a label."""
        return self.page.get_by_role("button", name=name, exact=True)

    def open(self, group: str) -> None:
        """Open a group of the controls unless it is open already."""
        summary = self.page.locator("#op-panel summary").filter(
            has=self.page.locator(".heading").get_by_text(group, exact=True)
        )
        if not summary.is_visible():
            self.button("Controls").first.click()
        if summary.locator("xpath=..").get_attribute("open") is None:
            summary.click()

    def choose(self, label: str, option: str) -> None:
        """Choose one of several options."""
        row = self.row(label)
        if row.locator("select").count():
            row.locator("select").select_option(label=option)
        else:
            row.get_by_role("radio", name=option, exact=True).check(force=True)

    def focus(self, control: Locator) -> None:
        """Focus a control once it is visible; a hidden one cannot be focused."""
        control.wait_for(state="visible")
        control.focus()
        wait_for(lambda: control.evaluate("control => control === document.activeElement"))

    def blur(self) -> None:
        """Remove the focus from the focused control."""
        self.page.evaluate(BLUR)

    def row(self, label: str) -> Locator:
        """Return the row of a setting, in a step's card or among all controls, once it is seen."""
        rows = self.page.locator(f'.form .field:has([aria-label^="{label}"])')
        rows.first.wait_for(state="attached")
        named = f':is([aria-label="{label}"], [aria-label^="{label} ["])'  # with its unit
        if (exact := self.page.locator(f".form .field:has({named})")).count():
            rows = exact
        if not rows.filter(visible=True).count():
            group = rows.first.locator("xpath=ancestor::details")
            if group.count():
                self.open(group.locator(".heading").inner_text())
            else:
                self.button("Controls").first.click()
        return rows.filter(visible=True).first

    def slider(self, label: str) -> Locator:
        """Return a slider."""
        return self.row(label).get_by_role("slider")

    def number(self, label: str) -> Locator:
        """Return the box for a number, which a slider has, too."""
        return self.row(label).get_by_role("textbox")

    def value(self, label: str) -> float:
        """Return the number that a box shows."""
        return float(self.number(label).input_value().replace("\N{MINUS SIGN}", "-"))

    def switch(self, label: str) -> Locator:
        """Return a switch."""
        return self.row(label).get_by_role("switch")

    def field(self, label: str) -> Locator:
        """Return a text field."""
        return self.page.get_by_label(label, exact=True).filter(visible=True)

    def enter(self, label: str, text: str) -> None:
        """Type a number into its box once that shows what the lab has."""
        self.settle()
        box = self.number(label)
        box.fill(text)
        box.press("Enter")
        self.blur()

    def card(self, label: str) -> Locator:
        """Return what chooses something on an open sheet, such as a lesson or a robot."""
        return self.page.get_by_role("dialog").get_by_role("button").filter(has_text=label)

    def teach(self, key: str) -> None:
        """Ask for the teacher's page with a key."""
        self.more("Language, display")
        dialog = self.page.get_by_role("dialog")
        dialog.get_by_role("button", name="Teacher…").click()
        dialog.get_by_label("Teacher's key").fill(key)
        dialog.get_by_role("button", name="Open the teacher's page").click()

    def wait_for_no_message(self) -> None:
        """Return when the page shows no message; a failure tells page and lab apart."""
        wait_for(
            lambda: not self.said(),
            state=lambda: f"{self.said()!r}, lab {self.lab.notice}, {self.scheduled.is_seen=}",
        )

    def said(self) -> str:
        """The message shown on the page."""
        return "".join(self.page.get_by_role("status").all_inner_texts())
