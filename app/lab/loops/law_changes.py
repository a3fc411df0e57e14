"""Changes of one lab's control laws, each made as soon as the loop that it needs is ready.

A chosen law takes effect when its loop can run; until then the old law stays in force. If a law in
force needs another loop, after a change of the robot or of a parameter, simulated time stands still
until that loop is ready. Nothing here blocks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.loops.loop_cache import Key, LoopCache
from onpath.models.closed_loop.loops import CompiledLoop, Loop
from onpath.models.closed_loop.simulation import FREE, Push, kind_of
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


def suits(law: str, robot: Robot, parameters: Parameters) -> bool:
    """Whether a law can be used with a robot and its controlled output."""
    entry, composite = law_named(law), getattr(parameters, "output", "") == "composite"
    return entry.suits(robot.system) and (entry.commands_acceleration or not composite)


class LawChanges:
    """The pending changes of law, and the loops that they lack.

    Args:
        loop_cache: provides the loops.
        change: changes the law of a side now.

    Attributes:
        coming: laws whose loops are being made, by side.
        remarks: what the user has not been told yet, for instance why a law cannot be used.
    """

    def __init__(self, loop_cache: LoopCache, change: Callable[[str, str], None]) -> None:
        self._loop_cache, self._change = loop_cache, change
        self.coming: dict[str, str] = {}
        self.remarks: list[ValueError | Message] = []
        self._interpreted = set[str]()  # laws of which the user has been told
        self._asked = False  # whether the last frame asked for loops

    def begin(
        self, laws: Mapping[str, str], robot: Robot, parameters: Parameters
    ) -> dict[str, str]:
        """The laws with which a run begins: a new lab's for those that do not suit the robot."""
        chosen = {**DEFAULT_LAWS, **laws}
        coming = self.coming.items()
        self.coming = {side: law for side, law in coming if suits(law, robot, parameters)}
        return {
            side: law if suits(law, robot, parameters) else DEFAULT_LAWS[side]
            for side, law in chosen.items()
        }

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
            Whether time can run: no robot lacks its loop.
        """
        lacking = dict[str, Key]()
        for side, run in runs.items():
            kind = run.lacks(parameters, curve, pushes[side])
            if kind is not None and run.diverged is None:
                lacking[side] = run.robot, kind
        if not (lacking or self.coming or self._asked):
            return True
        coming = {
            side: (runs[side].robot, kind_of(law, parameters, curve, pushes[side]))
            for side, law in self.coming.items()
        }
        self._ask([*lacking.values(), *coming.values()], parameters, curve)
        for side, key in coming.items():
            ready = self._is_ready(key)
            if ready:
                self._change(side, self.coming[side])
            elif ready is None:
                del self.coming[side]
        return all([self._goes_on(side, runs[side], key) for side, key in lacking.items()])

    def remark_on(self, moving: Iterable[tuple[ClosedLoopRun, Loop]]) -> None:
        """Remark once on each law that is interpreted because it cannot be compiled."""
        for run, loop in moving:
            if isinstance(loop, CompiledLoop) or run.law in self._interpreted:
                continue
            if (reason := self._loop_cache.why_interpreted(run.robot, run.kind)) is not None:
                self._interpreted.add(run.law)
                self.remarks.append(CodedError("say.law_interpreted", reason=reason))

    def _goes_on(self, side: str, run: ClosedLoopRun, key: Key) -> bool:
        """Whether a law has its loop; if it cannot have one, the side gets a new lab's law."""
        if run.law != key[1].law:  # it has just been changed
            return True
        ready = self._is_ready(key)
        if ready is None:
            self._change(side, DEFAULT_LAWS[side])
            ready = self._is_ready((run.robot, run.kind))
        if ready and run.kind == key[1]:
            run.loop()
        return ready is True

    def _ask(self, keys: list[Key], parameters: Parameters, curve: Curve) -> None:
        """Ask for these loops, and in advance for those with a hand on the robot, or without."""
        if keys or self._asked:
            self._loop_cache.want(self, keys)
        self._asked = bool(keys)
        for robot, kind in keys:
            for push in (FREE, None):
                self._loop_cache.prepare(robot, kind_of(kind.law, parameters, curve, push))

    def _is_ready(self, key: Key) -> bool | None:
        """Whether a loop is ready; None if it cannot be made, of which the user is told."""
        robot, kind = key
        try:
            return self._loop_cache.find(robot, kind) is not None
        except ValueError as error:
            self.remarks.append(error)
            return None
