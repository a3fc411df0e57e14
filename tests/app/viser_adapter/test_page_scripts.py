"""What is served is viser's page with our scripts before its own, whatever that page is like."""

from __future__ import annotations

import gzip
import http.client
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import viser

from onpath.app.viser_adapter.page_scripts import BODY, TITLES, our_scripts, with_scripts, words
from onpath.app.viser_adapter.secure_server import make_server
from onpath.assets import asset_path

SCRIPTS = sorted(asset_path("page").glob("*.js"))
FILES = sorted(asset_path("page").glob("*.*s"))
CLIENT = Path(viser.__file__).parent / "client"
INDEX = CLIENT / "build" / "index.html"
PARAMETER = re.compile(r"""earchParams\.(?:get|has)\("(\w+)"\)|: parse\w+\("(\w+)"\)""")
PICTURE = {  # what they change is how the lab is shown
    "showStats",
    "fixedDpr",
    "logCamera",
    "darkMode",
    "hideViserLogo",
    "forceOrbitOriginTool",
    *(f"initialCamera{what}" for what in ("Position", "LookAt", "Up", "Fov", "Near", "Far")),
}
FOREIGN = {  # servers and files, and a title that would be the link's author's
    "websocket",
    "playbackPath",
    "dummyWindowDimensions",
    "dummyWindowTitle",
}


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    server = make_server(port=0)
    yield server.get_port()
    server.stop()


def get(port: int, path: str, **headers: str) -> tuple[http.client.HTTPResponse, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request("GET", path, headers=headers)
    reply = connection.getresponse()
    return reply, reply.read()


@pytest.mark.parametrize("path", ["/", "/index.html", "/?fixedDpr=1", "/./index.html", "//"])
@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_the_page_is_visers_and_our_scripts(port: int, path: str, encoding: str) -> None:
    for _ in range(2):
        reply, body = get(port, path, **{"Accept-Encoding": encoding})
        assert reply.status == 200 and reply.getheader("Content-Encoding") == encoding
        assert reply.headers.get_all("Content-Length") == [str(len(body))]
        assert (reply.getheader("Content-Type") or "").startswith("text/html")
        page = gzip.decompress(body) if encoding == "gzip" else body
        added = our_scripts() + BODY
        assert page.count(added) == 1
        ours = INDEX.read_bytes().replace(*TITLES)
        assert page.replace(added, b"") == ours and b"<title>OnPath<" in page
        assert page.index(b"<meta charset") < 900  # a browser looks for it in the first 1024 bytes
        assert page.index(added) + len(added) == page.index(b"<script data-p")


def test_nothing_else_is_touched(port: int) -> None:
    assert get(port, "/nothing.html")[0].status == 404
    assert get(port, "/health")[1] == b"well\n"


def test_every_script_is_an_element_of_its_own_in_order_of_name() -> None:
    assert SCRIPTS and set(SCRIPTS) < set(FILES)
    texts = {file: file.read_bytes() for file in FILES}
    assert all(text.isascii() and text.endswith(b"\n") for text in texts.values())
    for ends in (b"</script", b"</style", b"<!--"):
        assert not any(ends in text.lower() for text in texts.values())
    kinds = [b"style" if file.suffix == ".css" else b"script" for file in FILES]
    elements = zip(kinds, texts.values(), strict=True)
    ours = b"".join(b"<%b>\n%b</%b>\n" % (k, t, k) for k, t in elements)
    assert our_scripts() == words() + ours


@pytest.mark.parametrize(
    ("page", "expected"),
    [
        (b"<head><title>x</title><script>1</script></head>", b"<head><title>x</title>!<script>1"),
        (b"<head><title>x</title></head><body>", b"<head><title>x</title>!</head><body>"),
        (b"<p>hello</p>", b"<p>hello</p>"),
        (b"", b""),
    ],
)
def test_scripts_come_first_in_whatever_page(page: bytes, expected: bytes) -> None:
    assert with_scripts(page, b"!").startswith(expected)


def test_all_parameters_of_visers_page_are_known() -> None:
    """A new one might name a server, too; address.js must know those that do."""
    sources = [file for file in (CLIENT / "src").rglob("*.ts*") if "dock" not in file.parts]
    text = "".join(source.read_text() for source in sources)
    found = {name or parsed for name, parsed in PARAMETER.findall(text)}
    assert found == (PICTURE | FOREIGN) - {"websocket"}
    assert 'searchParamKey = "websocket"' in text
    assert text.count("location.search") == text.count(
        "new URLSearchParams(window.location.search)"
    )
    by_variable = text.count("earchParams.get(") - text.count('earchParams.get("')
    assert by_variable == 2  # parseVec3, parseScalar
    known = re.findall(r'"(\w+)"', (asset_path("page") / "address.js").read_text())
    assert {*known} >= FOREIGN
