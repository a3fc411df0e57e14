"""Listening sockets: a port or a file."""

from __future__ import annotations

import errno
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

MANY = 4096  # open files, more than a server can use


class PortInUse(OSError):
    """The port is taken; the message names it and suggests what to do."""


def listen(host: str, port: int) -> socket.socket:
    """Listen on exactly this address; port 0 takes a free one.

    Raises:
        PortInUse: another program listens there.
        OSError: the address cannot be bound; the message names it.
        ValueError: the port is out of range.
    """
    with _address_named(host, port):
        return socket.create_server((host, port), family=_family(host))


def listen_unix(file: Path) -> socket.socket:
    """Listen on a file that only this user can open.

    Raises:
        OSError: the file, which the message names, cannot be created, or the system has no Unix
            sockets.
    """
    if not hasattr(socket, "AF_UNIX"):  # Windows
        raise OSError(f"cannot listen on {file}: this system has no Unix sockets")
    listener = socket.socket(socket.AF_UNIX)
    before = os.umask(0o177)
    try:
        listener.bind(str(file))
    except OSError as error:
        listener.close()
        raise OSError(f"cannot listen on {file}: {error.strerror or error}") from None
    finally:
        os.umask(before)
    listener.listen()
    return listener


def open_files() -> int:
    """Raise the limit on this process's open files as far as allowed, and return it."""
    try:
        import resource
    except ImportError:  # Windows has no such limit on sockets
        return MANY
    now, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MANY if most == resource.RLIM_INFINITY else min(most, MANY)
    if now == resource.RLIM_INFINITY or now >= MANY:
        return MANY
    resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, most))
    return wanted


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET


@contextmanager
def _address_named(host: str, port: int) -> Iterator[None]:
    try:
        yield
    except OverflowError:
        raise ValueError(f"port {port}: expected 0 to 65535") from None
    except OSError as error:
        if error.errno != errno.EADDRINUSE:
            raise OSError(f"cannot listen on {host}: {error.strerror}") from None
        remedy = "stop the program that has it, or choose another port (--port 0 takes any)"
        raise PortInUse(error.errno, f"port {port} on {host} is in use: {remedy}") from None
