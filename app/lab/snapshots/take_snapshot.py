"""Takes snapshots of a lab."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from onpath.app.lab.lab import Lab
from onpath.app.lab.path_editor import PathEditor
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.segments import Instant
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.law_places import law_places
from onpath.app.lab.snapshots.obstacles import (
    drawn_brakes,
    drawn_start,
    drawn_wall,
    wall_forces,
)
from onpath.app.lab.snapshots.page_snapshot import (
    LessonSnapshot,
    LogSnapshot,
    PageSnapshot,
    ParameterValues,
    PathEdit,
    RunState,
)
from onpath.app.lab.snapshots.robot_geometry import drawn_now, drawn_robots, robot_snapshots
from onpath.app.lab.snapshots.snapshot import Motion, PageKey, PathSnapshot
from onpath.lessons.progress import Truth
from onpath.lessons.schema import Sketch
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.control.bend_limit import speed_on
from onpath.models.control.settable import values_of
from onpath.models.control.sides import RIGHT
from onpath.models.paths.curve_fit import FAR
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import PathDesign
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

TRACE = 1.6  # [s] of the past that a trace shows
TRACE_POINTS = 48  # 30 a second: as many as pictures
CURVE_POINTS = 160  # of a series
OF_PIECE = 2  # of a piece of a drawing
DASH = 0.002  # [m], of a raised link, and from one dash to the next
DESIGN_POINTS = 32


def take_motion(lab: Lab, before: PageSnapshot | Motion | None = None, student: int = 0) -> Motion:
    """Take a snapshot of what moves in the scene, now or at the past instant being viewed.

    Args:
        before: the previous snapshot of the same lab; unchanged parts are shared with it.
        student: see `PageKey`.
    """
    simulation, key = lab.simulation, page_key(lab, student)
    robot, larger = simulation.robot, simulation.settings.larger
    if simulation.viewing is None and not lab.breakdown.replaying:
        curve, table = simulation.editor.curve, simulation.editor.table
        drawn, counts = drawn_now(robot, simulation.runs.values(), curve, table, larger)
    else:
        instant, curve, _ = _shown(lab)
        drawn, counts = drawn_robots(robot, curve, instant, larger)
    return Motion(
        key=key,
        path=_path_snapshot(simulation, curve, key, before),
        counts=counts,
        drawn=drawn,
        wall=drawn_wall(simulation),
        start=_drawn_start(simulation),
    )


def take_page_snapshot(
    lab: Lab,
    achieved_speed: float,
    before: PageSnapshot | None = None,
    student: int = 0,
    nickname: str = "",
) -> PageSnapshot:
    """Take a snapshot for the whole page; see `take_motion`.

    Args:
        nickname: the student's nickname in the class, or empty.
    """
    scene, simulation = _scene(lab, achieved_speed, before, student), lab.simulation
    right = simulation.runs[RIGHT]
    return PageSnapshot(
        **scene,
        parameters=_values(simulation.parameters),
        joints=right.row[right.log.slices["q"]].copy(),
        run=RunState(
            now=simulation.time,
            viewing=simulation.viewing,
            frozen=lab.frozen,
            waits=lab.waits,
            can_undo_going_on=simulation.undo_timeline is not None,
            laws=simulation.chosen_laws,
        ),
        edit=_path_edit(simulation),
        lesson=take_lesson(lab),
        shared=lab.shared,
        sent=lab.lessons.sent,
        nickname=nickname,
        wall_forces=wall_forces(simulation),
        settings=simulation.settings,
        refused=dict(lab.refused),
        places=law_places(simulation, scene["time"], before),
        log=_log(lab, before),
        plant=lab.plant,
    )


def _scene(lab: Lab, achieved: float, before: PageSnapshot | None, student: int) -> dict[str, Any]:
    """The fields of `Snapshot`."""
    simulation, key = lab.simulation, page_key(lab, student)
    instant, curve, time = _shown(lab)
    traces = _traces(simulation, time)
    message, level = lab.notice
    return {
        "time": time,
        "running": simulation.running,
        "achieved_speed": achieved,
        "robots": robot_snapshots(
            simulation.robot, curve, instant, traces, simulation.settings.larger
        ),
        "path": _path_snapshot(simulation, curve, key, before),
        "held": bool(simulation.forces.held),
        "grabbed": simulation.forces.grabbed,
        "message": message,
        "message_level": level,
        "messages": lab.messages,
        "note": scale_note(simulation, lab.words),
        "key": key,
        "wall": drawn_wall(simulation),
        "start": _drawn_start(simulation),
        "held_back": tuple(side for side in simulation.runs if side in simulation.forces.held),
        "pulled": _pulled(simulation),
        "brakes": drawn_brakes(simulation),
        "stopped": _stopped(simulation, time),
        "remedy": lab.breakdown.remedy(simulation),
    }


def _drawn_start(simulation: Simulation) -> Array:
    return drawn_start(simulation.robot, simulation.editor.curve, simulation.start)


def _pulled(simulation: Simulation) -> tuple[str, ...]:
    """`Snapshot.pulled`."""
    hands = simulation.forces.hands
    if not hands or simulation.viewing is not None:
        return ()
    return tuple(side for side in simulation.runs if side in hands)


def _stopped(simulation: Simulation, time: float) -> tuple[str, ...]:
    """Sides whose robots had diverged by a time, [s]."""
    faults = {side: run.diverged for side, run in simulation.runs.items()}
    return tuple(side for side, fault in faults.items() if fault and fault.time <= time)


def _shown(lab: Lab) -> tuple[Instant, Curve, float]:
    """The instant that is shown, its path and its time, [s]."""
    simulation = lab.simulation
    if (slow := lab.breakdown.instant(simulation)) is not None:
        instant, curve = slow
        return instant, curve, instant.time
    past = None if simulation.viewing is None else simulation.history.at(simulation.viewing)
    time = simulation.time if simulation.viewing is None else simulation.viewing
    if past is None:
        return simulation.instant(), simulation.editor.curve, time
    return past.instant(), past.curve, time


def page_key(lab: Lab, student: int = 0) -> PageKey:
    """Make the `PageKey` of a lab."""
    run, simulation = lab.lessons, lab.simulation
    return _page_key(
        name=simulation.entry.name,
        robot=simulation.robot,
        language=run.words.language,
        in_lesson=run.lesson is not None,
        presenting=simulation.settings.presenting,
        student=student,
    )


@lru_cache(maxsize=256)
def _page_key(
    *, name: str, robot: Robot, language: str, in_lesson: bool, presenting: bool, student: int
) -> PageKey:
    """The key; the same object for the same page."""
    return PageKey(
        robot=name,
        fields=sample_layout(robot).fields,
        motors=robot.system.motor_units,
        language=language,
        in_lesson=in_lesson,
        presenting=presenting,
        student=student,
        plane=robot.frame.numbers,
    )


def scale_note(simulation: Simulation, words: Words) -> str:
    """A note if the drawing is not true to scale, else empty."""
    larger = simulation.settings.larger
    if larger == 1.0 or not simulation.robot.extras:
        return ""
    return words("scene.larger", factor=f"{larger:g}")


def _traces(simulation: Simulation, time: float) -> Array:
    """Recent positions of both end-points, shape (n, robots, p)."""
    y = simulation.sample_layout.slices["y"]
    _, samples = simulation.history.samples(time - TRACE, time, TRACE_POINTS, y)
    return (
        samples if samples.size else np.zeros((0, len(simulation.runs), simulation.robot.system.p))
    )


def _path_snapshot(
    simulation: Simulation, curve: Curve, key: PageKey, before: PageSnapshot | Motion | None
) -> PathSnapshot:
    """The current path, or the past path `curve` without its control points."""
    editor, robot = simulation.editor, simulation.robot
    is_present = curve is editor.curve
    version = editor.version if is_present else curve.coefficients.tobytes()
    if (
        before is not None
        and (before.key.robot, before.key.plane) == (key.robot, key.plane)
        and before.path.version == version
    ):
        return before.path

    def placed(z: Array) -> Array:
        return robot.position(robot.frame.lift(z))

    refused = [fault.points for fault in editor.faults] if is_present else []
    points = np.zeros((0, 2))
    if is_present and not simulation.measured:
        points = editor.points()
    if len(points) and editor.rise:
        theta, _ = editor.blend.target.plan.nearest(points)
        points = np.column_stack([points, editor.blend.target.at(theta)[:, 2]])
    return PathSnapshot(
        version=version,
        curve=curve,
        points=placed(path_points(curve)),
        dashes=placed(_dashes(curve)),
        control_points=placed(points),
        selected=editor.selected if is_present else None,
        refused=placed(np.concatenate(refused) if refused else np.zeros((0, 2))),
        given=placed(_given(editor) if is_present else np.zeros((0, 2))),
    )


def path_points(curve: Curve) -> Array:
    """The points with which a path is drawn, at evenly spaced θ from -π to π, shape (n, d), [m]."""
    count = CURVE_POINTS
    if isinstance(curve, SplineCurve):
        count = max(count, OF_PIECE * curve.pieces + 1)
    return curve.at(np.linspace(-np.pi, np.pi, count))


def _dashes(curve: Curve) -> Array:
    """The dashes of raised links, shape (k, 2, d), [m]."""
    ends = [np.zeros((0, 2))]
    if isinstance(curve, SplineCurve):
        for begin, end in curve.raised:
            along = curve.at(np.linspace(begin, end, 2 * curve.pieces))
            length = float(np.linalg.norm(np.diff(along, axis=0), axis=1).sum())
            count = 2 * max(1, round(length / DASH / 2)) + 1
            ends.append(np.linspace(begin, end, count + 1)[1:-1].reshape(-1, 2))
    return curve.at(np.concatenate(ends))


def _given(editor: PathEditor) -> np.ndarray:
    """The line that the path was fitted to, if it is far from it, shape (n, 2), else empty."""
    curve = editor.design.curve
    if curve.given is None or curve.deviation <= FAR:
        return np.zeros((0, 2))
    return curve.given


def _path_edit(simulation: Simulation) -> PathEdit:
    editor = simulation.editor
    return PathEdit(
        version=editor.version,
        name=editor.design.name,
        sampled=_sampled(editor.design),
        points=editor.points(),
        selected=editor.selected,
        can_undo=editor.can_undo,
        can_redo=editor.can_redo,
        fastest=_fastest(simulation),
    )


def _fastest(simulation: Simulation) -> float:
    """The largest speed that is wanted along a drawing, [m/s]; 0 on other paths."""
    curve, parameters = simulation.editor.blend.target, simulation.parameters
    if not isinstance(curve, SplineCurve) or parameters.task == "position":
        return 0.0
    return abs(speed_on(parameters, curve)) * _steepest(curve)


@lru_cache(maxsize=128)
def _steepest(curve: SplineCurve) -> float:
    """The largest |σ'| where the pen is down, [m/rad]."""
    theta = curve.sample()
    return float(np.linalg.norm(curve.at(theta[curve.draws(theta)], 1), axis=1).max())


@lru_cache(maxsize=128)
def _sampled(design: PathDesign) -> Array:
    return design.curve.at(design.curve.sample(DESIGN_POINTS))


@lru_cache(maxsize=128)
def _values(parameters: Parameters) -> ParameterValues:
    """The values; the same object for the same parameters."""
    return values_of(parameters)


def _log(lab: Lab, before: PageSnapshot | None) -> LogSnapshot | None:
    """The log that is shown; the same if nothing has changed."""
    log, simulation = lab.shown_log, lab.simulation
    if log is None:
        return None
    last, blend = None if before is None else before.log, simulation.editor.blend
    is_level_set = simulation.parameters.across == LEVEL_SET
    if last is not None and last.log is log and last.is_level_set == is_level_set:
        frame, moves = simulation.robot.frame, blend.before is not None
        if last.frame is frame and (moves or last.curve is blend.target):
            return last
    return LogSnapshot(log, simulation.robot.frame, blend.target, is_level_set)


def take_lesson(lab: Lab) -> LessonSnapshot:
    """Take a snapshot of the lessons alone."""
    run = lab.lessons
    return LessonSnapshot(
        version=run.version,
        progress=run.progress,
        playing=run.playing,
        verdicts=dict(run.verdicts),
        truth=_truth(lab),
        pace=run.pace,
        votes=run.votes,
        presenting=lab.simulation.settings.presenting,
    )


def _truth(lab: Lab) -> Truth | None:
    """The actual curves; while the demonstration runs, only if they are drawn."""
    run, found = lab.lessons, lab.lessons.prediction()
    if found is None or (run.playing and not isinstance(found[1], Sketch)):
        return None
    return run.truth(lab.simulation)
