"""OnPath: a browser lab in which path following and trajectory tracking can be compared.

In Python, without a browser:

>>> import onpath
>>> run = onpath.simulate(robot="five_bar", law="path_following", hold=(1, 2), duration=3)
>>> run.distance.shape  # [m], one row per millisecond
(3000,)

`run.plot()` draws it, `run.to_csv("a.csv")` writes it; `help(onpath.simulate)` describes the
arguments. Robot, path and law come first, in this order, in every function, and on the command line
as `--robot`, `--path` and `--law`: each is a name, a text, a file or an object. A custom law
in CasADi is made with `onpath.followed`, `onpath.tangential` and `onpath.own_gain`, of what
`help(onpath.View)` lists; one that is a function is given what `help(onpath.Now)` lists.
`onpath.sweep` and `onpath.arena` take several of each, `onpath.figure` makes a live page, and
`onpath.controller` a controller for a plant that is elsewhere.
Names are listed by `onpath.robots()`, `onpath.laws()`, `onpath.paths()` and
`onpath.parameters("five_bar")`. The same arguments give the same motion here, on the command line,
in figures and in the lab. A new lab and a figure begin more slowly, as with `**onpath.NEWCOMER`.
"""

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from onpath.app.common.newcomer import NEWCOMER as NEWCOMER
    from onpath.app.notebook.arena import ArenaResult as ArenaResult
    from onpath.app.notebook.arena import arena as arena
    from onpath.app.notebook.controller import controller as controller
    from onpath.app.notebook.figure import figure as figure
    from onpath.app.notebook.identify import identify as identify
    from onpath.app.notebook.own_law import Now as Now
    from onpath.app.notebook.own_law import View as View
    from onpath.app.notebook.own_law import followed as followed
    from onpath.app.notebook.own_law import own_gain as own_gain
    from onpath.app.notebook.own_law import tangential as tangential
    from onpath.app.notebook.path_files import check_path as check_path
    from onpath.app.notebook.path_files import path_from as path_from
    from onpath.app.notebook.robot import robot as robot
    from onpath.app.notebook.run import Run as Run
    from onpath.app.notebook.simulate import circle as circle
    from onpath.app.notebook.simulate import ellipse as ellipse
    from onpath.app.notebook.simulate import laws as laws
    from onpath.app.notebook.simulate import parameters as parameters
    from onpath.app.notebook.simulate import paths as paths
    from onpath.app.notebook.simulate import robots as robots
    from onpath.app.notebook.simulate import segment as segment
    from onpath.app.notebook.simulate import simulate as simulate
    from onpath.app.notebook.simulate import through as through
    from onpath.app.notebook.sweep import SweepResult as SweepResult
    from onpath.app.notebook.sweep import sweep as sweep

__all__ = (
    "NEWCOMER",
    "ArenaResult",
    "Now",
    "Run",
    "SweepResult",
    "View",
    "arena",
    "check_path",
    "circle",
    "controller",
    "ellipse",
    "figure",
    "followed",
    "identify",
    "laws",
    "own_gain",
    "parameters",
    "path_from",
    "paths",
    "robot",
    "robots",
    "segment",
    "simulate",
    "sweep",
    "tangential",
    "through",
)

_MODULES = {
    "ArenaResult": "arena",
    "arena": "arena",
    "controller": "controller",
    "figure": "figure",
    "identify": "identify",
    "robot": "robot",
    "Now": "own_law",
    "View": "own_law",
    "followed": "own_law",
    "own_gain": "own_law",
    "tangential": "own_law",
    "path_from": "path_files",
    "check_path": "path_files",
    "sweep": "sweep",
    "SweepResult": "sweep",
}
"""Public names that are not in app/notebook/simulate.py -> the module that has them."""

# A wheel has app, assets, lessons and models in this folder; a checkout has them beside it.
if not (Path(__file__).parent / "app").is_dir():
    __path__.append(str(Path(__file__).parents[1]))


def __getattr__(name: str) -> Any:
    """Public names, imported when they are first used: `import onpath` alone is quick."""
    if name == "__version__":
        return import_module("importlib.metadata").version("onpath")
    if name not in __all__:
        raise AttributeError(f"module 'onpath' has no attribute {name!r}")
    module = import_module(f"onpath.app.notebook.{_MODULES.get(name, 'simulate')}")
    globals()[name] = getattr(module, name)
    return globals()[name]


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
