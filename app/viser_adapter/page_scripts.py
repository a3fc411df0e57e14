"""The page that browsers are given: viser's, with the scripts of assets/page before its own."""

from __future__ import annotations

import gzip
from functools import cache, lru_cache

from websockets.http11 import Response

from onpath.assets import asset_path


def add_scripts(response: Response | None) -> Response | None:
    """Put our scripts into a response, if it is viser's page; every other stays as it is."""
    if response and response.headers.get("Content-Type", "").startswith("text/html"):
        packed = response.headers.get("Content-Encoding") == "gzip"
        response.body = _page(bytes(response.body), packed)
        del response.headers["Content-Length"]
        response.headers["Content-Length"] = str(len(response.body))
    return response


def with_scripts(page: bytes, scripts: bytes) -> bytes:
    """A page that runs some scripts before its first one, or at the end of its head."""
    for place in (b"<script", b"</head>"):
        before, found, after = page.partition(place)
        if found:
            return before + scripts + found + after
    return page


@cache
def our_scripts() -> bytes:
    """Every file of assets/page, in order of name, each an element of its own."""
    files = sorted(asset_path("page").glob("*.js"))
    return b"".join(b"<script>\n" + file.read_bytes() + b"</script>\n" for file in files)


@lru_cache(maxsize=4)
def _page(body: bytes, packed: bool) -> bytes:
    """The same bytes for the same page: viser keeps its own, so that comparing costs nothing."""
    page = with_scripts(gzip.decompress(body) if packed else body, our_scripts())
    return gzip.compress(page, mtime=0) if packed else page
