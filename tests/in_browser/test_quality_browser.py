"""A browser that draws in software gets a scene that is quickly drawn, any other a fine one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab

pytestmark = pytest.mark.thorough

UNMASKED_RENDERER = 0x9246
NAMED = """
    const get = WebGL2RenderingContext.prototype.getParameter
    WebGL2RenderingContext.prototype.getParameter = function (name) {
        return name === %d ? "%s" : get.call(this, name)
    }
"""
SMOOTHED = (
    'document.querySelector("canvas[data-engine]").getContext("webgl2").getContextAttributes()'
)
SCENES = """
    const tools = window.__THREE_DEVTOOLS__ = new EventTarget()
    window.scenes = []
    tools.addEventListener("observe", ({ detail }) => { if (detail?.isScene) scenes.push(detail) })
"""
MATERIALS = """() => {
    const kinds = new Set()
    for (const scene of scenes) scene.traverse(({ material }) => kinds.add(material?.type))
    return [...kinds]
}"""
RENDERERS = {
    "ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 Direct3D11 vs_5_0 ps_5_0, D3D11)": False,
    "llvmpipe (LLVM 15.0.7, 256 bits)": True,
}


@contextmanager
def opened(browser: Browser, server: LabServer, renderer: str) -> Iterator[Tab]:
    context = browser.new_context()
    context.add_init_script(SCENES)
    if renderer:
        context.add_init_script(NAMED % (UNMASKED_RENDERER, renderer))
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


def test_the_scene_is_as_fine_as_the_browser_can_draw_it(
    browser: Browser, server: LabServer
) -> None:
    for renderer in (*RENDERERS, ""):
        with opened(browser, server, renderer) as tab:
            is_as_fine(tab, RENDERERS.get(renderer, True))  # that of the tests draws in software


def is_as_fine(tab: Tab, is_plain: bool) -> None:
    assert isinstance(tab.display, LabFeed)
    assert tab.display.scene is not None
    assert tab.display.scene._scene.stage.plain == is_plain
    assert tab.page.evaluate(SMOOTHED)["antialias"] == (not is_plain)
    assert ("MeshToonMaterial" in tab.page.evaluate(MATERIALS)) == is_plain
    assert not tab.page.get_by_text("Software WebGL").filter(visible=True).count()
