"""A simulated run: arrays over time, a picture, a CSV file, a data frame, a summary."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from onpath.app.common.atomic_file import check_plot, check_writable, whole_file
from onpath.app.common.user_files import user_file
from onpath.app.exports.summary_text import summary_lines
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import (
    MEASURED,
    Trajectory,
    header,
    numbers_of,
    write_csv,
)
from onpath.models.control.laws.own import law_title
from onpath.models.robot_files.guesses import Guess
from onpath.models.studies.experiments import Experiment, experiment_from, never_held, summary
from onpath.models.systems.guessed_numbers import told_guesses

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

    from onpath.app.exports.standalone.figure import Figure as LiveFigure

FORMAT = 1
"""Of a pickled run; another number for each change after which it must be read differently."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run:
    """One robot under one control law: arrays with one row per millisecond.

    n rows; a robot has k coordinates, m motors and an output of p components.

    A run can be pickled, and read in another process or on another computer, without the files of
    its robot and its law: everything here works there, also beside runs that are made there. A
    pickle is code that runs when it is read, so read none from somebody you do not trust; what is
    meant for others is the file of `to_csv`, with the units in its header.

    Attributes:
        experiment: robot, parameters, path and schedule.
        trajectory: the record that the arrays are views of.
    """

    experiment: Experiment
    trajectory: Trajectory

    @property
    def law(self) -> str:
        """Name of the control law."""
        return self.trajectory.law

    @property
    def guesses(self) -> tuple[Guess, ...]:
        """What is guessed about the robot, such as its masses, because its file does not say it."""
        return self.experiment.entry.guesses

    @property
    def t(self) -> Array:
        """Time, shape (n,), [s]."""
        return self.trajectory.t

    @property
    def q(self) -> Array:
        """Coordinates, shape (n, k); units as in the header of the CSV file, [rad] for angles."""
        return self.trajectory.fields["q"]

    @property
    def v(self) -> Array:
        """Rates of the coordinates, shape (n, k), [rad/s] for angles."""
        return self.trajectory.fields["v"]

    @property
    def y(self) -> Array:
        """Actual end-point, shape (n, p), [m]."""
        return self.trajectory.fields["y"]

    @property
    def theta(self) -> Array:
        """Path parameter of the closest point, shape (n,), [rad]. Source: eq. (7)."""
        return self.trajectory.fields["theta"][:, 0]

    @property
    def theta_rate(self) -> Array:
        """Rate of theta, shape (n,), [rad/s]."""
        return self.trajectory.fields["theta_rate"][:, 0]

    @property
    def theta_ref(self) -> Array:
        """Path parameter of the tracker's reference point, shape (n,), [rad]."""
        return self.trajectory.fields["theta_ref"][:, 0]

    @property
    def xi(self) -> Array:
        """Virtual output across the path, as the law sees it, shape (n, p - 1).

        The first is the signed distance, [m], or s(y) with across="level_set", [m²], on a path with
        an equation divided by the mean of |∇s|, [m]; for p = 3 the second is the distance to the
        path's plane, [m]. Source: eq. (9).
        """
        return self.trajectory.fields["xi"]

    @property
    def xi_rate(self) -> Array:
        """Rate of xi, shape (n, p - 1), in units of xi per second."""
        return self.trajectory.fields["xi_rate"]

    @property
    def distance(self) -> Array:
        """Distance of the actual end-point from the path, for any law, shape (n,), [m]."""
        return self.trajectory.distance

    @property
    def max_distance(self) -> float:
        """The largest distance, [m]; infinity if the run was stopped, so that it never wins."""
        return float(self.distance.max()) if self.stopped_at is None else np.inf

    @property
    def speed(self) -> Array:
        """Speed along the path, shape (n,), [m/s]."""
        return self.trajectory.speed

    @property
    def torque(self) -> Array:
        """Motor torques, shape (n, m), [N m]."""
        return self.trajectory.fields["u"]

    @property
    def force(self) -> Array:
        """External force of brake, hand and wall on the end-point, shape (n, p), [N]."""
        return self.trajectory.fields["force"]

    @property
    def held(self) -> NDArray[np.bool_]:
        """Whether the brake held the end-point back, shape (n,)."""
        return self.trajectory.held

    @property
    def stopped_at(self) -> float | None:
        """Time at which the simulation was stopped because the motion diverged, [s], or None."""
        return self.trajectory.stopped_at

    @property
    def reason(self) -> str:
        """Reason why the motion counts as diverged, or why the brake never acted, or ""."""
        return self.trajectory.reason or never_held(self.experiment, self.trajectory)

    def summary(self) -> dict[str, Any]:
        """Summary of the run, as in `onpath experiment --json`; units are in the names.

        Maxima and means of a run that was stopped are infinity, null in JSON.
        """
        return summary(self.experiment, [self.trajectory])["laws"][self.law]

    def plot(
        self,
        *others: Run | str | Path,
        file: str | Path | None = None,
        log: str | Path | None = None,
        columns: Mapping[str, str | int] | None = None,
        units: Mapping[str, str | float] | None = None,
    ) -> Figure:
        """Plot the end-point and path, and distance, xi, theta, its rate and torque over time.

        Args:
            others: runs of the same robot and path, drawn in the same picture; and the file, as in
                `run.plot("held.png")` and `run.plot(other, "held.png")`.
            file: the file to write, with a name ending in .png, .svg or .pdf.
            log: what a real arm has logged, drawn on the same axes from its beginning on.
            columns, units: of the log, as for `onpath.identify`.

        Raises:
            ValueError: another robot or path, two files, a file that cannot be written, or a log
                that is refused.
            OSError: the log cannot be read.
        """
        from onpath.app.exports.figures import experiment_figure  # slow to import
        from onpath.models.studies.log_motion import read_motions

        files = [each for each in (*others, file) if isinstance(each, str | Path)]
        if len(files) > 1:
            raise ValueError("plot: it writes one file, not " + " and ".join(map(str, files)))
        file = files[0] if files else None
        check_plot(None if file is None else Path(file).expanduser(), "plot")
        runs = tuple(each for each in others if not isinstance(each, str | Path))
        shown = self._with(runs)
        if log is not None:
            shown += read_motions(user_file(log), self.experiment, columns or {}, units or {})
        return written(experiment_figure(self.experiment, shown), file)

    def to_csv(self, file: str | Path, *others: Run) -> None:
        """Write one row per millisecond and run, as `onpath experiment --csv` does.

        Args:
            others: runs of the same robot and path, written after this one.

        Raises:
            ValueError: another robot or path, or a file that cannot be written.
        """
        path = Path(file).expanduser()
        check_writable(path)
        trajectories = self._with(others)
        with whole_file(path) as scratch, scratch.open("w", encoding="utf-8", newline="") as opened:
            write_csv(opened, self.experiment.robot(), trajectories, guesses=self.guesses)

    def to_dataframe(self) -> DataFrame:
        """A data frame with one row per millisecond, and the columns of `to_csv`.

        Its `attrs["guesses"]` says what is guessed about the robot.

        Raises:
            ImportError: pandas is not installed; `pip install "onpath[pandas]"` does that.
        """
        robot, run = self.experiment.robot(), self.trajectory
        measured = MEASURED in run.fields
        names = header(robot, run.level_set, measured=measured)[2:]
        frame = data_frame(dict(zip(names, numbers_of(robot, run, measured).T, strict=True)))
        frame["held"] = run.held
        frame.insert(0, "t_s", run.t)
        frame.insert(1, "law", self.law)
        frame.attrs["guesses"] = told_guesses(self.guesses)
        return frame

    def __reduce__(self) -> tuple[Callable[..., Run], tuple[int, str, dict[str, Any]]]:
        run = {f.name: getattr(self.trajectory, f.name) for f in dataclasses.fields(Trajectory)}
        data = {"experiment": self.experiment.data(), "trajectory": run}
        return read_run, (FORMAT, version("onpath"), data)

    def _with(self, others: tuple[Run, ...]) -> list[Trajectory]:
        """The trajectories of this run and others."""
        robot, path = self.experiment.robot(), self.experiment.curve().coefficients
        for other in others:
            if not isinstance(other, Run):
                raise TypeError(f"expected a run, got {other!r:.60}")
            experiment = other.experiment
            same_path = np.array_equal(experiment.curve().coefficients, path)
            if experiment.robot() is not robot or not same_path:
                raise ValueError("only runs of one robot on one path can be shown together")
        return [self.trajectory, *(other.trajectory for other in others)]

    def figure(self, *others: Run, title: str = "", language: str = "en") -> LiveFigure:
        """The figure of what was recorded: a picture, and a page on which it can be tried.

        On the page the robots begin on the path and are free; it says what the run had besides.

        Args:
            others: another run of the same robot and path, shown beside this one.
            title: title above the figure.
            language: language of its words.

        Raises:
            ValueError: another robot or path, more than two runs, or an unknown language.
        """
        from onpath.app.notebook.display import run_figure  # slow to import

        runs = self._with(others)
        experiments = [self.experiment, *(other.experiment for other in others)]
        return run_figure(experiments, runs, title, language)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from onpath.app.notebook.display import run_bundle  # slow to import

        return run_bundle(repr(self), self.experiment, self.trajectory, self.reason)

    def __repr__(self) -> str:
        lines = [f"{law_title(self.law)}, {self.experiment.title}, {len(self.t)} ms"]
        lines += summary_lines(self.summary(), self.guesses)
        lines += [self.reason] if self.reason else []
        return "\n  ".join([*lines, *told_guesses(self.guesses)])


def read_run(form: int, made_by: str, data: dict[str, Any]) -> Run:
    """The run that was pickled.

    Args:
        form: `FORMAT` of the version that pickled it.
        made_by: that version.

    Raises:
        ValueError: this version cannot read it.
    """
    if form != FORMAT:
        raise ValueError(
            f"this run was pickled by OnPath {made_by}, in a form that OnPath {version('onpath')}"
            " does not read: write it with to_csv there"
        )
    return Run(experiment_from(data["experiment"]), Trajectory(**data["trajectory"]))


def written(figure: Figure, file: str | Path | None) -> Figure:
    """A figure, which is written to a file if one is given.

    Raises:
        ValueError: the file cannot be written.
    """
    from onpath.app.exports.figures import save

    if file is not None:
        path = Path(file).expanduser()
        check_plot(path, "file")
        with whole_file(path) as scratch:
            save(figure, scratch)
    return figure


def data_frame(columns: Any) -> DataFrame:
    """A data frame of columns by name, or of rows that are mappings.

    Raises:
        ImportError: pandas is not installed.
    """
    try:
        from pandas import DataFrame
    except ImportError:
        raise ImportError('a data frame needs pandas: pip install "onpath[pandas]"') from None
    return DataFrame(columns)
