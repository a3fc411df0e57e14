"""To which process the supplied nginx leads, in whatever order processes end and start.

The processes are stand-ins, which take every websocket.
"""

from __future__ import annotations

import random
import socket
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from textwrap import dedent

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets import Headers
from websockets.http11 import Request

from onpath.app.viser_adapter.addresses import prefix_of
from onpath.app.viser_adapter.request_filter import RequestFilter
from tests.support.checkout import ROOT
from tests.support.lab_process import free_ports
from tests.support.site import HOST, needs_nginx, nginx, supplied
from tests.support.stand_in import NAME, StandIn

pytestmark = [pytest.mark.thorough, needs_nginx]

UPGRADE = {"Upgrade": "websocket", "Connection": "Upgrade"}
README = (ROOT / "assets" / "deploy" / "README.md").read_text()
CODE = "m63eyz"
BEGINS, ENDS = f"    upstream onpath_{CODE} {{", "        default    onpath;\n    }\n"
OF_ONE_CLASS = dedent(README[README.index(BEGINS) : README.index(ENDS) + len(ENDS)])


@dataclass
class Served:
    """nginx, and the stand-ins behind it."""

    port: int
    behind: list[StandIn]

    def ask(
        self, path: str, stack: ExitStack, method: str = "GET", **headers: str
    ) -> tuple[int, str, socket.socket]:
        """Status, name of the stand-in, and the connection, which stays open in the stack."""
        made = HTTPConnection("127.0.0.1", self.port, timeout=20.0)
        stack.callback(made.close)
        made.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        for name, value in {"Host": HOST, **headers}.items():
            made.putheader(name, value)
        made.endheaders()
        assert made.sock is not None
        kept = made.sock.dup()
        stack.callback(kept.close)
        reply: HTTPResponse = made.getresponse()
        return reply.status, reply.getheader(NAME) or "", kept

    def serving(self, path: str) -> str:
        """The stand-in that gets a websocket; empty if it is refused."""
        with ExitStack() as stack:
            status, name, _ = self.ask(path, stack, **UPGRADE)
            return name if status == 101 else ""


@contextmanager
def served(folder: Path, more: str = "", starts: bool = True) -> Iterator[Served]:
    """nginx, as supplied or with an upstream for a class, in front of two stand-ins."""
    *ports, port = free_ports(3)
    behind = [StandIn(each, name) for each, name in zip(ports, "ab", strict=True)]
    for each in behind if starts else ():
        each.start()
    text = supplied(port, ports)
    if more:
        for given_port, own in zip(("8081", "8082"), ports, strict=True):
            more = more.replace(given_port, str(own))
        text = more + text.replace("http://onpath;", "http://$onpath_upstream;")
    try:
        with nginx(folder, port, text):
            yield Served(port, behind)
    finally:
        for each in behind:
            each.kill()


# Order of kills and starts.


class Tabs:
    """Pages that connect again, by websocket alone, as viser's does."""

    def __init__(self, site: Served, prefixes: Sequence[str]) -> None:
        self._site = site
        self._prefixes = prefixes
        self._open = dict[str, tuple[str, socket.socket, ExitStack]]()

    def close(self) -> None:
        for _, _, stack in self._open.values():
            stack.close()

    def connect(self) -> None:
        """Those whose process has ended connect again, once: all of them are served at once."""
        up = {each.name for each in self._site.behind if each.runs}
        for prefix in self._prefixes:
            if prefix in self._open:
                name, _, stack = self._open[prefix]
                if name in up and not self._has_ended(prefix):
                    continue
                stack.close()
            stack = ExitStack()
            status, name, way = self._site.ask(f"/{prefix}/", stack, **UPGRADE)
            assert (status, name in up) == (101, True), (prefix, status, name)
            self._open[prefix] = name, way, stack

    def _has_ended(self, prefix: str) -> bool:
        way = self._open[prefix][1]
        way.setblocking(False)
        try:
            return not way.recv(1)
        except BlockingIOError:
            return False


@pytest.mark.parametrize("upstream", ["", OF_ONE_CLASS], ids=["supplied", "of one class"])
@pytest.mark.parametrize("first", ["processes", "proxy"])
def test_whoever_comes_is_served_at_once_while_one_process_is_there(
    tmp_path: Path, upstream: str, first: str
) -> None:
    """Also where a process had ended, and nobody but websockets, which do not finish, came since.

    "Kill, start again, kill the other" is the rolling restart of an upgrade.
    """
    chance = random.Random(39)
    prefixes = [f"c/{CODE}", *(f"{kind}/{number:06d}" for kind in "cl" for number in range(4))]
    with served(tmp_path, upstream, starts=first == "processes") as site, ExitStack() as stack:
        a, b = site.behind
        if first == "proxy":
            for prefix in prefixes:  # so that nginx has met nobody at all
                assert site.ask(f"/{prefix}/", stack, **UPGRADE)[0] == 502
            a.start()
            b.start()
        tabs = Tabs(site, prefixes)
        stack.callback(tabs.close)
        tabs.connect()
        upgrade = [b.kill, b.start, a.kill, a.start] * 2
        for event in upgrade:
            event()
            tabs.connect()
        for _ in range(30):
            one = chance.choice(site.behind)
            if not one.runs:
                one.start()
            elif all(each.runs for each in site.behind):
                one.kill()
            tabs.connect()


# Spellings.

CODES = CODE, "abc234", "n4ws8c", "q9tzrx", "222222", "zzzzzz"  # not all at home with one process


@st.composite
def spellings(draw: st.DrawFn) -> str:
    """Paths that resemble that of a class."""

    def spelt(text: str) -> str:
        ways = [str.lower, str.upper, lambda each: f"%{ord(each):02x}", lambda each: f"{each}/"]
        way = st.sampled_from([*ways[:1] * 16, *ways[:2] * 2, *ways[2:]])
        return "".join(draw(way)(each) for each in text)

    before = draw(st.sampled_from([""] * 12 + ["/", "/.", "/x/..", "/%2e", "/c/other/../.."]))
    slash = st.sampled_from(["/"] * 12 + ["//", "%2f", "/./"])
    kind = draw(st.sampled_from(["c"] * 8 + ["C", "l", "%63"]))
    after = [
        "",
        "/",
        "/",
        "//",
        "/.",
        "/x",
        "/X",
        "/index.html",
        "%2f",
        ";x",
        ".",
        "%00",
        "%3f",
        "A",
    ]
    query = draw(st.sampled_from(["", "", "?", "?x=1", "?utm_source=Moodle", "?/C/X", "#x"]))
    code = spelt(draw(st.sampled_from(CODES)))
    return f"{before}{draw(slash)}{kind}{draw(slash)}{code}{draw(st.sampled_from(after))}{query}"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("site")) as made:
        yield made


@given(path=spellings())
def test_a_websocket_comes_to_the_process_of_its_place_or_to_none(site: Served, path: str) -> None:
    """However the address is spelt: a process takes a class over when it gets a websocket of it."""
    for each in site.behind:
        each.asked.clear()
    name = site.serving(path)
    for received in [each.asked for each in site.behind]:
        assert len(received) <= 1
    came = [(each.name, text) for each in site.behind for text in each.asked]
    assert [each for each, _ in came] == ([name] if name else [])
    lab = RequestFilter((), local_only=False)
    lab.open = True
    for each, text in came:
        refused = lab.refusal(Request(text, Headers(Host=HOST, **UPGRADE)))
        prefix = "" if refused else prefix_of(text)
        assert not prefix or each == site.serving(f"/{prefix}/")


def test_the_pages_of_a_place_and_their_websockets_come_to_one_process(site: Served) -> None:
    found = set[str]()
    for number in range(40):
        prefix = f"c/{number:06d}"
        names = {site.serving(f"/{prefix}{rest}") for rest in ("", "/", "/?x=1", "/?websocket=x")}
        with ExitStack() as stack:
            names.add(site.ask(f"/{prefix}/", stack)[1])
        (name,) = names
        found.add(name)
    assert found == {"a", "b"}


@pytest.mark.parametrize("code", [CODE.upper(), "m63eyZ", "M63eyz", "m63Eyz"])
def test_a_page_of_another_spelling_is_passed_on_and_its_websocket_is_not(
    site: Served, code: str
) -> None:
    """The lab leads the page to the right spelling, and takes nothing over for it."""
    with ExitStack() as stack:
        assert site.ask(f"/c/{code}/", stack)[0] == 200
        for upgrade in ("websocket", "WebSocket", "h2c, websocket", "x"):
            asked = {"Upgrade": upgrade, "Connection": "Upgrade"}
            assert site.ask(f"/c/{code}/", stack, **asked)[0] == 404
