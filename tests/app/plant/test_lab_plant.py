"""A lab drives a plant as long as a page, the lab and the plant's measurements are there."""

from __future__ import annotations

import random
from collections.abc import Callable
from concurrent.futures import Future, wait
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.plant_messages import DrivePlant
from onpath.app.channel.reading import NoPageMessage, read_message
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.plant_state import SIDE, settable
from onpath.app.plant.controller_process import Address, ControllerPlan, ControllerProcess
from onpath.app.plant.datagrams import Measured
from onpath.app.plant.lab_plant import LOST, SILENT, LabPlant, PlantChoice
from onpath.app.plant.plant_link import PlantLink, PlantReport
from onpath.app.server.plant_desk import PlantDesk
from onpath.app.server.visit import Visit
from onpath.app.view.plant import plant_message
from onpath.lessons.words import Words
from onpath.models.control.settable import value_of, values_of
from onpath.models.control.sides import LEFT
from onpath.models.errors import Message
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from tests.bench.hostile_messages import wild_message
from tests.support.lab import FRAME, do, loop_cache
from tests.support.plant_end import measurement, torque_in

CHOICE = PlantChoice(
    address=("127.0.0.1", 9000), laws=("path_following", "waiting_clock"), fastest=50.0
)
INTERVAL = 0.01


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@dataclass
class Beside:
    """A controller in this process, and a plant that stands still beside its path."""

    plan: ControllerPlan
    clock: Clock
    sequence: int = 0
    address: Address = ("127.0.0.1", 9000)
    is_gone: bool = False
    is_closed: bool = False
    answer: tuple[int, int, Any] | None = None
    link: PlantLink = field(init=False)
    controllers: dict[str, Any] = field(init=False)

    def __post_init__(self) -> None:
        self.controllers, self.link = self.plan.made(), PlantLink(self.plan.made())

    @property
    def place(self) -> Any:
        """Where the plant stands: beside the path."""
        robot, curve = self.plan.robot.make(self.plan.robot.parameters()), circle(0.03)
        return robot.rest(robot.frame.lift(curve.at(np.array(0.0))))

    def measures(self, q: Any = None) -> None:
        """The plant sends a measurement."""
        q = self.place if q is None else q
        self.sequence += 1
        t = self.sequence * INTERVAL
        given = measurement(Measured(self.sequence, t, np.array(q), np.zeros(2)))
        answer = self.link.received(given, "plant", t)
        assert answer is not None
        self.answer = torque_in(answer, 2)

    def _asked(self) -> PlantReport:
        if self.is_gone or self.is_closed:
            raise OSError("gone")
        return self.link.report()

    report = _asked

    def stop(self) -> PlantReport:
        if self.link.started and not self.link.ended and not self.is_gone:
            self.link.stop()
        return self._asked()

    def set(self, **given: Any) -> None:
        for each in self.controllers.values():
            each.set(**given)
        self.link.set(**given)

    def follow(self, path: Any) -> None:
        for each in self.controllers.values():
            each.follow(path)
        self.link.follow(path)

    def use(self, law: str) -> None:
        self.link.use(law)

    def reason(self, report: PlantReport) -> Message | None:
        design = self.controllers[report.law].design
        return design.reason(report.code, np.array(report.q))

    def close(self) -> None:
        self.is_closed = True

    leave = close


@dataclass
class Bench:
    """A lab with a plant, and all controllers that have been made."""

    clock: Clock = field(default_factory=Clock)
    made: list[Beside] = field(default_factory=list[Beside])
    lab: Lab = field(default_factory=lambda: Lab(loop_cache(), ROBOTS["two_link_arm"]))

    def __post_init__(self) -> None:
        do(self.lab, c.Set("torque_limit", 5.0), c.Set("control_rate", 100))
        self.plant = LabPlant(self.lab, CHOICE, self.clock, self._begin)

    def _begin(self, plan: ControllerPlan, _: Address) -> ControllerProcess:
        self.made.append(Beside(plan, self.clock))
        return cast(ControllerProcess, self.made[-1])

    @property
    def beside(self) -> Beside | None:
        """The controller that answers now."""
        return self.made[-1] if self.made and not self.made[-1].is_closed else None

    @property
    def phase(self) -> str:
        assert self.lab.plant is not None
        return self.lab.plant.phase

    def frame(self) -> None:
        """A frame of the lab, once a controller that is being made is there."""
        self.clock.now += FRAME
        if self.plant._coming is not None:
            wait([self.plant._coming])
        self.lab.drain()
        self.lab.advance(FRAME)
        self.plant.show(self.lab, 0, 1.0)

    def run(self) -> Beside:
        """Start it, and let the plant measure."""
        self.plant.start("damp")
        self.frame()
        self.frame()
        assert self.phase == "waiting" and self.beside is not None
        self.beside.measures()
        self.frame()
        assert self.phase == "running"
        return self.beside


@dataclass
class Oracle:
    """What has to happen, by the rules of app/plant/README.md."""

    phase: str = "off"
    cause: str = ""
    wants: bool = False
    why: str = ""  # it is to end
    heard: float = 0.0
    sent: float = 0.0
    measured: bool = False  # since the last frame
    begun: bool = False  # whether the plant has measured
    ended: str = ""  # why the controller has ended by itself
    gone: bool = False
    sends: bool = False

    @property
    def live(self) -> bool:
        return self.phase in ("starting", "waiting", "running")

    def happens(self, event: str, now: float) -> None:
        if event == "start" and not self.live and not self.sends:
            self.wants, self.heard = True, now
        elif event == "beat":
            self.heard = now
        elif event == "stop":
            self.stops("plant.stopped")
        elif event == "measures":
            self.measured = self.begun = True
        elif event == "silence" and self.begun and not (self.why or self.ended):
            self.ended = "refused.late"
        elif event == "lies":
            self.measured = True
            if self.begun and not (self.why or self.ended):
                self.ended = "refused.not_finite"
        elif event == "dies":
            self.gone = True
        elif event == "frame":
            self.frame(now)

    def stops(self, why: str) -> None:
        self.wants = False
        if self.live and not self.why:
            self.why, self.measured = why, False  # what STOP has been answered with is not shown

    def frame(self, now: float) -> None:
        if now > self.heard + LOST:
            self.stops("plant.page_lost")
        if self.phase in ("waiting", "running") or self.sends:
            self.followed(now)
        elif self.phase == "starting":
            self.phase, self.sent = "waiting", now
            if self.why:
                self.followed(now)
        elif self.wants:
            self.phase, self.cause, self.why, self.ended = "starting", "", "", ""
            self.wants = self.begun = self.gone = self.measured = False

    def followed(self, now: float) -> None:
        why = self.why or self.ended
        if self.measured:
            self.sent, self.measured = now, False
        if self.gone:
            self.over("plant.failed")
        elif self.why and not self.begun:
            self.over(self.why)
        elif why:
            self.phase, self.cause, self.sends = "ended", self.cause or why, True
            if now > self.sent + SILENT:
                self.over(self.cause)
        elif self.begun:
            self.phase = "running"

    def over(self, cause: str) -> None:
        self.phase, self.cause, self.sends = "ended", cause, False


EVENTS = ["frame"] * 6 + ["beat"] * 3 + ["measures"] * 4
EVENTS += ["start", "start", "stop", "silence", "lies", "dies", "pause"]


@settings(max_examples=30)
@given(st.lists(st.sampled_from(EVENTS), min_size=10, max_size=40))
def test_it_runs_only_as_long_as_everything_is_there(events: list[str]) -> None:
    bench, oracle = Bench(), Oracle(heard=Clock.now)
    acts: dict[str, Callable[[], None]] = {
        "frame": bench.frame,
        "beat": bench.plant.beat,
        "stop": bench.plant.stop,
        "start": lambda: bench.plant.start("damp"),
    }
    for event in ["frame", *events, "frame"]:
        beside = bench.beside
        if event == "pause":  # nothing is heard of the page for a while
            bench.clock.now += LOST / 2
        elif event in acts:
            acts[event]()
            oracle.happens(event, bench.clock.now)
        elif beside is not None and not beside.is_gone and oracle.phase != "starting":
            if event == "measures":
                beside.measures()
                assert beside.answer is not None
                is_over = bool(oracle.why or oracle.ended)
                assert (beside.answer[1] != 0) == (is_over and oracle.begun)
            elif event == "lies" and beside.link.started:
                beside.measures((np.nan, 0.0))
            elif event == "silence" and beside.link.started and not beside.link.ended:
                beside.link.fall_silent()
            elif event == "dies":
                beside.is_gone = True
            else:
                continue
            oracle.happens(event, bench.clock.now)
        state = bench.lab.plant
        assert state is not None
        if event == "frame":
            cause = "" if state.cause is None else state.cause.code
            assert (state.phase, cause) == (oracle.phase, oracle.cause)
            assert bench.lab.simulation.running == (state.phase == "running")
            assert state.can_start == (not oracle.live and not oracle.sends)
            assert plant_message(state, Words("de")).text
    bench.plant.close()


def test_a_stop_counts_while_a_start_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    """It comes from another thread than the frame that makes the controller."""
    bench = Bench()

    def submit(make: Callable[..., Any], *given: Any) -> Future[Any]:
        bench.plant.stop()
        made = Future[Any]()
        made.set_result(make(*given))
        return made

    monkeypatch.setattr(bench.plant._starts, "submit", submit)
    bench.plant.start("zero")
    bench.frame()
    bench.frame()
    assert bench.phase == "ended" and bench.beside is None
    bench.plant.close()


def test_what_is_set_in_the_lab_is_set_there_or_taken_back() -> None:
    bench = Bench()
    beside, simulation = bench.run(), bench.lab.simulation
    refused = [c.Reset(), c.LookAt(1.0), c.SetRunning(False), c.Hold(), c.Set("payload", 0.1)]
    refused += [c.Set("wall", True), c.Set("rate", 0.5), c.StepOnce(), c.ResetParameters()]
    refused += [c.ChooseLaw(SIDE, "trajectory_tracking"), c.MovePoint(0, np.zeros(2))]
    before = simulation.parameters, simulation.settings, simulation.editor.design
    for command in refused:
        bench.lab.show_message("")
        do(bench.lab, command)
        bench.frame()
        assert bench.lab.message == str(Message("plant.cannot")), command
    assert before == (simulation.parameters, simulation.settings, simulation.editor.design)
    allowed = [c.Set("K1", 49.0), c.Set("speed", 0.5), c.ChoosePath("ellipse")]
    do(bench.lab, *allowed, c.ChooseLaw(SIDE, "waiting_clock"), c.ChooseLaw(LEFT, "event_based"))
    bench.frame()
    acting = beside.link._acting
    assert (acting.design.parameters.K1, acting.design.parameters.speed) == (49.0, 0.5)
    assert beside.link.report().law == "waiting_clock"
    assert np.array_equal(acting.curve.coefficients, simulation.editor.blend.target.coefficients)
    design = simulation.editor.design
    do(bench.lab, c.ChoosePath("segment"))  # open, which another controller would follow
    bench.frame()
    assert simulation.editor.design is design and "another controller" in bench.lab.message
    assert value_of(simulation.parameters, "K1") == 49.0
    bench.plant.close()


def test_no_message_does_what_cannot_be_done_to_an_arm() -> None:
    """Whatever the page that drives sends: the plant runs on, and only what may be set changes."""
    bench, draw, refused = Bench(), random.Random(1), 0
    simulation = bench.lab.simulation
    bench.run()
    before, began = values_of(simulation.parameters), simulation.time
    sets = [f'{{"do": "Set", "name": "{name}", "value": 0.2}}' for name in ("speed", "payload")]
    for number in range(150):
        sent = sets[number % 2] if number % 10 < 2 else str(wild_message(draw))
        try:
            message = read_message(sent)
        except NoPageMessage:
            continue
        if isinstance(message, Command):
            bench.lab.show_message("")
            do(bench.lab, message)
            refused += bench.lab.message == str(Message("plant.cannot"))
        assert bench.beside is not None
        bench.beside.measures()
        bench.plant.beat()
        time = simulation.time
        bench.frame()
        assert bench.phase == "running" and bench.beside.answer is not None
        assert bench.beside.answer[1] == 0 and simulation.time > time
    assert refused > 25 and simulation.time > began
    after = values_of(simulation.parameters)
    changed = [name for name, value in after.items() if value != before[name]]
    assert "speed" in changed
    assert all(settable(name, simulation.parameters) for name in changed)
    assert simulation.entry.name == "two_link_arm" and simulation.measured == SIDE
    assert simulation.chosen_laws[SIDE] in CHOICE.laws
    bench.plant.close()


def test_the_plant_is_shown_as_it_measures_and_the_other_robot_begins_there() -> None:
    bench = Bench()
    q = bench.run().place
    plant, other = bench.lab.simulation.runs[SIDE], bench.lab.simulation.runs[LEFT]
    assert np.array_equal(plant.fields()["q"], q) and np.allclose(other.fields()["q"], q)
    for _ in range(20):
        assert bench.beside is not None
        bench.beside.measures(q)
        bench.plant.beat()
        bench.frame()
    shown = plant.shown()
    assert np.array_equal(shown["q"], q) and not np.array_equal(other.fields()["q"], q)
    assert bench.beside is not None and bench.beside.answer is not None
    assert np.array_equal(shown["u"], bench.beside.answer[2])
    on_path = bench.lab.simulation.editor.curve.at(shown["theta"])[0]
    away = np.linalg.norm(shown["y"] - plant.robot.frame.lift(on_path))
    assert plant.distance == pytest.approx(float(away), abs=1e-6)
    times, samples = bench.lab.simulation.history.samples(0.0, 9.0, 99)
    assert len(times) > 10 and np.isfinite(samples).all()
    bench.plant.close()


@given(st.lists(st.tuples(st.sampled_from("abc"), st.sampled_from(["come", "leave"])), max_size=12))
@settings(max_examples=20)
def test_one_page_drives_that_has_the_key_and_is_here(events: list[tuple[str, str]]) -> None:
    desk = PlantDesk(Lab(loop_cache(), ROBOTS["two_link_arm"]), CHOICE)
    driver, here = "", dict[str, list[Callable[[], None]]]()
    for name, event in events:
        if event == "come" and name not in here:
            ends = here[name] = list[Callable[[], None]]()
            visit = SimpleNamespace(
                hello=SimpleNamespace(drives="wrong" if name == "c" else desk.key),
                address="127.0.0.1",
                language="",
                at_end=ends.append,
            )
            drives = desk.sit(cast(Visit, visit))
            assert drives == (not driver and name != "c")
            assert desk.shown(drives).find()[1] == (0 if drives else 1)
            driver = name if drives else driver
        elif event == "leave" and name in here:
            for end in here.pop(name):
                end()
            driver = "" if name == driver else driver
    desk.plant.close()


def test_a_key_from_another_machine_or_none_does_not_drive() -> None:
    desk = PlantDesk(Lab(loop_cache(), ROBOTS["two_link_arm"]), CHOICE)
    for address, key in (("192.168.1.9", desk.key), ("127.0.0.1", ""), ("::1", "ä")):
        hello = SimpleNamespace(drives=key)
        visit = SimpleNamespace(hello=hello, address=address, language="", at_end=lambda _: None)
        assert not desk.sit(cast(Visit, visit))
    desk.hear(DrivePlant(what="start", at_fault="hold"))
    assert desk.plant._wanted == "hold"
    desk.hear(DrivePlant(what="stop"))
    assert not desk.plant._wanted
    desk.plant.close()
