"""Widgets that follow a lab, and the release of a held button from "held" messages alone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab.commands import ChooseRobot, Command, SetParameter
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.gains_panel import ADVANCED, BASIC, own_of
from onpath.app.page.panels.widgets import PRESS_ENDS, OwnGainWidgets, ParameterWidgets, on_hold
from onpath.lessons.words import ENGLISH
from onpath.models.control.laws.registry import OWN_GAINS
from onpath.models.control.settable import changed
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import declared
from onpath.models.systems.robots import RobotEntry
from tests.support.lab import store


class Timer:
    """Something to be done at a time, [s]."""

    def __init__(self, at: float, act: Callable[[], None]) -> None:
        self.at, self.act, self.off = at, act, False

    def cancel(self) -> None:
        self.off = True


class Loop:
    """An event loop with a clock that the test advances."""

    def __init__(self) -> None:
        self.now, self.timers = 0.0, list[Timer]()

    def call_later(self, delay: float, act: Callable[[], None]) -> Timer:
        self.timers.append(Timer(self.now + delay, act))
        return self.timers[-1]

    def pass_time(self, until: float) -> None:
        while due := [timer for timer in self.timers if not timer.off and timer.at <= until]:
            first = min(due, key=lambda timer: timer.at)
            self.now = first.at
            first.cancel()
            first.act()
        self.now = until


class Button:
    """Records what to do while the button is held."""

    def on_hold(self, act: Callable[[object], Coroutine[Any, Any, None]]) -> None:
        self.act = act

    def tell(self) -> None:
        """Deliver a message, whose handler must not wait."""
        with pytest.raises(StopIteration):
            self.act(None).send(None)


gaps = st.lists(st.floats(0.01, 3 * PRESS_ENDS).filter(lambda gap: abs(gap - PRESS_ENDS) > 1e-3))


@given(gaps)
def test_a_press_lasts_as_long_as_messages_come(gaps: list[float]) -> None:
    loop, button = Loop(), Button()
    heard: list[tuple[str, float]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(asyncio, "get_running_loop", lambda: loop)
        on_hold(
            button,
            lambda: heard.append(("begin", loop.now)),
            lambda: heard.append(("end", loop.now)),
        )
        button.tell()
        for gap in gaps:
            loop.pass_time(loop.now + gap)
            button.tell()
        last = loop.now
        loop.pass_time(last + 10.0)
    kinds = [kind for kind, _ in heard]
    presses = 1 + sum(gap > PRESS_ENDS for gap in gaps)
    assert kinds == ["begin", "end"] * presses
    assert heard[-1][1] == pytest.approx(last + PRESS_ENDS)


class Slider:
    """A slider that is moved by its user, or by the lab."""

    def __init__(self, *_: object, initial_value: float, **__: object) -> None:
        self.value, self.visible = initial_value, True

    def on_update(self, act: Callable[[Any], Coroutine[Any, Any, None]]) -> None:
        self.act = act

    def move(self, value: float) -> None:
        """Deliver a message, whose handler must not wait."""
        self.value = value
        with pytest.raises(StopIteration):
            self.act(SimpleNamespace(client="somebody")).send(None)


def test_a_snapshot_from_before_a_change_does_not_set_the_slider_back() -> None:
    lab, posted = Lab(store()), list[Command]()
    before, sliders = take_page_snapshot(lab, 1.0), list[Slider]()

    def add_slider(*args: object, **options: Any) -> Slider:
        sliders.append(Slider(*args, **options))
        return sliders[-1]

    gui: Any = SimpleNamespace(add_slider=add_slider)
    widgets = ParameterWidgets(gui, ENGLISH, posted.append, ["K1"], before)
    (slider,) = sliders
    slider.move(123.0)
    widgets.follow(before)
    assert slider.value == 123.0 and posted == [SetParameter("K1", 123.0)]
    for command in posted:
        command.apply(lab)
    widgets.follow(take_page_snapshot(lab, 1.0))
    assert slider.value == 123.0
    slider.move(1e9)  # refused: the lab keeps its value, and so does the slider
    widgets.follow(before)
    widgets.follow(take_page_snapshot(lab, 1.0))
    assert slider.value == 123.0


@pytest.mark.parametrize("entry", ROBOTS.values(), ids=lambda entry: entry.name)
def test_a_slider_stops_at_multiples_of_its_step(entry: RobotEntry) -> None:
    lab, made = Lab(store()), list[tuple[str, dict[str, Any]]]()
    ChooseRobot(entry.name).apply(lab)

    def add_slider(heading: str, **options: Any) -> Slider:
        made.append((heading, options))
        return Slider(initial_value=options["initial_value"])

    gui: Any = SimpleNamespace(add_slider=add_slider)
    names = [name for name, spec in declared(entry.parameters).items() if not spec.options]
    for end in ("low", "high"):
        for name in names:
            limit = getattr(declared(entry.parameters)[name], end)
            lab.session.parameters = changed(lab.session.parameters, name, limit)
        ParameterWidgets(gui, ENGLISH, lambda _: None, names, take_page_snapshot(lab, 0.0))
    assert len(made) == 2 * len(names)
    for heading, slider in made:
        low, high, step = slider["min"], slider["max"], slider["step"]
        assert low <= slider["initial_value"] <= high, heading
        for end in (low, high):
            assert end == pytest.approx(round(end / step) * step, abs=1e-12), heading


def test_the_sliders_of_own_gains_are_those_of_the_laws_in_use() -> None:
    lab, shown = Lab(store()), dict[str, Slider]()

    def add_slider(label: str, **given: Any) -> Slider:
        shown[label.partition(" [")[0]] = Slider(initial_value=given["initial_value"])
        return shown[label.partition(" [")[0]]

    gui: Any = SimpleNamespace(add_slider=add_slider)
    widgets = OwnGainWidgets(gui, ENGLISH, lambda _: None, take_page_snapshot(lab, 0.0))

    def visible() -> set[str]:
        widgets.follow(take_page_snapshot(lab, 0.0))
        return {label for label, slider in shown.items() if slider.visible}

    assert len(shown) == len(OWN_GAINS) and visible() == set()
    lab.session.change_law(LEFT, "waiting_clock")
    assert visible() == {"Clock waits"}
    lab.session.change_law(RIGHT, "contouring")
    assert visible() == {"Clock waits", "Along / across"}
    lab.session.change_law(LEFT, "path_following")
    assert visible() == {"Along / across"}


@pytest.mark.parametrize("entry", ROBOTS.values(), ids=lambda entry: entry.name)
def test_every_parameter_of_a_robot_has_one_place_in_the_lab(entry: RobotEntry) -> None:
    specs = declared(entry.parameters)
    own, apart = own_of(entry), [n for n, s in specs.items() if s.group in ("realism", "path")]
    shown = [*BASIC, *ADVANCED, *own, *apart]
    assert len(shown) == len(set(shown))
    if entry.flexible_link is None:  # its panel has the others
        assert set(shown) == specs.keys()


def test_what_only_one_robot_has_stands_beside_the_gains() -> None:
    assert own_of(ROBOTS["rod_gantry"]) == ["alpha", "rod", "pivot"]
    assert own_of(ROBOTS["cart_pendulum"]) == ["pendulum", "mass", "pivot"]
