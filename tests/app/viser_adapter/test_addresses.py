"""The page has an address for each class, so that a proxy can tell by the path who belongs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from http.client import HTTPConnection, HTTPResponse

import pytest
import viser
from hypothesis import given
from hypothesis import strategies as st
from websockets import Headers
from websockets.exceptions import InvalidStatus
from websockets.http11 import Request
from websockets.sync.client import connect

from onpath.app.viser_adapter.addresses import class_code_in, prefix_of, without_prefix
from onpath.app.viser_adapter.request_filter import RequestFilter
from onpath.app.viser_adapter.secure_server import Limits, make_server

ORIGIN = "https://lab.example.org"


@pytest.fixture(scope="module")
def alone() -> Iterator[viser.ViserServer]:
    server = make_server(port=0)
    yield server
    server.stop()


@pytest.fixture(scope="module")
def proxied() -> Iterator[viser.ViserServer]:
    server = make_server(port=0, allowed_origins=(ORIGIN,))
    yield server
    server.stop()


def get(server: viser.ViserServer, path: str, **headers: str) -> HTTPResponse:
    connection = HTTPConnection("127.0.0.1", server.get_port(), timeout=10)
    connection.request("GET", path, headers=headers)
    return connection.getresponse()


@pytest.mark.parametrize(
    ("path", "prefix", "rest"),
    [
        ("/", "", "/"),
        ("/c/abc234/", "c/abc234", "/"),
        ("/c/abc234", "c/abc234", "/"),
        ("/c/ABC234/x.js?y", "c/abc234", "/x.js?y"),
        ("/c/abc234?y", "c/abc234", "/?y"),
        ("/l/abc/index.html", "l/abc", "/index.html"),
        ("/c/", "", "/c/"),
        ("/c/a-b/", "", "/c/a-b/"),
        ("/d/abc234/", "", "/d/abc234/"),
        ("/c/" + "a" * 33, "", "/c/" + "a" * 33),
    ],
)
def test_a_prefix_is_the_beginning_of_a_path(path: str, prefix: str, rest: str) -> None:
    assert (prefix_of(path), without_prefix(path)) == (prefix, rest)


def test_only_a_class_has_its_code_in_the_prefix() -> None:
    assert class_code_in("l/abc") == "" and class_code_in("c/abc") == "abc"


def test_every_place_has_the_same_page(alone: viser.ViserServer) -> None:
    page = get(alone, "/").read()
    for path in ("/c/abc234/", "/l/abc/", "/index.html"):
        assert get(alone, path).read() == page
    for path in ("/c/abc234/nothing.js", "/c/abc234/..%2f..%2f..%2fsetup.py", "/c/a-b/"):
        assert get(alone, path).status == 404


@pytest.mark.parametrize(
    ("path", "to"),
    [
        ("/c/abc234", "/c/abc234/"),
        ("/c/ABC234/", "/c/abc234/"),
        ("/C/abc234/", "/c/abc234/"),
        ("/c/ABC234?x=1", "/c/abc234/"),
        ("/c/abc234/?utm_source=moodle", "/c/abc234/"),
        ("/c/abc234/index.html", "/c/abc234/"),
        ("/l/ABC/x.js?y", "/l/abc/x.js?y"),
        ("/l/abc", "/l/abc/"),
    ],
)
def test_a_similar_address_leads_to_the_page(alone: viser.ViserServer, path: str, to: str) -> None:
    answer = get(alone, path)
    assert (answer.status, answer.getheader("Location")) == (302, to)


@given(
    st.sampled_from("cCl"),
    st.text("abcXYZ234", min_size=1, max_size=34),
    st.sampled_from(["", "/", "//", "/index.html", "/x", "/."]),
    st.sampled_from(["", "?", "?x=1", "?websocket=ws://evil.example", "#x"]),
)
def test_a_websocket_is_opened_at_a_place_as_it_is_spelt_only(
    kind: str, name: str, rest: str, query: str
) -> None:
    """What another process may be asked for, since a proxy does not read it as this prefix."""
    door = RequestFilter((), local_only=False)
    door.open = True
    path = f"/{kind}/{name}{rest}{query}"
    canonical = kind in "cl" and name == name.lower() and len(name) <= 32 and rest in ("", "/")
    answer = door.refusal(Request(path, Headers(Upgrade="websocket")))
    assert (answer is None) == (canonical and not query)


def test_at_no_place_a_websocket_is_opened_as_before() -> None:
    door = RequestFilter((), local_only=False)
    door.open = True
    for path in ("/", "/?x", "/index.html", "/onpath", "/user/ada/proxy/8080/"):
        assert door.refusal(Request(path, Headers(Upgrade="websocket"))) is None


def test_who_asks_for_a_class_of_another_process_is_told_to_ask_again() -> None:
    server = make_server(port=0, elsewhere=lambda prefix: prefix == "c/abc234")
    assert get(server, "/c/abc234/").status == 200  # the page, which asks every second
    with pytest.raises(InvalidStatus) as refused:
        connect(f"ws://127.0.0.1:{server.get_port()}/c/abc234")
    answer = refused.value.response
    assert answer.status_code == 502 and answer.headers["Retry-After"] == "1"
    server.stop()


def test_a_full_process_sends_those_on_whose_class_another_one_has() -> None:
    """At 503 nginx asks nobody else: who fills one process would lock a class out of another."""
    away = "c/abc234"
    limits = Limits(max_connections=0)
    server = make_server(port=0, limits=limits, elsewhere=lambda prefix: prefix == away)
    for asked in ({}, {"Upgrade": "websocket", "Connection": "Upgrade"}):
        assert get(server, f"/{away}/", **asked).status == 502
        assert get(server, "/c/n4ws8c/", **asked).status == 503
        assert get(server, "/", **asked).status == 503
    server.stop()


def test_who_is_in_no_class_has_a_place_that_stays(proxied: viser.ViserServer) -> None:
    first = get(proxied, "/")
    prefix, cookie = first.getheader("Location") or "", first.getheader("Set-Cookie") or ""
    assert first.status == 302 and re.fullmatch("/l/[a-z0-9]{12}/", prefix)
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    again = get(proxied, "/index.html", Cookie=f"other=1; {cookie.partition(';')[0]}")
    assert again.getheader("Location") == prefix and again.getheader("Set-Cookie") is None
    assert get(proxied, "/").getheader("Location") != prefix
    for wrong in ("onpath=evil", "onpath=../../../etc", f"onpath={'A' * 12}"):
        answer = get(proxied, "/", Cookie=wrong)
        assert re.fullmatch("/l/[a-z0-9]{12}/", answer.getheader("Location") or "")
        assert answer.getheader("Set-Cookie")
    assert get(proxied, prefix).status == 200


def test_without_a_proxy_the_page_is_where_it_was(alone: viser.ViserServer) -> None:
    answer = get(alone, "/")
    assert answer.status == 200 and answer.getheader("Set-Cookie") is None
