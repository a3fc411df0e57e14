"""The lab's page has to do with its own server alone, whatever a link says, at whatever address."""

from __future__ import annotations

import socket
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from textwrap import dedent
from urllib.parse import quote

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab.commands import SetLanguage
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from tests.support.browser import COARSER, Tab, wait_for
from tests.support.checkout import ROOT
from tests.support.free_lab import fresh
from tests.support.lab_process import free_ports
from tests.support.site import needs_nginx, nginx

SCENE = "(window.onpathLab?.lab?.scene ?? 0)"
"""How many times the page had asked for the picture that it has; 0 if it has none."""


class Stranger:
    """Another server, which notes who comes."""

    def __init__(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.host = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self.heard: list[bytes] = []
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        with suppress(OSError):
            while True:
                with self._listener.accept()[0] as guest:
                    guest.settimeout(5.0)
                    with suppress(OSError):
                        self.heard.append(guest.recv(100))

    def close(self) -> None:
        self._listener.close()


@pytest.fixture
def stranger() -> Iterator[Stranger]:
    stranger = Stranger()
    yield stranger
    stranger.close()


@contextmanager
def opened(browser: Browser, server: LabServer, path: str) -> Iterator[Tab]:
    context = fresh(browser)
    try:
        yield Tab(server, context, draws=False, path=path)
    finally:
        context.close()


def links(host: str) -> list[str]:
    """Queries that name a foreign server."""
    server, file = f"ws://{host}", f"http://{host}/a.viser"
    return [
        f"websocket={server}&playbackPath={file}",
        f"websocket={server}/&websocket={server}",
        f"%77ebsocket={quote(server, safe='')}",
        f"x={quote(f'1&websocket={server}')}",  # viser writes it into the address as it is
        f"websocket={server}&dummyWindowDimensions=fill&dummyWindowTitle=Your+class+has+ended",
    ]


@pytest.mark.thorough
def test_no_link_leads_the_page_to_a_foreign_server(
    browser: Browser, server: LabServer, stranger: Stranger
) -> None:
    for link in links(stranger.host):
        with opened(browser, server, f"/?{link}&last=") as tab:  # asserts that the lab has come
            tab.reload()
            assert tab.errors == []
            assert "Your class has ended" not in tab.page.locator("body").inner_text()
            assert tab.page.url.startswith(f"{server.address}/?")
    assert stranger.heard == []


def parameters(tab: Tab) -> list[str]:
    """Names in the query of the page's address."""
    names: list[str] = tab.page.evaluate("[...new URLSearchParams(location.search).keys()]")
    return names


@pytest.mark.thorough
def test_no_address_to_copy_names_the_server(browser: Browser, server: LabServer) -> None:
    for path in ("/", "/index.html", "/c/abc234/"):
        names_no_server(browser, server, path)


def names_no_server(browser: Browser, server: LabServer, path: str) -> None:
    with opened(browser, server, path) as tab:
        address = tab.page.url
        kept = [] if path.startswith("/c/") else ["fixedDpr"]  # a place has no query
        assert parameters(tab) == kept and address.startswith(f"{server.address}{path}")
        wait_for(lambda: tab.page.evaluate(SCENE) > 0)
        first = tab.page.evaluate(SCENE)
        server.server.get_event_loop().call_soon_threadsafe(
            server.server._websock_server._live_connections[tab.client.client_id].transport.abort
        )
        wait_for(lambda: tab.page.evaluate(SCENE) > first)  # another connection's
        assert tab.page.url == address


ASK = """async ([host, way]) => {
    const ways = {
        socket: url => new Promise((yes, no) => {
            const made = new WebSocket(`ws://${url}`)
            made.onopen = made.onerror = no
        }),
        fetch: url => fetch(`http://${url}/`, {mode: "no-cors"}),
        beacon: async url => navigator.sendBeacon(`http://${url}/`),
        picture: url => new Promise((yes, no) => {
            const made = new Image()
            made.onload = made.onerror = no
            made.src = `http://${url}/a.png`
        }),
        script: url => new Promise((yes, no) => {
            const made = document.createElement("script")
            made.onload = made.onerror = no
            made.src = `http://${url}/a.js`
            document.head.append(made)
        }),
        frame: url => new Promise((yes, no) => {
            const made = document.createElement("iframe")
            made.onload = made.onerror = no
            made.src = `http://${url}/`
            document.body.append(made)
        }),
        worker: url => new Promise((yes, no) => {
            const code = `const made = new WebSocket("ws://${url}");
                made.onopen = made.onerror = () => postMessage(1)`
            const made = new Worker(URL.createObjectURL(new Blob([code])))
            made.onmessage = made.onerror = no
        }),
    }
    const blocked = new Promise(yes =>
        addEventListener("securitypolicyviolation", event => yes(event.effectiveDirective)))
    await Promise.race([ways[way](host).catch(() => 0), blocked])
}"""
WAYS = "socket", "fetch", "beacon", "picture", "script", "frame", "worker"


def test_no_script_in_the_page_reaches_a_foreign_server(
    browser: Browser, server: LabServer, stranger: Stranger
) -> None:
    """The second wall, behind the first one."""
    with opened(browser, server, "/") as tab:
        for way in WAYS:
            tab.page.evaluate(ASK, [stranger.host, way])
        assert stranger.heard == []
        tab.press("Pause")  # and the lab is still there
        tab.button("Run").wait_for()


# Behind a web server that has the lab in a folder.

FOLDER = "/robots/onpath"
GUIDE = f"""location {FOLDER}/ {{
    proxy_pass http://127.0.0.1:8080/;
    proxy_http_version 1.1;
    proxy_set_header Host $http_host;
    proxy_set_header Upgrade $http_upgrade;
    proxy_set_header Connection "upgrade";
}}"""  # as most guides have it
README = (ROOT / "assets" / "deploy" / "README.md").read_text()
SUPPLIED = dedent(README[README.index("    location ") : README.index("    }\n") + 6])
TLS = "ssl; ssl_certificate {0}; ssl_certificate_key {0}"


def certificate(folder: Path) -> Path:
    """A file with a certificate for localhost, and its key."""
    file = folder / "both.pem"
    ask = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost"]
    made = [*ask, "-keyout", str(file), "-out", str(folder / "cert.pem")]
    subprocess.run(made, check=True, capture_output=True)
    file.write_text(file.read_text() + (folder / "cert.pem").read_text())
    return file


@needs_nginx
def test_the_lab_in_a_folder_of_a_web_server(
    browser: Browser, server: LabServer, tmp_path: Path
) -> None:
    (port,) = free_ports(1)
    location = GUIDE.replace("8080", str(server.server.get_port()))
    sites = f"server {{ listen 127.0.0.1:{port}; {location} }}"
    with nginx(tmp_path, port, sites):
        context = fresh(browser)
        site = f"http://localhost:{port}"
        tab = Tab(server, context, draws=False, path=FOLDER, site=site)  # without a slash
        assert tab.page.url.startswith(f"{site}{FOLDER}/?") and "ws" not in tab.page.url
        tab.press("Pause")
        tab.button("Run").wait_for()
        context.close()


@needs_nginx
@pytest.mark.thorough
@pytest.mark.parametrize("host", ["$http_host", "internal.example"])
def test_the_lab_in_a_folder_as_the_readme_says_with_tls(
    browser: Browser, tmp_path: Path, host: str
) -> None:
    (port,) = free_ports(1)
    site = f"https://localhost:{port}"
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(allowed_origins=(site,)))
    location = SUPPLIED.replace("$http_host", host).replace("8080", str(server.server.get_port()))
    listens = f"127.0.0.1:{port} {TLS.format(certificate(tmp_path))}"
    with nginx(tmp_path, port, f"server {{ listen {listens}; {location} }}"):
        context = browser.new_context(ignore_https_errors=True)
        tab = Tab(server, context, draws=False, path=f"{FOLDER}/", site=site)
        place = tab.page.url.removeprefix(f"{site}{FOLDER}/l/")
        assert place.partition("/")[2] == ""  # a place has no query
        (cookie,) = context.cookies()
        assert cookie.get("path") == f"{FOLDER}/"
        tab.reload()
        assert tab.page.url.endswith(place) and tab.errors == []
        context.close()
    server.stop()


# When nobody answers.


@needs_nginx
def test_who_waits_in_vain_is_told_so_and_then_shown_the_lab(
    browser: Browser, server: LabServer, tmp_path: Path
) -> None:
    """A proxy passes no websockets on, and is mended."""
    (port,) = free_ports(1)
    location = GUIDE.replace("8080", str(server.server.get_port()))
    mended = f"server {{ listen 127.0.0.1:{port}; {location} }}"
    broken = mended.replace("proxy_set_header Upgrade $http_upgrade;", "")
    context = browser.new_context(locale="de-AT")
    page = context.new_page()
    told = page.get_by_role("status").filter(has_text="seine Verbindung öffnet sich nicht")
    with nginx(tmp_path, port, broken):
        page.goto(f"http://localhost:{port}{FOLDER}/?{COARSER}")
        told.wait_for(timeout=60e3)
    with nginx(tmp_path, port, mended):
        page.wait_for_function(f"(() => {SCENE} > 0)()", timeout=60e3)
        told.wait_for(state="detached", timeout=60e3)
        context.close()


@needs_nginx
@pytest.mark.thorough
def test_a_lost_connection_is_reported_until_it_is_back(
    browser: Browser, server: LabServer, tmp_path: Path
) -> None:
    """In the language of the page, whatever the browser's is."""
    (port,) = free_ports(1)
    location = GUIDE.replace("8080", str(server.server.get_port()))
    proxy = f"server {{ listen 127.0.0.1:{port}; {location} }}"
    context = browser.new_context(locale="fr")
    with nginx(tmp_path, port, proxy):
        site = f"http://localhost:{port}"
        tab = Tab(server, context, draws=False, path=f"{FOLDER}/", site=site)
        tab.ask(SetLanguage("de"))
        tab.page.locator("html[lang=de]").wait_for()
    alert = tab.page.get_by_role("status").filter(has_text="Verbindung zum Labor ist abgebrochen")
    alert.wait_for(timeout=60e3)
    with nginx(tmp_path, port, proxy):
        alert.wait_for(state="detached", timeout=60e3)
        context.close()
