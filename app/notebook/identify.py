"""`onpath.identify`: a robot's parameters from the log of a real arm."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onpath.app.common.atomic_file import check_writable, whole_file
from onpath.app.common.user_files import user_file
from onpath.app.notebook.run import written
from onpath.app.notebook.simulate import entry_named
from onpath.models.studies.link_estimate import LinkParameter
from onpath.models.studies.log_identification import FileEstimate, identify_file
from onpath.models.systems.catalogue import ROBOTS, RobotEntry, robot_named

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class IdentificationResult:
    """The parameters of a robot that were identified from a log; printed as a table.

    Attributes:
        found: the estimates with standard errors, residuals, and a motion that would identify more.
    """

    found: FileEstimate

    @property
    def values(self) -> dict[str, float]:
        """Estimates by name; a sum has a name such as "a1 + 0.0484 g2" (SI)."""
        return {each.label(): each.value for each in self.found.estimate.found}

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Intervals that contain the true values with a probability of 95 %.

        Of friction where motors are slow or turn round, nothing is assumed. They are infinite if
        too little of the motion tells a value, or more than a twentieth of the torque is not
        explained.
        """
        return {each.label(): (each.low, each.high) for each in self.found.estimate.found}

    @property
    def delay(self) -> float | None:
        """Delay of the logged torques, [s]; None if the motion does not show it."""
        late = self.found.estimate.delay
        return None if late is None else late.value

    @property
    def settings(self) -> dict[str, float]:
        """Friction and delay, for `onpath.simulate(..., **result.settings)` and `onpath.arena`.

        `coulomb` is the mean of the motors' dry friction, [N m]. `delay` is that of torques that
        were logged before they acted, in control intervals: of 1 ms or, if it is longer than eight
        of these, of `control_rate`.
        """
        return self.found.settings

    @property
    def unexplained(self) -> dict[str, float]:
        """Share of the torque in each file of `validate` that the values do not explain."""
        return dict(self.found.others)

    @property
    def links(self) -> tuple[LinkParameter, ...]:
        """The base parameters of the links, from the base to the tip, if `links` was asked for."""
        return () if self.found.links is None else self.found.links.parameters

    def plot(self, file: str | Path | None = None) -> Figure:
        """Draw the torques and their residuals.

        Args:
            file: also write the picture to this .png, .svg or .pdf file.

        Raises:
            ValueError: another kind of file.
        """
        from onpath.app.exports.identification import residual_figure

        return written(residual_figure(self.found), file)

    def motion_to_csv(self, file: str | Path) -> None:
        """Write a motion to record next: times, coordinates and their rates.

        Of many random ones from rest to rest, about the same place and no faster, it is the one
        that tells the most parameters, with the least condition number.

        Raises:
            ValueError: the robot cannot move there, or the file cannot be written.
        """
        from onpath.app.exports.identification import motion_text
        from onpath.models.studies.exciting_motion import planned_motion

        path, entry = Path(file).expanduser(), robot_named(self.found.robot)
        check_writable(path)
        motion = planned_motion(entry, self.found.centre, self.found.fastest)
        with whole_file(path) as scratch:
            scratch.write_text(motion_text(entry, motion), encoding="utf-8")

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from onpath.app.notebook.display import identification_bundle  # slow to import

        return identification_bundle(repr(self), self.found)

    def __repr__(self) -> str:
        from onpath.app.exports.identification import identification_text

        return identification_text(self.found)


def identify(
    robot: str | Path | RobotEntry = "five_bar",
    file: str | Path = "",
    *,
    columns: Mapping[str, str | int] | None = None,
    units: Mapping[str, str | float] | None = None,
    law: str = "",
    validate: str | Path | Sequence[str | Path] = (),
    links: bool = False,
) -> IdentificationResult:
    """Estimate a robot's parameters from the log of a real arm, or a CSV file of OnPath.

    The file is a table, with the names of its columns in the first line or without, whose
    separators, decimal sign and encoding are recognised; or arrays t, q and tau in a .npz, .npy or
    .mat file. Its times may be uneven, and its torques late by an unknown time.

    Args:
        robot: as for `onpath.simulate`; its geometry has to be that of the arm.
        file: such as "arm.csv".
        columns: names of the log's columns: "t", each coordinate, such as "q1", the torque of each
            motor, such as "tau1", and perhaps the force on the end-point, "force1" and so on.
            Those that are not given are named as in files of OnPath: t_s, q1_rad, tau1_Nm,
            force1_N. Where they have no names, their places from 1 on, as {"t": 1, "q1": 2}. A
            log without forces is of a free motion.
        units: of these columns, such as {"q1": "deg", "t": "ms"}, or factors to SI units, such as
            {"tau1": 0.085} for a current; others are in s, rad or m, N m or N, and N.
        law: use only the rows of this law, if there is a column `law`.
        validate: another file of the same form, or several: the result says how much of their
            torque the values do not explain.
        links: whether to estimate the base parameters of each link, too; for a robot that is a
            chain of links, as from a file.

    Raises:
        ValueError: the file, a name or a unit is refused; the message names line and column. Or
            the robot's equations of motion are not linear in its parameters, or the motion is too
            short.
        OSError: the file cannot be read.

    >>> import onpath, pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp(), "motion.csv")
    >>> onpath.simulate(path="clover", speed=4, encoder_counts=20000).to_csv(file)
    >>> result = onpath.identify("five_bar", file)
    >>> low, high = result.intervals["M11"]
    >>> bool(low < 0.0226 < high), bool(abs(result.delay) < 1e-3)
    (True, True)
    """
    if not file or isinstance(file, RobotEntry) or str(file) in ROBOTS:
        raise TypeError('identify(robot, file): as in onpath.identify("five_bar", "arm.csv")')
    entry, path = entry_named(robot), user_file(file)
    several = [validate] if isinstance(validate, str | Path) else validate
    others = [user_file(each) for each in several]
    found = identify_file(path, entry, law, columns, units, others, links=links)
    return IdentificationResult(found)
