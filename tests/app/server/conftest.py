"""A site of two processes with classes behind nginx, one for each file, with either database."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from onpath.app.classroom.class_opening import KEY
from tests.support.site import needs_postgres, postgres, site
from tests.support.site_class import KEYS, Running


@pytest.fixture(scope="module", params=["sqlite", pytest.param("postgres", marks=needs_postgres)])
def running(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Running]:
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
