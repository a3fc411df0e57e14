"""`onpath identify`: a robot's parameters from a recorded motion."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions


@dataclass(frozen=True)
class IdentifyCommand:
    """Estimate a robot's parameters from the log of a real arm, or a CSV file of OnPath."""

    file: Annotated[Path, tyro.conf.Positional]
    """CSV file of `onpath experiment --csv`, of the lab's export or of a real arm, with any
    separators, decimal sign and encoding; or arrays t, q and tau of a real arm in a .npz, .npy or
    .mat file. If a file of OnPath has columns of measured angles, these
    are used, and their rates by a filter; otherwise the true ones."""
    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    law: str = ""
    """Use only the rows of this control law; all by default."""
    column: Repeated = ()
    """Name of a column of a real arm's log, as q1="Joint 1", or its place from 1 on where columns
    have no names, as q1=2; repeat for t, q1, q2, tau1, tau2 and, if the log has them, forces at the
    end-point (force1, force2). Times may be uneven."""
    unit: Repeated = ()
    """Unit of a column, as q1=deg, or its factor to SI units, as tau1=0.085; repeat for more. By
    default s, rad, N m and N."""
    links: bool = False
    """Print the base parameters of each link, too: the combinations of its mass, first moments and
    inertias that this log tells. For a robot that is a chain of links, as from a file."""
    validate: Repeated = ()
    """Another file of the same form: print how much of its torque the values do not explain;
    repeat for more."""
    plot: Path | None = None
    """Draw the torques and their residuals to this .png, .svg or .pdf file."""
    motion: Path | None = None
    """Write a motion to record next to this CSV file: about the same place, no faster, from rest to
    rest, and where the robot is neither singular nor at a limit."""
    json: bool = False
    """Print the result as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Read, estimate, draw and print."""
        from onpath.app.cli.assignments import assignments
        from onpath.app.common.atomic_file import check_file, check_plot, whole_file
        from onpath.app.common.user_files import user_file
        from onpath.app.exports.figures import save
        from onpath.app.exports.identification import (
            identification_data,
            identification_text,
            motion_text,
            residual_figure,
        )
        from onpath.models.studies.exciting_motion import planned_motion
        from onpath.models.studies.log_identification import identify_file

        check_plot(self.plot)
        check_file(self.motion, (".csv",), "--motion")
        entry, file = self.file_options.entry_of(self.robot), user_file(self.file)
        columns = assignments(self.column, "--column")
        units = assignments(self.unit, "--unit")
        others = [user_file(Path(each)) for each in self.validate]
        found = identify_file(file, entry, self.law, columns, units, others, links=self.links)
        if self.plot:
            with whole_file(self.plot) as path:
                save(residual_figure(found), path)
        if self.motion:
            motion = planned_motion(entry, found.centre, found.fastest)
            with whole_file(self.motion) as path:
                path.write_text(motion_text(entry, motion), encoding="utf-8")
        data = identification_data(found) if self.json else None
        print(json.dumps(data, indent=2) if self.json else identification_text(found))
