"""`onpath export site`: the course as a folder of pages that need no server."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from onpath.app.cli.options import Repeated


@dataclass(frozen=True)
class ExportSite:
    """Write the course as a static site: lessons with live figures, in all languages."""

    target: Annotated[Path, tyro.conf.Positional]
    """The folder to write; an earlier site in it is replaced."""
    lessons: Path | None = None
    """Folder of lessons; by default the built-in ones."""
    language: Repeated = ()
    """A language; repeat for more. By default all, English first."""

    def run(self) -> None:
        """Write the site, and print its size."""
        from rich.console import Console

        from onpath.app.exports.site.write_site import write_site
        from onpath.assets.messages import languages
        from onpath.lessons.course import BUILT_IN, read_course

        known = sorted(languages(), key=lambda language: (language != "en", language))
        for language in self.language:
            if language not in known:
                raise ValueError(f"--language {language}: there are {', '.join(known)}")
        home = self.lessons or BUILT_IN
        course, problems = read_course([home])
        if problems:
            raise ValueError(str(problems[0]))
        console = Console(stderr=True, quiet=not sys.stderr.isatty())
        with console.status("reading lessons") as shown:
            write_site(self.target, course, home, self.language or known, shown.update)
        files = [file for file in self.target.rglob("*") if file.is_file()]
        size = sum(file.stat().st_size for file in files)
        print(f"{self.target}: {len(files)} files, {size / 1e6:.1f} MB, needs no server")
