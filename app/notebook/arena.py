"""`onpath.arena`: all control laws, and the user's, through the same trials."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from onpath.app.exports.arena_page import Contents, run_rows, table_rows
from onpath.app.exports.arena_run import Arena, ArenaOptions
from onpath.app.notebook.simulate import entry_named, law_of
from onpath.models.control.laws.registry import LAWS
from onpath.models.studies.arena import ROBOT_NAMES
from onpath.models.systems.robots import RobotEntry

GivenRobot = str | Path | RobotEntry


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ArenaResult:
    """The results of an arena, for the trials that all laws have finished; printed as tables.

    Attributes:
        contents: the results.
        text: the tables, in Markdown.
    """

    contents: Contents
    text: str

    @property
    def table(self) -> list[dict[str, Any]]:
        """A row for each robot, law and reaction at the torque limit, such as for `pandas`.

        With `robot`, `law`, `at_limit` ("cut", "remedy", or "torques" for a law that commands
        torques), `stops`, and for each measure its worst value, `_median` and `_rank`. Measures are
        `force_N`, `distance_m`, `delay_s`, `energy_J` and `overshoot_m`, as on the page; None if no
        run has given one, infinity for a path that was not left, or not reached again.
        """
        return list(table_rows(self.contents))

    @property
    def runs(self) -> list[dict[str, Any]]:
        """A row for each run, as in the CSV file of `onpath arena`."""
        return list(run_rows(self.contents))

    def __repr__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.text


def arena(
    robot: GivenRobot | Sequence[GivenRobot] = ROBOT_NAMES,
    law: Any = (),
    *,
    only: bool = False,
    rounds: int = 3,
    seed: int = 1,
    processes: int = 0,
    folder: str | Path | None = None,
    html: str | Path | None = None,
    csv: str | Path | None = None,
    figures: bool = True,
    language: str = "en",
    **settings: float | str,
) -> ArenaResult:
    """Run all control laws, and yours, through the same trials, as `onpath arena` does.

    It takes minutes. If it is interrupted, what all laws have finished is returned. The runs are
    shared among processes by joblib, as those of `onpath.sweep`: also among those of a cluster.

    Args:
        robot: one as for `onpath.simulate`, or several.
        law: a custom law, or several, as for `onpath.simulate`.
        only: compare only the laws given, which may also be names of `onpath.laws()`.
        rounds: number of rounds. Each has five obstructions for each robot; the first is on the
            circle with an exact model, others have random paths and conditions.
        seed: of the random numbers: the same seed gives the same trials.
        processes: number of processes; 0: what joblib is set to, or one for each processor.
        folder: a folder in which finished runs are kept: an arena that was interrupted goes on
            where it was. None: nothing is kept.
        html: the page to write; it is written after each round.
        csv: the file of all runs to write, one per line.
        figures: whether a live figure of each law on each robot is written, in a folder beside the
            page.
        language: of the page and of the tables.
        settings: any of `onpath.parameters(robot)` by name, in all trials, such as coulomb=0.03;
            what a trial draws takes its place.

    Raises:
        ValueError: an unknown name, an invalid number, a law that does not suit a robot or has an
            error, or a file that cannot be written.

    Warns:
        UserWarning: the arena was interrupted.
    """
    laws = law if isinstance(law, list | tuple) else [law]
    robots = [robot] if isinstance(robot, str | Path | RobotEntry) else robot
    for each in robots:
        if callable(each) or hasattr(each, "command") or each in LAWS:
            raise ValueError(f"arena: {each!r:.60} is a law: arena(law=…)")
    names = [law_of(each) for each in laws]
    entries = [entry_named(each).name for each in robots]
    given = {"robot": entries, "only": only, "rounds": rounds, "seed": seed, **settings}
    told = ", ".join([f"law={names!r}", *(f"{name}={value!r}" for name, value in given.items())])
    options = ArenaOptions(
        laws=names,
        robots=entries,
        only=only,
        settings=settings,
        rounds=rounds,
        seed=seed,
        processes=processes,
        folder=None if folder is None else Path(folder).expanduser(),
        html=None if html is None else Path(html).expanduser(),
        csv=None if csv is None else Path(csv).expanduser(),
        figures=figures,
        language=language,
        command=f"onpath.arena({told})",
    )
    entered = Arena(options)
    if not entered.run():
        warnings.warn("interrupted: these are the trials that all laws have finished", stacklevel=2)
    return ArenaResult(entered.contents, entered.text)
