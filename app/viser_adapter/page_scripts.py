"""Adds our title, and the files of assets/page before viser's scripts, to viser's page."""

from __future__ import annotations

import gzip
from functools import cache, lru_cache

import msgspec
from websockets.http11 import Response

from onpath.assets import asset_path
from onpath.assets.messages import catalogue, languages

ELEMENTS = {".js": b"script", ".css": b"style"}
TITLES = b"<title>Viser</title>", b"<title>OnPath</title>"


def add_scripts(response: Response | None) -> Response | None:
    """Insert our scripts into a response if it is viser's page; leave all others unchanged."""
    if response and response.headers.get("Content-Type", "").startswith("text/html"):
        packed = response.headers.get("Content-Encoding") == "gzip"
        response.body = _page(bytes(response.body), packed)
        del response.headers["Content-Length"]
        response.headers["Content-Length"] = str(len(response.body))
    return response


def with_scripts(page: bytes, scripts: bytes) -> bytes:
    """A page with scripts inserted before its first one, or at the end of its head."""
    for place in (b"<script", b"</head>"):
        before, found, after = page.partition(place)
        if found:
            return before + scripts + found + after
    return page


@cache
def our_scripts() -> bytes:
    """The words that the scripts need before the lab sends any, then all files of assets/page.

    Each is a <script> or <style> element; the files are in alphabetical order.
    """
    files = sorted(file for file in asset_path("page").iterdir() if file.suffix in ELEMENTS)
    elements = [(ELEMENTS[file.suffix], file.read_bytes()) for file in files]
    parts = [b"<%b>\n%b</%b>\n" % (name, text, name) for name, text in elements]
    return b"".join([words(), *parts])


def words() -> bytes:
    """The messages of connection.js in every language, as an element with JSON."""
    keys = {"silent": "connect.silent", "lost": "connect.lost"}
    messages = {
        code: {name: catalogue(code).text(key, {}) for name, key in keys.items()}
        for code in languages()
    }
    text = msgspec.json.encode(messages).replace(b"<", b"\\u003c")
    return b'<script id="op-words" type="application/json">%b</script>\n' % text


@lru_cache(maxsize=4)
def _page(body: bytes, packed: bool) -> bytes:
    """The page with our scripts. Cached, because viser serves the same bytes every time."""
    page = gzip.decompress(body) if packed else body
    page = with_scripts(page.replace(*TITLES, 1), our_scripts())
    return gzip.compress(page, mtime=0) if packed else page
