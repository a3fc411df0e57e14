"""Recordings: many at once, one that takes too long, one that is no longer wanted."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest
from typing_extensions import override
from viser.infra import WebsockServer

from onpath.app.exports import exporter as exports
from onpath.app.exports.exporter import Delivery, Exporter
from onpath.app.exports.files import film_file
from onpath.app.exports.recording import record_scene
from onpath.app.lab.lab import Lab
from onpath.app.viser_adapter import secure_server as hardening
from onpath.lessons.words import Words
from tests.support import waiting
from tests.support.export_jobs import die
from tests.support.lab import new_lab

pytestmark = pytest.mark.thorough

WAIT = 240.0  # [s]; only ends a test that would hang
CROWD = 12
FILM = "onpath.html"
SOCKETS = Path("/proc/self/fd")
wait_for = partial(waiting.wait_for, seconds=WAIT)


class Client(Delivery):
    """A browser: what it has been told of each file, and the files that it has got."""

    def __init__(self) -> None:
        self.notes, self.files = list[str](), list[bytes]()

    @override
    def making(self, name: str, words: Words) -> None:
        self.notes.append("")

    @override
    def ready(self, name: str, content: bytes, words: Words) -> None:
        self.notes[-1] = words("export.ready", name=name)
        self.files.append(content)

    @override
    def failed(self, name: str, words: Words) -> None:
        self.notes[-1] = words("export.failed", name=name)

    @property
    def answered(self) -> bool:
        """Whether all that was asked for has come, or has been given up."""
        return bool(self.notes) and all(self.notes)


@contextmanager
def tab() -> Iterator[tuple[Client, Exporter]]:
    client = Client()
    exporter = Exporter(client)
    yield client, exporter
    exporter.close()


@pytest.fixture(scope="module")
def lab() -> Lab:
    return new_lab(0.4)


def open_sockets() -> int:
    """Number of sockets that this process has open."""
    ours = [SOCKETS / name for name in os.listdir(SOCKETS)] if SOCKETS.exists() else []
    return sum(os.readlink(each).startswith("socket:") for each in ours if each.is_symlink())


def press_at_once(lab: Lab, exporters: list[Exporter]) -> None:
    """The button of each, all in the same moment."""
    ready = threading.Barrier(len(exporters))

    def press(exporter: Exporter) -> None:
        exporter.recording()
        ready.wait()
        exporter.serve(lab)

    threads = [threading.Thread(target=press, args=(each,)) for each in exporters]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_twelve_simultaneous_requests_make_twelve_films_and_leave_nothing_behind(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[WebsockServer] = []
    genuine = WebsockServer.start
    monkeypatch.setattr(WebsockServer, "start", lambda s: (started.append(s), genuine(s)))
    record_scene(lab.simulation.robot, lab.simulation.history.all())
    with tab() as (client, exporter):  # a first one, which loads what all share
        press_at_once(lab, [exporter])
        wait_for(lambda: client.answered)
    wait_for(lambda: not exports.process._calls.locked())
    threads, sockets = threading.active_count(), open_sockets()
    clients, exporters = [Client() for _ in range(CROWD)], list[Exporter]()
    for each in clients:
        exporters.append(Exporter(each))
    press_at_once(lab, exporters)
    wait_for(lambda: all(client.answered for client in clients))
    for exporter in exporters:
        exporter.close()
    assert [len(client.files) for client in clients] == [1] * CROWD
    assert len({film for client in clients for film in client.files}) == 1
    assert not started
    wait_for(lambda: threading.active_count() <= threads)
    assert open_sockets() <= sockets


def test_the_user_is_told_that_the_process_died_and_the_next_film_is_made(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = lab.words("export.failed", name=FILM)
    with tab() as (client, exporter):
        monkeypatch.setattr(exports, "film_file", die)
        press_at_once(lab, [exporter])
        wait_for(lambda: client.notes and client.notes[0] == failed)
        assert not client.files
        monkeypatch.undo()
        wait_for(lambda: not exporter._under_way)
        press_at_once(lab, [exporter])
        wait_for(lambda: client.files)


def test_a_film_that_takes_too_long_is_given_up_and_the_user_is_told(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    with tab() as (client, exporter):
        monkeypatch.setattr(exports, "PATIENCE", -1.0)
        press_at_once(lab, [exporter])
        wait_for(lambda: client.answered)
        assert lab.words("export.failed", name=FILM) == client.notes[0]
        monkeypatch.undo()
        wait_for(lambda: not exporter._under_way)
        press_at_once(lab, [exporter])  # the next one is made
        wait_for(lambda: client.files)


class Occupied:
    """The films of others, which take their time."""

    def __init__(self) -> None:
        self.over = threading.Event()
        begun = threading.Event()
        self._film = exports._queue.submit(lambda: (begun.set(), self.over.wait(WAIT)))
        begun.wait(WAIT)

    def end(self) -> None:
        """Wait until everybody in the queue has had a turn."""
        self.over.set()
        exports._queue.submit(lambda: None).result(WAIT)


def test_pressed_a_hundred_times_it_makes_one_film(lab: Lab) -> None:
    others = Occupied()
    with tab() as (client, exporter):
        for _ in range(100):
            exporter.recording()
            exporter.serve(lab)
        wait_for(lambda: client.notes)
        wait_for(lambda: exporter._latest)
        others.end()
        wait_for(lambda: client.answered)
        assert (len(client.notes), len(client.files)) == (1, 1)


def test_while_one_file_is_made_others_are_refused_and_the_user_is_told(lab: Lab) -> None:
    lab.clear_message()
    others, busy = Occupied(), lab.words("export.busy")
    with tab() as (client, exporter):
        exporter.recording()
        exporter.serve(lab)
        assert lab.message != busy
        for _ in range(100):
            for ask in (exporter.csv, exporter.picture, exporter.report, exporter.recording):
                ask()
        assert len(exporter._wanted) == 1  # a word, once
        exporter.serve(lab)
        assert lab.message == busy
        others.end()
        wait_for(lambda: not exporter._under_way)
        assert (len(client.notes), len(client.files)) == (1, 1)
        exporter.csv()  # the next one is made
        exporter.serve(lab)
        wait_for(lambda: len(client.files) == 2)
    lab.clear_message()


def test_nothing_is_made_for_a_user_who_has_left_the_queue(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []
    monkeypatch.setattr(exports.process, "call", lambda *_: made.append("film"))
    others = Occupied()
    with tab() as (client, exporter):
        press_at_once(lab, [exporter])
        wait_for(lambda: exporter._latest)
    others.end()
    assert not made and not client.files


class Asked:
    """A lock that tells when somebody asks for it."""

    def __init__(self) -> None:
        self._lock, self.asked = threading.Lock(), threading.Event()

    def __enter__(self) -> None:
        self.asked.set()
        self._lock.acquire()

    def __exit__(self, *_: object) -> None:
        self._lock.release()


def test_a_server_built_while_another_is_being_built_listens(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """viser looks up the function that listens, which is replaced meanwhile: once at a time."""
    lock, listening = Asked(), threading.Event()
    monkeypatch.setattr(hardening, "_patching", lock)

    def build() -> None:
        server = hardening.make_server(port=0)
        listening.set()
        server.stop()

    with hardening.listen("127.0.0.1", 0) as listener:
        door, limits = hardening.RequestFilter((), local_only=True), hardening.Limits()
        connections = hardening.ConnectionLimits(limits, hardening.Proxies())
        with hardening._guarded_serve(
            listener=listener,
            requests=door,
            limits=limits,
            counts=connections,
            set_prefix=lambda *_: None,
            elsewhere=bool,
            channel=hardening.DataChannel(),
            course_url="",
            scripts=b"",
            screen=lambda *_: "",
        ):
            lock.asked.clear()
            threading.Thread(target=build, daemon=True).start()
            assert lock.asked.wait(WAIT)
        assert listening.wait(WAIT / 6)


def test_a_recording_says_what_was_set_and_has_the_plots(lab: Lab) -> None:
    simulation = lab.simulation
    page = film_file("five_bar", simulation.parameters, simulation.history.copy(), "en").decode()
    told = page.rpartition("<details")[2]
    assert "Settings and plots" in told and "data:image/png;base64,iVBOR" in told
