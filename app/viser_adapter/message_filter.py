"""Decides which decoded messages of a browser reach viser's handlers; see secure_server.py."""

from __future__ import annotations

import dataclasses
import weakref
from dataclasses import dataclass, replace
from typing import Any

import viser
from viser import _messages as wire
from viser.infra import ClientId, WebsockMessageHandler
from websockets.asyncio.server import ServerConnection

from onpath.app.common.error_log import log_error, log_warning
from onpath.app.viser_adapter.file_uploads import FileUploads
from onpath.app.viser_adapter.widget_validation import Refused, accepted_value

OWN_FILES = 48  # open files besides the connections: database, pipes, modules
FEWEST = 16  # connections with which a server is worth starting


@dataclass(frozen=True, slots=True)
class Limits:
    """What one browser may send.

    Attributes:
        max_message_bytes: of one websocket message, [B]; a larger one closes the connection.
        max_unfinished_bytes: of all incomplete messages together, [B]; beyond it, the connection
            that holds most is closed.
        message_seconds: time from a message's first byte to its last, [s]; more closes the
            connection.
        max_request_bytes: of an HTTP request, [B]; a larger one closes the connection.
        messages_per_second: sustained rate; more closes the connection. viser's page sends at
            most 20 for a drag, 20 for a widget and 50 for the camera.
        message_burst: messages at once; every 4 kB of a long message counts as one more.
        changes_per_second: sustained rate of changed widgets, of drags, and of the commands of a
            data channel; more closes the connection.
        change_burst: of those at once.
        max_text_length: of a text widget, [characters]; longer texts are cut.
        max_magnitude: of any number in a drag, click or camera message.
        max_upload_bytes: of a file, one file at a time, [B]; 0 refuses all.
        max_connections: in total, including those that request a file.
        max_connections_each: per address; sixty students behind one address have five each,
            two of which are the websockets of a page.
        max_waiting: of further connections that have not sent a complete request yet.
        max_waiting_each: of those, per address.
        tabs_per_second_each: sustained rate of new websockets, per address.
        tab_burst_each: new websockets at once, per address; a class of sixty that reloads all its
            pages opens 120.
        silence: time after which a browser is pinged; it has three times as long to answer, [s].
        farewell: time that a browser has to acknowledge the close of its connection, [s].
    """

    max_message_bytes: int = 1_000_000
    max_unfinished_bytes: int = 8_000_000
    message_seconds: float = 10.0
    max_request_bytes: int = 65_536
    messages_per_second: float = 120.0
    message_burst: float = 1000.0
    changes_per_second: float = 25.0
    change_burst: float = 300.0
    max_text_length: int = 2000
    max_magnitude: float = 1e9
    max_upload_bytes: int = 0
    max_connections: int = 700  # with the waiting ones below 1024, a common limit on open files
    max_connections_each: int = 300
    max_waiting: int = 250
    max_waiting_each: int = 200
    tabs_per_second_each: float = 5.0
    tab_burst_each: float = 300.0
    silence: float = 20.0
    farewell: float = 2.0

    def within(self, files: int) -> Limits:
        """These limits, with fewer connections if there would be too many open files.

        Args:
            files: number of files that a process may have open.

        Raises:
            ValueError: the number is too small for a server.
        """
        if files < OWN_FILES + FEWEST:
            least = OWN_FILES + FEWEST
            raise ValueError(f"ulimit -n {files}: expected {least} open files or more")
        share = min((files - OWN_FILES) / (self.max_connections + self.max_waiting), 1.0)
        return replace(
            self,
            max_connections=int(share * self.max_connections),
            max_connections_each=int(share * self.max_connections_each),
            max_waiting=int(share * self.max_waiting),
            max_waiting_each=int(share * self.max_waiting_each),
        )


class MessageFilter:
    """Filters messages before viser's handlers of one scope: the server's, or one client's."""

    def __init__(
        self,
        server: viser.ViserServer,
        scope: WebsockMessageHandler,
        gui: viser.GuiApi,
        limits: Limits,
        uploads: FileUploads,
    ) -> None:
        self._uploads = uploads
        self._connections = server._websock_server._live_connections
        self._gui = gui
        self._limits = limits
        self._deliver = scope._handle_incoming_message
        scope._handle_incoming_message = self._receive

    def receive(self, client_id: ClientId, message: Any) -> None:
        """Handle at once a message whose handlers do not wait."""
        handling = self._receive(client_id, message)
        try:
            handling.send(None)
            handling.throw(RuntimeError(f"a handler of {type(message).__name__} waits"))
        except StopIteration:
            return
        except Exception as error:
            log_error(error)

    async def _receive(self, client_id: ClientId, message: Any) -> None:
        # Every message reaches both scopes; the one that does not know its widget ignores it.
        widget = self._gui._gui_input_handle_from_uuid.get(getattr(message, "uuid", ""))
        match message:
            case wire.GuiUpdateMessage():
                if widget is not None:
                    await self._update(client_id, widget, message)
                return
            case wire.FileTransferStartUpload():
                passes = self._uploads.begins(self._gui, message)
            case wire.FileTransferPart():
                passes = self._uploads.takes(self._gui, message)
            case _:
                passes = True
        if passes:
            await self._deliver(client_id, message)

    async def _update(self, client_id: ClientId, widget: Any, message: Any) -> None:
        asked = message.updates.get("value")
        accepted = None
        try:
            if message.updates.keys() != {"value"}:
                raise Refused("expected no other property")
            accepted = accepted_value(widget, asked, self._limits.max_text_length)
            update = dataclasses.replace(message, updates={"value": accepted})
            await self._deliver(client_id, update)
        except Refused as refused:
            description = f"an update of a {type(widget).__name__} ({refused})"
            warn_once(self._connections.get(client_id), description)
        finally:
            if accepted != asked and not widget._impl.removed:
                truth = wire.GuiUpdateMessage(message.uuid, {"value": widget.value})
                self._gui._websock_interface.queue_message(truth)


_warned: weakref.WeakSet[Any] = weakref.WeakSet()


def warn_once(connection: ServerConnection | None, description: str) -> None:
    """Log that a message of a browser was dropped, once per connection."""
    if connection is not None and connection not in _warned:
        _warned.add(connection)
        client = connection.remote_address
        log_warning("client %s: dropped %s; further messages are not logged", client, description)
