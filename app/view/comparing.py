"""Which laws can be compared, and the results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from onpath.app.channel.sheet_messages import (
    Compared,
    ComparedLaw,
    CompareSheet,
    LawChoice,
    ObstructionChoice,
)
from onpath.lessons.sides import law_text, law_titles
from onpath.lessons.words import Words
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.studies.comparison import (
    BEFORE,
    CURVE_STEP,
    OBSTRUCTIONS,
    Outcome,
    beyond_efforts,
    worst,
)
from onpath.models.systems.robots import Robot

MOST = 6  # laws in one comparison
CHOSEN = ("trajectory_tracking", "path_following", "waiting_clock")  # at first, besides the sides'


def compare_sheet(robot: Robot, laws: Mapping[str, str], words: Words) -> CompareSheet:
    """The laws that suit a robot and move along the path, and those that are typed for a side."""
    names = [name for name, law in LAWS.items() if law.travels and law.suits(robot.system)]
    names += dict.fromkeys(law for law in laws.values() if is_text(law))
    chosen = [*dict.fromkeys([*laws.values(), *CHOSEN])][:MOST]
    titles = law_titles(names, words)
    return CompareSheet(
        laws=[
            LawChoice(
                name=name, label=titles[name], text=law_text(name, words), chosen=name in chosen
            )
            for name in names
        ],
        obstructions=[
            ObstructionChoice(name=name, label=words(f"obstruction.{name}"))
            for name in OBSTRUCTIONS
        ],
        most=MOST,
    )


def compared(
    results: Mapping[str, Sequence[Outcome]],
    laws: Sequence[str],
    obstruction: str,
    robot: Robot,
    words: Words,
) -> Compared:
    """The results so far.

    Args:
        results: the outcomes of each law that is done, one for each place.
        laws: all laws of the comparison.
    """
    titles = law_titles(laws, words)
    rows = [_row(law, titles[law], results[law], robot, words) for law in laws if law in results]
    return Compared(
        rows=rows, all=len(laws), acts=(BEFORE, BEFORE + OBSTRUCTIONS[obstruction].seconds)
    )


def _row(
    law: str, title: str, outcomes: Sequence[Outcome], robot: Robot, words: Words
) -> ComparedLaw:
    values = worst(outcomes)
    stopped = values["stopped_at_s"] is not None
    farthest = max(outcomes, key=lambda each: each.max_distance_m)
    beyond = beyond_efforts(robot, outcomes)
    return ComparedLaw(
        law=law,
        label=title,
        distance=0.0 if stopped else round(1e3 * (values["max_distance_m"] or 0.0), 3),
        delay=0.0 if stopped else round((values["delay_s"] or 0.0) + 0.0, 3),
        force=0.0 if stopped else round(values["peak_force_N"] or 0.0, 2),
        stopped=stopped,
        beyond=f"{title}: {words.sentence(beyond)}" if beyond else "",
        step=CURVE_STEP,
        curve=[round(1e3 * each, 2) for each in farthest.distances_m],
    )
