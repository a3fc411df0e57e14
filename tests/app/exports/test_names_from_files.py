"""Names from a foreign file do no harm wherever they are shown."""

from __future__ import annotations

import dataclasses
import io
import json
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest
from typing_extensions import override

import onpath
from onpath.app.exports.arena_page import Contents, arena_page, markdown
from onpath.app.exports.figures import experiment_figure
from onpath.app.view.robots import robot_card
from onpath.lessons.words import Words
from onpath.models.robot_files.file_chain import guessed_tip
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.catalogue import robot_named
from onpath.models.systems.chain_robot import chain_entry
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.robots import RobotEntry
from tests.support.guessed_robot import in_catalogue

LONG = 2000  # characters of a text with a few names
NAMES = {
    "markup": "<script>alert(1)</script><img src=x onerror=alert(1)>",
    "end of a script": "</script></style>]]>--><!--",
    "formula": '=HYPERLINK("http://x.example","y")',
    "another formula": "@SUM(1+1)*cmd|' /C calc'!A0",
    "long": "x" * 10_000,
    "right to left": "\u202egnp.exe\u2066\u200f",
    "mathematics": r"$\frac{1}{0}$ \undefined _^",
    "templates": "{{ 7*7 }}{% include 'x' %}%s%n{0}",
    "shell": "'; rm -rf ~; echo `id` $(id)\n\x1b[2J\x00",
    "Markdown": "[a](javascript:alert(1)) | b | `c` <b>",
}


def named(name: str) -> RobotEntry:
    """The planar arm with this name wherever a file has one."""
    source = robot_named("planar_arm").source
    assert source is not None
    bodies = tuple(
        dataclasses.replace(
            body, name=name, joint=dataclasses.replace(body.joint, name=name, low=-4.0, high=4.0)
        )
        for body in source.chain.bodies
    )
    changed = dataclasses.replace(
        source,
        name="foreign_0a1b2c3d",
        label=shown(name),
        text=f"3 joints, from {shown(name)}.",
        chain=dataclasses.replace(source.chain, bodies=bodies),
        guesses=(guessed_tip(name),),
    )
    return chain_entry(changed)


@pytest.fixture(params=NAMES, scope="module")
def entry(request: pytest.FixtureRequest) -> Iterator[RobotEntry]:
    with in_catalogue(named(NAMES[request.param])) as robot:
        yield robot


class Elements(HTMLParser):
    """The elements and attributes of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found = list[tuple[str, tuple[str, ...]]]()
        self.feed(page)

    @override
    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, tuple(name for name, _ in attrs)))


def texts(data: Any) -> Iterator[str]:
    """All texts in data of JSON."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, dict):
        for each in data.values():
            yield from texts(each)
    elif isinstance(data, list | tuple):
        for each in data:
            yield from texts(each)


def test_texts_are_short_and_visible(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    told = exceeded(robot, np.array([1e6, 0.0, 0.0]))
    (passed,) = (stop.reason for stop in robot.stops or () if callable(stop.reason))
    said = [str(told), str(passed(np.array([9.0, 0, 0]), entry.parameters())), repr(entry)]
    for language in ("en", "de"):
        card = robot_card(entry, Words(language))
        said += [told.text(language) if told else "", card.label, card.differs, card.text]
    for text in said:
        assert text.isprintable() and len(text) < LONG


def test_cells_of_a_notebook_have_no_elements_of_a_name(entry: RobotEntry) -> None:
    usual = named("arm")
    assert Elements(entry._repr_html_()).found == Elements(usual._repr_html_()).found
    assert len(re.sub("<svg.*</svg>", "", entry._repr_html_())) < LONG


def test_the_arena_has_no_elements_of_a_name(entry: RobotEntry) -> None:
    contents = Contents(
        rows={entry.name: []}, results={entry.name: []}, command="", figures={}, planned=0
    )
    page, words = arena_page(contents, Words("en")), Words("en")
    assert "script" not in {tag for tag, _ in Elements(page).found}
    assert not {n for _, names in Elements(page).found for n in names if n.startswith("on")}
    lines = markdown(contents, words).splitlines()
    for line in (lines[0], lines[-1]):
        assert not re.search(r"(?<!\\)[\[<`|]", line)
    assert len(lines) < 12


@pytest.mark.thorough
def test_runs_files_and_pictures_are_made(entry: RobotEntry, tmp_path: Any) -> None:
    run = onpath.simulate(entry, duration=0.02)
    run.to_csv(tmp_path / "run.csv")
    rows = (tmp_path / "run.csv").read_text("utf-8").splitlines()
    for cell in ",".join((rows[0], rows[1])).split(","):
        assert not cell.startswith(("=", "@", "+", "\t")) and cell.isprintable()
    assert Elements(run._repr_mimebundle_()["text/html"]).found[0][0] == "div"
    experiment_figure(run.experiment, [run.trajectory]).savefig(io.BytesIO(), dpi=20)


@pytest.mark.thorough
def test_a_figure_keeps_a_name_inside_its_data(entry: RobotEntry) -> None:
    page = onpath.figure(entry, law="path_following").html
    tags = [tag for tag, _ in Elements(page).found]
    assert tags.count("script") == 2 and tags.count("img") == 1 and "b" not in tags
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)
    for text in texts(json.loads(data)):
        assert "\u202e" not in text and "\x1b" not in text
        assert "x" * 200 not in text
