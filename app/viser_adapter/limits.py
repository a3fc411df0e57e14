"""What one browser may send, and how many may be connected."""

from __future__ import annotations

from dataclasses import dataclass, replace

OWN_FILES = 48  # open files besides the connections: database, pipes, modules
FEWEST = 16  # least number of connections with which a server starts


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
            most 20 for a drag and 50 for the camera.
        message_burst: messages at once; every 4 kB of a long message counts as one more.
        changes_per_second: sustained rate of drags, and of the messages of a data channel; more
            closes the connection.
        change_burst: of those at once.
        max_magnitude: of any number in a drag, click or camera message.
        max_connections: in total, including those that request a file.
        max_connections_each: per address; sixty students behind one address have five each,
            two of which are the websockets of a page.
        max_screens: walls and remote controls of classes, in total. They do not count as
            connections, and no other page can take their places.
        max_screens_each: of those, per address.
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
    max_magnitude: float = 1e9
    max_connections: int = 700  # with the waiting ones below 1024, a common limit on open files
    max_connections_each: int = 300
    max_screens: int = 40
    max_screens_each: int = 20
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
