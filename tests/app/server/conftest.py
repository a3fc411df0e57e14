"""What files of tests share: a server with a class, and a site of two processes behind nginx."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from onpath.app.classroom.class_opening import KEY
from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from tests.support.site import needs_postgres, postgres, site
from tests.support.site_class import KEYS, Running


@pytest.fixture(scope="module")
def room() -> Classroom:
    return Classroom()


@pytest.fixture(scope="module")
def server(room: Classroom) -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    yield server
    server.stop()


@pytest.fixture(scope="module", params=["sqlite", pytest.param("postgres", marks=needs_postgres)])
def running(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Running]:
    """A site with classes, with either database."""
    folder = tmp_path_factory.mktemp("site")
    with ExitStack() as stack:
        database = f"sqlite:///{folder / 'labs.db'}"
        if request.param == "postgres":
            database = stack.enter_context(postgres())
        given: Any = {KEY: " ".join(KEYS)}
        made = Running(
            stack.enter_context(site(folder, database, ["--classroom"], **given)), database
        )
        yield made
        made.records.close()
