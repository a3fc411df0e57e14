"""`onpath control`: a control law drives a plant that is elsewhere, and reached by UDP."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal
from urllib.parse import urlsplit

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file

if TYPE_CHECKING:
    from onpath.app.plant.controller_process import Address, ControllerPlan


@dataclass(frozen=True)
class ControlCommand:
    """Drive a plant elsewhere: answer its measured positions with torques, over UDP.

    Not a safety function: a real arm needs a stop that cuts the power, and its maker's limits.
    """

    plant: Annotated[str, tyro.conf.Positional]
    """Address where the controller listens for the plant: udp://HOST:PORT, of this machine."""
    open_to_others: bool = False
    """Allow an address that other machines can reach. There is no password: whoever sends a
    measurement first is the plant."""
    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    path: Repeated = ()
    """A path, such as circle or "ellipse 0.07 0.04", or @FILE with options, as for onpath
    experiment. Repeat for more that can be followed in turn. By default the circle."""
    law: Repeated = ()
    """A control law: a name; or one of your own, as "across = …; along = …", or in CasADi,
    my_law.py:Name. Repeat for more that can act in turn. By default path_following."""
    at_fault: Literal["zero", "hold", "damp"] = "zero"
    """Torque after the end: none, the last one, or against the velocities."""
    fastest: float = 100.0
    """Largest rate of a joint, above which a measurement ends it, in rad/s, or m/s of one that
    slides."""
    set: Repeated = ()
    """Set any parameter of the robot as name=value; repeat for more. It must have torque_limit."""
    log: Path | None = None
    """Write time, positions, velocities and torques to this CSV file at the end."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> int:
        """Drive the plant until Enter or Ctrl-C; return 1 if the controller has ended itself."""
        check_file(self.log, (".csv",), "--log")
        address = plant_address(self.plant, open_to_others=self.open_to_others)

        from onpath.app.cli.driving import Driving, write_log
        from onpath.app.plant.controller_process import ControllerProcess

        beside = ControllerProcess(self._plan(), address)
        driving = Driving(beside, self.at_fault, keeps=self.log is not None)
        try:
            code = driving.run()
        except BaseException:  # such as a terminal that is gone
            beside.leave()
            raise
        finally:
            if self.log:
                write_log(self.log, beside.robot, driving.rows)
        beside.close()
        return code

    def _plan(self) -> ControllerPlan:
        from onpath.app.notebook.arguments import curve_of, path_name
        from onpath.app.plant.controller_process import ControllerPlan
        from onpath.models.control.settable import value_of, with_values

        entry = self.file_options.entry_of(self.robot)
        given = assignments(self.set)
        parameters = with_values(entry.parameters(), given)
        if parameters.torque_limit == 0:
            raise ValueError("a plant needs limits: --set torque_limit=... in N m")
        robot = entry.make(parameters)
        named = {path_name(each): each for each in self.path or ("circle",)}
        return ControllerPlan(
            robot=entry,
            paths={name: curve_of("--path", each, robot) for name, each in named.items()},
            laws=self.law or ("path_following",),
            at_fault=self.at_fault,
            fastest=self.fastest,
            settings={name: value_of(parameters, name) for name in given},
        )


def plant_address(text: str, *, open_to_others: bool) -> Address:
    """Host and port of udp://HOST:PORT.

    Raises:
        ValueError: it is no such address, or other machines can reach it and that is not wanted.
    """
    from onpath.app.viser_adapter.request_filter import is_loopback

    try:
        parts = urlsplit(text)
        host, port = parts.hostname, parts.port
    except ValueError:  # a port that is no number from 0 to 65535, or a bracket too few
        host = port = None
    if text.partition("://")[0] != "udp" or not host or port is None or parts.path:
        raise ValueError(f"{text}: expected udp://HOST:PORT, such as udp://127.0.0.1:9000")
    if not (is_loopback(host) or open_to_others):
        raise ValueError(
            f"{text}: other machines can reach this address, and drive the plant or be driven:"
            " use udp://127.0.0.1:PORT, or add --open-to-others"
        )
    return host, port
