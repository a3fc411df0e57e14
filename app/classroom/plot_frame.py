"""Where the curves of a plot on the teacher's page are, and the labels beside them."""

from __future__ import annotations

from dataclasses import dataclass

WIDTH, HEIGHT = 640, 380  # of a plot, [px]
SMALL, LARGE = 15, 36  # size of its labels, for a screen and for a projector, [px]


@dataclass(frozen=True, slots=True)
class PlotFrame:
    """The part of a plot that its labels leave to the curves. All lengths are in [px].

    Attributes:
        letters: size of the labels.
        titled: whether the axes have titles, besides numbers.
    """

    letters: int
    titled: bool = False

    @property
    def left(self) -> int:
        """Its left border."""
        return round((4.1 if self.titled else 3.3) * self.letters)

    @property
    def right(self) -> int:
        """Its right border, as far from the plot's as its upper one."""
        return WIDTH - self.letters

    @property
    def floor(self) -> int:
        """Its lower border."""
        return HEIGHT - round((3.5 if self.titled else 2.4) * self.letters)

    def position(self, across: float, up: float) -> tuple[float, float]:
        """Position of a point by its shares of width and height; 0 and 1 are the borders.

        Points beyond the borders are moved onto them.
        """
        across, up = (min(max(share, 0.0), 1.0) for share in (across, up))
        top = self.letters
        return (
            self.left + across * (self.right - self.left),
            top + (1.0 - up) * (self.floor - top),
        )


def frame_for(large: bool, titled: bool = False) -> PlotFrame:
    """The frame of a plot for a projector (`large`) or a screen."""
    return PlotFrame(LARGE if large else SMALL, titled)
