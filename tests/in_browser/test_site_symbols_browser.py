"""Whoever points at a symbol of a lesson's text, or chooses it by keys, sees it on the robots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.support.site_export import LESSON, exported_site
from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough
LIT = "site.stage.figure.views.map(each => each.lit)"
MEANT = "spring across the path"
SHAPES = "([name, seen]) => shapesOf(name, seen)"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    site: Path = exported_site(tmp_path_factory.mktemp("site"), ("en",))
    return (site / f"{LESSON}.html").as_uri()


def test_a_symbol_is_lit_by_pointing_and_by_keys(browser: Browser, address: str) -> None:
    reader = SiteReader(browser, f"{address}#7", reduced_motion="reduce")
    page = reader.page
    reader.ready()
    assert page.evaluate(LIT) == ["", ""]
    page.locator(".step.open span[data-symbol=K_1]").first.hover()
    wait_for(lambda: page.evaluate(LIT) == ["K_1", "K_1"], WAIT)
    assert page.locator(".meaning").inner_text().startswith(f"K1: {MEANT}")
    assert page.locator(".step.open .words [data-symbol=K_1]:not(.lit)").count() == 0
    page.mouse.move(1000, 300)
    wait_for(lambda: page.evaluate(LIT) == ["", ""], WAIT)
    assert page.locator(".meaning").count() == 0
    page.locator(".step.open .symbols summary").focus()
    page.keyboard.press("Enter")
    reader.focus(page.locator(".step.open .symbols button", has_text=MEANT))
    assert page.evaluate(LIT) == ["K_1", "K_1"]
    page.keyboard.press("Tab")
    assert page.evaluate(LIT) != ["K_1", "K_1"]
    assert reader.complaints == []
    reader.context.close()


def test_a_step_without_symbols_has_no_list(browser: Browser, address: str) -> None:
    reader = SiteReader(browser, f"{address}#2", reduced_motion="reduce")
    reader.ready()
    assert reader.page.locator(".step.open :is([data-symbol], .symbols)").count() == 0
    reader.context.close()


def test_what_is_drawn_is_to_scale(browser: Browser, address: str) -> None:
    """On a circle, wherever the robot is."""
    reader = SiteReader(browser, address, reduced_motion="reduce")
    random = np.random.default_rng(41)
    angles = np.linspace(-np.pi, np.pi, 241)
    for _ in range(30):
        radius, theta = random.uniform(0.02, 0.2), random.choice(angles[1:-1])
        middle, away = random.uniform(-0.2, 0.2, 2), random.uniform(-0.01, 0.01)

        def at(angle: Any, r: float, middle: Any = middle) -> Any:
            return middle + r * np.array([np.cos(angle), np.sin(angle)])

        closest, tip = at(theta, radius), at(theta, radius - away)
        reference = at(random.choice(angles), radius)
        seen = {
            "tip": tip.tolist(),
            "closest": closest.tolist(),
            "reference": reference.tolist(),
            "pushed": (tip + [0.01, 0]).tolist(),
            "outline": [at(each, radius).tolist() for each in angles],
            "closed": True,
            "joints": {},
        }
        drawn = {
            name: [np.array(each["points"]) for each in reader.page.evaluate(SHAPES, [name, seen])]
            for name in ("lambda", "e", "N", "T", "theta", "K_1", "q_1")
        }
        np.testing.assert_allclose(drawn["lambda"], [[closest, tip]])
        np.testing.assert_allclose(drawn["e"], [[reference, tip]])
        np.testing.assert_allclose(drawn["K_1"], [[reference, tip]])
        (normal,), (tangent,) = drawn["N"], drawn["T"]
        inwards = (middle - closest) / radius  # where λ > 0
        np.testing.assert_allclose((normal[1] - normal[0]) / 0.03, inwards, atol=0.02)
        assert abs((tangent[1] - tangent[0]) @ inwards) < 1e-3
        (arc,) = drawn["theta"]
        length = np.linalg.norm(np.diff(arc, axis=0), axis=1).sum()
        np.testing.assert_allclose(length, radius * abs(theta), rtol=0.01, atol=1e-3)
        np.testing.assert_allclose(arc[-1], closest, atol=1e-9)
        assert drawn["q_1"] == []  # it has no such joint
    reader.context.close()
