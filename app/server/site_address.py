"""The address at which other devices open the lab, for the projector and the terminal."""

from __future__ import annotations

import re
import socket
from urllib.parse import urlsplit

from onpath.app.viser_adapter.request_filter import is_loopback

ANY = ("0.0.0.0", "::")
_SOMEWHERE = {socket.AF_INET: "192.0.2.1", socket.AF_INET6: "2001:db8::1"}  # RFC 5737, RFC 3849
_HOST = r"(?:[a-z0-9.-]{1,100}|\[[0-9a-f:]{2,39}\])(?::[0-9]{1,5})?"
_SITE = re.compile(rf"https?://{_HOST}(?:/[\w.~%-]{{1,50}}){{0,6}}", re.ASCII)


def reachable_site(host: str, port: int) -> str:
    """The address of a server, without a final slash.

    Args:
        host: where it listens. If that is everywhere, it is reached at the address of this machine
            in its network; without a network, only from here.
    """
    if host in ANY:
        host = _address_here(socket.AF_INET) or _address_here(socket.AF_INET6) or "localhost"
    elif is_loopback(host):
        host = "localhost" if host == "127.0.0.1" else host
    return f"http://{f'[{host}]' if ':' in host else host}:{port}"


def is_local(site: str) -> bool:
    """Whether no other device can open an address."""
    try:
        return is_loopback(urlsplit(site).hostname or "")
    except ValueError:  # not an IPv6 address
        return True


def site_for_students(seen: str, served: str) -> str:
    """The address of the site that a teacher shows.

    Args:
        seen: where the teacher's browser has opened the site. Students find it there, too, behind
            whatever proxy and in whatever folder, unless the name means the teacher's machine.
        served: where the server believes to be.
    """
    return seen if _SITE.fullmatch(seen) and not is_local(seen) else served


def _address_here(family: socket.AddressFamily) -> str:
    """This machine's address in its network; empty if there is none. Nothing is sent."""
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((_SOMEWHERE[family], 9))
            return str(probe.getsockname()[0])
    except OSError:
        return ""
