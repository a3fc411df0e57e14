"""How far each robot is from the path, now and at most, and what the lab has to say."""

from __future__ import annotations

import html

import viser

from onpath.app.common.palette import CONTROLLERS, WARNING
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshot import RobotView, Snapshot
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.words import Words

LEVELS = {"info": "#33506b", "warning": "#8a5a00", "error": WARNING.hex}


class Readout:
    """Two lines of numbers, a clock, and the message."""

    def __init__(self, gui: viser.GuiApi, lab: Lab) -> None:
        self._words = lab.words
        self._table = gui.add_html("")
        self._shown = ""

    def follow(self, snapshot: Snapshot) -> None:
        """Show the snapshot's numbers."""
        words = self._words
        rows = "".join(_row(name, view, words) for name, view in snapshot.robots.items())
        distance, now, most = (words(f"readout.{key}") for key in ("distance", "now", "most"))
        content = (
            '<div style="padding:0.5em 0.9em 0 0.9em;font-size:0.85em">'
            '<table style="width:100%;border-collapse:collapse">'
            f'<tr style="color:#667"><td>{distance}</td><td align="right">{now}</td>'
            f'<td align="right">{most}</td></tr>{rows}</table>'
            f'<div style="color:#667;margin-top:0.3em">{_clock(snapshot, words)}</div>'
            f"{_message(snapshot)}</div>"
        )
        if content != self._shown:
            self._shown = content
            update_gui(self._table, "content", content)


def _row(name: str, view: RobotView, words: Words) -> str:
    colour, title = CONTROLLERS[name].hex, words(f"controller.{name}.title")
    return (
        f'<tr style="color:{colour};font-weight:600"><td>{title}</td>'
        f'<td align="right">{view.distance * 1e3:.1f} mm</td>'
        f'<td align="right">{view.max_distance * 1e3:.1f} mm</td></tr>'
    )


def _clock(snapshot: Snapshot, words: Words) -> str:
    if not snapshot.running:
        return words("readout.paused", time=f"{snapshot.time:.2f}")
    speed = f"{snapshot.achieved_speed:.2g}"
    return words("readout.running", time=f"{snapshot.time:.1f}", speed=speed)


def _message(snapshot: Snapshot) -> str:
    if not snapshot.message:
        return ""
    colour = LEVELS.get(snapshot.message_level, LEVELS["info"])
    return (
        f'<div role="status" style="margin-top:0.5em;padding:0.5em;border-left:4px solid {colour};'
        f'color:{colour};background:#f6f7f9">{html.escape(snapshot.message)}</div>'
    )
