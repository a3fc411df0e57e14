"""One user's lab: the simulation, and the commands, lessons and messages around it.

Commands come in through `post` from any thread and are applied by the simulation thread at the
beginning of its next frame.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from dataclasses import dataclass
from math import inf
from time import thread_time
from typing import Any, ClassVar

import numpy as np
from typing_extensions import override

from onpath.app.lab.advance_together import Frame, advance_together
from onpath.app.lab.breakdown import Breakdown
from onpath.app.lab.identification.in_background import Identification
from onpath.app.lab.lesson_run import LessonRun
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.plant_state import PlantState
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.shown_log import ShownLog
from onpath.app.lab.simulation import Simulation
from onpath.lessons.course import NO_LESSONS, Course
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.closed_loop.simulation import has_level_set
from onpath.models.control.forecast import UNMODELLED, doubts, forecasts
from onpath.models.control.settable import changed
from onpath.models.errors import Message
from onpath.models.systems.catalogue import FIVE_BAR, RobotEntry
from onpath.models.systems.law_parameters import DISTANCE, LEVEL_SET

MOST_COMMANDS = 500  # commands in the queue; further ones are dropped
PATIENCE = 15  # frames of waiting after which a lab says that it waits
BRIEFLY = 1e-3  # [s] that a frame waits for work in another thread


class Command:
    """A command to a lab: a frozen record that knows how to apply itself.

    Fields, keys, the mouse and the teacher's page make commands in any thread and pass them to
    `Lab.post`. The contents of a command are checked once, when it is applied.

    Attributes:
        from_teacher: whether it comes from a teacher; such commands are applied even while the lab
            is frozen.
        is_answer: whether it answers a question, which is possible even while the lab is frozen.
        lets_time_run: whether it lets time run, and so is refused while a prediction is pending.
    """

    __slots__ = ()
    from_teacher: ClassVar[bool] = False
    is_answer: ClassVar[bool] = False
    lets_time_run: ClassVar[bool] = False

    def apply(self, lab: Lab) -> None:
        """Apply the command, in the simulation thread.

        Raises:
            ValueError: it is not possible now; the message tells the user why.
        """
        raise NotImplementedError

    def suits(self, lab: Lab, plant: PlantState) -> bool:
        """Whether it can be done while a robot of the lab is a plant elsewhere."""
        del lab, plant
        return False

    def parts(self, lab: Lab) -> Iterator[Command]:
        """The commands of which it consists; between two of them, other labs have their turn."""
        del lab
        yield self


@dataclass(frozen=True, slots=True, eq=False)
class Await(Command):
    """A part of a command that is done when another thread has done its work.

    Attributes:
        work: of the other thread.
    """

    work: Future[Any]

    @override
    def apply(self, lab: Lab) -> None:
        wait([self.work], BRIEFLY)


class Lab:
    """A simulated lab and its user's state.

    Args:
        loop_cache: provides the closed loops.
        entry: the initial robot.
        course: the available lessons.

    Attributes:
        simulation: the simulated lab.
        lessons: the user's progress through the lessons.
        script: player of the running script, or None.
        message: message to the user.
        messages: number of messages shown so far; one may be shown again with the same words.
        message_level: "info", "warning", "error", "replay" while it is shown why a robot has
            stopped, or "stop" while the teacher has stopped the lab.
        refused: why a setting, or the law that was typed for a side, was refused last, by name
            of the setting or side.
        shared: the last share code made.
        log: of a real arm, drawn over the plots outside of lessons, or None.
        frozen: whether the teacher has stopped this lab.
        asked: number of commands given by the user.
        unsaved: why the latest changes are not saved, a key of the catalogues; empty if they are.
        breakdown: what can be done when a robot has stopped.
        identification: of the controllers' model.
        watch: called in every frame, or None.
        plant: that stands in the place of a robot, or None.
    """

    def __init__(
        self, loop_cache: LoopCache, entry: RobotEntry = FIVE_BAR, course: Course = NO_LESSONS
    ) -> None:
        self._inbox: deque[Command] = deque(maxlen=MOST_COMMANDS)
        self._parts: Iterator[Command] = iter(())  # of the command that is being applied, after
        self._part: Command | None = None  # the next one
        self._waiting = 0  # frames for which something has been waiting
        self.simulation = Simulation(loop_cache, entry)
        self.lessons = LessonRun(course)
        self.script: ScriptPlayer[Command] | None = None
        self.message, self.message_level, self.messages = "", "info", 0
        self._holds: Callable[[], bool] | None = None  # whether the message has a reason
        self._caution: Message | None = None
        self._forecast: tuple[tuple[object, ...], Message | None] | None = None
        self.refused: dict[str, str] = {}
        self.shared = ""
        self.log: ShownLog | None = None
        self.frozen, self.asked = False, 0
        self.unsaved = ""
        self.breakdown = Breakdown()
        self.identification = Identification(loop_cache.at_once)
        self.watch: Callable[[Lab], None] | None = None
        self.plant: PlantState | None = None

    @property
    def words(self) -> Words:
        """Texts in the user's language."""
        return self.lessons.words

    @property
    def shown_log(self) -> ShownLog | None:
        """The log, unless it is of another robot, or a lesson is open."""
        log = self.log
        shows = self.lessons.lesson is None and log is not None and log.fits(self.simulation.robot)
        return log if shows else None

    @property
    def locked(self) -> Message | None:
        """Why time must not run now; None if it may."""
        return self.lessons.locked

    # Commands

    def post(self, command: Command) -> None:
        """Queue a command. Thread-safe."""
        self._inbox.append(command)

    @property
    def has_commands(self) -> bool:
        """Whether commands wait to be applied."""
        return self._part is not None or bool(self._inbox)

    @property
    def waits(self) -> bool:
        """Whether commands, or robots whose loops are being made, have been waiting for a while."""
        return self._waiting > PATIENCE

    def drain(self, most: float = inf) -> float:
        """Apply the queued commands. If one is refused, the user is told why.

        Args:
            most: processor time after which the remaining commands wait, [s]; one that consists of
                parts waits between two of them, and simulated time with it.

        Returns:
            Processor time of the commands in this thread, [s]; what it waits for others is not
            the user's doing.
        """
        begun = thread_time()
        self._apply_commands(begun + most)
        if self._part is not None:
            return thread_time() - begun
        if not self.frozen:
            self._play()
        taken = thread_time() - begun
        self._follow()
        return taken

    def _apply_commands(self, until: float) -> None:
        """Apply queued commands until a processor time, [s], or until one has to wait for loops."""
        applied = 0
        while self.has_commands and not self.simulation.has_to_step and thread_time() < until:
            self._apply_next()
            applied += 1
            if isinstance(self._part, Await) and until < inf:
                break  # others have their turn meanwhile
        is_behind = self._part is not None or self.simulation.lacks_loops
        is_behind = is_behind or (self.has_commands and not applied)
        self._waiting = self._waiting + 1 if is_behind else 0

    def _follow(self) -> None:
        """Do what follows from the frame before: models, lessons, messages, and who watches."""
        self._adopt_identified()
        self._end_level_set()
        self.lessons.follow(self)
        if self._holds is not None and not self._holds():
            self.clear_message()
        if self.watch is not None:
            self.watch(self)

    def _apply_next(self) -> None:
        """Apply the next part of a command, or begin the next command."""
        if self._part is None:
            command = self._inbox.popleft()
            if not command.from_teacher:
                self.asked += 1
                if refusal := self._refusal(command):
                    level = "stop" if self.frozen else "warning"
                    text = self.words.sentence(refusal)
                    self.show_message(text, level, lambda: self._refusal(command) is not None)
                    return
                if self.breakdown.interrupt(self.simulation):
                    self.clear_message()
            self._parts = command.parts(self)
        try:
            if self._part is not None:
                self._part.apply(self)
            self._part = next(self._parts, None)
        except ValueError as error:
            self._part = None
            self.show_message(self.words.sentence(error), "warning")
        self.show_faults()

    def _refusal(self, command: Command) -> Message | None:
        """Why a user's command is refused now; None if it is not."""
        if self.frozen and not command.is_answer:
            return Message("class.frozen")
        if self.plant is not None and not command.suits(self, self.plant):
            return Message("plant.cannot")
        return self.locked if command.lets_time_run else None

    def _adopt_identified(self) -> None:
        """Give the controllers the requested model as soon as it has been identified."""
        simulation = self.simulation
        try:
            learned = self.identification.take()
            if learned is not None and learned.robot.core == simulation.robot.core:
                before = simulation.parameters
                simulation.set_parameters(learned.believed(before))
                simulation.note("identify")
                self.show_message(learned.report(before, self.words))
        except ValueError as error:
            self.show_message(self.words.sentence(error), "warning")

    def _end_level_set(self) -> None:
        """Return to the distance, and say so, if the path no longer has a level set."""
        simulation = self.simulation
        now, path = simulation.parameters, simulation.editor.blend.target
        if now.across == LEVEL_SET and not has_level_set(path):
            simulation.set_parameters(changed(now, "across", DISTANCE))
            simulation.note("set", "across")
            self.remark(self.words("say.level_set_ends"))

    def _play(self) -> None:
        """Apply the commands of the running script that are due."""
        if self.script is None:
            return
        try:
            if self.script.play(self.simulation, lambda command: command.apply(self)):
                self.script = None
        except ValueError as error:
            self.script = None
            self.show_message(self.words.sentence(error), "warning")

    # The simulated lab

    def frame(self, seconds: float) -> Frame:
        """Simulate `seconds` if running and not frozen; see `advance_together`."""
        if not self.frozen and self._part is None:
            yield from self.simulation.frame(seconds)
            self.show_faults()
            if self.breakdown.follow(self.simulation, seconds / self.simulation.settings.rate):
                self.clear_message()

    def advance(self, seconds: float) -> None:
        """Simulate `seconds` of simulated time of this lab alone."""
        advance_together([self.frame(seconds)])

    def set_up(self, setup: Setup) -> None:
        """Apply a set-up, with both robots at the start of the path. The old path is one undo away.

        Raises:
            ValueError: the set-up is impossible; the lab is unchanged.
        """
        restore(self.simulation, setup)
        self.refused.clear()
        self.show_message("")

    def return_to_present(self) -> None:
        """Stop viewing the past; the history is kept, and time runs if it ran before."""
        if self.simulation.viewing is not None:
            self.simulation.return_to_present()
            self.remark(self.words("say.present"))

    # Messages

    @property
    def notice(self) -> tuple[str, str]:
        """The message on the page, and its level.

        It is preceded by a warning while nothing is saved.
        """
        message, level = self.message, self.message_level
        if not self.unsaved:
            return message, level
        is_error = bool(message) and level == "error"
        text = f"{self.words(self.unsaved)} {message}".strip()
        return text, "error" if is_error else "warning"

    def show_message(
        self, message: str, level: str = "info", holds: Callable[[], bool] | None = None
    ) -> None:
        """Show a message to the user; an empty one clears the last.

        Args:
            holds: whether there is still reason for it; if not, it is cleared.
        """
        self.message, self.message_level, self._holds = message, level, holds
        self.messages += message != ""

    def clear_message(self) -> None:
        """Clear the message, or show again why robots are stopped."""
        self.message, self.message_level, self._holds = "", "info", None
        if text := self.fault_words("say.stopped"):
            self.message, self.message_level = text, "error"
        elif self._caution is not None:
            self.message = self.words.sentence(self._caution)
            self.message_level = "info" if self._caution == UNMODELLED else "warning"

    def remark(self, message: str) -> None:
        """Show a message, unless a robot is stopped, which is more important."""
        self.clear_message()
        if not self.message:
            self.show_message(message)

    def show_faults(self) -> None:
        """Report robots that have just stopped, and laws that cannot be used or compiled."""
        faults, remarks = self.simulation.faults, self.simulation.law_changes.remarks
        caution = self._foreseen()
        if caution != self._caution:
            self._caution = caution
            self.clear_message()
        while remarks:
            self.show_message(self.words.sentence(remarks.pop(0)), "warning")
        if faults:
            faults.clear()
            self.show_message(self.fault_words("say.stopped"), "error")

    def _foreseen(self) -> Message | None:
        """A problem with the settings that is foreseen before the robots run, or None.

        The zero dynamics of a flexible link are shown at its settings. While a prediction is
        pending, only the caution of the robot's catalogue entry is given.
        """
        simulation, robot = self.simulation, self.simulation.robot
        caution = simulation.entry.caution(simulation.parameters)
        if caution or self.locked:
            return caution
        path, laws = simulation.editor.blend.target, tuple(simulation.chosen_laws.values())
        inputs = robot, laws, simulation.parameters, path
        if self._forecast is None or self._forecast[0] != inputs:
            if robot.system.modes:
                messages = doubts(robot, laws, simulation.parameters, path)
            else:
                q = robot.rest(robot.frame.lift(path.at(np.array(path.begin))))
                messages = forecasts(robot, laws, simulation.parameters, q, path)
            self._forecast = inputs, next(iter(messages), None)
        return self._forecast[1]

    def fault_words(self, key: str, **more: str) -> str:
        """The message of a key about the robot that stopped last; empty if none has stopped."""
        runs = self.simulation.runs.items()
        faults = {side: run.diverged for side, run in runs if run.diverged is not None}
        if not faults:
            return ""
        side, fault = max(faults.items(), key=lambda each: each[1].time)
        titles = side_titles(self.simulation.laws, self.words)
        return self.words(
            key,
            robot=titles[side],
            time=f"{fault.time:.2f}",
            reason=self.words.sentence(fault.reason),
            **more,
        )
