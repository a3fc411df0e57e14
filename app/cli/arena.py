"""`onpath arena`: all control laws, and the user's, through the same trials."""

from __future__ import annotations

import shlex
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions

INTERRUPTED = 130


@dataclass(frozen=True)
class ArenaCommand:
    """Run all control laws, and yours, through the same trials; write a page and a CSV file.

    The first round has every obstruction once, on the circle with an exact model. Further rounds
    have random paths and conditions. The page is written after each round and on Ctrl-C.
    """

    robot: Repeated = ()
    """Name of a robot, or its URDF or MJCF file. Repeat, or put commas between, for more. By
    default the five-bar and the two-link arm."""
    law: Repeated = ()
    """Your law, as my_law.py:Name, or typed, as "across = …; along = …"; repeat for more."""
    only: bool = False
    """Compare only the laws given, which may also be names of OnPath's laws."""
    set: Repeated = ()
    """Set any parameter of the robots in all trials, as name=value, or @FILE of onpath identify
    --json; repeat for more. What a trial draws takes its place."""
    rounds: int = 3
    """Number of rounds."""
    seed: int = 1
    """Seed of the random numbers: the same seed gives the same trials."""
    processes: int = 0
    """Number of processes; 0: one for each processor."""
    folder: Path | None = None
    """Keep finished runs in this folder: an arena that was interrupted goes on where it was."""
    html: Path = Path("arena.html")
    """The page. Its live figures are in a folder beside it, NAME-figures."""
    csv: Path = Path("arena.csv")
    """All runs, one per line."""
    no_figures: bool = False
    """Write no live figures. By default there is one of each law on each robot, unless a law is a
    Python function."""
    language: str = "en"
    """Language of the page."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> int:
        """Simulate and write; return 130 if it was interrupted."""
        from onpath.app.common.atomic_file import check_file
        from onpath.app.common.own_laws import law_given
        from onpath.app.exports.arena_run import Arena, ArenaOptions
        from onpath.lessons.words import Words
        from onpath.models.studies.arena import ROBOT_NAMES

        check_file(self.html, (".html",), "--html")
        check_file(self.csv, (".csv",), "--csv")
        began = time.monotonic()
        options = ArenaOptions(
            laws=[law_given(text) for text in self.law],
            robots=self.file_options.names_of(self.robot or ROBOT_NAMES),
            only=self.only,
            settings=assignments(self.set),
            rounds=self.rounds,
            seed=self.seed,
            processes=self.processes,
            folder=self.folder,
            html=self.html,
            csv=self.csv,
            figures=not self.no_figures,
            language=self.language,
            command=shlex.join(["onpath", "arena", *sys.argv[2:]]),
        )
        arena, words = Arena(options), Words(self.language)

        def show_first(number: int) -> None:
            if number == 0 and self.rounds > 1:
                told = words("arena.first", seconds=f"{time.monotonic() - began:.0f}")
                print(f"onpath: {told}\n\n{arena.text}\n", file=sys.stderr)

        finished = arena.run(show_first)
        if text := arena.text:
            print(text)
        told = "arena.written" if finished else "arena.interrupted" if text else "arena.nothing"
        print(f"onpath: {words(told, html=str(self.html), csv=str(self.csv))}", file=sys.stderr)
        return 0 if finished else INTERRUPTED
