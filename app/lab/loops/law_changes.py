"""Changes of one lab's control laws, each made as soon as the loop that it needs is ready.

A chosen law takes effect when its loop can run; until then the old law stays in force. A typed law
in force may need another loop after a change of the robot or of a parameter: simulated time then
stands still until that loop is ready. Nothing here blocks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.loops.typed_loops import Key
from onpath.models.closed_loop.loops import CompiledLoop, Loop
from onpath.models.closed_loop.simulation import FREE, Push, kind_of
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


def suits(law: str, robot: Robot, parameters: Parameters) -> bool:
    """Whether a law can be used with a robot and its controlled output."""
    entry, composite = law_named(law), getattr(parameters, "law", "") == "composite"
    return entry.suits(robot.system) and (entry.commands_acceleration or not composite)


class LawChanges:
    """The pending changes of law, and the loops that they lack.

    Args:
        store: provides the loops.
        change: changes the law of a side now.

    Attributes:
        coming: laws whose loops are being made, by side.
        stands_still: whether time waits for them, because a run begins with them.
        remarks: what the user has not been told yet: why a law cannot be used, or not compiled.
    """

    def __init__(self, store: LoopCache, change: Callable[[str, str], None]) -> None:
        self._store, self._change = store, change
        self.coming: dict[str, str] = {}
        self.stands_still = False
        self.remarks: list[ValueError] = []
        self._interpreted = set[str]()  # laws of which the user has been told
        self._asked = False  # whether the last frame asked for loops of typed laws

    def begin(
        self, laws: Mapping[str, str], robot: Robot, parameters: Parameters, curve: Curve
    ) -> dict[str, str]:
        """The laws with which a run can begin now, given the chosen ones.

        A law that does not suit the robot is replaced by a new lab's. So is a typed law whose loop
        is not ready, and time stands still until it is.
        """
        chosen = {**DEFAULT_LAWS, **laws}
        first = {
            side: law if suits(law, robot, parameters) else DEFAULT_LAWS[side]
            for side, law in chosen.items()
        }
        coming = self.coming.items()
        self.coming = {side: law for side, law in coming if suits(law, robot, parameters)}
        late = dict[str, str]()
        for side, law in list(first.items()):
            if is_text(law):
                ready = self._is_ready((robot, kind_of(law, parameters, curve, FREE)))
                if not ready:
                    first[side] = DEFAULT_LAWS[side]
                if ready is False:
                    late[side] = law
        self.stands_still = bool(late) or (self.stands_still and bool(self.coming))
        self.coming = late | self.coming
        return first

    def follow(
        self,
        runs: Mapping[str, ClosedLoopRun],
        parameters: Parameters,
        curve: Curve,
        pushes: Mapping[str, Push],
    ) -> bool:
        """Make the changes that can be made now, and ask for the loops that are lacking.

        Args:
            parameters, curve, pushes: the inputs of the next frame; pushes by side.

        Returns:
            Whether time can run: no robot is under a typed law that needs another loop.
        """
        typed = [side for side, run in runs.items() if run.is_typed]
        if not (typed or self.coming or self._asked):
            return True
        kinds = {side: runs[side].lacks(parameters, curve, pushes[side]) for side in typed}
        lacking = {
            side: (runs[side].robot, kind) for side, kind in kinds.items() if kind is not None
        }
        coming = {
            side: (runs[side].robot, kind_of(law, parameters, curve, pushes[side]))
            for side, law in self.coming.items()
        }
        self._ask([*lacking.values(), *coming.values()])
        for side, (robot, kind) in coming.items():
            ready = self._is_ready((robot, kind))
            if ready:
                self._store.prepare(robot, kind_of(kind.controller, parameters, curve))
                self._change(side, self.coming[side])
            elif ready is None:
                del self.coming[side]
        self.stands_still = self.stands_still and bool(self.coming)
        goes_on = [self._goes_on(side, runs[side], key) for side, key in lacking.items()]
        return all(goes_on) and not self.stands_still

    def remark_on(self, moving: Iterable[tuple[ClosedLoopRun, Loop]]) -> None:
        """Remark once on each law that is interpreted because it cannot be compiled."""
        for run, loop in moving:
            if isinstance(loop, CompiledLoop) or run.law in self._interpreted:
                continue
            if (reason := self._store.why_interpreted(run.robot, run.kind)) is not None:
                self._interpreted.add(run.law)
                self.remarks.append(CodedError("say.law_interpreted", reason=reason))

    def _goes_on(self, side: str, run: ClosedLoopRun, key: Key) -> bool:
        """Whether a typed law can go on; if it never can, the side gets a new lab's law."""
        _, kind = key
        if run.kind == kind or run.law != kind.controller:  # it has just been changed
            return True
        ready = self._is_ready(key)
        if ready is None:
            self._change(side, DEFAULT_LAWS[side])
        return ready is not False

    def _ask(self, keys: Sequence[Key]) -> None:
        """Ask for the loops of typed laws among these, and cancel this lab's other requests."""
        typed = [(robot, kind) for robot, kind in keys if is_text(kind.controller)]
        if typed or self._asked:
            self._store.want(self, typed)
        self._asked = bool(typed)

    def _is_ready(self, key: Key) -> bool | None:
        """Whether a loop is ready; None if it cannot be made, of which the user is told."""
        robot, kind = key
        try:
            return self._store.is_ready(robot, kind)
        except ValueError as error:
            self.remarks.append(error)
            return None
