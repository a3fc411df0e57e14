"""The simulated lab: two robots on one path with one clock. Not thread-safe; independent of viser.

It does not know its user: commands, lessons, class and messages belong to `app.lab.lab`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from onpath.app.lab.advance_together import NO_FRAME, Frame, Ticks, advance_together
from onpath.app.lab.closed_loop_run import ClosedLoopRun, project
from onpath.app.lab.events import EventLog, LabEvent
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.app.lab.loops.law_changes import LawChanges, suits
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.path_editor import PathEditor
from onpath.app.lab.plot_samples import sample_layout, samples_of
from onpath.app.lab.recorder import CurrentInstant, Recorder, sample_of
from onpath.app.lab.robot_settings import RobotSettings
from onpath.app.lab.segments import Instant
from onpath.app.lab.timeline import Timeline
from onpath.models.arrays import Array
from onpath.models.closed_loop.lab_settings import SETTINGS, LabSettings, settings_of_start
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.start import ON_PATH, Start, check_start
from onpath.models.control.laws.own import short_name
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import SIDES
from onpath.models.layout import Layout
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.systems.catalogue import FIVE_BAR, RobotEntry
from onpath.models.systems.parameters import TICK, Parameters, rise_of, time_step
from onpath.models.systems.robots import Robot

MOST_TICKS = 200  # largest number of ticks per frame


class Simulation:
    """The simulated half of a lab.

    Args:
        loop_cache: provides the closed loops.
        entry: the initial robot.

    Attributes:
        entry, robot, parameters: catalogue entry, model and parameters of the current robot.
        runs: the two closed loops, by side.
        editor: the path.
        law_changes: pending changes of law.
        settings: the lab's own settings; change them by `set`.
        start: where and how the next run starts, from `settings`.
        wall: in the way of both end-points, or None, from `settings`; it stays from run to run.
        forces: external forces on the robots.
        history: the last minute.
        time: simulated, [s].
        running: whether simulated time advances.
        lacks_loops: whether time stands still because loops are being made.
        has_to_step: whether a step has to be made as soon as they are.
        viewing: the past instant being viewed, [s], or None.
        resumes: whether time runs again in the present, while the past is being viewed.
        undo_timeline: the timeline replaced by continuing from the past, or None.
        events: user actions and incidents, oldest first.
        faults: sides whose robots have stopped and have not been reported yet.
        run_number: number of resets.
        across_since: time since which ξ has had its present unit, [s].
        measured: the side whose robot is measured elsewhere, from the next run on; "": none.
    """

    def __init__(self, loop_cache: LoopCache, entry: RobotEntry = FIVE_BAR) -> None:
        self._loop_cache = loop_cache
        self.earlier: dict[str, RobotSettings] = {}
        self.history = History(self._samples)
        self._now = CurrentInstant()
        self._recorder = Recorder()
        self.runs: dict[str, ClosedLoopRun] = {}
        self.law_changes = LawChanges(loop_cache, self.change_law)
        self.running = self.resumes = True
        self.lacks_loops = self.has_to_step = False
        self._is_bent = False  # whether the path has already been bent for the next ticks
        self.viewing: float | None = None
        self.settings = LabSettings()
        self.events = EventLog()
        self.faults: list[str] = []
        self.run_number = 0
        self.measured = ""
        self._set_up(entry)

    # The robot

    @property
    def presets(self) -> Mapping[str, PathDesign]:
        """The predefined paths of the robot."""
        return presets(self.robot.radius)

    def choose_robot(self, entry: RobotEntry) -> None:
        """Choose another robot, with its previous parameters and path."""
        if entry is not self.entry:
            self.earlier[self.entry.name] = self.robot_settings()
            self._set_up(entry)
            self.note("robot", entry.name)

    def set_parameters(self, parameters: Parameters) -> None:
        """Set the parameters; a structural change makes a new robot.

        If it has the same states, both go on from the present one; otherwise they restart.
        """
        robot = self.entry.make(parameters)  # may take long, and another thread may read the lab
        self._make_plans(self.laws.values(), robot, parameters)
        if self.robot.extras:
            self.history.settle()  # the samples depend on the parameters
        rise = rise_of(parameters)
        if rise != self.editor.rise:
            self.editor.raise_to(rise)
        if parameters.across != self.parameters.across:
            self.across_since = self.time
        before, self.parameters = self.parameters, parameters
        if robot is self.robot:
            return
        self.history.settle()
        self.robot = self.editor.robot = robot
        if not self.entry.keeps_states(before, parameters):
            self._restart()
            return
        for run in self.runs.values():
            run.change_robot(robot, parameters, self.editor.curve, self.forces.pushes[run.side])

    def robot_settings(self) -> RobotSettings:
        """What the present robot keeps while another one is used."""
        own = replace(self.settings, **settings_of_start(self._beginning()))
        return RobotSettings(self.parameters, self.editor, own)

    def _set_up(self, entry: RobotEntry) -> None:
        self.history.settle()  # a page that is being built in another thread reads it, too
        new = RobotSettings(entry.parameters())
        parameters, editor, own = self.earlier.get(entry.name, new)
        robot, rise = entry.make(parameters), rise_of(parameters)
        editor = editor or PathEditor(robot, presets(robot.radius)["circle"], rise)
        self.entry, self.editor = entry, editor
        self.parameters: Parameters = parameters
        self.robot: Robot = robot
        of_robot = [name for name, setting in SETTINGS.items() if setting.of_robot]
        self._take(replace(self.settings, **{name: getattr(own, name) for name in of_robot}))
        self._restart()

    # The control laws

    @property
    def laws(self) -> dict[str, str]:
        """Control law of each side."""
        return {side: run.law for side, run in self.runs.items()}

    @property
    def chosen_laws(self) -> dict[str, str]:
        """Control law of each side, in force as soon as its loop can run."""
        return self.laws | self.law_changes.coming

    def suits(self, law: str) -> bool:
        """Whether a law can be used with the current robot and its controlled output."""
        return suits(law, self.robot, self.parameters)

    def choose_law(self, side: str, law: str) -> None:
        """Change the law of a side as soon as its loop can run; the old law goes on until then."""
        self.law_changes.coming[side] = law
        self._make_plans([law], self.robot, self.parameters)
        self._follow_laws()

    def _make_plans(self, laws: Iterable[str], robot: Robot, parameters: Parameters) -> None:
        """Make the plans of laws now, while a command is applied: they take tens of milliseconds.

        They are kept until the next frame needs them.
        """
        for law in laws:
            if (plan := law_named(law).plan) is not None:
                plan(robot, parameters, self.editor.curve)

    def change_law(self, side: str, law: str) -> None:
        """Change the law of a side now; its robot moves on from where it is."""
        self.law_changes.coming.pop(side, None)
        if law != self.runs[side].law:
            push = self.forces.pushes[side]
            self.runs[side].change_law(law, self.parameters, self.editor.curve, push)
            self.note("law", short_name(law), (side,))

    def _follow_laws(self) -> bool:
        """Change to the laws whose loops can run now; returns whether time can run."""
        curve, pushes = self.editor.curve, self.forces.pushes
        ready = self.law_changes.follow(self.runs, self.parameters, curve, pushes)
        self.lacks_loops = not ready
        return ready

    def note(self, name: str, detail: str = "", sides: tuple[str, ...] = SIDES) -> None:
        """Record an event; what a drag of a slider repeats within a second is recorded once."""
        event = LabEvent(run=self.run_number, time=self.time, name=name, detail=detail, sides=sides)
        self.events.append(event)

    # Time

    def frame(self, seconds: float) -> Frame:
        """Simulate `seconds` of simulated time, if running; see `advance_together`."""
        ready = self._follow_laws()
        if ready and self.has_to_step:
            self.has_to_step = False
            return self.frame_of(self._step_ticks)
        if not self.running:
            self._owed = 0.0
            if self.viewing is None:
                self._bend_paused(seconds)
        if not ready or not self.running:
            return NO_FRAME
        dt = time_step(self.parameters)
        owed = self._owed + seconds
        ticks = min(int(owed / dt + 1e-9), MOST_TICKS)
        self._owed = min(owed - ticks * dt, MOST_TICKS * dt)
        return self.frame_of(ticks)

    def simulate(self, ticks: int) -> None:
        """Simulate some ticks of this simulation alone."""
        advance_together([self.frame_of(ticks)])

    def frame_of(self, ticks: int) -> Frame:
        """Simulate both robots for some ticks, with the same path, settings and external forces.

        The parts of a speed profile are simulated one after the other.
        """
        parameters, editor, runs = self.parameters, self.editor, list(self.runs.values())
        dt, profile = time_step(parameters), profile_of(parameters)
        if ticks and not self._is_bent:
            self._bend(ticks * dt)
        self._is_bent = False
        curve, table, pushes = editor.curve, editor.table, self.forces.pushes
        while ticks > 0:
            now = round(self.time / dt)
            leg = None if profile is None else profile.leg(now, dt)
            count = ticks if leg is None or leg.end is None else min(ticks, leg.end - now)
            for run in runs:
                run.configure(parameters, curve, pushes[run.side], leg, now)
            going = [run for run in runs if run.moves]
            moving = [(run, loop) for run in going if (loop := run.loop()) is not None]
            if len(moving) < len(going):  # the path has just become another kind of curve
                self._is_bent = True
                return
            self.law_changes.remark_on(moving)
            part = Ticks(
                runs=moving,
                count=count,
                time=self.time,
                dt=dt,
                parameters=parameters,
                curve=curve,
                table=table,
            )
            begun = [run.slot for run in runs]
            yield part
            for i, run in enumerate(runs):
                if not run.moves:
                    begun[i] = run.slot  # it stands still
            self.history.append(self._recorder.record(part, runs, begun))
            for run, _ in moving:
                if run.diverged is not None:
                    self.note("diverged", sides=(run.side,))
                    self.faults.append(run.side)
            self.time += count * dt
            ticks -= count

    def _bend(self, seconds: float) -> None:
        """Advance the blend of an edited path."""
        if self.editor.advance(seconds):
            project(list(self.runs.values()), self.editor.curve)

    def _bend_paused(self, seconds: float) -> None:
        """Advance the blend of an edited path while time stands still, and measure distances."""
        before = self.editor.curve
        self._bend(seconds)
        if (curve := self.editor.curve) is not before:
            for run in self.runs.values():
                if run.diverged is None:
                    run.measure(curve)

    def look_at(self, time: float) -> None:
        """Pause and view a past instant, [s]."""
        if self.viewing is None:
            self.resumes = self.running
        self.viewing, self.running = time, False

    def return_to_present(self) -> None:
        """Stop viewing the past, if it is being viewed; time runs again if it ran before."""
        if self.viewing is not None:
            self.viewing, self.running = None, self.resumes

    def step_once(self) -> None:
        """Make one step of a paused lab: the controller's next sample, at least a millisecond.

        If a robot lacks its loop, the step is made as soon as there is one.
        """
        self.running = False
        self.has_to_step = not self._follow_laws()
        if not self.has_to_step:
            self.simulate(self._step_ticks)

    @property
    def _step_ticks(self) -> int:
        step = max(TICK, 1 / self.parameters.control_rate)
        return max(1, round(step / time_step(self.parameters)))

    def reset(self, laws: Mapping[str, str] | None = None) -> None:
        """Put both robots at the start. Clears the history; keeps path, parameters and wall.

        Args:
            laws: control laws from now on, defaults for missing sides; None keeps the present ones.

        Raises:
            ValueError: the start is not possible on the present path; nothing has changed.
        """
        self.check_start(self.start)
        if laws is not None:
            self.law_changes.coming.clear()
        self._restart(laws)
        self.note("reset")

    def restart(self) -> None:
        """`reset`, with a new lab's start if the present one is not possible on the path."""
        self._restart()
        self.note("reset")

    def _restart(self, laws: Mapping[str, str] | None = None) -> None:
        laws, curve = self.laws if laws is None else laws, self.editor.curve
        laws = self.law_changes.begin(laws, self.robot, self.parameters)
        self.run_number += 1
        self.time = self.across_since = 0.0
        self._owed = 0.0
        self.has_to_step = False
        self.return_to_present()
        self.undo_timeline: Timeline | None = None
        self.history.clear()
        self.faults.clear()
        start, loop_cache = self._beginning(), self._loop_cache
        self.runs = {
            side: ClosedLoopRun(
                loop_cache,
                robot=self.robot,
                side=side,
                law=law,
                parameters=self.parameters,
                curve=curve,
                start=start,
                tell=self.law_changes.remarks.append,
                measured=side == self.measured,
            )
            for side, law in laws.items()
        }
        self.forces = ExternalForces(self.robot, self.runs, self.note, self.wall)

    def prepare_loops(self) -> None:
        """Have the loops made that it needs, free and held, when no lab waits for others."""
        for run in self.runs.values():
            for free in (True, False):
                self._loop_cache.prepare(run.robot, replace(run.kind, free=free))

    # The lab's own settings

    def set(self, **changes: Any) -> None:
        """Change some of the lab's own settings; the values are not checked again."""
        self.change_settings(replace(self.settings, **changes))

    def change_settings(self, wanted: LabSettings) -> None:
        """Change the lab's own settings; a brake that acts is applied again where it is."""
        before, wall = self.settings, self.wall
        self._take(wanted)
        if self.wall != wall:
            self.forces.set_wall(self.wall)
        if wanted.hold_direction != before.hold_direction:
            held = sorted(self.forces.held)
            self.forces.hold(held, False, self.editor.curve)
            self.forces.hold(held, True, self.editor.curve, wanted.hold_direction)

    def _take(self, settings: LabSettings) -> None:
        self.settings = settings
        self.start, self.wall = settings.start, settings.obstacle

    def check_start(self, start: Start) -> None:
        """Refuse a start that is not possible on the present path; see `check_start`."""
        if start != ON_PATH:
            check_start(self.robot, self.editor.curve, self.parameters, start)

    def _beginning(self) -> Start:
        """The start, or a new lab's if it is not possible."""
        try:
            self.check_start(self.start)
        except ValueError:
            return ON_PATH
        return self.start

    def targets(self, side: str) -> list[str]:
        """The sides that a gesture at `side` acts on."""
        return list(SIDES) if self.settings.copy else [side]

    # Samples of an instant

    @property
    def sample_layout(self) -> Layout:
        """Fields of a sample; see `app.lab.plot_samples`."""
        return sample_layout(self.robot)

    def instant(self) -> Instant:
        """The current instant; the same object until something changes."""
        runs = list(self.runs.values())
        return self._now.of(self.time, self.robot, self.parameters, self.editor.curve, runs)

    def sample(self) -> np.ndarray:
        """The current sample, shape (robots, sample_layout.size)."""
        return sample_of(self.robot, self.parameters, self.runs.values())

    def _samples(self, rows: Array, distances: Array) -> Array:
        """Plotted values; see `History`."""
        return samples_of(self.robot, self.parameters, rows, distances)
