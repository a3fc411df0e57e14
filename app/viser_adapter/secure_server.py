"""Protects a viser server from untrusted browsers.

Data from a browser passes the handshake (request_filter.py) and the websocket
(secure_connection.py: size, rate and kind; message_schema.py: fields and types). Exceptions in
callbacks are logged (error_log.py).
"""

from __future__ import annotations

import asyncio
import logging
import socket
import threading
import time
from collections.abc import Awaitable, Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from http import HTTPStatus
from pathlib import Path
from typing import Any

import viser
import websockets.asyncio.server
from viser import _messages as wire
from viser import _scene_api, _viser
from viser.infra import ClientId, WebsockClientConnection, WebsockMessageHandler
from websockets.frames import CloseCode
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from onpath.app.common.error_log import log_error
from onpath.app.viser_adapter.addresses import (
    not_here,
    prefix_of,
    redirection,
    screen_of,
    without_prefix,
)
from onpath.app.viser_adapter.connection_limits import ConnectionLimits, Proxies
from onpath.app.viser_adapter.connections import connection_of
from onpath.app.viser_adapter.data_channel import FAMILY, SUBPROTOCOL, DataChannel
from onpath.app.viser_adapter.limits import Limits
from onpath.app.viser_adapter.message_event import let_threads_send
from onpath.app.viser_adapter.page_scripts import add_scripts
from onpath.app.viser_adapter.request_filter import (
    RequestFilter,
    is_loopback,
    well,
    without_repeats,
)
from onpath.app.viser_adapter.secure_connection import (
    SecureConnection,
    UnfinishedMessages,
    take_decoded_messages,
)
from onpath.app.viser_adapter.sockets import PortInUse, listen, listen_unix, open_files
from onpath.app.viser_adapter.viser_caches import keep_what_is_constant

__all__ = ["Limits", "PortInUse", "harden", "make_server"]

_SUBPROTOCOL = f"viser-v{viser.__version__}"
_SHARE_TUNNEL = (wire.ShareUrlRequest, wire.ShareUrlDisconnect)

BACKLOG = 100  # connections, asyncio's default
ANSWERS = (
    3  # as long as the silence before: a page whose first messages are late has time to answer
)
STARTING = 8.0  # [s] that a request waits until the server is ready; websockets gives up after 10


def make_server(
    host: str = "127.0.0.1",
    port: int = 8080,
    *,
    label: str | None = None,
    limits: Limits = Limits(),
    allowed_origins: tuple[str, ...] = (),
    trusted_proxies: tuple[str, ...] = (),
    unix_socket: Path | None = None,
    health: Callable[[str], str] = well,
    trouble: Callable[[], str] = str,
    elsewhere: Callable[[str], bool] = lambda _: False,
    screen: Callable[[str, str], str] = lambda *_: "",
    channel: DataChannel | None = None,
    prepare: Callable[[viser.ViserServer], None] = lambda _: None,
    course_url: str = "",
    scripts: bytes = b"",
    verbose: bool = False,
) -> viser.ViserServer:
    """A protected server that listens on exactly this address; port 0 takes a free one.

    Args:
        allowed_origins: pages of other sites that may connect, "https://lab.example:8443". The
            server's own page always may, and so may clients that are not browsers. With such an
            address, visitors get prefixes of their own; see addresses.py.
        trusted_proxies: see `app.viser_adapter.connection_limits.Proxies`.
        unix_socket: listen on this file only, for a proxy of the same user that serves the page in
            a folder of its own.
        health, trouble: see `RequestFilter`.
        elsewhere: whether another process serves a prefix; a websocket there is answered 502.
        screen: the page of one of `addresses.SCREENS`, given its name and a language.
        channel: the data channels of the pages, if they have any.
        prepare: called with the server; all requests wait until it has returned.
        course_url: see `page_scripts.words`.
        scripts: elements for the head of the page; see `add_scripts`.

    Raises:
        ValueError: a proxy is malformed, or the process may not open enough files.
        PortInUse: the port is taken; viser alone would silently use the next one.
        OSError: the address cannot be bound.
    """
    limits = limits.within(open_files())
    connections = ConnectionLimits(limits, Proxies(trusted_proxies))
    keep_what_is_constant()
    take_decoded_messages()
    logging.getLogger("websockets.server").addFilter(_is_news)
    listener = listen_unix(unix_socket) if unix_socket else listen(host, port)
    port = 0 if unix_socket else listener.getsockname()[1]
    local_only = is_loopback(host) and not unix_socket
    door = RequestFilter(allowed_origins, local_only=local_only, health=health, trouble=trouble)
    redirects, spreads = unix_socket is None, bool(door.allowed)
    set_prefix = partial(_set_prefix, redirects=redirects, spreads=spreads, elsewhere=elsewhere)
    with _guarded_serve(
        listener=listener,
        requests=door,
        limits=limits,
        counts=connections,
        set_prefix=set_prefix,
        elsewhere=elsewhere,
        screen=screen,
        channel=DataChannel() if channel is None else channel,
        course_url=course_url,
        scripts=scripts,
    ):
        shown = f"[{host}]" if ":" in host else host  # in the addresses that viser prints
        server = viser.ViserServer(host=shown, port=port, label=label, verbose=verbose)
    listener.listen(BACKLOG)  # so many may wait in the system, even if fewer are accepted at once
    harden(server)
    prepare(server)
    door.open = True
    return server


def harden(server: viser.ViserServer) -> None:
    """Handle the gestures of all future clients at once. Call it once, before the first one.

    `make_server` does this and adds the checks before decoding, which must be installed while viser
    constructs its server.
    """
    websock = server._websock_server
    for message in _SHARE_TUNNEL:
        websock.unregister_handler(message)
    _log_errors_of_callbacks(server)

    def guard(connection: WebsockClientConnection) -> None:
        let_threads_send(connection)
        client = ClientId(connection.client_id)

        def handle(message: Any) -> None:
            for scope in (websock, connection):
                _handle_at_once(scope, client, message)

        if (secured := connection_of(server, client)) is not None:
            secured.handle = handle

    let_threads_send(websock)
    websock.on_client_connect(guard)


def _handle_at_once(scope: WebsockMessageHandler, client: ClientId, message: Any) -> None:
    """Handle a message whose handlers do not wait."""
    handling = scope._handle_incoming_message(client, message)
    try:
        handling.send(None)
        handling.throw(RuntimeError(f"a handler of {type(message).__name__} waits"))
    except StopIteration:
        return
    except Exception as error:
        log_error(error)


Answer = Callable[[SecureConnection, Request], Awaitable[Response | None]]


def _set_prefix(
    connection: SecureConnection,
    request: Request,
    redirects: bool,
    spreads: bool,
    elsewhere: Callable[[str], bool],
) -> Response | None:
    """Set the prefix of a connection, unless it belongs to another address or process.

    Every process has the page. A proxy may send the page and its websocket to different ones, if it
    decides by the whole path.

    Args:
        redirects: whether a page at a similar address is redirected.
        spreads: see `redirection`.
        elsewhere: see `make_server`.
    """
    is_tab = "Upgrade" in request.headers
    if redirects and (response := redirection(connection, request, spreads)):
        return response
    connection.screen, connection.prefix = screen_of(request.path), prefix_of(request.path)
    request.path = without_prefix(request.path)
    return not_here(connection) if is_tab and elsewhere(connection.prefix) else None


def _logged(answer: Answer) -> Answer:
    """Log exceptions, which websockets answers with 500 and viser keeps out of the log."""

    async def logged(connection: SecureConnection, request: Request) -> Response | None:
        try:
            return await answer(connection, request)
        except Exception as error:
            log_error(error)
            raise

    return logged


def _finish(
    requests: RequestFilter, connection: SecureConnection, request: Request, response: Response
) -> None:
    """Add the security headers to a response, and remove the body if the request was HEAD."""
    requests.add_headers(request, response)
    if connection.is_head:
        response.body = b""


def _options(limits: Limits) -> dict[str, Any]:
    """Limits that websockets enforces."""
    return {
        "backlog": min(BACKLOG, limits.max_waiting),  # accepted before any of them is counted
        "max_size": limits.max_message_bytes,
        "ping_interval": limits.silence,
        "ping_timeout": ANSWERS * limits.silence,
        "close_timeout": limits.farewell,
    }


def _screen_page(connection: SecureConnection, screen: Callable[[str, str], str]) -> Response:
    """A class's wall or remote control, whether or not there is such a class."""
    response = connection.respond(HTTPStatus.OK, screen(connection.screen, connection.language))
    del response.headers["Content-Type"]
    response.headers["Content-Type"] = "text/html; charset=utf-8"
    response.headers["Cache-Control"] = "no-store"
    return response


_patching = threading.Lock()


@contextmanager
def _guarded_serve(
    listener: socket.socket,
    requests: RequestFilter,
    limits: Limits,
    counts: ConnectionLimits,
    set_prefix: Callable[[SecureConnection, Request], Response | None],
    elsewhere: Callable[[str], bool],
    screen: Callable[[str, str], str],
    channel: DataChannel,
    course_url: str,
    scripts: bytes,
) -> Iterator[None]:
    """Install our checks in the one call of `websockets.serve` that viser makes.

    A full process sends clients of a class that another process has open on to that process.
    """
    library: Any = websockets.asyncio.server

    def serve(handler: Any, _host: str, _port: int, *, process_request: Any, **options: Any) -> Any:
        @_logged
        async def answer_request(connection: SecureConnection, request: Request) -> Response | None:
            await _opened(requests)
            without_repeats(request, connection.is_head)
            if answer := requests.refusal(request, connection.peer):  # or the health report
                return connection.respond(*answer)
            if answer := counts.refusal(connection, request):
                if elsewhere(prefix_of(request.path)):
                    return not_here(connection)
                return connection.respond(*answer)
            if response := set_prefix(connection, request):
                return response
            if connection.screen and "Upgrade" not in request.headers:
                return _screen_page(connection, screen)
            return add_scripts(process_request(connection, request), course_url, scripts)

        options |= _options(limits)
        finish = partial(_finish, requests)
        options["process_request"], options["process_response"] = answer_request, finish
        options["select_subprotocol"] = _chosen
        options["create_connection"] = partial(
            SecureConnection,
            limits=limits,
            connections=counts,
            unfinished=UnfinishedMessages(limits.max_unfinished_bytes),
        )
        return genuine(_dispatch(handler, channel), sock=listener, **options)

    with _patching:
        genuine = library.serve  # read under the lock: else it may be another thread's patch
        library.serve = serve
        try:
            yield
        finally:
            library.serve = genuine


def _chosen(_: object, offered: Sequence[Subprotocol]) -> Subprotocol | None:
    """The subprotocol that a page is answered with: viser's or ours, in any version."""
    return next((each for each in offered if each.startswith(("viser-v", FAMILY))), None)


def _dispatch(handler: Any, channel: DataChannel) -> Callable[[SecureConnection], Awaitable[None]]:
    """The handler of all websockets; those of other versions are closed with a reason."""

    async def handle(connection: SecureConnection) -> None:
        if connection.subprotocol == _SUBPROTOCOL:
            await handler(connection)
            connection.forget_handler()
        elif connection.subprotocol == SUBPROTOCOL:
            await channel.handle(connection)
        else:  # viser would print what the browser sent
            reason = "this page is of another version of the server: reload it"
            await connection.close(CloseCode.PROTOCOL_ERROR, reason)

    return handle


async def _opened(requests: RequestFilter) -> None:
    """Wait until the server is ready, for a limited time."""
    until = time.monotonic() + STARTING
    while not requests.open and time.monotonic() < until:
        await asyncio.sleep(0.02)


def _is_news(record: logging.LogRecord) -> bool:
    """Whether to log a record; not for each connection without a request, or with a bad one.

    viser installs the same filter, but only with the first request for a page. Our own errors are
    logged where they happen.
    """
    return record.getMessage() != "opening handshake failed"


def _log_outcome(done: Any) -> None:
    if not done.cancelled() and done.exception() is not None:
        log_error(done.exception())


def _log_errors_of_callbacks(server: viser.ViserServer) -> None:
    """Log exceptions in callbacks, which viser prints. This patches viser for the whole process."""
    for module in (_scene_api, _viser):
        for name, log in _PRINTERS.items():
            if hasattr(module, name):
                setattr(module, name, log)

    def log_unhandled(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        error = context.get("exception")
        if error is None:
            loop.default_exception_handler(context)
        else:
            log_error(error)

    server._event_loop.set_exception_handler(log_unhandled)


_PRINTERS = {
    "print_threadpool_errors": _log_outcome,
    "print_task_error": _log_outcome,
    "print_awaited_callback_error": log_error,
}
