"""A simulated run: arrays over time, a picture, a CSV file, a summary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from onpath.app.common.atomic_file import check_plot, check_writable, whole_file
from onpath.app.exports.summary_text import summary_lines
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory, write_csv
from onpath.models.control.laws.own import law_title
from onpath.models.studies.experiments import Experiment, never_held, summary

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run:
    """One robot under one control law: arrays with one row per millisecond.

    n rows; a robot has k coordinates, m motors and an output of p components.

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

    def plot(self, *others: Run, file: str | Path | None = None) -> Figure:
        """Plot the end-point and path, and distance, xi, theta, its rate and torque over time.

        Args:
            others: runs of the same robot and path, drawn in the same picture.
            file: file to write, with a name ending in .png, .svg or .pdf.

        Raises:
            ValueError: another robot or path, nothing to draw, or a file that cannot be written.
        """
        from onpath.app.exports.figures import experiment_figure, save  # slow to import

        path = None if file is None else Path(file)
        check_plot(path, "plot")
        figure = experiment_figure(self.experiment, self._with(others))
        if path:
            with whole_file(path) as scratch:
                save(figure, scratch)
        return figure

    def to_csv(self, file: str | Path, *others: Run) -> None:
        """Write one row per millisecond and run, as `onpath experiment --csv` does.

        Args:
            others: runs of the same robot and path, written after this one.

        Raises:
            ValueError: another robot or path, or a file that cannot be written.
        """
        path = Path(file)
        check_writable(path)
        trajectories = self._with(others)
        with whole_file(path) as scratch, scratch.open("w", encoding="utf-8", newline="") as opened:
            write_csv(opened, self.experiment.robot(), trajectories)

    def _with(self, others: tuple[Run, ...]) -> list[Trajectory]:
        """The trajectories of this run and others."""
        robot, series = self.experiment.robot(), self.experiment.curve().series
        for other in others:
            experiment = other.experiment
            same_path = np.array_equal(experiment.curve().series, series)
            if experiment.robot() is not robot or not same_path:
                raise ValueError("only runs of one robot on one path can be shown together")
        return [self.trajectory, *(other.trajectory for other in others)]

    def __repr__(self) -> str:
        lines = [f"{law_title(self.law)}, {self.experiment.title}, {len(self.t)} ms"]
        lines += summary_lines(self.summary())
        return "\n  ".join([*lines, self.reason] if self.reason else lines)
