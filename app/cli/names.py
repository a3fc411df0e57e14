"""`onpath names`: the names that the other commands take."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions


@dataclass(frozen=True)
class NamesCommand:
    """List the names of robots, paths, laws, and a robot's settings with ranges and units."""

    robot: str = "five_bar"
    """Whose settings are listed: its name, or its URDF or MJCF file."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Print the lists."""
        from onpath.app.notebook.simulate import described, laws, parameters, paths, robots
        from onpath.models.closed_loop.lab_settings import SETTINGS
        from onpath.models.studies import schedule

        entry = self.file_options.entry_of(self.robot)
        lists = {
            "--robot": robots(),
            "--path": paths(),
            "--law": laws(),
            f"--set, of {entry.name}": parameters(entry),
            "--set of a new lab (onpath serve), too": {
                name: described(each.spec, each.default) for name, each in SETTINGS.items()
            },
        }
        for title, names in lists.items():
            print(title)
            for name, text in names.items():
                print(f"  {name:24}  {text}")
        print(f"--set of onpath experiment, too\n  {', '.join(sorted(schedule.NAMES))}")
