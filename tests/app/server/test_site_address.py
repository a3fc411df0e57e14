"""The address that a teacher shows: one that students' devices can open."""

from __future__ import annotations

import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.server.site_address import is_local, reachable_site, site_for_students

SERVED = "http://192.0.2.7:8080"


@pytest.mark.parametrize(
    ("host", "site", "local"),
    [
        ("127.0.0.1", "http://localhost:8080", True),
        ("localhost", "http://localhost:8080", True),
        ("::1", "http://[::1]:8080", True),
        ("192.0.2.7", SERVED, False),
        ("2001:db8::7", "http://[2001:db8::7]:8080", False),
        ("lab.example", "http://lab.example:8080", False),
    ],
)
def test_a_server_is_where_it_listens(host: str, site: str, local: bool) -> None:
    assert reachable_site(host, 8080) == site
    assert is_local(site) == local


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
def test_a_server_that_listens_everywhere_is_at_this_machines_address(
    host: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = reachable_site(host, 8080)
    assert host not in site

    def offline(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(socket, "socket", offline)
    assert reachable_site(host, 8080) == "http://localhost:8080"


@pytest.mark.parametrize(
    "seen",
    [
        "https://lab.example.org",
        "https://www.example.org/robots/onpath",
        "http://192.0.2.9:8080",
        "http://[2001:db8::7]:8080",
    ],
)
def test_students_go_where_the_teachers_browser_is(seen: str) -> None:
    assert site_for_students(seen, SERVED) == seen


@pytest.mark.parametrize(
    "seen",
    [
        "",
        "http://localhost:8080",
        "http://127.0.0.1:8080/folder",
        "http://[::1]:8080",
        "http://[::::]",
        "javascript:alert(1)//",
        "https://a.example/?x=<script>",
        "https://user:secret@a.example",
        "https://a.example/" + "x" * 300,
        "https://a.example\nhttps://b.example",
    ],
)
def test_what_no_student_can_open_is_not_shown(seen: str) -> None:
    assert site_for_students(seen, SERVED) == SERVED


@given(st.text(max_size=200))
def test_any_text_of_a_browser_is_an_address_or_left_out(seen: str) -> None:
    shown = site_for_students(seen, SERVED)
    assert shown == SERVED or (shown.startswith(("http://", "https://")) and shown.isascii())


def test_behind_a_proxy_the_site_is_the_proxys() -> None:
    origins = ("https://lab.example.org", "https://other.example.org")
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(allowed_origins=origins))
    try:
        assert server.site == origins[0]
    finally:
        server.stop()
