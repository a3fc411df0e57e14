"""One page's visit: what it asked for, its two websockets, and what it is shown."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

import viser

from onpath.app.channel.messages import Hello, Refused, Store, StoredName, Wait, encoded
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.common.error_log import log_error
from onpath.app.common.presses import Presses
from onpath.app.scene.client_scene import Look
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.tab_visibility import TabVisibility
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.viser_adapter.data_channel import DataChannel, PageStream
from onpath.app.viser_adapter.secure_connection import SecureConnection
from onpath.lessons.words import Words


class Visit:
    """A page, from its first websocket to its last.

    Its own websocket comes first, and viser's at any time, or never; either may break and come
    back. Whoever gives the visit something says here how to take it back, and `close` does so.

    Args:
        number: that no other visit has.
        connection: the page's first one.
        left: called on the event loop when the page's own websocket has ended.

    Attributes:
        address, prefix, screen, language: of that connection; see `CountedConnection`.
        stream: what the page is told.
        look: how its scene is to be drawn.
        presses: limit what it asks for that takes long.
        client: viser's, while there is one.
        asked: how many times the page had asked for a picture when it asked for this client.
        feed: shows its lab; None before it has one.
        teacher: the pass and the choices of a teacher, or None.
    """

    def __init__(
        self,
        number: int,
        hello: Hello,
        connection: SecureConnection,
        channel: DataChannel,
        left: Callable[[], None],
    ) -> None:
        self.number, self.hello = number, hello
        self.address, self.prefix = connection.address, connection.prefix
        self.screen = connection.screen
        self.language = connection.language
        self.stream = PageStream(channel, left)
        self.stream.receive = _no_lab
        self.look, self.presses = Look(hello.dark, hello.plain, hello.upright), Presses()
        self.sight = TabVisibility()
        self.client: viser.ClientHandle | None = None
        self.asked = 0
        self.feed: LabFeed | None = None
        self.teacher: tuple[str, TeacherChoices] | None = None
        self._kept = dict[str, str]()  # since the page greeted
        self._told = dict[str, bytes]()  # what a page that comes back is told again
        self._lock = threading.Lock()
        self._has_ended = False
        self._at_end = list[Callable[[], None]]()

    @property
    def is_connected(self) -> bool:
        """Whether one of its websockets is open."""
        return self.stream.is_open or self.client is not None

    @property
    def has_ended(self) -> bool:
        """Whether it is closed, or about to be."""
        return self._has_ended

    def at_end(self, act: Callable[[], None]) -> None:
        """Call a function when the visit ends, or now if it has ended; the last one first."""
        with self._lock:
            if not self._has_ended:
                self._at_end.append(act)
                return
        act()

    def close(self) -> None:
        """Release everything that was given to the visit. Not on the event loop."""
        with self._lock:
            self._has_ended = True
            acts, self._at_end = self._at_end, []
        self.show_nothing()
        for act in reversed(acts):
            try:
                act()
            except Exception as error:  # the rest is released all the same
                log_error(error)

    def show(self, lab: ScheduledLab, feed: LabFeed) -> None:
        """Show a lab from now on, unless the visit has ended."""
        self._told.pop("wait", None)
        with self._lock:
            if not self._has_ended:
                self.feed = feed
                self.sight.watch(lab, feed)
                return
        feed.close()

    def show_nothing(self) -> None:
        """Show no lab."""
        with self._lock:
            feed, self.feed = self.feed, None
            self.sight.leave()
            self.stream.receive = _no_lab
        if feed is not None:
            feed.close()

    @property
    def kept(self) -> Mapping[str, str]:
        """What the browser keeps, by name."""
        hello = self.hello
        kept = {"speaks": hello.speaks, "sounds": hello.sounds, "first_minute": hello.first_minute}
        return kept | self._kept

    def keep(self, key: StoredName, value: str) -> None:
        """Have the browser keep a value, or forget it if it is empty. Thread-safe."""
        self._kept[key] = value
        self._tell(key, Store(key, value))

    def wait(self, key: str, places: int, before: int) -> None:
        """Tell the page that the lab is full, and how many have waited longer. Thread-safe."""
        words = Words(self.language)
        texts = words(key, places=places), words("full.before", count=before)
        self._tell("wait", Wait(" ".join(texts)))

    def renew(self) -> None:
        """Tell a page that has connected again what it may have missed. On the event loop."""
        for message in list(self._told.values()):
            self.stream.say(message)

    def _tell(self, key: str, message: Store | Wait) -> None:
        self._told[key] = text = encoded(message)
        self.stream.say(text)


def _no_lab(_: str) -> bytes:
    return encoded(Refused("there is no lab yet"))
