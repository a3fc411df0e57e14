"""The flexible link: what the controller sees of it, how it bends, how it is drawn and pulled."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import viser

from app import commands as c
from app.palette import WARNING
from app.panels.widgets import ParameterWidgets, Post, on_user_update
from app.session import Session
from app.snapshot import FollowerName
from models.flexible_five_bar import RIGID
from models.flexible_robot import FlexibleParameters, robot_for
from models.zero_dynamics import flexible_zero_dynamics

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


def alpha_bar(alpha: float, critical: float, used: bool) -> str:
    """A line from -1 to 1, red where the inside is unstable, with alpha marked.

    Args:
        used: whether the controller looks at alpha at all.
    """

    def percent(value: float) -> float:
        return 100 * (min(max(value, LEAST), MOST) - LEAST) / (MOST - LEAST)

    limit = percent(MOST if math.isinf(critical) else critical) if critical == critical else 100.0
    if math.isnan(critical):
        words = "critical α: being computed"
    elif math.isinf(critical):
        words = "critical α: none up to 1"
    else:
        words = f"critical α = {critical:.2f}, here and at rest"
    if not used:
        words += "; composite control puts the tip itself on the path and needs no α"
    elif alpha > critical:
        words += ": <b>unstable inside</b>"
    return (
        f'<div style="padding:0.2em 0.9em;font-size:0.8em;opacity:{1 if used else 0.55}">'
        f'<div style="position:relative;height:0.7em;border-radius:0.3em;background:'
        f'linear-gradient(90deg,{STABLE} {limit:.1f}%,{WARNING.hex} {limit:.1f}%)">'
        f'<div style="position:absolute;left:{percent(alpha):.1f}%;top:-0.2em;width:3px;'
        f'height:1.1em;background:#111"></div></div>'
        f'<div style="color:#445">α = {alpha:.2f}; {words}</div></div>'
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
        session: Session,
        post: Post,
        pulls: list[str],
        choose_pull: Callable[[str], None],
        submit: Callable[[Callable[[], None]], None],
    ) -> None:
        own, self._post = _own(session), post
        self._critical = CriticalAlpha(submit)
        self._shown = ""
        with gui.add_folder("Flexible link"):
            self._widgets = [ParameterWidgets(gui, own, ["law", "alpha"], self._set)]
            self._bar = gui.add_html("")
            self._numbers = gui.add_markdown("")
            pull = gui.add_dropdown(
                "Pull in", pulls, hint="The plane, through the tip, in which the mouse pulls it"
            )
            self._larger = gui.add_slider(
                "Drawn larger [×]",
                min=c.EXAGGERATIONS[0],
                max=c.EXAGGERATIONS[-1],
                step=1.0,
                initial_value=session.exaggeration,
                hint="The deflection in the drawing alone; 1 is true scale",
            )
            with gui.add_folder("Beam and plant", expand_by_default=False):
                gui.add_markdown("Plant and modes start the robots anew. *Values illustrative.*")
                self._widgets.append(ParameterWidgets(gui, own, BEAM, post))
            with gui.add_folder("Composite control", expand_by_default=False):
                self._widgets.append(ParameterWidgets(gui, own, COMPOSITE, post))
        on_user_update(pull, choose_pull)
        on_user_update(self._larger, lambda factor: post(c.SetExaggeration(factor)))

    def follow(self, session: Session) -> None:
        """Show the session's values and where the limit lies now."""
        own = session.parameters
        if not isinstance(own, FlexibleParameters):
            return  # another robot: the page is about to be rebuilt
        for widgets in self._widgets:
            widgets.follow(own)
        if self._larger.value != session.exaggeration:
            self._larger.value = session.exaggeration
        self._critical.follow(own, session.runs[FollowerName].shown()["q"])
        bar = alpha_bar(own.alpha, self._critical.value, own.law == "redefined")
        if bar != self._shown:
            self._shown = self._bar.content = bar
        words = deflections(session)
        if self._numbers.content != words:
            self._numbers.content = words

    def _set(self, command: c.Command) -> None:
        """Alpha belongs to output redefinition: who moves it wants that."""
        self._post(command)
        if isinstance(command, c.SetParameter) and command.name == "alpha":
            self._post(c.SetParameter("law", "redefined"))


def deflections(session: Session) -> str:
    """How far each tip is bent aside, in words."""
    layout = session.sample_layout
    past = None if session.viewing is None else session.history.at(session.viewing)
    samples = session.sample() if past is None else past.sample
    values = layout.unpack(samples)["deflection"][:, 0] * 1e3
    scale = "true scale" if session.exaggeration == 1 else f"drawn {session.exaggeration:g}×"
    return f"Deflection: tracking **{values[0]:.1f} mm**, following **{values[1]:.1f} mm**; {scale}"


def _own(session: Session) -> FlexibleParameters:
    assert isinstance(session.parameters, FlexibleParameters)
    return session.parameters
