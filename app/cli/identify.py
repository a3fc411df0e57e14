"""`onpath identify`: a robot's parameters from a recorded motion."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

if TYPE_CHECKING:
    from onpath.models.studies.linear_model import BaseParameter, Estimate

MUCH = 0.1  # unexplained share of the torque above which the table warns


@dataclass(frozen=True)
class IdentifyCommand:
    """Estimate a robot's parameters from a CSV file that an experiment or the lab wrote."""

    file: Annotated[Path, tyro.conf.Positional]
    """CSV file of `onpath experiment --csv` or of the lab's export. A spreadsheet may have saved it
    again, with other separators, decimal commas or another encoding. If it has columns of
    measured angles, these are used, and their rates by a filter; otherwise the true ones."""
    robot: str = "five_bar"
    """Name of the robot."""
    law: str = ""
    """Use only the rows of this control law; all by default."""
    json: bool = False
    """Print the result as JSON."""

    def run(self) -> None:
        """Read, estimate and print."""
        from onpath.models.errors import CodedError
        from onpath.models.studies.linear_model import estimate, linear_model
        from onpath.models.studies.record_file import read_records
        from onpath.models.systems.catalogue import ROBOTS
        from onpath.models.systems.parameter_specs import unknown_name

        if self.robot not in ROBOTS:
            raise unknown_name(self.robot, list(ROBOTS), "robot")
        entry = ROBOTS[self.robot]
        robot = entry.make(entry.parameters())
        linear_model(robot.system)  # refuse an unsuitable robot before reading
        try:
            records = read_records(self.file, robot)
        except CodedError as error:
            raise ValueError(f"{self.file}: {error}") from None
        known = list(dict.fromkeys(law for law, _ in records))
        if self.law and known == [""]:
            raise ValueError(f"--law {self.law}: {self.file} has no column law")
        laws = [law for law in known if self.law in ("", law)]
        if not laws:
            raise unknown_name(self.law, known, "law")
        used = [each for law, each in records if law in laws]
        geometry = robot.plant(entry.parameters())
        result = estimate(robot.system, used, geometry)
        seconds = sum(len(each.q) * each.dt for each in used)
        angles = "measured" if all(each.measured for each in used) else "true"
        if self.json:
            data = _data(self.robot, laws, seconds, result) | {"angles": angles}
            print(json.dumps(data, indent=2))
        else:
            print(_table(self.robot, laws, seconds, result, angles))


def _data(robot: str, laws: list[str], seconds: float, result: Estimate) -> dict[str, Any]:
    return {
        "robot": robot,
        "laws": [law for law in laws if law],
        "seconds": round(seconds, 6),
        "parameters": [_entry(each) for each in result.found],
        "not_excited": list(result.unexcited),
        "unexplained": float(f"{result.unexplained:.3g}"),
        "torque_late_s": float(f"{result.late:.3g}"),
    }


def _entry(each: BaseParameter) -> dict[str, Any]:
    return {
        "name": each.name,
        "plus": {name: float(f"{share:.6g}") for name, share in each.others},
        "value": float(f"{each.value:.9g}"),
        "standard_error": float(f"{each.error:.3g}"),
    }


def _table(robot: str, laws: list[str], seconds: float, result: Estimate, angles: str) -> str:
    """The result as text."""
    under = f" under {', '.join(laws)}" if any(laws) else ""
    lines = [f"{robot}: {seconds:.1f} s{under}, from the {angles} angles"]
    lines += [
        f"  {each.label():24s} {each.value:12.6g}  ± {each.error:.2g}" for each in result.found
    ]
    if any(each.others for each in result.found):
        lines.append("  the motion does not tell the parameters of a sum apart")
    if result.unexcited:
        lines.append(f"  not excited: {', '.join(result.unexcited)}")
    lines.append(f"  {100 * result.unexplained:.2g} % of the torque is not explained")
    lines.append(
        "  ± is one standard error from what is not explained. It leaves out what all rows share:"
        " wrong geometry, scale or time of torques and forces, the filter of measured rates, and"
        " terms that the model lacks."
    )
    if result.unexplained > MUCH:
        lines.append(
            f"  so much is not explained that no value above can be trusted: is the robot {robot},"
            " and is everything in s, rad, N m and N?"
        )
    if result.late:
        side = "behind" if result.late > 0 else "ahead of"
        lines.append(
            f"  the torques seem to be logged {1e3 * abs(result.late):.1f} ms {side} the motion:"
            " then no value above can be trusted"
        )
    return "\n".join(lines)
