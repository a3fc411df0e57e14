"""A proxy behind which the first messages of every websocket come late."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress

END = b"\r\n\r\n"
SCRIPT = b"<script data-p="
"""With which viser's own script begins."""


class LateProxy:
    """Passes everything on to a port of this machine.

    Args:
        delay: returns how late [s] the answer to the next websocket's handshake, its first message
            from the browser and the first one to it are; called once for each of them.
        script: set when viser's script may come with the page.
    """

    def __init__(
        self, to: int, delay: Callable[[], float], script: threading.Event | None = None
    ) -> None:
        self._to, self._delay, self._script = to, delay, script
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """Accept nobody any more."""
        self._listener.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                browser, _ = self._listener.accept()
                threading.Thread(target=self._serve, args=(browser,), daemon=True).start()

    def _serve(self, browser: socket.socket) -> None:
        with suppress(OSError), browser, socket.create_connection(("127.0.0.1", self._to)) as lab:
            request = _until_end(browser)
            if self._script:
                request = request.replace(b"Accept-Encoding: ", b"Encodings: ")
            lab.sendall(request)
            first_from = first_to = 0.0
            if b"upgrade: websocket" in request.lower():
                first_from, first_to = self._delay(), self._delay()
                head, _, rest = _until_end(lab).partition(END)
                time.sleep(self._delay())
                browser.sendall(head + END)
                back = threading.Thread(target=_pass, args=(lab, browser, first_to, rest))
            else:
                head = self._first_part(lab, browser) if self._script else b""
                back = threading.Thread(target=_pass, args=(lab, browser, first_to, head))
            back.start()
            _pass(browser, lab, first_from)
            back.join()

    def _first_part(self, lab: socket.socket, browser: socket.socket) -> bytes:
        """Pass on what comes before viser's script, and wait; return what has come of the rest."""
        got = b""
        while SCRIPT not in got and (data := lab.recv(65536)):
            got += data
        first, _, rest = got.partition(SCRIPT)
        browser.sendall(first)
        assert self._script
        self._script.wait()
        return SCRIPT + rest if SCRIPT in got else b""


def _until_end(source: socket.socket) -> bytes:
    """What comes until a head has ended, and perhaps more."""
    got = b""
    while END not in got and (data := source.recv(65536)):
        got += data
    return got


def _pass(source: socket.socket, to: socket.socket, late: float, first: bytes = b"") -> None:
    with suppress(OSError):
        if late:
            first = first or source.recv(65536)
            time.sleep(late)
        to.sendall(first)
        while data := source.recv(65536):
            to.sendall(data)
    for each in (source, to):
        with suppress(OSError):
            each.shutdown(socket.SHUT_RDWR)
