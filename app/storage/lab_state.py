"""The stored state of a lab: its set-up and the progress through the lessons."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture, own_differences
from onpath.app.lab.setups.former import own_of_today, with_paths_of_today
from onpath.app.lab.setups.plan import own_settings
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.stored import (
    from_data,
    to_data,
    without_absent_laws,
    without_absent_robots,
)
from onpath.app.lab.shown_log import ShownLog, log_data, log_from
from onpath.lessons.progress import Progress, read_progress
from onpath.models.closed_loop.lab_settings import settings_kept

SAVE_INTERVAL = 60  # frames between checks for changes
LabState = dict[str, Any]
NEW = (Setup(), Progress(), None, dict[str, Any](), None)
Now = tuple[Setup, Progress, Setup | None, dict[str, Any], ShownLog | None]


class Keeper(Protocol):
    """Saves states; see `WriteBehind`."""

    @property
    def generation(self) -> int: ...

    def submit(self, code: str, make_state: Callable[[], LabState], at_once: bool = False) -> int:
        """Save the state that a function returns; it is called in another thread."""
        ...

    def written(self, code: str) -> int:
        """Number of the latest state of a lab that is saved, as `submit` returned it."""
        ...

    def unsaved(self, code: str) -> str:
        """Why the latest state of a lab is not saved, as a key of the catalogues, or empty."""
        ...


class StateObserver:
    """Watches a lab, and submits its state when it has changed, at most once a second.

    An answer is submitted at once, and the lessons learn when it is saved. The user is told when
    the lab cannot be saved, and when it is saved again.

    Args:
        code: code of the lab.
        lab: the lab, if its state is stored already; None for a new one.
    """

    def __init__(self, code: str, keeper: Keeper, lab: Lab | None = None) -> None:
        self._code, self._keeper = code, keeper
        self._seen = NEW if lab is None else _now(lab)
        self._generation = keeper.generation
        self._frames = self._answers = 0
        self._awaited: tuple[int, Progress] | None = None  # a state that is being saved
        if lab is not None:
            lab.lessons.stored, self._answers = lab.lessons.progress, lab.lessons.answers_given

    def __call__(self, lab: Lab) -> None:
        """Called in every frame; see `Lab.watch`."""
        self._frames += 1
        if self._frames % SAVE_INTERVAL == 0 or lab.lessons.answers_given != self._answers:
            self.check(lab)
        if self._awaited is not None and self._keeper.written(self._code) >= self._awaited[0]:
            lab.lessons.stored, self._awaited = self._awaited[1], None

    def check(self, lab: Lab) -> None:
        """Submit the state if it has changed. Nobody else may change the lab meanwhile."""
        now = _now(lab)
        if (generation := self._keeper.generation) != self._generation:
            self._generation, self._seen = generation, NEW
            if now != NEW:
                lab.remark(lab.words("keep.anew"))
        if now != self._seen:
            self._seen, answers = now, lab.lessons.answers_given
            is_new, self._answers = answers != self._answers, answers
            number = self._keeper.submit(self._code, lambda: _state(*now), at_once=is_new)
            self._awaited = number, now[1]
        if (unsaved := self._keeper.unsaved(self._code)) != lab.unsaved:
            lab.unsaved = unsaved
            if not unsaved:
                lab.remark(lab.words("keep.again"))


def keep(lab: Lab, submit: Callable[[Callable[[], LabState]], object]) -> None:
    """Submit the state even if it has not changed. Call it on the simulation thread."""
    now = _now(lab)
    submit(lambda: _state(*now))


def put_back(lab: Lab, state: LabState) -> None:
    """Restore a stored state in a new lab; the user is told which parts are no longer possible.

    Raises:
        ValueError: the state is invalid; the lab is then unchanged.
    """
    data, gone = without_absent_robots(state.get("setup"))
    data, absent = without_absent_laws(data)
    setup, refused = with_paths_of_today(from_data(data))
    progress = read_progress(state.get("lessons"))
    own = own_settings(own_of_today(state), "lab")
    before = without_absent_laws(without_absent_robots(state.get("before"))[0])[0]
    earlier = from_data(before) if before else None
    lab.set_up(setup)
    lab.simulation.set(**{name: getattr(own, name) for name in settings_kept("lab")})
    lab.lessons.resume(progress, earlier, lab)
    lab.log = log_from(state.get("log"))
    messages = list[str]()
    if refused:
        reasons = "; ".join(map(lab.words.sentence, refused))
        messages.append(lab.words("say.path_of_then", reasons=reasons))
    if absent:
        messages.append(lab.words("say.laws_of_then", names=", ".join(absent)))
    if gone:
        messages.append(lab.words("say.robots_of_then", names=", ".join(gone)))
    if messages:
        lab.show_message(" ".join(messages), "warning")


def _now(lab: Lab) -> Now:
    own = own_differences(lab.simulation.settings, "lab")
    return capture(lab.simulation), lab.lessons.progress, lab.lessons.before, own, lab.log


def _state(
    setup: Setup,
    progress: Progress,
    before: Setup | None,
    own: dict[str, Any],
    log: ShownLog | None,
) -> LabState:
    state = {
        "setup": to_data(setup),
        "lessons": msgspec.to_builtins(progress),
        "before": None if before is None else to_data(before),
        "settings": own,
    }
    return state if log is None else {**state, "log": log_data(log)}
