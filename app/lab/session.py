"""One user's lab: two robots, one path, one clock. No viser in it; one thread at a time.

Commands come in through `post` from any thread and are applied by the simulation thread at the
beginning of its next frame.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from math import inf
from operator import is_
from time import perf_counter

import numpy as np

from onpath.app.lab import commands
from onpath.app.lab.apply_class import apply
from onpath.app.lab.class_commands import ClassCommand
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.app.lab.lesson_run import LessonRun
from onpath.app.lab.looking_back import Timeline
from onpath.app.lab.loop_cache import LoopCache
from onpath.app.lab.path_editor import PathEditor
from onpath.app.lab.plot_samples import sample_layout, samples_of
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.lab.segments import HistoryFrame, Inputs, Instant
from onpath.app.lab.snapshot import PathView
from onpath.lessons.course import NO_LESSONS, Course
from onpath.lessons.record import ROLES, Happening
from onpath.lessons.schema import RobotName
from onpath.models.arrays import Array
from onpath.models.control.laws import NAMES
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.systems.catalogue import FIVE_BAR, RobotEntry
from onpath.models.systems.parameters import TICK, Parameters, time_step
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)

MOST_COMMANDS = 500  # waiting at once; a flood beyond is dropped
MOST_TICKS = 200  # in one frame
MOST_HAPPENINGS = 1500  # 0.2 MB


class Session:
    """The state of one lab.

    Attributes:
        runs: the two closed loops, by controller.
        editor: the path.
        history: the last minute.
        time: simulated, [s].
        viewing: the past instant being looked at, [s], or None.
        put_aside: what going on from the past has forgotten, or None.
        grips: what holds the robots back, and what pulls at them.
        happenings: what was done and came about, for the lessons' checks.
        run_number: how often the robots have been set back to the start.
        script: what is being done by itself, or None.
        lessons: the way through the lessons.
        watch: called at every frame, or None.
        shared: the share code asked for last.
        locked: why time must not run now; empty when it may.
        frozen: whether the teacher has stopped this lab.
        asked: how many commands the user has given.
    """

    def __init__(
        self, store: LoopCache, entry: RobotEntry = FIVE_BAR, course: Course = NO_LESSONS
    ) -> None:
        self._store = store
        self._inbox: deque[commands.Command | ClassCommand] = deque(maxlen=MOST_COMMANDS)
        self._benches: dict[str, tuple[Parameters, PathEditor]] = {}
        self.history = History(self._samples)
        self._inputs: Inputs | None = None
        self.presets: Mapping[str, PathDesign] = presets()
        self.running = True
        self.rate = 1.0
        self.copy = True
        self.exaggeration = 1.0  # of a deflection, in the drawing alone
        self.path_view: PathView | None = None  # the last one drawn, while it is still right
        self.message, self.message_level = "", "info"
        self.happenings: deque[Happening] = deque(maxlen=MOST_HAPPENINGS)
        self.run_number = 0
        self.script: ScriptPlayer | None = None
        self.locked = ""
        self.frozen, self.asked = False, 0
        self.lessons = LessonRun(course)
        self.watch: Callable[[Session], None] | None = None
        self.shared = ""
        self._set_up(entry)

    # The robot

    def choose_robot(self, entry: RobotEntry) -> None:
        """Another robot, with the parameters and the path that it had before."""
        if entry is not self.entry:
            self._benches[self.entry.name] = (self.parameters, self.editor)
            self._set_up(entry)
            self.note("robot", entry.name)
            self.show_message("")

    def set_parameters(self, parameters: Parameters) -> None:
        """New numbers; a structural one makes another robot, which starts anew."""
        if self.robot.extra_fields:
            self.history.settle()  # their samples depend on parameters
        self.parameters = parameters
        robot = self.entry.make(parameters)
        if robot is not self.robot:
            self.robot = robot
            self.editor.robot = robot
            self._restart()

    def _set_up(self, entry: RobotEntry) -> None:
        self.entry = entry
        parameters, editor = self._benches.get(entry.name, (entry.lab, None))
        self.parameters: Parameters = parameters
        self.robot: Robot = entry.make(parameters)
        self.editor = editor or PathEditor(self.robot, self.presets["circle"])
        self.path_view = None
        self._restart()

    # Commands

    def post(self, command: commands.Command | ClassCommand) -> None:
        """Ask for something; from any thread."""
        self._inbox.append(command)

    def drain(self, most: float = inf) -> float:
        """Apply what has been asked for. A command that makes no sense is answered in words.

        Args:
            most: of computing, after which the rest waits, [s].

        Returns:
            How long the commands took, [s].
        """
        begun = perf_counter()
        while self._inbox and perf_counter() - begun < most:
            command = self._inbox.popleft()
            if not isinstance(command, ClassCommand):
                self.asked += 1
                if refusal := self._refusal(command):
                    self.show_message(refusal, "warning")
                    continue
            try:
                apply(command, self)
            except ValueError as error:
                self.show_message(self.lessons.words.sentence(str(error)), "warning")
        taken = perf_counter() - begun
        if not self.frozen:
            self._play()
        self.lessons.follow(self)
        if self.watch is not None:
            self.watch(self)
        return taken

    def _refusal(self, command: commands.Command) -> str:
        """Why a command of the user's is not applied now; empty when it is."""
        if self.frozen:
            return self.lessons.words("class.frozen")
        return self.locked if isinstance(command, commands.LETS_TIME_RUN) else ""

    def _play(self) -> None:
        """What a script says."""
        try:
            if self.script is not None and self.script.play(self):
                self.script = None
        except ValueError as error:
            self.script = None
            self.show_message(self.lessons.words.sentence(str(error)), "warning")

    def note(self, name: str, detail: str = "", controllers: tuple[str, ...] = NAMES) -> None:
        """Remember that something has happened."""
        what = Happening(self.run_number, self.time, name, detail, _roles(controllers))
        self.happenings.append(what)

    def show_message(self, message: str, level: str = "info") -> None:
        """Show a sentence to the user."""
        self.message, self.message_level = message, level

    def clear_message(self) -> None:
        """Say nothing more, but for robots that still stand still."""
        self.show_message("")
        for name, run in self.runs.items():
            if run.diverged is not None:
                self._tell_divergence(name)

    # Time

    def advance(self, seconds: float) -> None:
        """Simulate `seconds` of simulated time, if running."""
        if self.frozen:
            return
        if not self.running:
            self._owed = 0.0
            if self.viewing is None:
                self._bend(seconds)
            return
        dt = time_step(self.parameters)
        self._owed += seconds
        ticks = min(int(self._owed / dt + 1e-9), MOST_TICKS)
        self._owed = min(self._owed - ticks * dt, MOST_TICKS * dt)
        if ticks:
            self.simulate(ticks)

    def simulate(self, ticks: int) -> None:
        """Both robots by some ticks, with the same path, settings and push."""
        dt = time_step(self.parameters)
        self._bend(ticks * dt)
        curve, runs = self.editor.curve, list(self.runs.values())
        states, most = [run.state for run in runs], [run.max_distance for run in runs]
        rows, distances = [run.row for run in runs], [run.distance for run in runs]
        for run in runs:
            self._advance(run, ticks, dt)
        inputs = {run.controller: run.input() for run in runs}
        if self._inputs is None or not self._inputs.are(curve, dt, inputs.values()):
            self._inputs = Inputs(curve, dt, inputs)
        self.history.append(
            HistoryFrame(self.time, ticks, self._inputs, states, most, rows, distances)
        )
        self.time += ticks * dt

    def _advance(self, run: ClosedLoopRun, ticks: int, dt: float) -> None:
        was, name = run.diverged, run.controller
        editor, push = self.editor, self.grips.pushes[name]
        run.advance(
            self._store, self.parameters, editor.curve, editor.table, push, ticks, self.time, dt
        )
        if run.diverged is not None and was is None:
            self._tell_divergence(name)

    def _bend(self, seconds: float) -> None:
        """Let an edit of the path blend in."""
        if self.editor.advance(seconds):
            for run in self.runs.values():
                run.project(self.editor.curve)

    def step_once(self) -> None:
        """One step of a paused lab: the controller's next action, at least a millisecond."""
        if self.locked:
            raise ValueError(self.locked)
        self.running = False
        dt = time_step(self.parameters)
        self.simulate(max(1, round(max(TICK, 1 / self.parameters.control_rate) / dt)))

    def reset(self) -> None:
        """Both robots to the start, at rest. The past is forgotten; path and parameters stay."""
        self._restart()
        self.note("reset")
        self.show_message("")

    def _restart(self) -> None:
        self.run_number += 1
        self.time = 0.0
        self._owed = 0.0
        self._now: Instant | None = None
        self.viewing: float | None = None
        self.put_aside: Timeline | None = None
        self.history.clear()
        start = self.start_point(self.editor.curve)
        curve = self.editor.curve
        self.runs = {
            name: ClosedLoopRun(self.robot, name, self.parameters, curve, start) for name in NAMES
        }
        self.grips = ExternalForces(self.robot, self.runs, self.note)

    def start_point(self, curve: Curve) -> Array:
        """Where a run begins: on the path, (p,), [m]."""
        return self.robot.frame.lift(curve.at(np.array(0.0)))

    def _tell_divergence(self, name: str) -> None:
        run = self.runs[name]
        assert run.diverged is not None
        self.note("diverged", controllers=(name,))
        words = self.lessons.words
        said = words(
            "say.stopped",
            robot=words(f"controller.{name}.title"),
            time=f"{run.diverged.time:.2f}",
            reason=words.sentence(run.diverged.reason),
        )
        self.show_message(said, "error")

    def targets(self, controller: str) -> list[str]:
        """Which robots a gesture at `controller` acts on."""
        return list(NAMES) if self.copy else [controller]

    # What is kept of an instant

    @property
    def sample_layout(self) -> Layout:
        """See `app.lab.plot_samples`."""
        return sample_layout(self.robot)

    def instant(self) -> Instant:
        """Now; the same object until something changes."""
        runs, now = self.runs.values(), self._now
        made_of = [self.editor.curve, self.parameters, *[run.row for run in runs]]
        if now is None or now.time != self.time or not all(map(is_, made_of, self._made_of)):
            states, most = [run.state for run in runs], [run.max_distance for run in runs]
            now = self._now = Instant(self.time, states, most, self.sample())
            self._made_of = made_of
        return now

    def sample(self) -> np.ndarray:
        """Now, shape (robots, sample_layout.size)."""
        runs = self.runs.values()
        rows, distances = [run.row for run in runs], [run.distance for run in runs]
        return samples_of(self.robot, self.parameters, rows, distances)

    def _samples(self, frames: Sequence[HistoryFrame]) -> np.ndarray:
        """What the plots show of some frames, shape (frames, robots, sample_layout.size)."""
        rows = [row for frame in frames for row in frame.rows]
        distances = [distance for frame in frames for distance in frame.distances]
        samples = samples_of(self.robot, self.parameters, rows, distances)
        return samples.reshape(len(frames), len(self.runs), -1)


@lru_cache
def _roles(controllers: tuple[str, ...]) -> tuple[RobotName, ...]:
    """The same object for all that concerns the same robots: it is kept many times."""
    return tuple(ROLES[controller] for controller in controllers)
