"""The picture of a comparison of laws."""

from __future__ import annotations

from onpath.app.exports.comparison import outcomes_of
from onpath.app.exports.figures_comparison import comparison_figure
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR


def test_a_law_that_stops_stands_at_the_edge() -> None:
    what = FIVE_BAR.name, FIVE_BAR.parameters(), circle(0.05)
    laws = "u1 = 9; u2 = 0", "path_following"
    figure = comparison_figure({(law, "none"): outcomes_of(*what, law, "none") for law in laws})
    (axes,) = figure.axes
    hollow = [line for line in axes.lines if line.get_markerfacecolor() == "none"]
    assert len(hollow) == 1 and [text.get_text() for text in axes.texts] == ["stopped"]
