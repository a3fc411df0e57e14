"""What the lessons print, as a browser prints it."""

from __future__ import annotations

import re
import subprocess
import sys
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from onpath.app.exports.guide import worksheet
from onpath.assets.messages import languages
from onpath.lessons.course import BUILT_IN
from onpath.lessons.words import Words
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough

if TYPE_CHECKING:
    from playwright.sync_api import Browser

PAGE = re.compile(rb"/Type\s*/Page\b")


def test_every_worksheet_fits_on_two_sheets_of_paper(browser: Browser) -> None:
    course, _ = built_in_course()
    page = browser.new_page()
    for name, language in product(course.lessons, languages()):
        page.set_content(worksheet(course, BUILT_IN, name, Words(language))[0])
        count = len(PAGE.findall(page.pdf(prefer_css_page_size=True)))
        assert 2 <= count <= 4, (name, language)
    page.close()


def test_a_worksheet_is_written_as_pdf(tmp_path: Path) -> None:
    """In a process of its own, since `browser` is open in this one."""
    file = tmp_path / "sheet.pdf"
    command = [sys.executable, "-m", "onpath", "lessons", "worksheet", "1", "--pdf", str(file)]
    subprocess.run(command, check=True)
    assert len(PAGE.findall(file.read_bytes())) == 2
