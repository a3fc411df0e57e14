"""Has the loops of a class's next steps made before anybody waits for them."""

from __future__ import annotations

from functools import partial

from onpath.app.common.work_thread import WorkThread
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_registry import LabRegistry


class StepLoops:
    """Prepares steps, each once. Thread-safe."""

    def __init__(self, registry: LabRegistry) -> None:
        self._registry, self._thread = registry, WorkThread("steps")
        self._known = set[tuple[str, int]]()

    def prepare(self, step: TakeStep) -> None:
        """Have the loops of a step made when no lab waits for others."""
        key = step.lesson, step.step
        if key not in self._known:
            self._known.add(key)
            self._thread.submit(partial(self._prepare, step))

    def close(self) -> None:
        """Start no further work."""
        self._thread.close()

    def _prepare(self, step: TakeStep) -> None:
        lab = self._registry.unowned_lab().lab
        step.apply(lab)
        lab.simulation.prepare_loops()
