"""Prints a page to PDF with an installed Chromium."""

from __future__ import annotations

from pathlib import Path

from onpath.app.common.chromium import find_browser


def print_page(html: str, path: Path) -> None:
    """Write a standalone HTML page to a PDF file, as a browser prints it.

    Raises:
        ValueError: Playwright or Chromium is not installed.
    """
    browser = find_browser()
    if browser is None:
        raise ValueError(
            'a PDF needs Chromium and Playwright: pip install "onpath[pdf]"; '
            "or write --html and print it in a browser"
        )
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        try:
            page = chromium.new_page()
            page.set_content(html, wait_until="load")
            page.pdf(path=path, prefer_css_page_size=True, print_background=True)
        finally:
            chromium.close()
