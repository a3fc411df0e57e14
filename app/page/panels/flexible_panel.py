"""Panel of the flexible link: controlled output, alpha, beam, drawing and pulling."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import viser

from onpath.app.common.templates import render
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.lab.snapshots.snapshot import FollowerName, TrackerName
from onpath.app.page.panels.widgets import ParameterWidgets, Post, on_user_update
from onpath.lessons.words import Words
from onpath.models.systems.flexible_five_bar import RIGID
from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics

LEAST, MOST = -1.0, 1.0  # range of alpha on its bar
BEAM = ["plant", "modes", "rho", "frequency", "zeta"]
COMPOSITE = ["tip_damping", "tip_prediction", "tip_shaping", "tip_yielding"]
TURNED = 0.03  # [rad], joint change below which the critical alpha is not recomputed


def critical_alpha(parameters: FlexibleParameters, joints: np.ndarray) -> float:
    """Alpha from which the internal dynamics at rest at joints (3,) are unstable; or infinity."""
    robot = robot_for(parameters)
    q = np.concatenate([joints, np.zeros(robot.modes)])
    zero = flexible_zero_dynamics(parameters.modes, parameters.plant)
    return zero.critical_alpha(q, robot.plant(parameters), MOST)


class CriticalAlpha:
    """The follower's critical alpha, computed in another thread when it may have changed.

    Args:
        submit: runs something in another thread.

    Attributes:
        value: the latest result; infinity if there is none up to 1, NaN while unknown.
    """

    def __init__(self, submit: Callable[[Callable[[], None]], None]) -> None:
        self._submit = submit
        self._key: FlexibleParameters | None = None
        self._joints = np.full(RIGID, np.inf)
        self._busy = False
        self.value = math.nan

    def follow(self, parameters: FlexibleParameters, q: np.ndarray) -> None:
        """Recompute if the parameters or joint angles, (n,), have changed."""
        key = replace(FlexibleParameters(), **{name: getattr(parameters, name) for name in BEAM})
        joints = q[:RIGID].copy()
        moved = np.abs(joints - self._joints).max() > TURNED
        if self._busy or (key == self._key and not moved):
            return
        self._key, self._joints, self._busy = key, joints, True
        self._submit(lambda: self._find(key, joints))

    def _find(self, key: FlexibleParameters, joints: np.ndarray) -> None:
        try:
            self.value = critical_alpha(key, joints)
        finally:
            self._busy = False


def alpha_bar(alpha: float, critical: float, used: bool, words: Words) -> str:
    """A line from -1 to 1, red where the internal dynamics are unstable, with alpha marked.

    Args:
        used: whether the controller uses alpha.
    """

    def percent(value: float) -> float:
        return 100 * (min(max(value, LEAST), MOST) - LEAST) / (MOST - LEAST)

    limit = percent(MOST if math.isinf(critical) else critical) if critical == critical else 100.0
    if math.isnan(critical):
        said = words("flexible.computing")
    elif math.isinf(critical):
        said = words("flexible.none")
    else:
        said = words("flexible.critical", critical=f"{critical:.2f}")
    if not used:
        said += f"; {words('flexible.unused')}"
    return render(
        "panel/alpha.html",
        alpha=f"{alpha:.2f}",
        place=f"{percent(alpha):.1f}",
        limit=f"{limit:.1f}",
        said=said,
        used=used,
        beyond=used and alpha > critical,
        words=words,
    )


class FlexiblePanel:
    """Output, alpha with its limit, the beam, and how it is drawn and pulled.

    Args:
        pulls: names of the planes in which an end-point can be pulled, the current one first.
        choose_pull: called with the selected name.
        submit: runs something in another thread.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        first: PageSnapshot,
        pulls: list[str],
        choose_pull: Callable[[str], None],
        submit: Callable[[Callable[[], None]], None],
    ) -> None:
        self._post, self._words = post, words
        self._critical = CriticalAlpha(submit)
        self._shown: tuple[float, float, bool] | None = None
        with gui.add_folder(words("flexible.title")):
            self._widgets = [ParameterWidgets(gui, words, self._set, ["law", "alpha"], first)]
            self._bar = gui.add_html("")
            self._numbers = gui.add_markdown("")
            planes = {words(f"pull.{plane}"): plane for plane in pulls}
            pull = gui.add_dropdown(
                words("flexible.pull"), list(planes), hint=words("flexible.pull_hint")
            )
            self._larger = gui.add_slider(
                words("flexible.larger"),
                min=c.EXAGGERATIONS[0],
                max=c.EXAGGERATIONS[-1],
                step=1.0,
                initial_value=first.run.exaggeration,
                hint=words("flexible.larger_hint"),
            )
            with gui.add_folder(words("flexible.beam"), expand_by_default=False):
                gui.add_markdown(words("flexible.anew"))
                self._widgets.append(ParameterWidgets(gui, words, post, BEAM, first))
            with gui.add_folder(words("flexible.composite"), expand_by_default=False):
                self._widgets.append(ParameterWidgets(gui, words, post, COMPOSITE, first))
        on_user_update(pull, lambda shown: choose_pull(planes[shown]))
        on_user_update(self._larger, lambda factor: post(c.SetExaggeration(factor)))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's values and the current limit of alpha."""
        own = parameters_of(snapshot)
        assert isinstance(own, FlexibleParameters)
        for widgets in self._widgets:
            widgets.follow(snapshot)
        if self._larger.value != snapshot.run.exaggeration:
            self._larger.value = snapshot.run.exaggeration
        self._critical.follow(own, snapshot.joints)
        shown = own.alpha, self._critical.value, own.law == "redefined"
        if shown != self._shown:
            self._shown, self._bar.content = shown, alpha_bar(*shown, self._words)
        numbers = deflections(snapshot, self._words)
        if self._numbers.content != numbers:
            self._numbers.content = numbers

    def _set(self, command: c.Command) -> None:
        """Post a command; changing alpha also selects output redefinition, which uses it."""
        self._post(command)
        if isinstance(command, c.SetParameter) and command.name == "alpha":
            self._post(c.SetParameter("law", "redefined"))


def deflections(snapshot: PageSnapshot, words: Words) -> str:
    """Tip deflection of each robot as text."""
    tracking, following = (
        f"{snapshot.robots[name].deflection * 1e3:.1f}" for name in (TrackerName, FollowerName)
    )
    factor = snapshot.run.exaggeration
    scale = words("flexible.drawn", factor=f"{factor:g}") if factor != 1 else None
    return words(
        "flexible.deflections",
        tracking=tracking,
        following=following,
        scale=scale or words("scene.true_scale"),
    )
