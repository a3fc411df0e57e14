"""The addresses of a lab behind a proxy: /c/CODE/ for a class, and /l/NAME/ for all others.

All of them serve the same page, but for /c/CODE/wall and /c/CODE/remote, the class's wall and its
teacher's remote control. They let a proxy send everybody who belongs together to one process, by
the path alone: viser's page opens its websocket at its own address.

An address has one spelling, in lower case and without a query, because a proxy may send another
spelling of it to another process. A request for a page in another spelling is redirected, and a
websocket is refused.
"""

from __future__ import annotations

import re
from http import HTTPStatus

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from onpath.app.common.access_codes import new_code

CLASS, ALONE = "c", "l"
WALL, REMOTE = "wall", "remote"
SCREENS = (WALL, REMOTE)
"""Pages of a class that have no lab of their own, by the last part of their address."""
COOKIE = "onpath"  # name of the cookie that brings a browser back to its /l/NAME/
_PLACE = re.compile(r"/([cl])/([a-z0-9]{1,32})(?=[/?]|$)", re.ASCII | re.IGNORECASE)
_LIKE_A_PLACE = re.compile(r"/[cl](?:[/?]|$)", re.IGNORECASE)
_SCREEN = re.compile(rf"/{CLASS}/[a-z0-9]{{1,32}}/({'|'.join(SCREENS)})", re.ASCII)
_SOCKET = re.compile(r"/[cl]/[a-z0-9]{1,32}/?")
_KNOWN = re.compile(rf"(?:^|;\s*){COOKIE}=([a-z0-9]{{12}})(?:;|$)")
_START = ("/", "/index.html")
_YEAR = 31_536_000  # [s] in a year


def class_address(code: str) -> str:
    """The path of a class's page."""
    return f"/{CLASS}/{code}/"


def class_link(code: str, prefix: str) -> str:
    """The address of a class's page, relative to the page under a prefix."""
    up = "../.." if prefix else "."
    return f"{up}{class_address(code)}"


def screen_of(path: str) -> str:
    """Which of `SCREENS` a path leads to; empty: to a lab, or to a file."""
    found = _SCREEN.fullmatch(path)
    return found[1] if found else ""


def prefix_of(path: str) -> str:
    """The prefix in a path, "c/CODE" or "l/NAME"; empty if there is none."""
    found = _PLACE.match(path)
    return f"{found[1]}/{found[2]}".lower() if found else ""


def takes_websocket(path: str) -> bool:
    """Whether a websocket may be opened at a path: under a prefix in its one spelling, or at none.

    viser's page omits the final slash.
    """
    is_at_place = _SOCKET.fullmatch(path) or _SCREEN.fullmatch(path)
    return bool(is_at_place) or not _LIKE_A_PLACE.match(path)


def class_code_in(prefix: str) -> str:
    """The class code of a prefix; empty if the prefix is not a class's."""
    kind, _, name = prefix.partition("/")
    return name if kind == CLASS else ""


def without_prefix(path: str) -> str:
    """A path within its prefix."""
    rest = _PLACE.sub("", path, count=1)
    return rest if rest.startswith("/") else f"/{rest}"


def redirection(connection: ServerConnection, request: Request, spreads: bool) -> Response | None:
    """The redirection of a page that is asked for at a similar address, without its query.

    Args:
        spreads: whether visitors without a class get prefixes of their own.
    """
    if "Upgrade" in request.headers:
        return None
    path, mark, query = request.path.partition("?")
    if found := _PLACE.match(path):
        rest = path[found.end() :] or "/"
        rest = "/" if rest in _START else f"{rest}{mark}{query}"
        address = f"/{prefix_of(path)}{rest}"
        return None if address == request.path else _redirect(connection, address)
    if not spreads or path not in _START:
        return None
    cookies = "; ".join(request.headers.get_all("Cookie"))
    known = _KNOWN.search(cookies)
    name = known[1] if known else new_code()
    response = _redirect(connection, f"/{ALONE}/{name}/")
    if not known:
        cookie = f"{COOKIE}={name}; Path=/; HttpOnly; SameSite=Strict; Max-Age={_YEAR}"
        response.headers["Set-Cookie"] = cookie
    return response


def not_here(connection: ServerConnection) -> Response:
    """The answer to a websocket under a prefix that another process serves.

    It makes nginx pass the request on to the next process (`http_502`, a status that a process uses
    for nothing else); a page asks again every second. A full process answers pages with it, too.
    """
    text = "Another process serves this class: ask again.\n"
    response = connection.respond(HTTPStatus.BAD_GATEWAY, text)
    response.headers["Retry-After"] = "1"
    return response


def _redirect(connection: ServerConnection, address: str) -> Response:
    response = connection.respond(HTTPStatus.FOUND, "")
    response.headers["Location"] = address
    response.headers["Cache-Control"] = "no-store"
    return response
