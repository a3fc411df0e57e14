"""Panel of the flexible link: controlled output, alpha, beam, drawing and pulling."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import viser

from onpath.app.common.background import Background, Submit
from onpath.app.common.templates import render
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.page.panels.widgets import (
    ParameterWidgets,
    Post,
    add_menu,
    put,
)
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.systems.robots import FlexibleLink

LEAST, MOST = -1.0, 1.0  # range of alpha on its bar
TURNED = 0.05  # [rad], to which joint angles are rounded: the critical alpha varies slowly


def alpha_bar(
    alpha: float,
    critical: float,
    used: bool,
    words: Words,
    beam: tuple[int, float] | None = None,
) -> str:
    """A line from -1 to 1, red where the internal dynamics are unstable, with alpha marked.

    Args:
        used: whether the controller uses alpha.
        beam: number of modes, and their damping ratio, on which the limit depends.
    """

    def percent(value: float) -> float:
        return 100 * (min(max(value, LEAST), MOST) - LEAST) / (MOST - LEAST)

    limit = percent(MOST if math.isinf(critical) else critical) if critical == critical else 100.0
    if math.isnan(critical):
        text = words("flexible.computing")
    elif math.isinf(critical):
        text = words("flexible.none")
    else:
        text = words("flexible.critical", critical=f"{critical:.2f}")
    if beam is not None and not math.isnan(critical):
        text += f" ({words('flexible.of_beam', modes=beam[0], zeta=f'{beam[1]:g}')})"
    if not used:
        text += f"; {words('flexible.unused')}"
    return render(
        "panel/alpha.html",
        alpha=f"{alpha:.2f}",
        place=f"{percent(alpha):.1f}",
        limit=f"{limit:.1f}",
        text=text,
        used=used,
        beyond=used and alpha > critical,
        words=words,
    )


class FlexiblePanel:
    """Controlled output, alpha with its limit, the beam, and how it is drawn and pulled.

    Args:
        link: the robot's flexible link.
        pulls: names of the planes in which an end-point can be pulled, the current one first.
        choose_pull: called with the selected name.
        submit: runs a function in another thread.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        first: PageSnapshot,
        link: FlexibleLink,
        pulls: list[str],
        choose_pull: Callable[[str], None],
        submit: Submit,
    ) -> None:
        self._post, self._words = post, words
        self._link, self._critical = link, Background[float](submit)
        self._shown: tuple[float, float, bool, tuple[int, float]] | None = None
        with gui.add_folder(words("flexible.title")):
            output = ParameterWidgets(
                gui, words, post=self._set, names=["output", "alpha"], first=first
            )
            self._widgets = [output]
            self._bar = gui.add_html("")
            self._numbers = gui.add_markdown("")
            planes = {words(f"pull.{plane}"): plane for plane in pulls}
            hint = words("flexible.pull_hint")
            add_menu(gui, words("flexible.pull"), planes, choose_pull, hint=hint)
            self._larger = ParameterWidgets(gui, words, post, names=["larger"], first=first)
            with gui.add_folder(words("flexible.beam"), expand_by_default=False):
                gui.add_markdown(words("flexible.anew"))
                names = list(link.beam)
                self._widgets.append(ParameterWidgets(gui, words, post, names=names, first=first))
            with gui.add_folder(words("flexible.composite"), expand_by_default=False):
                names = list(link.composite)
                self._widgets.append(ParameterWidgets(gui, words, post, names=names, first=first))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's values and the current limit of alpha."""
        parameters = snapshot.parameters
        for widgets in self._widgets:
            widgets.follow(snapshot)
        self._larger.follow(snapshot)
        alpha, critical = float(parameters["alpha"]), self._critical_alpha(snapshot)
        used = parameters["output"] == "redefined"
        beam = int(parameters["modes"]), float(parameters["zeta"])
        shown = alpha, critical, used, beam
        if shown != self._shown:
            self._shown = shown
            self._bar.content = alpha_bar(alpha, critical, used, self._words, beam=beam)
        put(self._numbers, content=deflections(snapshot, self._words))

    def _critical_alpha(self, snapshot: PageSnapshot) -> float:
        """The right robot's; infinity if there is none up to 1, NaN while it is not known yet."""
        link, parameters = self._link, parameters_of(snapshot)
        joints = snapshot.joints[: link.joints]
        key = (
            tuple(getattr(parameters, name) for name in link.beam),
            np.round(joints / TURNED).tobytes(),
        )
        self._critical.ask(key, lambda: link.critical_alpha(parameters, joints))
        return math.nan if self._critical.value is None else self._critical.value

    def _set(self, command: c.Command) -> None:
        """Post a command; changing alpha also selects output redefinition, which uses it."""
        self._post(command)
        if isinstance(command, c.Set) and command.name == "alpha":
            self._post(c.Set("output", "redefined"))


def deflections(snapshot: PageSnapshot, words: Words) -> str:
    """Tip deflection of each robot as text."""
    titles = side_titles(snapshot.laws, words)
    robots = [
        words("flexible.deflection", robot=titles[side], value=f"{robot.deflection * 1e3:.1f}")
        for side, robot in snapshot.robots.items()
    ]
    factor = snapshot.settings.larger
    scale = words("flexible.drawn", factor=f"{factor:g}") if factor != 1 else None
    return words(
        "flexible.deflections",
        each=", ".join(robots),
        scale=scale or words("scene.true_scale"),
    )
