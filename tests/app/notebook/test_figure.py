"""`onpath.figure` and `Run.figure`: what is made, saved and shown, and what is refused."""

from __future__ import annotations

import dataclasses
import gzip
import json
import re
import sys
import threading
from base64 import b64decode, b64encode
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.common import announced
from onpath.app.exports.standalone import figure as figures
from onpath.app.exports.standalone.figure import Figure
from onpath.models.systems.catalogue import ROBOTS

LARGEST = 300_000  # [B], of a figure in a notebook
LAWS = "trajectory_tracking", "path_following"


def page_in(bundle: dict[str, Any]) -> str:
    """The page that a cell's frame unpacks."""
    (packed,) = re.findall(r"atob\('([^']*)'\)", bundle["text/html"])
    return gzip.decompress(b64decode(packed)).decode()


@pytest.mark.parametrize(
    "robot", ["five_bar", *(pytest.param("seven_axes", marks=pytest.mark.thorough),)]
)
def test_a_cell_has_the_picture_and_the_page_and_is_small(
    robot: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = onpath.figure(robot)
    bundle = shown._repr_mimebundle_()
    assert len(json.dumps(bundle)) < LARGEST
    assert b64decode(bundle["image/png"]) == shown.png
    assert shown.png.startswith(b"\x89PNG") and bundle["image/png"] in bundle["text/html"]
    picture = re.search('<img class="still"[^>]*>', shown.html)
    assert picture and bundle["image/png"] in picture[0]
    without = unescape(shown.html.replace(picture[0], ""))
    assert unescape(page_in(bundle)) == without.replace("img-src data:", "img-src 'none'")
    assert "script" not in re.sub(r'srcdoc="[^"]*"', "", bundle["text/html"])
    assert not list(tmp_path.iterdir())  # nothing is written unasked


def test_a_figure_is_saved_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = onpath.figure(path="circle")
    for name in ("held.txt", "held", "held.png", "no/held.html"):
        with pytest.raises(ValueError, match=r"\.html|no folder"):
            shown.save(tmp_path / name)
    with pytest.raises(ValueError, match="language xx: there are"):
        shown.save(tmp_path / "held.html", language="xx")
    assert not list(tmp_path.iterdir())
    monkeypatch.setenv("HOME", str(tmp_path))
    assert shown.save("~/held.html").read_text("utf-8") == shown.html
    assert [each.name for each in tmp_path.iterdir()] == ["held.html"]


@pytest.mark.thorough
def test_another_language_costs_only_its_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown, computed = onpath.figure(path="circle"), list[str]()
    for name in ("figure_numbers", "held_runs"):
        monkeypatch.setattr(figures, name, watched(getattr(figures, name), name, computed))
    english = shown.html
    german = shown.save(tmp_path / "a.html", language="de").read_text("utf-8")
    assert computed == ["held_runs", "figure_numbers"]
    assert 'lang="de"' in german and 'lang="en"' in english and shown.html == english
    assert german == onpath.figure(path="circle", language="de").html


def watched(function: Any, name: str, calls: list[str]) -> Any:
    def call(*given: Any) -> Any:
        calls.append(name)
        return function(*given)

    return call


def test_one_or_many_of_path_and_law() -> None:
    one = onpath.figure("five_bar", onpath.circle(0.05), "path_following", sliders="K1").choice
    assert one and len(one.paths) == 1 and one.laws == ("path_following",)
    assert one.sliders == ("K1",)
    two = onpath.figure("five_bar", ["circle", "clover"], LAWS).choice
    assert two and [*two.paths] == ["circle", "clover"] and two.laws == LAWS


def test_arguments_of_before_are_answered_with_those_of_now() -> None:
    for call, hint in (
        (lambda: onpath.figure("held.html"), r"figure\(...\).save\(file\)"),
        (lambda: onpath.figure(Path("held.html"), "five_bar"), r"figure\(...\).save\(file\)"),  # type: ignore[arg-type]
        (lambda: onpath.figure(laws=LAWS), "write law"),
        (lambda: onpath.figure(paths=["circle"]), "write path"),
    ):
        with pytest.raises(TypeError, match=hint):
            call()


def test_a_run_s_figure_is_what_was_recorded_and_can_be_tried() -> None:
    runs = [onpath.simulate(law=law, hold=(0.2, 0.5), duration=0.6, K1=900) for law in LAWS]
    shown = runs[0].figure(runs[1])
    assert shown.recorded == tuple(run.trajectory for run in runs)
    assert shown.choice and shown.choice.laws == LAWS
    assert shown.choice.parameters == runs[0].experiment.parameters
    held = onpath.figure(
        "five_bar", "circle", LAWS, K1=900, speed=runs[0].experiment.parameters.speed
    )
    assert shown.png != held.png
    with pytest.raises(ValueError, match="one or two runs"):
        runs[0].figure(runs[1], runs[0])
    with pytest.raises(ValueError, match="one robot on one path"):
        runs[0].figure(onpath.simulate(path="clover", duration=0.05))


@pytest.mark.thorough
def test_the_page_of_a_run_says_what_the_run_had_besides(tmp_path: Path) -> None:
    place = (0.03, 0.0)
    cases: tuple[tuple[dict[str, Any], tuple[str, ...]], ...] = (
        ({}, ()),
        ({"hold": (0.02, 0.05)}, ("a hold",)),
        ({"start": (0.06, 0.0), "profile": [(0, 0), (1, 6)]}, ("another start", "a speed profile")),
        ({"velocity": (0.0, 0.1), "reverse_at": 0.05}, ("another start", "a reversal")),
        ({"push": (0, 0.02, place), "wall": (0, 0.1, place, 0.0)}, ("a pulling hand", "a wall")),
    )
    for values, parts in cases:
        shown = onpath.simulate(duration=0.1, **values).figure()
        said = "In the recorded run, but not on this page: " + ", ".join(parts) + "."
        assert (said in shown.html) == bool(parts)
        assert (said in page_in(shown._repr_mimebundle_())) == bool(parts)
        assert "Hold the robot back" in shown.html and "Hold both robots" not in shown.html
        german = shown.save(tmp_path / "a.html", language="de").read_text("utf-8")
        assert ("Im aufgezeichneten Lauf" in german) == bool(parts)


def test_a_run_that_no_page_can_show_is_a_picture_and_says_why() -> None:
    def called(now: Any) -> tuple[float, float]:
        return -now.K5 * (now.theta_rate - now.speed), -400 * now.xi[0] - 40 * now.xi_rate[0]

    run = onpath.simulate(duration=0.1)
    for shown, why in (
        (onpath.simulate(law=called, duration=0.1).figure(), "called"),
        (run.figure(onpath.simulate(K1=900, duration=0.1)), "different settings"),
    ):
        assert shown.choice is None and why in shown.reason
        page = shown.html
        assert unescape(shown.reason) in unescape(page) and "<script" not in page
        assert "script-src 'none'" in unescape(page)
        assert "data:image/png" in page
        html = shown._repr_mimebundle_()["text/html"]
        assert "iframe" not in html and shown.reason in unescape(html)


def test_a_run_of_a_law_from_elsewhere_is_drawn_with_the_label_of_its_record() -> None:
    run = onpath.simulate(duration=0.1)
    afar = dataclasses.replace(run.trajectory, law="nowhere", label="Law from afar")
    shown = onpath.Run(run.experiment, afar).figure()
    assert shown.choice is None and "nowhere" in shown.reason
    assert "Law from afar" in repr(shown) and "Law from afar" in shown.html
    assert onpath.Run(run.experiment, afar)._repr_mimebundle_()["image/png"]


def shown_things() -> dict[str, Any]:
    """What a notebook shows as more than text -> the class of it."""
    run = onpath.simulate(hold=(0.2, 0.5), duration=0.6)
    return {
        "run": run,
        "laws": onpath.laws(),
        "law": onpath.laws()["path_following"],
        "robots": onpath.robots(),
        "parameters": onpath.parameters("flexible"),
        "paths": onpath.paths(),
        **ROBOTS,
    }


def test_everything_shows_itself_in_a_cell() -> None:
    for name, thing in shown_things().items():
        bundled = hasattr(thing, "_repr_mimebundle_")
        html = thing._repr_mimebundle_()["text/html"] if bundled else thing._repr_html_()
        assert re.search("<table>|<p>|<svg", html), name
        assert len(html) < LARGEST / 4, name
        assert not re.search("object at 0x|functools", repr(thing)), name


def test_a_check_of_a_path_shows_its_drawing_and_what_it_says() -> None:
    for path in ("circle", onpath.circle(0.006), "figure of eight"):
        check = onpath.check_path("five_bar", path)
        html = check._repr_html_()
        assert b64encode(check._repr_svg_().encode()).decode() in html
        assert all(line in unescape(html) for line in repr(check).splitlines())


def test_a_run_shows_its_numbers_and_why_it_stopped() -> None:
    run = onpath.simulate(law="set_point", path="circle", hold=(0.2, 0.5), duration=0.6)
    html = run._repr_mimebundle_()["text/html"]
    for line in repr(run).splitlines()[1:]:
        for part in re.split(r"\s{2,}", line.strip()):
            assert part in unescape(html)


def test_lists_are_mappings_as_before() -> None:
    laws = onpath.laws()
    assert isinstance(laws, dict) and {**laws}["set_point"].endswith(".")
    assert f"{laws['set_point']}" == str(laws["set_point"]) and "set_point" in laws


@given(st.text(st.sampled_from("<>&\"'ab/ ="), min_size=1))
@settings(max_examples=30)
def test_no_text_in_a_cell_is_markup(text: str) -> None:
    from onpath.app.notebook.display import NamesTable, bundle

    table = NamesTable({text: text}, [text], [[text]])._repr_html_()
    html = (
        bundle(text, b"", title=text, before=[text], caption=text, head=[text], rows=[[text]])[
            "text/html"
        ]
        + table
    )
    tags = re.findall("<(/?[a-z0-9]+)", html)
    known = ["b", "caption", "div", "img", "p", "table", "tbody", "td", "th", "thead", "tr"]
    assert {tag.lstrip("/") for tag in tags} <= {*known}


def test_what_takes_long_is_said_and_the_line_is_blanked(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal:
        """A terminal that can be waited for."""

        def __init__(self) -> None:
            self.text, self.wrote = "", threading.Event()

        def isatty(self) -> bool:
            return True

        def write(self, text: str) -> None:
            self.text += text

        def flush(self) -> None:
            self.wrote.set()

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    monkeypatch.setattr(announced, "PATIENCE", 0.01)
    with announced.announced("Making it"):
        assert terminal.wrote.wait(60)
        assert terminal.text == "\rMaking it"
    assert terminal.text.split("\r")[2:] == [" " * len("Making it"), ""]
    monkeypatch.setattr(announced, "PATIENCE", 3600)
    with announced.announced("At once"):
        pass
    assert "At once" not in terminal.text


def test_a_figure_is_made_once() -> None:
    shown = onpath.figure(path="circle")
    assert isinstance(shown, Figure) and shown.html is shown.html and shown.png is shown.png
