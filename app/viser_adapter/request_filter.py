"""Filters HTTP requests: which origins may open a websocket, and who may read which paths."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from http import HTTPStatus
from ipaddress import ip_address
from urllib.parse import unquote, urlsplit

from websockets.http11 import Request, Response

from onpath.app.viser_adapter.addresses import takes_websocket

LONGEST_PATH = 200  # [characters]; file systems have limits
ORIGIN = "Onpath-Origin"  # with which a page asks whether pages of its origin may connect
HEALTH = "/health"  # answered while the network thread is alive, for process supervisors

_POLICY = (  # viser's page is one file that unpacks and runs itself, with workers and WebAssembly
    "default-src 'self' blob: data:",
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:",
    "style-src 'self' 'unsafe-inline'",
    "object-src 'none'",
    "base-uri 'none'",
    "form-action 'none'",
    "frame-ancestors 'self'",  # JupyterLab may show the lab in a frame of its own page
)
_HEADERS = {
    "X-Frame-Options": "SAMEORIGIN",  # for browsers that do not know frame-ancestors
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
_FORBIDDEN = HTTPStatus.FORBIDDEN, "This page's origin may not connect to this server.\n"
_HOST = re.compile(r"[a-z0-9.-]+(:[0-9]+)?")


def _policy(hosts: Iterable[str]) -> str:
    """The Content-Security-Policy of a page that may connect to these hosts only."""
    named = sorted({host for host in map(str.lower, hosts) if _HOST.fullmatch(host)})
    sockets = [f"{scheme}://{host}" for host in named for scheme in ("ws", "wss")]
    return "; ".join((*_POLICY, " ".join(("connect-src 'self' blob: data:", *sockets))))


def without_repeats(request: Request, is_head: bool) -> None:
    """Join repeated headers, on which viser would fail, and keep HEAD from opening a websocket."""
    encodings = request.headers.get_all("Accept-Encoding")
    if len(encodings) > 1:
        del request.headers["Accept-Encoding"]
        request.headers["Accept-Encoding"] = ", ".join(encodings)
    if is_head and "Upgrade" in request.headers:
        del request.headers["Upgrade"]


def well(_query: str) -> str:
    """The default health report."""
    return "well\n"


class RequestFilter:
    """Decides on requests. Rejects websockets until `open` is set."""

    def __init__(
        self,
        allowed_origins: tuple[str, ...],
        *,
        local_only: bool,
        health: Callable[[str], str] = well,
        trouble: Callable[[], str] = str,
    ) -> None:
        """Args:
        allowed_origins: pages of other sites that may connect, "https://lab.example:8443".
        local_only: whether the server listens on this machine only. The page's origin must then
            be a local name; else any site could point its own name at 127.0.0.1 (DNS rebinding).
        health: the metrics at `HEALTH`, given the query string. Only this machine gets them;
            others only learn that the server is well.
        trouble: why the server is not well, which anyone may learn; empty if it is well.
        """
        self.open = False
        self._health, self._trouble = health, trouble
        self.allowed = frozenset(origin.lower().rstrip("/") for origin in allowed_origins)
        self._local_only = local_only

    def add_headers(self, request: Request, response: Response) -> None:
        """Add the security headers, unless the response opens a websocket.

        The page may connect to its own host, which is that of the request or, behind a proxy that
        does not pass it on, that of an allowed origin: websockets of other pages are refused.
        The hosts are listed because not every browser includes websockets in 'self'.
        """
        if response.status_code == HTTPStatus.SWITCHING_PROTOCOLS:
            return
        hosts = [*request.headers.get_all("Host"), *map(_host, self.allowed)]
        for name, value in {"Content-Security-Policy": _policy(hosts), **_HEADERS}.items():
            response.headers.pop(name, None)
            response.headers[name] = value

    def refusal(self, request: Request, peer: str = "") -> tuple[HTTPStatus, str] | None:
        """Status and text with which to answer at once, or None to let the request through.

        Args:
            peer: address at the other end of the connection; empty for a Unix socket.
        """
        asked, _, query = request.path.partition("?")
        if asked == HEALTH:
            if trouble := self._trouble():
                return HTTPStatus.SERVICE_UNAVAILABLE, f"{trouble}\n"
            report = self._health if _is_asked_here(request, peer) else well
            return HTTPStatus.OK, report(query)
        path = unquote(asked).replace("\\", "/")
        if len(path) > LONGEST_PATH:
            return HTTPStatus.NOT_FOUND, "Not found.\n"
        if ".." in path.split("/") or ":" in path or "\0" in path:  # C:/ is absolute on Windows
            return HTTPStatus.NOT_FOUND, "Not found.\n"
        upgrades = request.headers.get_all("Upgrade")
        if not upgrades:
            return self._answer_about(request)
        if len(upgrades) > 1:
            return HTTPStatus.BAD_REQUEST, "More than one Upgrade.\n"
        if not self.open:
            return HTTPStatus.SERVICE_UNAVAILABLE, "Starting.\n"
        if not takes_websocket(request.path):
            return HTTPStatus.NOT_FOUND, "No lab has this address.\n"
        return None if self._trusts(request, request.headers.get_all("Origin")) else _FORBIDDEN

    def _answer_about(self, request: Request) -> tuple[HTTPStatus, str] | None:
        """The answer to a page that asks why its websocket does not open: browsers do not tell."""
        origins = request.headers.get_all(ORIGIN)
        if not origins:
            return None
        return (HTTPStatus.OK, "welcome\n") if self._trusts(request, origins) else _FORBIDDEN

    def _trusts(self, request: Request, origins: list[str]) -> bool:
        if not origins:  # not a browser; other programs could send any origin anyway
            return True
        origin = origins[0].lower()
        if len(origins) > 1 or origin in self.allowed:
            return len(origins) == 1
        try:
            site = urlsplit(origin)
        except ValueError:
            return False
        itself = [site.netloc] == [host.lower() for host in request.headers.get_all("Host")]
        named_well = not self._local_only or is_loopback(site.hostname or "")
        return bool(site.netloc) and itself and named_well


def _host(origin: str) -> str:
    """Host and port of an origin; empty if it has none."""
    return origin.partition("://")[2]


def _is_asked_here(request: Request, peer: str) -> bool:
    """Whether the request comes from this machine, from no proxy and from no web page."""
    headers = request.headers
    if not is_loopback(peer) or any(name in headers for name in ("Origin", "X-Forwarded-For")):
        return False
    try:
        hosts = [urlsplit(f"//{host}").hostname or "" for host in headers.get_all("Host")]
    except ValueError:
        return False
    return len(hosts) == 1 and is_loopback(hosts[0])


def is_loopback(host: str) -> bool:
    """Whether a host name or address is this machine's loopback."""
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False
