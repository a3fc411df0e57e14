"""A student's actions in a lab: gestures by mouse, keys or touch, one after the other.

The lab is paused during a gesture, and each gesture waits until the lab has received it, so that
the result does not depend on how busy the machine is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from playwright.sync_api import Locator

from onpath.app.lab.lab import Lab
from onpath.app.lab.simulation import Simulation
from onpath.lessons.labels import parameter_label
from onpath.lessons.words import ENGLISH
from onpath.models.control.settable import specs, value_of
from onpath.models.control.sides import RIGHT
from tests.support.browser import THREE_FRAMES, Place, Tab, wait_for

ROBOT = RIGHT
PACE = 0.1  # [s], simulated, from key to key
NEAR = 3e-3  # [m]


class Hands:
    """The gestures of one student.

    Args:
        tab: the student's tab.
        touch: whether the student touches the screen or uses a mouse.
    """

    def __init__(self, tab: Tab, touch: bool) -> None:
        self.tab, self._touch = tab, touch

    @property
    def lab(self) -> Lab:
        """The student's lab."""
        return self.tab.lab

    @property
    def simulation(self) -> Simulation:
        """Simulation of the lab."""
        return self.lab.simulation

    def press(self, what: Locator) -> None:
        """Press a button or a link."""
        (what.tap if self._touch else what.click)()

    @contextmanager
    def dragging(self, *way: Place, in_scene: bool = True) -> Iterator[Callable[[Place], None]]:
        """Take something at the first place and move it through the others; let go on exit.

        Gives what moves it further.
        """
        drag = self.tab.touching if self._touch else self.tab.dragging
        with drag(*way, in_scene=in_scene) as move:
            yield move

    @contextmanager
    def until_received(self) -> Iterator[None]:
        """Wait on exit until the lab has received the command given within."""
        asked = self.lab.asked
        yield
        wait_for(lambda: self.lab.asked > asked)

    def has(self, label: str, value: float, near: float = 0.0) -> bool:
        """Whether the lab's parameter with a label is near a value, in the unit that is shown."""
        own = self.simulation.parameters
        known = {parameter_label(name, spec, ENGLISH): name for name, spec in specs(own).items()}
        name = known[min((full for full in known if full.startswith(label)), key=len)]
        _, factor = specs(own)[name].shown_in or ("", 1.0)
        return abs(value_of(own, name) * factor - value) <= near + 1e-9

    def is_near(self, output: np.ndarray, z: np.ndarray) -> bool:
        """Whether an output is near a point of the path's plane, shape (2,), [m]."""
        return bool(np.linalg.norm(self.simulation.robot.frame.planar(output) - z) < NEAR)

    @staticmethod
    def box(what: Locator) -> dict[str, float]:
        """Position and size of an element in the window, [px]."""
        box = what.bounding_box()
        assert box is not None
        return {"x": box["x"], "y": box["y"], "width": box["width"], "height": box["height"]}


@dataclass(frozen=True)
class Wait:
    """Wait for a number of simulated seconds."""

    seconds: float

    def __call__(self, hands: Hands) -> None:
        hands.tab.elapse(self.seconds)


@dataclass(frozen=True)
class Press:
    """Press a button or a link with a label."""

    label: str

    def __call__(self, hands: Hands) -> None:
        with hands.until_received():
            hands.press(hands.tab.button(self.label).first)
        hands.tab.settle()  # what is typed next is not replaced by what the press changed


@dataclass(frozen=True)
class Key:
    """Press a key, once or several times."""

    key: str
    times: int = 1

    def __call__(self, hands: Hands) -> None:
        for _ in range(self.times):
            with hands.until_received():
                hands.tab.page.keyboard.press(self.key)
            hands.tab.elapse(PACE)


@dataclass(frozen=True)
class Enter:
    """Type a number into the box with a label."""

    label: str
    value: float

    def __call__(self, hands: Hands) -> None:
        hands.tab.enter(self.label, f"{self.value:g}")
        wait_for(lambda: hands.has(self.label, self.value))


@dataclass(frozen=True)
class Slide:
    """Move a slider's handle to a number, or as near as the pixels of its bar allow."""

    label: str
    value: float
    near: float = 0.05

    def __call__(self, hands: Hands) -> None:
        slider = hands.tab.slider(self.label)
        slider.scroll_into_view_if_needed()
        bar = hands.box(slider)
        low, high, y = bar["x"], bar["x"] + bar["width"], bar["y"] + bar["height"] / 2
        tried: list[tuple[float, float]] = []  # distance from the number, and place
        with hands.dragging(((low + high) / 2, y), in_scene=False) as move:
            while high - low > 0.5:  # px
                middle = (low + high) / 2
                move((middle, y))
                hands.tab.page.evaluate(THREE_FRAMES)  # a finger's moves wait for a picture
                found = hands.tab.value(self.label)
                tried.append((abs(found - self.value), middle))
                if found < self.value:
                    low = middle
                else:
                    high = middle
            move((min(tried)[1], y))
            wait_for(lambda: hands.has(self.label, self.value, self.near))


@dataclass(frozen=True)
class Choose:
    """Choose an option of a list."""

    label: str
    option: str

    def __call__(self, hands: Hands) -> None:
        with hands.until_received():
            hands.tab.choose(self.label, self.option)
        wait_for(hands.tab.is_built)  # another number of modes is another robot
        hands.tab.settle()


@dataclass(frozen=True)
class Pull:
    """Pull the follower's end-point aside by [mm] for some seconds, and let go."""

    right: float
    up: float
    seconds: float

    def __call__(self, hands: Hands) -> None:
        tab, forces = hands.tab, hands.simulation.forces
        tip = tab.tip(ROBOT)
        hand = tip + np.array([self.right, self.up]) / 1e3
        with hands.dragging(tab.placed(ROBOT, tip), tab.placed(ROBOT, hand)):
            wait_for(lambda: forces.grabbed == ROBOT)
            wait_for(lambda: hands.is_near(forces.hands[ROBOT], hand))
            hands.tab.elapse(self.seconds)
        wait_for(lambda: not forces.hands)


@dataclass(frozen=True)
class DragBall:
    """Drag the control point nearest to `start` near to `end`, in the path's plane, [mm]."""

    start: Place
    end: Place

    def __call__(self, hands: Hands) -> None:
        tab, editor = hands.tab, hands.simulation.editor
        points = editor.design.points
        index = int(np.linalg.norm(points - np.array(self.start) / 1e3, axis=1).argmin())
        end = np.array(self.end) / 1e3
        with hands.dragging(tab.placed(ROBOT, points[index]), tab.placed(ROBOT, end)):
            wait_for(lambda: np.linalg.norm(editor.points()[index] - end) < NEAR)
        wait_for(lambda: editor.design.points is not points)
        assert not hands.simulation.forces.hands


Gesture = Wait | Press | Key | Enter | Slide | Choose | Pull | DragBall
