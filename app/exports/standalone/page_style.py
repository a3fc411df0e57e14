"""The style of pages without a server, with the colours that their scripts draw in."""

from __future__ import annotations

from onpath.app.common import palette
from onpath.app.common.templates import Markup, inlined, part_of_page
from onpath.app.scene.tones import DARK, LIGHT, Tones
from onpath.models.control.sides import SIDES


def page_style(template: str) -> Markup:
    """A style template of assets/templates, rendered."""
    dark = inlined("web/dark_colours.css")
    return part_of_page(template, dark=dark, tones={"light": _tones(LIGHT), "dark": _tones(DARK)})


def _tones(tones: Tones) -> dict[str, str]:
    """Name -> colour, on a light or a dark page; see assets/web/core/ink.ts."""
    is_dark = tones is DARK
    shown = {
        "ink": tones.line,
        "soft": tones.arc if is_dark else palette.GREY,
        "grid": tones.cells,
        "path": tones.path,
        "point": tones.point,
        "selected": palette.SELECTED,
        "warning": palette.WARNING,
        "steel": palette.STEEL,
        "force": tones.force,
        "held": tones.wall.toward(palette.BLUE, 0.35 if is_dark else 0.13),
        "pulled": tones.wall.toward(tones.force, 0.16 if is_dark else 0.1),
        "mass": palette.GREEN.toward(palette.WHITE, 0.35 if is_dark else 0),
        "arc": tones.arc,
        "yours": palette.VIOLET.toward(palette.WHITE, 0.5 if is_dark else 0),
    }
    for number, side in enumerate(SIDES):
        colour = palette.OF_SIDE[side]
        shown[f"side{number}"] = colour.toward(palette.WHITE, 0.25 if is_dark else 0)
        toward, share = (palette.WHITE, 0.45) if is_dark else (palette.INK, 0.35)
        shown[f"dark{number}"] = colour.toward(toward, share)
    for number, colour in enumerate(palette.OTHERS):
        lighter = colour.toward(palette.WHITE, 0.25 if is_dark else 0)
        shown[f"other{number}"] = tones.line if colour is palette.INK else lighter
    return {name: colour.hex for name, colour in shown.items()}
