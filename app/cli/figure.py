"""`onpath figure`, which repeats a figure of the paper with the paper's settings."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from onpath.app.common.atomic_file import check_plot, whole_file
from onpath.app.exports.summary_text import summary_lines


@dataclass(frozen=True)
class FigureCommand:
    """Run what one of the paper's figures shows; print its settings and the numbers of the runs."""

    number: Annotated[int, tyro.conf.Positional]
    """2, 3, 5, 6 or 7."""
    plot: Path | None = None
    """Draw the figure to this .png, .svg or .pdf file."""
    json: bool = False
    """Print settings and numbers as JSON."""

    def run(self) -> None:
        """Simulate, then draw and print."""
        from onpath.models.studies.paper_figures import FIGURES, figure_summary

        if self.number not in FIGURES:
            numbers = ", ".join(map(str, FIGURES))
            raise ValueError(f"figure {self.number}: expected one of {numbers}")
        check_plot(self.plot)
        figure = FIGURES[self.number]
        runs = figure.runs()
        if self.plot:
            from onpath.app.exports.paper_figures import draw_paper_figure

            with whole_file(self.plot) as path:
                draw_paper_figure(figure, runs, path)
        result = figure_summary(figure, runs)
        print(json.dumps(result, indent=2, ensure_ascii=False) if self.json else _text(result))


def _text(result: dict[str, Any]) -> str:
    lines = [f"Figure {result['figure']}: {result['title']}", "  from the paper's text"]
    lines += [f"    {line}" for line in result["given"]]
    lines += ["  illustrative", *(f"    {line}" for line in result["illustrative"])]
    for law, values in result["laws"].items():
        lines += [f"  {law.replace('_', ' ')}", *(f"    {line}" for line in summary_lines(values))]
    return "\n".join(lines)
