"""The messages of a figure's page, which fills in the {names} in them."""

from __future__ import annotations

from collections.abc import Sequence

from onpath.app.view.forms import form_words
from onpath.app.view.page_words import CHART
from onpath.lessons.sides import law_titles
from onpath.lessons.words import Words
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import SIDES
from onpath.models.paths.curve_fit import SHORTEST
from onpath.models.paths.path_checks import LEAST_RADIUS, TUBE

PLAIN = (
    *CHART,
    *("lens.closest", "lens.reference", "lens.straight"),
    *("run.rate", "past.go_on", "transport.go_on_hint", "transport.back", "transport.back_hint"),
    *("run.hold_both", "run.hold", "run.let_both_go", "run.let_go", "run.hold_hint"),
    *("run.run", "run.pause", "run.run_hint", "run.step", "run.reset", "key.reset", "key.right"),
    "standalone.late",
    *("standalone.coincide", "standalone.drag_hint"),
    *("gains.across", "gains.along"),
    *(f"side.{side}" for side in SIDES),
)
_BEHAVIOURS = (
    *("behaviour.no_overshoot", "behaviour.no_oscillation", "behaviour.damping"),
    *("behaviour.unstable", "behaviour.swings", "behaviour.not_stable"),
)
_FAULTS = (
    *("fault.outside", "fault.singular", "fault.bends", "fault.cusp", "fault.narrow"),
    "fault.crosses",
)
_FILLED = {
    **{f"caption.{kind}": ("mm",) for kind in ("torn_off", "held", "waits", "pulled", "chases")},
    **{f"caption.{kind}": ("mm",) for kind in ("off", "stopped", "returns", "off_bounded")},
    **{f"caption.{kind}": ("mm",) for kind in ("pulled_far", "pulled_bounded")},
    "design.pace": ("speed",),
    "chart.at": ("time", "values"),
    "lens.name": ("law",),
    "efforts.exceeded": ("joint", "gave", "limit"),
    "caption.spoken": ("robot", "caption"),
    "standalone.scene": ("law",),
    "standalone.refused": ("reason",),
    "standalone.selected": ("number", "all"),
    "side.title": ("law", "side"),
    "say.ambiguous": ("reasons",),
    "say.no_further": ("reasons",),
    "say.stopped": ("robot", "time", "reason"),
    "gains.poles": ("poles",),
    "behaviour.settles": ("seconds", "kind"),
    **{key: ("damping", "seconds") for key in _BEHAVIOURS},
}


def run_titles(runs: Sequence[Trajectory], words: Words) -> list[str]:
    """Displayed names of the runs' laws; one that is not known here has that of its record."""
    known = law_titles([run.law for run in runs if is_text(run.law) or run.law in LAWS], words)
    return [known.get(run.law, run.label) for run in runs]


def figure_words(words: Words) -> dict[str, str]:
    """Key -> text of every message that a figure may show."""
    messages = {key: words(key) for key in PLAIN}
    messages |= words.unfilled(_FILLED)
    widths = {"radius": f"{TUBE * 1e3:.0f}", "least": f"{2 * TUBE * 1e3:.0f}"}
    messages |= {key: words(key, **widths) for key in _FAULTS}
    sharpest = f"{LEAST_RADIUS * 1e3:g}"
    messages["fault.bends_sharply"] = words("fault.bends", radius=sharpest)
    shortest = f"{1e3 * SHORTEST:.0f}"
    messages["error.path_too_short"] = words(
        "error.path_too_short", length="{length}", least=shortest
    )
    return messages | form_words(words)
