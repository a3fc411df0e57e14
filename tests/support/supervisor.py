"""`onpath --workers` in a separate process, for tests."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from onpath.app.storage.records import Records
from tests.support import waiting
from tests.support.checkout import ROOT


class Supervisor:
    """`onpath --workers` and its output."""

    def __init__(self, folder: Path, *options: str) -> None:
        self.database = f"sqlite:///{folder / 'labs.db'}"
        command = [sys.executable, "-m", "onpath", "--database", self.database, *options]
        self.process = subprocess.Popen(
            command,
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.said = ""
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said += line

    def wait_for(self, pattern: str, times: int = 1) -> list[str]:
        def found() -> list[str]:
            return re.findall(pattern, self.said, re.MULTILINE)

        try:
            waiting.wait_for(lambda: len(found()) >= times, 60.0)
        except AssertionError:
            raise AssertionError(self.said) from None
        return found()

    @cached_property
    def records(self) -> Records:
        """What it keeps; to be read once it is ready."""
        return Records(self.database)

    def has_kept(self, code: str, *words: str) -> bool:
        """Whether all of this stands in the stored state of a lab."""
        state = str(self.records.load(code))
        return all(word in state for word in words)

    def end(self) -> None:
        """Kill it, which ends its workers as well."""
        self.process.kill()
        self.process.wait()
        if "records" in vars(self):
            self.records.close()

    def workers(self) -> list[int]:
        """Process ids of the running workers."""
        children = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        return [int(word) for file in children for word in file.read_text().split()]

    def sockets(self, worker: int) -> int:
        """Number of connections of a worker."""
        own: set[str] = set()
        for descriptor in Path(f"/proc/{worker}/fd").iterdir():
            with suppress(OSError):
                own.add(os.readlink(descriptor).removeprefix("socket:["))
        rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
        return sum(row[3] == "01" and f"{row[9]}]" in own for row in rows)
