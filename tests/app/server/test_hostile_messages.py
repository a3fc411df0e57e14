"""Every kind of message, every field of it, with hostile values: no handler raises anything.

A page of ours sends no messages of viser's widgets; whoever does so is not heard.
"""

from __future__ import annotations

import dataclasses
import json
import logging
import random
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onpath.app.common import error_log
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.secure_connection import FROM_BROWSER
from onpath.app.viser_adapter.secure_server import Limits
from tests.bench.hostile_messages import (
    ASKED,
    DRAG,
    HONEST,
    HOSTILE,
    INDEXES,
    wild_request,
)
from tests.support.lab import assert_sound
from tests.support.student import Student
from tests.support.waiting import wait_for

WAIT = 60.0  # [s]; only ends a test that would hang
WIDE = Limits(message_burst=1_000_000, change_burst=1_000_000)
QUICK = ASKED.keys() - {"make", "compare_laws"}  # the others are done in another process


@dataclasses.dataclass(frozen=True)
class Tab:
    """A tab of a real lab, with everything that may be hit by a message."""

    student: Student
    server: LabServer
    lab: Lab

    @property
    def client(self) -> Any:
        (client,) = self.server.server.get_clients().values()
        return client

    @property
    def gain(self) -> float:
        return self.lab.simulation.parameters.K2

    def settle(self) -> None:
        """Return when everything that was sent has been handled."""
        gain = 45.0 if self.gain == 44.0 else 44.0

        def arrived() -> bool:
            if self.gain != gain:  # a lab whose inbox is full drops a command
                self.student.set("K2", gain)
            return self.gain == gain

        self.student.read(arrived)  # reads as a browser does; who does not is closed

    def nodes(self) -> list[str]:
        return list(self.client.scene._handle_from_node_name)


@pytest.fixture
def tab() -> Iterator[Tab]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(limits=WIDE))
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.moving > 3 and student.values)
        (entry,) = server.registry._entries.values()
        yield Tab(student, server, entry.scheduled.lab)
    server.stop()


@pytest.fixture(autouse=True)
def nothing_raises(caplog: pytest.LogCaptureFixture, tab: Tab) -> Iterator[None]:
    """Errors are counted, because each is logged in full only once in a process."""
    caplog.set_level(logging.WARNING)
    before = error_log._seen.copy()
    yield
    tab.settle()
    assert error_log._seen - before == {}
    told = caplog.get_records("call")
    assert [each.getMessage() for each in told if each.levelno > logging.WARNING] == []
    assert_sound(tab.lab)


def test_there_is_an_honest_message_of_every_kind() -> None:
    forms = {form.__name__: form for form in FROM_BROWSER}
    assert forms.keys() <= HONEST.keys()
    for name, form in forms.items():
        assert {field.name for field in dataclasses.fields(form)} == HONEST[name].keys()


def test_every_field_of_every_message_with_every_value(tab: Tab) -> None:
    for kind, honest in HONEST.items():
        for field in honest:
            for value in HOSTILE:
                tab.student.send(kind, **honest | {field: value})
            tab.student.send(kind, **{k: v for k, v in honest.items() if k != field})
        tab.student.send(kind, **honest, surplus=1)
        tab.settle()


@st.composite
def hostile_messages(draw: st.DrawFn) -> tuple[str, dict[str, Any]]:
    """A message of any kind with hostile values in some of its fields, and others missing."""
    kind = draw(st.sampled_from(sorted(HONEST)))
    names = st.sampled_from([*HONEST[kind], "surplus"])
    hostile = draw(st.dictionaries(names, st.sampled_from(HOSTILE), min_size=1))
    missing = draw(st.sets(names, max_size=2)) - hostile.keys()
    return kind, {k: v for k, v in (HONEST[kind] | hostile).items() if k not in missing}


@pytest.mark.thorough
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(messages=st.lists(hostile_messages(), min_size=1, max_size=20), at=st.data())
def test_several_hostile_fields_at_once(
    tab: Tab, messages: list[tuple[str, dict[str, Any]]], at: st.DataObject
) -> None:
    """One lab meets all examples; those at its own nodes pass the first checks."""
    for kind, fields in messages:
        real = {"name": tab.nodes(), "owner": [str(tab.client.client_id)]}
        for name in real.keys() & fields.keys():
            if (which := at.draw(st.none() | st.integers(0, 1000))) is not None:
                fields[name] = real[name][which % len(real[name])]
        tab.student.send(kind, **fields)
    tab.settle()


@pytest.mark.thorough
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(draw=st.randoms(use_true_random=False), count=st.integers(1, 20))
def test_hostile_requests_of_a_page(tab: Tab, draw: random.Random, count: int) -> None:
    """One lab meets all examples."""
    tab.student.tell(*(json.loads(wild_request(draw, sorted(QUICK))) for _ in range(count)))
    tab.settle()


def hit_every_node(tab: Tab) -> None:
    """With every index, in every phase of a drag."""
    owner = {"owner": str(tab.client.client_id)}
    for name in tab.nodes():
        for index in INDEXES:
            at = {"name": name, "instance_index": index, **owner}
            tab.student.send("SceneNodeClickMessage", **HONEST["SceneNodeClickMessage"] | at)
            for phase in ("update", "end", "start", "start", "update"):
                for button in ("right", "left"):
                    drag = {"phase": phase, "button": button, **at}
                    tab.student.send("SceneNodeDragMessage", **DRAG | drag)
        tab.settle()


@pytest.mark.thorough
@pytest.mark.parametrize("path", ["circle", "clover", "segment"])
def test_every_node_with_every_index(tab: Tab, path: str) -> None:
    tab.lab.post(c.ChoosePath(path))
    wait_for(lambda: tab.lab.simulation.editor.design.name == path, WAIT)
    hit_every_node(tab)


@pytest.mark.thorough
def test_a_sheet_to_draw_on_with_every_index(tab: Tab) -> None:
    tab.student.tell({"is": "freehand"})
    wait_for(lambda: any("freehand" in name for name in tab.nodes()), WAIT)
    hit_every_node(tab)


@pytest.mark.thorough
def test_a_wall_and_the_start_of_a_run_with_every_index(tab: Tab) -> None:
    tab.student.set("show_start", True)
    tab.lab.post(c.Set("wall", True))
    wait_for(lambda: {"/wall/body", "/wall/ends", "/start/ball"} <= set(tab.nodes()), WAIT)
    hit_every_node(tab)
