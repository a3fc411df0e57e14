"""The simulated lab: two robots on one path with one clock. Not thread-safe; independent of viser.

It does not know its user: commands, lessons, class and messages belong to `app.lab.lab`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from operator import is_

import numpy as np

from onpath.app.lab.advance_together import Frame, Ticks, advance_together
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.app.lab.loop_cache import LoopCache
from onpath.app.lab.path_editor import PathEditor
from onpath.app.lab.plot_samples import sample_layout, samples_of
from onpath.app.lab.segments import HistoryFrame, Inputs, Instant
from onpath.app.lab.timeline import LabEvent, Timeline
from onpath.models.arrays import Array
from onpath.models.control.laws import NAMES
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.systems.catalogue import FIVE_BAR, RobotEntry
from onpath.models.systems.parameters import TICK, Parameters, time_step
from onpath.models.systems.robots import Robot

MOST_TICKS = 200  # per frame
MOST_EVENTS = 1500  # 0.2 MB


class Session:
    """The state of one simulated lab.

    Args:
        store: provides the closed loops.
        entry: the initial robot.

    Attributes:
        entry, robot, parameters: catalogue entry, model and parameters of the current robot.
        runs: the two closed loops, by controller.
        editor: the path.
        grips: external forces that hold the robots back or pull at them.
        history: the last minute.
        time: simulated, [s].
        running: whether simulated time advances.
        rate: simulated seconds per second.
        copy: whether pulling and holding act on both robots.
        exaggeration: magnification of the drawn deflection.
        viewing: the past instant being viewed, [s], or None.
        undo_timeline: the timeline replaced by continuing from the past, or None.
        events: user actions and incidents, oldest first.
        faults: controllers whose robots have stopped and have not been reported yet.
        run_number: number of resets.
    """

    def __init__(self, store: LoopCache, entry: RobotEntry = FIVE_BAR) -> None:
        self._store = store
        self._benches: dict[str, tuple[Parameters, PathEditor]] = {}
        self.history = History(self._samples)
        self._inputs: Inputs | None = None
        self.presets: Mapping[str, PathDesign] = presets()
        self.running = True
        self.rate = 1.0
        self.copy = True
        self.exaggeration = 1.0
        self.events: deque[LabEvent] = deque(maxlen=MOST_EVENTS)
        self.faults: list[str] = []
        self.run_number = 0
        self._set_up(entry)

    # The robot

    def choose_robot(self, entry: RobotEntry) -> None:
        """Choose another robot, with its previous parameters and path."""
        if entry is not self.entry:
            self._benches[self.entry.name] = (self.parameters, self.editor)
            self._set_up(entry)
            self.note("robot", entry.name)

    def set_parameters(self, parameters: Parameters) -> None:
        """Set the parameters; a structural change makes a new robot, which starts anew."""
        if self.robot.extra_fields:
            self.history.settle()  # its samples depend on the parameters
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
        self._restart()

    def note(self, name: str, detail: str = "", controllers: tuple[str, ...] = NAMES) -> None:
        """Record an event."""
        self.events.append(LabEvent(self.run_number, self.time, name, detail, controllers))

    # Time

    def frame(self, seconds: float) -> Frame:
        """Simulate `seconds` of simulated time, if running; see `advance_together`."""
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
            yield from self.frame_of(ticks)

    def simulate(self, ticks: int) -> None:
        """Simulate some ticks of this session alone."""
        advance_together([self.frame_of(ticks)])

    def frame_of(self, ticks: int) -> Frame:
        """Simulate both robots for some ticks, with the same path, settings and external forces."""
        dt, parameters = time_step(self.parameters), self.parameters
        self._bend(ticks * dt)
        curve, table, runs = self.editor.curve, self.editor.table, list(self.runs.values())
        for run in runs:
            run.configure(parameters, curve, self.grips.pushes[run.controller])
        states, most = [run.state for run in runs], [run.max_distance for run in runs]
        rows, distances = [run.row for run in runs], [run.distance for run in runs]
        moving = [(run, run.loop(self._store)) for run in runs if run.diverged is None]
        yield Ticks(moving, ticks, self.time, dt, parameters, curve, table)
        for run, _ in moving:
            if run.diverged is not None:
                self.note("diverged", controllers=(run.controller,))
                self.faults.append(run.controller)
        inputs = {run.controller: run.input() for run in runs}
        if self._inputs is None or not self._inputs.are(curve, dt, inputs.values()):
            self._inputs = Inputs(curve, dt, inputs)
        self.history.append(
            HistoryFrame(self.time, ticks, self._inputs, states, most, rows, distances)
        )
        self.time += ticks * dt

    def _bend(self, seconds: float) -> None:
        """Advance the blend of an edited path."""
        if self.editor.advance(seconds):
            for run in self.runs.values():
                run.project(self.editor.curve)

    def step_once(self) -> None:
        """Make one step of a paused lab: the controller's next sample, at least a millisecond."""
        self.running = False
        dt = time_step(self.parameters)
        self.simulate(max(1, round(max(TICK, 1 / self.parameters.control_rate) / dt)))

    def reset(self) -> None:
        """Put both robots at the start, at rest. Clears the history; keeps path and parameters."""
        self._restart()
        self.note("reset")

    def _restart(self) -> None:
        self.run_number += 1
        self.time = 0.0
        self._owed = 0.0
        self._now: Instant | None = None
        self.viewing: float | None = None
        self.undo_timeline: Timeline | None = None
        self.history.clear()
        self.faults.clear()
        start = self.start_point(self.editor.curve)
        curve = self.editor.curve
        self.runs = {
            name: ClosedLoopRun(self.robot, name, self.parameters, curve, start) for name in NAMES
        }
        self.grips = ExternalForces(self.robot, self.runs, self.note)

    def start_point(self, curve: Curve) -> Array:
        """Start of a run, on the path, (p,), [m]."""
        return self.robot.frame.lift(curve.at(np.array(0.0)))

    def targets(self, controller: str) -> list[str]:
        """Controllers of the robots that a gesture at `controller` acts on."""
        return list(NAMES) if self.copy else [controller]

    # Samples of an instant

    @property
    def sample_layout(self) -> Layout:
        """See `app.lab.plot_samples`."""
        return sample_layout(self.robot)

    def instant(self) -> Instant:
        """The current instant; the same object until something changes."""
        runs, now = self.runs.values(), self._now
        made_of = [self.editor.curve, self.parameters, *[run.row for run in runs]]
        if now is None or now.time != self.time or not all(map(is_, made_of, self._made_of)):
            states, most = [run.state for run in runs], [run.max_distance for run in runs]
            now = self._now = Instant(self.time, states, most, self.sample())
            self._made_of = made_of
        return now

    def sample(self) -> np.ndarray:
        """The current sample, shape (robots, sample_layout.size)."""
        runs = self.runs.values()
        rows, distances = [run.row for run in runs], [run.distance for run in runs]
        return samples_of(self.robot, self.parameters, rows, distances)

    def _samples(self, frames: Sequence[HistoryFrame]) -> np.ndarray:
        """Plotted values of some frames, shape (frames, robots, sample_layout.size)."""
        rows = [row for frame in frames for row in frame.rows]
        distances = [distance for frame in frames for distance in frame.distances]
        samples = samples_of(self.robot, self.parameters, rows, distances)
        return samples.reshape(len(frames), len(self.runs), -1)
