"""A file with a path is chosen in the path editor, and the lab follows it, or says why not."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.channel.file_inbox import MOST_BYTES
from onpath.models.arrays import Array
from tests.support.browser import Tab
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

pytest.importorskip("svgpathtools")

LEAF = b"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 80">
<path d="M8 40 C8 10 60 2 88 14 S118 66 84 68 S8 70 8 40 Z"/></svg>"""
BOMB = b'<!DOCTYPE a [<!ENTITY a "xxxxxxxxxx"><!ENTITY b "&a;&a;">]>\n<svg>&b;</svg>'
WAIT = 60.0


def test_a_file_becomes_the_path_and_a_hostile_one_is_refused(tab: Tab) -> None:
    page, simulation = tab.page, tab.simulation

    def choose(name: str, content: bytes) -> None:
        if not page.get_by_role("dialog").is_visible():
            tab.open("Gains and path")
            tab.press("File…")
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="Choose a file").click()
        file = {"name": name, "mimeType": "text/plain", "buffer": content}
        chooser.value.set_files(file)  # type: ignore[arg-type]

    choose("leaf.svg", LEAF)
    wait_for(lambda: simulation.editor.design.name == "drawn", WAIT)
    width = 1e3 * simulation.editor.design.curve.at(simulation.editor.design.curve.sample(200))
    assert (width.max(0) - width.min(0)).max() == pytest.approx(100, abs=2)
    design = simulation.editor.design
    for name, content, words in (
        ("bomb.svg", BOMB, "does not stand for plain text"),
        ("tool.nc", b"G0 X0 Y0\nG41 X3\n", "line 2, column 1: G41"),
        ("big.csv", b"0.01,0.02\n" * (MOST_BYTES // 10 + 1), "larger than 1 MB"),
        ("b.csv", b"x,y\n0.05,0\n0,four\n", "'four' is not a number"),
        ("huge.csv", b"0.01,0.02\n" * 600_000, "larger than 1 MB"),
    ):
        choose(name, content)
        page.get_by_text(words).wait_for(timeout=1e3 * WAIT)
        assert simulation.editor.design is design
    choose("points.csv", b"0;0\n4;0\n4;3\n0;3\n")
    wait_for(lambda: simulation.editor.design is not design, WAIT)
    assert tab.errors == []


GIVE = """([kind, text]) => {
    const data = new DataTransfer()
    if (kind === "drop") data.items.add(new File([text], "a.svg"))
    else data.setData("text/plain", text)
    const init = { bubbles: true, cancelable: true, dataTransfer: data, clipboardData: data }
    const Kind = kind === "drop" ? DragEvent : ClipboardEvent
    document.body.dispatchEvent(new Kind(kind, init))
}"""
LINES = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90">
<ellipse cx="60" cy="60" rx="28" ry="20"/><circle cx="20" cy="20" r="15"/></svg>"""


@pytest.mark.parametrize("way", ["drop", "paste"])
def test_a_drawing_is_brought_to_the_page_its_line_pressed_and_its_size_changed(
    tab: Tab, way: str
) -> None:
    page, editor = tab.page, tab.simulation.editor
    page.evaluate(GIVE, [way, LINES])
    page.get_by_role("img", name="The lines of the file").wait_for()
    wait_for(lambda: editor.design.name == "drawn", WAIT)

    def points() -> Array:
        curve = editor.design.curve
        return 1e3 * curve.at(curve.sample(400))

    def sides() -> list[float]:
        return sorted(np.ptp(points(), axis=0))

    short, long = sides()
    assert short / long == pytest.approx(75 / 83, abs=0.01)  # of both lines together
    box = page.locator("polyline").nth(1).bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    wait_for(lambda: sides() == pytest.approx([long, long], abs=1), WAIT)
    page.get_by_label("Size [mm]").fill(f"{0.7 * long:.0f}")
    page.keyboard.press("Enter")
    wait_for(lambda: sides() == pytest.approx([0.7 * long] * 2, abs=1), WAIT)
    page.keyboard.press("Escape")
    tab.open("Gains and path")
    tab.press("File…")  # the same file is there again
    page.get_by_label("Middle, up [mm]").fill("10")
    page.keyboard.press("Enter")
    wait_for(lambda: points().mean(0) == pytest.approx([0, 10], abs=1), WAIT)
    assert tab.errors == []


def test_what_would_help_is_pressed_and_helps(tab: Tab) -> None:
    editor = tab.simulation.editor
    tab.page.evaluate(GIVE, ["paste", "G0 X0 Y0\nG1 X30\nY30\nX0\nY0\n"])
    wait_for(lambda: editor.design.name == "drawn", WAIT)
    tab.page.get_by_label("Size [mm]").fill("300")
    tab.page.keyboard.press("Enter")
    refusal = tab.page.get_by_text("It cannot be followed")
    refusal.wait_for(timeout=1e3 * WAIT)
    wait_for(lambda: editor.faults, WAIT)
    tab.page.get_by_role("button", name="Smaller:").click()
    wait_for(lambda: not editor.faults, WAIT)
    refusal.wait_for(state="detached", timeout=1e3 * WAIT)
