"""Adds our title, and the files of assets/page before viser's scripts, to viser's page."""

from __future__ import annotations

import gzip
from functools import cache, lru_cache

import msgspec
from websockets.http11 import Response

from onpath.assets import asset_path
from onpath.assets.messages import catalogue, languages

ELEMENTS = {".js": b"script", ".css": b"style"}
SAID = (
    *("connect.opening", "connect.silent", "connect.blocked", "connect.offline", "connect.lost"),
    *("connect.building", "connect.loading", "connect.back", "connect.slow"),
    *("connect.forbidden", "connect.refused", "connect.version", "connect.picture_lost"),
    *("connect.picture_back", "connect.no_webgl", "connect.course_link"),
)
"""Messages of browser_words.js."""
TITLES = b"<title>Viser</title>", b"<title>OnPath</title>"
BODY = b"</head>\n<body>\n"
"""Begins the body before viser's script of 0.8 MB, so that our page is there while that comes."""


def add_scripts(
    response: Response | None, course_url: str = "", more: bytes = b""
) -> Response | None:
    """Insert our scripts into a response if it is viser's page; leave all others unchanged.

    Args:
        course_url: see `words`.
        more: elements to insert after those of assets/page.
    """
    if response and response.headers.get("Content-Type", "").startswith("text/html"):
        packed = response.headers.get("Content-Encoding") == "gzip"
        response.body = _page(bytes(response.body), packed, course_url, more)
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
def our_scripts(course_url: str = "") -> bytes:
    """The words that the scripts need before the lab sends any, then all files of assets/page.

    Each is a <script> or <style> element; the files are in alphabetical order.
    """
    files = sorted(file for file in asset_path("page").iterdir() if file.suffix in ELEMENTS)
    elements = [(ELEMENTS[file.suffix], file.read_bytes()) for file in files]
    parts = [b"<%b>\n%b</%b>\n" % (name, text, name) for name, text in elements]
    return b"".join([words(course_url), *parts])


def words(course_url: str = "") -> bytes:
    """`messages` as an element with JSON."""
    text = msgspec.json.encode(messages(course_url)).replace(b"<", b"\\u003c")
    return b'<script id="op-words" type="application/json">%b</script>\n' % text


def messages(course_url: str = "") -> dict[str, dict[str, str]]:
    """The messages of browser_words.js in every language.

    Args:
        course_url: address of the course as pages without a server; empty if there is none.
    """
    filled = {"origin": "{origin}"}  # by the page
    return {
        code: {key.partition(".")[2]: catalogue(code).text(key, filled) for key in SAID}
        | {"course_url": course_url}
        for code in languages()
    }


@lru_cache(maxsize=4)
def _page(body: bytes, packed: bool, course_url: str, more: bytes) -> bytes:
    """The page with our scripts. Cached, because viser serves the same bytes every time."""
    page = gzip.decompress(body) if packed else body
    page = with_scripts(page.replace(*TITLES, 1), our_scripts(course_url) + more + BODY)
    return gzip.compress(page, mtime=0) if packed else page
