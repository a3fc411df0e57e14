"""A system without what only Linux, or only Unix, has, as OnPath's own code sees it.

`python -m tests.support.elsewhere` imports every module of OnPath there, and runs the command that
follows.
"""

from __future__ import annotations

import builtins
import importlib
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from tests.support.checkout import ROOT, modules

MISSING = re.compile(r"(resource|fcntl|pwd|grp|termios|tty|pty|syslog|crypt|posix)\b")
"""Modules that Windows does not have."""

LACKING = {
    "faulthandler": r"register|unregister",
    "os": r"sched_\w+|fork\w*|(get|set)e?[ug]id|getgroups|[gs]et(sid|pgid|pgrp)|killpg|nice"
    r"|getloadavg|register_at_fork|sysconf\w*|f?chown|fchmod|mkfifo|posix_\w+|wait[34]?|W[A-Z]+"
    r"|memfd_\w+|pidfd_\w+|eventfd\w*|set_blocking|O_(NOFOLLOW|DIRECTORY|CLOEXEC|NONBLOCK|SYNC)",
    "signal": r"SIG(PROF|KILL|HUP|USR[12]|ALRM|CHLD|PIPE|CONT|STOP|TSTP|QUIT|WINCH)|[gs]etitimer"
    r"|ITIMER_\w+|pthread_\w+|sig(wait|pending|timedwait)\w*|alarm|pause|set_wakeup_fd",
    "socket": r"AF_(UNIX|NETLINK|PACKET)|SO_REUSEPORT|socketpair|send_fds|recv_fds",
    "time": r"clock_\w+|CLOCK_\w+|tzset|pthread_\w+",
}
"""Their names that Windows does not have, by module."""


class Without(ModuleType):
    """A module without some of its names, and with others of its own."""

    def __init__(self, module: ModuleType, lacking: str, own: Mapping[str, object]) -> None:
        super().__init__(module.__name__)
        self.__dict__.update(_module=module, _lacking=re.compile(lacking), **own)

    def __getattr__(self, name: str) -> Any:
        if self._lacking.fullmatch(name):
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r} here")
        return getattr(self._module, name)


def leave_linux(platform: str) -> None:
    """Take what is not on the `platform` away from OnPath's own modules, not from libraries."""
    importing = builtins.__import__
    seen: dict[str, ModuleType] = {
        name: Without(importlib.import_module(name), lacking, {})
        for name, lacking in LACKING.items()
    }
    seen["sys"] = Without(sys, "getandroidapilevel", {"platform": platform})

    def import_(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        if str((globals or {}).get("__name__", "")).partition(".")[0] == "onpath":
            if MISSING.match(name):
                raise ModuleNotFoundError(f"No module named {name!r} here", name=name)
            if name in seen:
                return seen[name]
        return importing(name, globals, locals, fromlist or (), level)

    builtins.__import__ = import_


def main() -> None:
    """Import everything, then run the command line."""
    leave_linux("win32")
    for name in modules():
        importlib.import_module(name)
    for name in modules():
        for key, value in vars(sys.modules[name]).items():
            if isinstance(value, Path) and value.parts[1:2] == ("proc",):
                setattr(sys.modules[name], key, ROOT / "no" / "proc")
    if sys.argv[1:]:
        from onpath.app.cli.main import run_command

        sys.exit(run_command(sys.argv[1:]))


if __name__ == "__main__":
    main()
