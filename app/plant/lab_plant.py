"""A lab of which one robot is a plant elsewhere: the lab follows the plant's controller, and what
is set in the lab is set there."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from typing_extensions import override

from onpath.app.lab.closed_loop_run import MeasuredRobot
from onpath.app.lab.lab import Lab
from onpath.app.lab.plant_state import SIDE, PlantState
from onpath.app.plant.controller_process import (
    ASKED,
    LINGER,
    Address,
    ControllerPlan,
    ControllerProcess,
)
from onpath.app.plant.plant_link import SILENCE, PlantReport
from onpath.app.simulation.scheduled_lab import LabDisplay
from onpath.models.control.settable import specs, value_of, values_of
from onpath.models.controller.functions import AT_FAULT, STOPPED
from onpath.models.errors import CodedError, Message
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import Parameters

log = logging.getLogger(__name__)

LOST = 2.0  # [s] without a sign of life of the page that drives, after which it ends
SILENT = 1.0  # [s] without a measurement, after which a plant that has ended is gone
TOLD = 1.0  # [s] for which the longest lateness is shown


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantChoice:
    """A plant that a lab is to drive.

    Attributes:
        address: where its controller listens, once it has been started.
        laws: that can act on it; the first acts first.
        at_fault, fastest: see `onpath.controller`.
        silence, asked, own: see `ControllerPlan`.
    """

    address: Address
    laws: tuple[str, ...] = ("path_following",)
    at_fault: str = "zero"
    fastest: float
    silence: int = SILENCE
    asked: float = ASKED
    own: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class _Told:
    """What the controller has been told last."""

    parameters: Parameters
    design: PathDesign
    law: str


class LabPlant(LabDisplay):
    """Drives the plant in a lab, whose simulated robots stand still until it measures.

    `start`, `stop` and `beat` are called by the page that drives, in any thread; the rest is for
    the simulation thread, in each frame. If that stands still for a second, the controller ends.

    Args:
        clock: does not jump, [s].
        begin: makes the process; tests replace it.
    """

    def __init__(
        self,
        lab: Lab,
        choice: PlantChoice,
        clock: Callable[[], float] = time.monotonic,
        begin: Callable[[ControllerPlan, Address], ControllerProcess] = ControllerProcess,
    ) -> None:
        self._lab, self._choice, self._clock, self._make = lab, choice, clock, begin
        self._state = PlantState(
            address=_shown(choice.address), laws=choice.laws, at_fault=choice.at_fault
        )
        self._lock = threading.Lock()  # of what is wanted, and of whether it is live
        self._wanted = ""  # torque at a fault, of a start that somebody wants
        self._stopped: Message | None = None  # why it is to end, or has been told to
        self._beside: ControllerProcess | None = None
        self._coming: Future[ControllerProcess] | None = None
        self._told: _Told | None = None
        self._heard = self._sent = self._since = clock()
        self._starts = ThreadPoolExecutor(1, "plant")
        simulation = lab.simulation
        simulation.measured = SIDE
        simulation.choose_law(SIDE, choice.laws[0])
        simulation.restart()
        simulation.running = False
        lab.plant = self._state

    # From the page that drives

    def start(self, at_fault: str) -> None:
        """Start a controller, unless there is one.

        Raises:
            ValueError: there is no such torque at a fault.
        """
        if at_fault not in AT_FAULT:
            raise unknown_name(at_fault, [*AT_FAULT], "at_fault")
        self.beat()
        with self._lock:
            if self._state.can_start:
                self._wanted = at_fault

    def stop(self, why: Message = Message("plant.stopped")) -> None:  # noqa: B008
        """End it now, also while the simulation thread is busy."""
        with self._lock:
            self._wanted = ""
            if not self._state.is_live or self._stopped is not None:
                return
            self._stopped = why
        if (beside := self._beside) is not None:
            with suppress(OSError):  # the next frame notices
                beside.stop()

    def beat(self) -> None:
        """Note that the page is there."""
        self._heard = self._clock()

    def close(self) -> None:
        """End it for good. A plant that runs gets the torque for a fault for a while."""
        self.stop()
        self._starts.shutdown()
        if self._coming is not None and self._coming.exception() is None:
            self._coming.result().close()
        if self._beside is not None:
            log.info("the plant's torque is now: %s, for up to %g s", self._state.at_fault, LINGER)
            self._beside.leave()
            log.info("the plant's controller has ended")

    # In the simulation thread

    @property
    @override
    def is_outdated(self) -> bool:
        return False

    @override
    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        return True

    @override
    def show(self, lab: Lab, frame: int, stride: float) -> None:
        """Follow the plant."""
        if self._clock() > self._heard + LOST:
            self.stop(Message("plant.page_lost"))
        state = self._state
        if self._beside is not None:
            state = self._followed(self._beside)
        elif self._coming is not None:
            state = self._come(self._coming)
        elif self._wanted:
            state = self._begun()
        lab.simulation.running = state.phase == "running"
        self._state = lab.plant = state

    @override
    def refresh(self, lab: Lab, achieved: float) -> None:
        pass

    @override
    def send(self) -> None:
        pass

    def _begun(self) -> PlantState:
        """The state once a start that is wanted has begun, unless somebody has stopped it."""
        with self._lock:
            at_fault, self._wanted = self._wanted, ""
            if not at_fault:
                return self._state
            self._stopped = None
            self._state = replace(self._state, phase="starting", at_fault=at_fault, cause=None)
        simulation, choice = self._lab.simulation, self._choice
        now, parameters = self._now, simulation.parameters
        plan = ControllerPlan(
            robot=simulation.entry,
            paths={now.design.name: now.design.curve},
            laws=(now.law, *(law for law in choice.laws if law != now.law)),
            at_fault=at_fault,
            fastest=choice.fastest,
            settings=values_of(parameters),
            silence=choice.silence,
            asked=choice.asked,
            own=choice.own,
        )
        self._told = now
        self._coming = self._starts.submit(self._make, plan, choice.address)
        return self._state

    def _come(self, coming: Future[ControllerProcess]) -> PlantState:
        """The controller, as soon as it listens."""
        if not coming.done():
            return self._state
        self._coming = None
        if (error := coming.exception()) is not None:
            if not isinstance(error, ValueError | OSError):
                raise error
            return self._over(_why(error))
        self._beside, self._sent = coming.result(), self._clock()
        if self._stopped is not None:
            return self._followed(self._beside)
        address = _shown(self._beside.address)
        return replace(
            self._state, phase="waiting", address=address, late=0.0, latest=0.0, answered=0
        )

    def _followed(self, beside: ControllerProcess) -> PlantState:
        try:
            if self._state.is_live:
                self._change(beside)
            report = beside.report() if self._stopped is None else beside.stop()
        except OSError as error:
            beside.close()
            return self._over(_why(error))
        return self._reported(beside, report)

    def _reported(self, beside: ControllerProcess, report: PlantReport) -> PlantState:
        now, state = self._clock(), self._state
        if self._stopped is not None and not report.started:
            beside.close()
            return self._over(self._stopped)
        if report.rows:
            self._sent = now
            self._show(report, begins=state.phase in ("starting", "waiting"))
        phase = "ended" if report.code else "running" if report.started else "waiting"
        if phase == "ended" and now > self._sent + SILENT:
            beside.close()
            return self._over(state.cause or self._cause(beside, report))
        late = max(state.late, report.late)
        if now > self._since + TOLD:
            self._since, late = now, report.late
        return replace(
            state,
            phase=phase,
            cause=state.cause or self._cause(beside, report),
            sends=phase == "ended",
            late=late,
            latest=report.latest,
            answered=report.answered,
        )

    def _over(self, cause: Message | None) -> PlantState:
        """The state without a controller."""
        self._beside = None
        return replace(self._state, phase="ended", cause=cause, sends=False)

    def _cause(self, beside: ControllerProcess, report: PlantReport) -> Message | None:
        """Why it has ended; None: it has not."""
        if self._stopped is not None or not report.code:
            return self._stopped
        if report.code == STOPPED:
            return Message("plant.stood_still")
        return beside.reason(report)

    def _show(self, report: PlantReport, begins: bool) -> None:
        """Show the last measurement; at the first one, the other robot begins there, too."""
        simulation = self._lab.simulation
        n = simulation.robot.system.n
        _, *numbers = report.rows[-1]
        q, v, u = np.split(np.nan_to_num(np.array(numbers)), [n, 2 * n])
        curve = simulation.editor.curve
        if begins:
            simulation.restart()
            for run in simulation.runs.values():
                run.place(q, v, curve)
        now = MeasuredRobot(q=q, v=v, u=u, theta=report.theta, theta_ref=report.theta_ref)
        simulation.runs[SIDE].follow(now, curve)

    @property
    def _now(self) -> _Told:
        simulation = self._lab.simulation
        law = simulation.chosen_laws[SIDE]
        return _Told(simulation.parameters, simulation.editor.design, law)

    def _change(self, beside: ControllerProcess) -> None:
        """Tell the controller what has been set in the lab, or the lab that it cannot be."""
        told, now = self._told, self._now
        assert told is not None
        try:
            if now.parameters != told.parameters:
                beside.set(**_changes(told.parameters, now.parameters))
            if now.design is not told.design:
                beside.follow(now.design.curve)
            if now.law != told.law:
                beside.use(now.law)
            self._told = now
        except ValueError as error:
            self._take_back(told)
            self._lab.show_message(self._lab.words.sentence(error), "warning")

    def _take_back(self, told: _Told) -> None:
        simulation = self._lab.simulation
        simulation.set_parameters(told.parameters)
        simulation.editor.commit(told.design)
        simulation.choose_law(SIDE, told.law)


def _changes(before: Parameters, now: Parameters) -> dict[str, float | str]:
    return {
        name: value
        for name in specs(now)
        if (value := value_of(now, name)) != value_of(before, name)
    }


def _shown(address: Address) -> str:
    host, port = address
    return f"udp://[{host}]:{port}" if ":" in host else f"udp://{host}:{port}"


def _why(error: BaseException) -> Message:
    """An error in words."""
    if isinstance(error, CodedError):
        return error.message
    return Message("plant.failed", {"reason": str(error)})
