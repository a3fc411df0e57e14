"""What axe-core, https://github.com/dequelabs/axe-core, finds on a page."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

from tests.support.browser import Tab
from tests.support.checkout import ROOT

if TYPE_CHECKING:
    from playwright.sync_api import Page

SCRIPT = ROOT / "tests" / "vendor" / "axe-core" / "axe.min.js"
RUN = """async () => (await axe.run({ resultTypes: ["violations"] })).violations
    .filter(each => ["serious", "critical"].includes(each.impact))
    .map(each => [each.id, ...each.nodes.map(node => node.html)])"""

ROLES: dict[str, Literal["img", "radiogroup"]] = {"canvas": "img", ".options": "radiogroup"}
"""The role that every element of a CSS selector must have."""


def violations(tab: Tab) -> list[list[str]]:
    """Serious and critical violations: the rule, and the elements that violate it."""
    if not tab.page.evaluate("'axe' in window"):
        tab.page.add_script_tag(path=SCRIPT)
    return tab.page.evaluate(RUN)


def unnamed(page: Page) -> list[str]:
    """Canvases and groups of options that lack a role or a name; axe-core does not report them."""
    found = list[str]()
    for selector, role in ROLES.items():
        shown = page.locator(f"{selector}:visible")
        named = page.get_by_role(role, name=re.compile(r"\w"))
        found += [selector] * (shown.count() - shown.and_(named).count())
    return found
