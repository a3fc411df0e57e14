"""Filters HTTP requests: which origins may open a websocket, and which paths may be read."""

from __future__ import annotations

from collections.abc import Callable
from http import HTTPStatus
from ipaddress import ip_address
from urllib.parse import unquote, urlsplit

from websockets.http11 import Request

LONGEST_PATH = 200  # [characters]; file systems have limits
HEALTH = "/health"  # answered while the network thread is alive, for process supervisors


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
    ) -> None:
        """Args:
        allowed_origins: pages of other sites that may connect, "https://lab.example:8443".
        local_only: whether the server listens on this machine only. The page's origin must then
            be a local name; else any site could point its own name at 127.0.0.1 (DNS rebinding).
        health: the report for `HEALTH`, given the query string.
        """
        self.open = False
        self._health = health
        self._allowed = frozenset(origin.lower().rstrip("/") for origin in allowed_origins)
        self._local_only = local_only

    def refusal(self, request: Request) -> tuple[HTTPStatus, str] | None:
        """Status and text with which to answer at once, or None to let the request through."""
        asked, _, query = request.path.partition("?")
        if asked == HEALTH:
            return HTTPStatus.OK, self._health(query)
        path = unquote(asked).replace("\\", "/")
        if len(path) > LONGEST_PATH:
            return HTTPStatus.NOT_FOUND, "Not found.\n"
        if ".." in path.split("/") or ":" in path or "\0" in path:  # C:/ is absolute on Windows
            return HTTPStatus.NOT_FOUND, "Not found.\n"
        if not request.headers.get_all("Upgrade"):
            return None
        if not self.open:
            return HTTPStatus.SERVICE_UNAVAILABLE, "Starting.\n"
        if not self._trusts(request):
            return HTTPStatus.FORBIDDEN, "This page's origin may not connect to this server.\n"
        return None

    def _trusts(self, request: Request) -> bool:
        origins = request.headers.get_all("Origin")
        if not origins:  # not a browser; other programs could send any origin anyway
            return True
        origin = origins[0].lower()
        if len(origins) > 1 or origin in self._allowed:
            return len(origins) == 1
        try:
            site = urlsplit(origin)
        except ValueError:
            return False
        itself = [site.netloc] == [host.lower() for host in request.headers.get_all("Host")]
        named_well = not self._local_only or is_loopback(site.hostname or "")
        return bool(site.netloc) and itself and named_well


def is_loopback(host: str) -> bool:
    """Whether a host name or address is this machine's loopback."""
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False
