"""The flexible link: what the controller sees of it, how it bends, how it is drawn and pulled."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import viser

from onpath.app.common.palette import WARNING
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshot import FollowerName
from onpath.app.page.panels.widgets import ParameterWidgets, Post, on_user_update
from onpath.lessons.words import Words
from onpath.models.systems.flexible_five_bar import RIGID
from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics

LEAST, MOST = -1.0, 1.0  # of alpha on its bar
BEAM = ["plant", "modes", "rho", "frequency", "zeta"]
COMPOSITE = ["tip_damping", "tip_prediction", "tip_shaping", "tip_yielding"]
TURNED = 0.03  # [rad], of a joint; less changes the critical alpha too little to see
STABLE = "#2a8a5b"


def critical_alpha(parameters: FlexibleParameters, joints: np.ndarray) -> float:
    """Alpha from which the inside is unstable, at rest at these joint angles, (3,); or infinity."""
    robot = robot_for(parameters)
    q = np.concatenate([joints, np.zeros(robot.modes)])
    zero = flexible_zero_dynamics(parameters.modes, parameters.plant)
    return zero.critical_alpha(q, robot.plant(parameters), MOST)


class CriticalAlpha:
    """The follower's critical alpha, computed elsewhere and only when it may have changed.

    Args:
        submit: runs something in another thread.

    Attributes:
        value: the latest, infinity if there is none up to 1, NaN while unknown.
    """

    def __init__(self, submit: Callable[[Callable[[], None]], None]) -> None:
        self._submit = submit
        self._key: FlexibleParameters | None = None
        self._joints = np.full(RIGID, np.inf)
        self._busy = False
        self.value = math.nan

    def follow(self, parameters: FlexibleParameters, q: np.ndarray) -> None:
        """Ask for it anew if parameters or joints, (n,), are others."""
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
    """A line from -1 to 1, red where the inside is unstable, with alpha marked.

    Args:
        used: whether the controller looks at alpha at all.
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
    elif alpha > critical:
        said += f": <b>{words('flexible.unstable')}</b>"
    said = words("flexible.alpha", alpha=f"{alpha:.2f}", limit=said)
    return (
        f'<div style="padding:0.2em 0.9em;font-size:0.8em;opacity:{1 if used else 0.55}">'
        f'<div style="position:relative;height:0.7em;border-radius:0.3em;background:'
        f'linear-gradient(90deg,{STABLE} {limit:.1f}%,{WARNING.hex} {limit:.1f}%)">'
        f'<div style="position:absolute;left:{percent(alpha):.1f}%;top:-0.2em;width:3px;'
        f'height:1.1em;background:#111"></div></div>'
        f'<div style="color:#445">{said}</div></div>'
    )


class FlexiblePanel:
    """Output, alpha with its limit, the beam, and how it is drawn and pulled.

    Args:
        pulls: names of the planes in which an end-point can be pulled, the present one first.
        choose_pull: called with the name chosen.
        submit: runs something in another thread.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        lab: Lab,
        post: Post,
        pulls: list[str],
        choose_pull: Callable[[str], None],
        submit: Callable[[Callable[[], None]], None],
    ) -> None:
        self._post, self._words = post, lab.words
        words = self._words
        self._critical = CriticalAlpha(submit)
        self._shown = ""
        with gui.add_folder(words("flexible.title")):
            self._widgets = [ParameterWidgets(gui, lab, ["law", "alpha"], self._set)]
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
                initial_value=lab.session.exaggeration,
                hint=words("flexible.larger_hint"),
            )
            with gui.add_folder(words("flexible.beam"), expand_by_default=False):
                gui.add_markdown(words("flexible.anew"))
                self._widgets.append(ParameterWidgets(gui, lab, BEAM, post))
            with gui.add_folder(words("flexible.composite"), expand_by_default=False):
                self._widgets.append(ParameterWidgets(gui, lab, COMPOSITE, post))
        on_user_update(pull, lambda shown: choose_pull(planes[shown]))
        on_user_update(self._larger, lambda factor: post(c.SetExaggeration(factor)))

    def follow(self, lab: Lab) -> None:
        """Show the session's values and where the limit lies now."""
        own = lab.session.parameters
        if not isinstance(own, FlexibleParameters):
            return  # another robot: the page is about to be rebuilt
        for widgets in self._widgets:
            widgets.follow(own)
        if self._larger.value != lab.session.exaggeration:
            self._larger.value = lab.session.exaggeration
        self._critical.follow(own, lab.session.runs[FollowerName].shown()["q"])
        bar = alpha_bar(own.alpha, self._critical.value, own.law == "redefined", self._words)
        if bar != self._shown:
            self._shown = self._bar.content = bar
        numbers = deflections(lab)
        if self._numbers.content != numbers:
            self._numbers.content = numbers

    def _set(self, command: c.Command) -> None:
        """Alpha belongs to output redefinition: who moves it wants that."""
        self._post(command)
        if isinstance(command, c.SetParameter) and command.name == "alpha":
            self._post(c.SetParameter("law", "redefined"))


def deflections(lab: Lab) -> str:
    """How far each tip is bent aside, in words."""
    layout = lab.session.sample_layout
    past = None if lab.session.viewing is None else lab.session.history.at(lab.session.viewing)
    samples = lab.session.sample() if past is None else past.sample
    tracking, following = (f"{mm:.1f}" for mm in layout.unpack(samples)["deflection"][:, 0] * 1e3)
    words, factor = lab.words, lab.session.exaggeration
    scale = words("flexible.drawn", factor=f"{factor:g}") if factor != 1 else None
    return words(
        "flexible.deflections",
        tracking=tracking,
        following=following,
        scale=scale or words("scene.true_scale"),
    )
