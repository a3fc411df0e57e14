"""Composition root: server, simulation thread, and a lab for every browser tab."""

from __future__ import annotations

import logging
import threading
import webbrowser
from pathlib import Path

import viser

from app.error_log import log_error
from app.hardening import make_server
from app.lab_view import LabView
from app.loop import SimulationThread
from app.loop_store import LoopStore
from app.session import Session
from app.sessions import Sessions
from app.stage import set_initial_camera
from app.stages import RIGID
from lessons.course import BUILT_IN, Course, read_course
from lessons.parse import LessonError
from models.catalogue import FIVE_BAR

log = logging.getLogger(__name__)
STORAGE_KEY = "onpath_sessions"
STORAGE_WAIT = 3.0  # [s]


class LabServer:
    """A running lab server.

    Args:
        host, port: where to listen; port 0 takes a free one.
        store: where the loops come from.
        course: the lessons; the built-in ones if there is none.

    Raises:
        OSError: the address cannot be had; the message says why and the way out.
    """

    def __init__(
        self, host: str, port: int, store: LoopStore, course: Course | None = None
    ) -> None:
        self._store = store
        lessons = course or read_course([BUILT_IN])[0]
        self.server = make_server(host, port, label="OnPath")
        self.simulation = SimulationThread()
        self.sessions = Sessions(self.simulation, lambda: Session(store, FIVE_BAR, lessons))
        self._views: dict[int, LabView] = {}
        set_initial_camera(self.server, RIGID)
        self.server.on_client_connect(self._connected)
        self.server.on_client_disconnect(self._disconnected)
        self.simulation.start()

    @property
    def address(self) -> str:
        """What to type into a browser."""
        host = self.server.get_host()
        shown = "localhost" if host in ("127.0.0.1", "0.0.0.0", "::") else host
        return f"http://{shown}:{self.server.get_port()}"

    def stop(self) -> None:
        """Stop everything."""
        self.simulation.stop()
        self._store.close()
        self.server.stop()

    def _connected(self, client: viser.ClientHandle) -> None:
        try:
            known = client.local_storage.get_item(STORAGE_KEY, timeout=STORAGE_WAIT)
        except (RuntimeError, TimeoutError):
            known = None  # a browser that keeps nothing, or one that is gone again
        if client.client_id not in self.server.get_clients():
            return
        entry = self.sessions.join(client.client_id, known)
        try:
            client.local_storage.set_item(STORAGE_KEY, self.sessions.remembered(entry.code, known))
            view = LabView(client, entry.lab.session, self._store)
        except Exception as error:
            log_error(error)
            self.sessions.leave(client.client_id)
            return
        self._views[client.client_id] = view
        entry.lab.view = view
        if client.client_id not in self.server.get_clients():
            self._disconnected(client)

    def _disconnected(self, client: viser.ClientHandle) -> None:
        self.sessions.leave(client.client_id)
        view = self._views.pop(client.client_id, None)
        if view is not None:
            view.close()


def serve(host: str, port: int, lessons: Path | None = None, open_browser: bool = False) -> None:
    """Serve the lab until Ctrl-C.

    Args:
        lessons: a folder of lessons of one's own.

    Raises:
        LessonError: one of those is not all right.
    """
    course, problems = read_course([BUILT_IN, *([lessons] if lessons else [])])
    if problems:
        raise LessonError(problems)
    lab = LabServer(host, port, LoopStore.with_system_compiler(), course)
    log.info("OnPath is ready at %s  (Ctrl-C stops it)", lab.address)
    if open_browser:
        webbrowser.open(lab.address)
    try:
        threading.Event().wait()
    except KeyboardInterrupt:
        log.info("stopping")
    finally:
        lab.stop()
