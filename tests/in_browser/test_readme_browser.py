"""What README tells to type for pages without a server, word for word in an empty folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import ZipFile

import pytest

from tests.support.built_in import built_in_course
from tests.support.checkout import ROOT
from tests.support.lab_process import free_ports
from tests.support.site_reader import WAIT, SiteReader
from tests.support.site_servers import python_server, running
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Frame, Page

pytestmark = pytest.mark.thorough
COURSE, _ = built_in_course()
README = (ROOT / "README.md").read_text("utf-8")
SECTION = README.split("## Pages without a server")[1].split("\n## ")[0]
COMMANDS = re.findall(r"^onpath .*$", SECTION, re.MULTILINE)
SERVE = re.findall(r"`(python -m http\.server [^`]*)`", SECTION)[0]
FRAME = re.findall(r"`(<iframe .*</iframe>)`", SECTION)[0]
BLOG = '<!doctype html><title>Blog</title><link rel="icon" href="data:,">{}'
FIGURES = ("held.html", "arm.html", "laws.html")
MOVES = "(window.onpath ?? window.site?.figure)?.simulation.time ?? 0"
LARGEST = 250_000  # [B], of "one page of 0.2 MB"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty folder after all commands of the section, in their order."""
    folder: Path = tmp_path_factory.mktemp("empty")
    programs = Path(sys.executable).parent  # of the environment, without following the link
    own = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    for command in COMMANDS:
        shell = ["bash", "-c", command]
        done = subprocess.run(shell, cwd=folder, env=own, capture_output=True, check=False)
        assert (done.returncode, done.stderr) == (0, b""), command
    return folder


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    """The address of that folder in a web server."""
    with python_server(folder) as found:
        yield found


def moves(page: Page | Frame) -> None:
    wait_for(lambda: page.evaluate(MOVES) > 0.3, WAIT)


def test_its_commands_make_what_they_say(folder: Path) -> None:
    made = sorted(each.name for each in folder.iterdir())
    assert made == sorted([*FIGURES, "lesson.zip", "course"])
    assert (folder / "held.html").stat().st_size < LARGEST
    assert "imsmanifest.xml" in ZipFile(folder / "lesson.zip").namelist()


@pytest.mark.parametrize("name", FIGURES)
def test_its_figures_open_from_the_folder_and_move(
    browser: Browser, folder: Path, name: str
) -> None:
    reader = SiteReader(browser, (folder / name).as_uri())
    moves(reader.page)
    assert len(reader.requests) == 1 and reader.complaints == []
    laws = reader.page.get_by_role("combobox", name=re.compile("Law, ")).count()
    assert laws == (2 if name == "laws.html" else 0)
    reader.context.close()


def test_its_course_opens_from_the_folder_and_as_it_is_served(
    browser: Browser, folder: Path
) -> None:
    (port,) = free_ports(1)
    served = [sys.executable, *SERVE.split()[1:], str(port)]
    with running(served, port, folder) as address:
        for start in (f"{address}/", (folder / "course" / "index.html").as_uri()):
            reader = SiteReader(browser, start)
            moves(reader.page)
            assert reader.page.locator(".lessons li").count() == len(COURSE.lessons)
            assert reader.complaints == []
            reader.context.close()


def test_its_frame_shows_the_figure_whole(browser: Browser, folder: Path, address: str) -> None:
    (folder / "blog.html").write_text(BLOG.format(FRAME))
    for width in (1280, 800):
        size = {"width": width, "height": 900}
        reader = SiteReader(browser, f"{address}/blog.html", viewport=size)
        moves(reader.page.frames[1])
        left = reader.page.frames[1].evaluate("document.documentElement.scrollHeight - innerHeight")
        assert left == 0 and reader.complaints == [], width
        reader.context.close()
