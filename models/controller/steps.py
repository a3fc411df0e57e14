"""A controller that runs, in CasADi's virtual machine."""

from __future__ import annotations

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.controller.functions import REFUSALS, Functions


class Steps:
    """A controller's functions with settings, path and state. Not thread-safe.

    Args:
        functions: of the controller.
        settings: of the controller, shape (functions.settings.size,).
        table: `Curve.table()`.

    Attributes:
        settings, table: may be replaced between two steps.
        state: shape (functions.state.size,); None until it is started.
    """

    def __init__(self, functions: Functions, settings: Array, table: Array) -> None:
        self.settings, self.table, self.state = settings, table, np.empty(0)
        self._layout = functions.state
        self._begin, self._due = Buffered(functions.begin), Buffered(functions.due)
        self._tick = Buffered(functions.tick)

    @property
    def started(self) -> bool:
        """Whether it has been started."""
        return len(self.state) > 0

    @property
    def fields(self) -> dict[str, Array]:
        """Views of the state's fields by name, once it has been started."""
        return self._layout.unpack(self.state)

    def start(self, t: float, q: Array, v: Array, theta: float) -> None:
        """Begin at time t [s], with the closest point at θ [rad]; q and v: shape (n,)."""
        self.state = self._begin(t, q, v, theta)[0].copy()

    def step(self, t: float, q: Array, v: Array | None = None) -> Array:
        """Torques of the motors from a measurement, shape (m,), [N m]; see `Functions.step`."""
        none = np.zeros_like(q)
        for _ in range(int(self._due(self.state, self.settings, t)[0][0])):
            self._advance(t, none, none, (0.0, 0.0))
        rates, flags = (none, (1.0, 0.0)) if v is None else (v, (1.0, 1.0))
        return self._advance(t, q, rates, flags)

    def refuse(self, reason: str) -> None:
        """Refuse from the next step on, for one of `REFUSALS`, unless a step has been refused."""
        code = self.fields["code"]
        if code[0] == 0:
            code[:] = [*REFUSALS].index(reason) + 1

    def _advance(self, t: float, q: Array, v: Array, has: tuple[float, float]) -> Array:
        sample = np.concatenate([[t], q, v, has])
        state, torque = self._tick(self.state, self.settings, self.table, sample)
        self.state = state.copy()
        return torque.copy()
