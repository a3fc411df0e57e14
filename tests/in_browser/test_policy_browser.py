"""Pages of servers whose Content-Security-Policy forbids what figures need: the pages say so."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import onpath
from tests.support.site_export import LESSON, exported_site
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.thorough
WAIT = 60.0  # [s]
NO_SCRIPT = "needs JavaScript"
NO_WASM = "'wasm-unsafe-eval'"
INLINE = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'"
SELF = "default-src 'self'"
HINT = "Hold both robots back"
PICTURE = "The robots at their largest distance from the path"
WITHOUT = "delete globalThis.WebAssembly"
"""What a browser does that has no WebAssembly."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A site, and a figure in it."""
    site = exported_site(tmp_path_factory.mktemp("site"), ("en",))
    onpath.figure().save(site / "figure.html")
    return site


class Handler(SimpleHTTPRequestHandler):
    """Sends a policy with every file."""

    policy = ""

    def end_headers(self) -> None:
        self.send_header("Content-Security-Policy", self.policy)
        super().end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Nothing."""


@contextmanager
def served(folder: Path, policy: str) -> Iterator[str]:
    kind = type("Policed", (Handler,), {"policy": policy})
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(kind, directory=str(folder))) as server:
        threading.Thread(target=server.serve_forever).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@contextmanager
def shown(browser: Browser, folder: Path, policy: str, name: str) -> Iterator[Page]:
    with served(folder, policy) as address:
        page = browser.new_page()
        page.goto(f"{address}/{name}")
        yield page
        page.close()


def test_what_a_server_forbids_is_said(browser: Browser, folder: Path) -> None:
    for policy, name, said, not_said in (
        (INLINE, "figure.html", NO_WASM, NO_SCRIPT),
        (SELF, "figure.html", NO_SCRIPT, NO_WASM),
        ("default-src 'none'", "index.html", NO_SCRIPT, NO_WASM),
        (SELF, "index.html", NO_WASM, NO_SCRIPT),
        (SELF, f"{LESSON}.html", NO_WASM, NO_SCRIPT),
    ):
        with shown(browser, folder, policy, name) as page:
            told = page.get_by_text(said)
            wait_for(lambda told=told: told.is_visible(), WAIT)
            assert not page.get_by_text(not_said).is_visible()


def test_a_browser_without_webassembly_says_so(browser: Browser, folder: Path) -> None:
    page = browser.new_page()
    page.add_init_script(WITHOUT)
    for name in ("figure.html", "index.html", f"{LESSON}.html"):
        page.goto((folder / name).as_uri())
        wait_for(lambda: page.get_by_text("needs WebAssembly").is_visible(), WAIT)
        if name == "figure.html":
            assert page.get_by_alt_text(PICTURE).is_visible()
            assert not page.get_by_text(HINT).is_visible()
    page.close()


def test_a_figure_that_runs_says_what_can_be_done(browser: Browser, folder: Path) -> None:
    page = browser.new_page()
    page.goto((folder / "figure.html").as_uri())
    wait_for(lambda: page.get_by_text(HINT).is_visible(), WAIT)
    page.close()


def test_a_figure_without_scripts_is_a_picture(browser: Browser, folder: Path) -> None:
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto((folder / "figure.html").as_uri())
    assert page.get_by_text(NO_SCRIPT).is_visible()
    assert not page.get_by_text(HINT).is_visible()
    box = page.get_by_alt_text(PICTURE).bounding_box()
    assert box and box["width"] > 300 and box["height"] > 200
    page.close()


def test_a_lesson_whose_figures_are_forbidden_can_be_read(browser: Browser, folder: Path) -> None:
    """Its pictures stand where the runs would be, after the prediction."""
    with shown(browser, folder, SELF, f"{LESSON}.html#2") as page:
        still = page.locator(".step.open .still")
        page.locator("#next").click()  # skips the prediction
        wait_for(lambda: page.locator(".step.open").get_by_text(NO_WASM).is_visible(), WAIT)
        assert still.is_visible()
        assert page.locator("#next.main").is_visible()
        for name in ("Let it happen", "Skip the run"):
            assert not page.get_by_role("button", name=name).is_visible()
        assert page.get_by_text("Four arches, not one bump").is_visible()
