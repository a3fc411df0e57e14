"""The supplied nginx configuration, in front of two real workers, one of which is killed."""

from __future__ import annotations

import http.client
import os
import random
import re
import shutil
import signal
import socket
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from tests.support.built_in import built_in_course
from tests.support.checkout import ROOT
from tests.support.student import Student
from tests.support.supervisor import Supervisor
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin")
HOST, ORIGIN = "lab.example.org", "https://lab.example.org"
CONFIGURATION = ROOT / "assets" / "deploy" / "nginx.conf"
needs_nginx = pytest.mark.skipif(NGINX is None, reason="nginx is not installed (apt install nginx)")


def free_ports(count: int) -> list[int]:
    """Successive ones, of those that no system gives to whoever asks for any."""
    while True:
        ports = [random.randrange(20000, 32000)]
        ports += [ports[0] + i for i in range(1, count)]
        with ExitStack() as probes, suppress(OSError):
            for port in ports:
                probes.enter_context(socket.create_server(("127.0.0.1", port)))
            return ports


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@dataclass
class Site:
    """The proxy and what is behind it."""

    port: int
    supervisor: Supervisor

    def get(self, path: str = "/", host: str = HOST, **headers: str) -> http.client.HTTPResponse:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.request("GET", path, headers={"Host": host, **headers})
        return connection.getresponse()

    def cookie(self) -> str:
        """What a browser is given with the page."""
        reply = self.get()
        assert reply.status == 200 and b"<html" in reply.read(200).lower()
        return (reply.getheader("Set-Cookie") or "").partition(";")[0]

    def student(self, cookie: str, origin: str = ORIGIN) -> Student:
        return Student(f"ws://{HOST}", self.port, Origin=origin, Cookie=cookie)


def proxied(folder: Path, port: int, workers: list[int]) -> list[str]:
    """The supplied file with this test's ports, and the command that starts nginx with it."""
    text = CONFIGURATION.read_text()
    for given, here in zip(("8081", "8082"), workers, strict=True):
        text = text.replace(f"127.0.0.1:{given}", f"127.0.0.1:{here}")
    text = re.sub(r"^(\s+listen) 80\b", rf"\1 127.0.0.1:{port}", text, flags=re.MULTILINE)
    (folder / "onpath.conf").write_text(text)
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    paths = "".join(f"{kind}_temp_path {folder / kind};" for kind in kinds)
    main = f"daemon off; pid {folder / 'pid'}; error_log stderr; events {{}}"
    (folder / "nginx.conf").write_text(
        f"{main} http {{ access_log off; {paths} include {folder / 'onpath.conf'}; }}"
    )
    return [NGINX or "", "-e", "stderr", "-p", str(folder), "-c", str(folder / "nginx.conf")]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    folder = tmp_path_factory.mktemp("site")
    first, second, port = free_ports(3)
    options = ["--workers", "2", "--successive-ports", "--port", str(first), "--origin", ORIGIN]
    supervisor = Supervisor(folder, *options)
    command = proxied(folder, port, [first, second])
    nginx = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    supervisor.wait_for("OnPath is ready", times=2)
    wait_for(lambda: _answers(port) or nginx.poll() is not None, 60.0)
    assert nginx.poll() is None
    yield Site(port, supervisor)
    nginx.terminate()
    nginx.wait()
    supervisor.end()
    wait_for(lambda: not (_answers(first) or _answers(second)), 60.0)


def worker_of(site: Site, student: Student) -> int:
    """The process that has opened a student's websocket: the only one with a held lab."""
    assert student.code
    served = [p for p in site.supervisor.workers() if site.supervisor.sockets(p) > 0]
    (process,) = served
    return process


@needs_nginx
def test_the_same_browser_stays_with_its_worker_and_browsers_are_spread(site: Site) -> None:
    served: dict[str, set[int]] = {}
    while len(served) < 6 or len(set.union(*served.values())) < 2:
        assert len(served) < 40  # by chance all would be with one worker once in 2^39 times
        cookie = site.cookie()
        assert re.fullmatch("onpath=[0-9a-f]{32}", cookie)
        for _ in range(2):
            with site.student(cookie) as student:
                student.open()
                student.read(lambda: student.kept)
                served.setdefault(cookie, set()).add(worker_of(site, student))
            wait_for(lambda: not any(map(site.supervisor.sockets, site.supervisor.workers())), 60.0)
    assert all(len(processes) == 1 for processes in served.values())
    assert site.get("/", Cookie="onpath=" + "a" * 32).getheader("Set-Cookie") is None
    assert site.get("/", Cookie="onpath=evil").getheader("Set-Cookie") is not None


@needs_nginx
def test_strangers_and_monsters_are_refused(site: Site) -> None:
    cookie = site.cookie()
    for origin in ("https://evil.example", f"{ORIGIN}.evil.example", "null"):
        with pytest.raises(InvalidStatus) as refused:
            site.student(cookie, origin).open()
        assert refused.value.response.status_code == 403
    assert site.get("/", host="evil.example").status == 421
    assert site.get("/", X="x" * 20_000).status == 400
    assert site.get("/" + "x" * 5_000).status == 414
    assert site.get("/..%2f..%2fetc/passwd").status in (400, 404)
    assert site.get("/health").status == 200


@needs_nginx
def test_a_student_whose_worker_is_killed_continues_on_another(site: Site) -> None:
    with site.student(site.cookie()) as student:
        student.open()
        student.set("K2", 44.0)
        student.set("Path", "clover")
        student.set("Lessons", True)
        numbers = built_in_course()[0].numbers().values()
        student.read(lambda: all(student.has_widget(f"Open lesson {each}") for each in numbers))
        student.set(f"Open lesson {[*numbers][-1]}", True)
        student.set("Next", True)
        student.read(lambda: student.sees("Step 2 of"))
        student.set("B", "B")
        student.set("Commit to this prediction: B", True)
        student.read(lambda: student.has_widget("Next") and not student.has_widget("Commit"))
        kept = ("'answers': {'1'", "'K2': 44.0", "'clover'")
        student.read(lambda: site.supervisor.has_kept(student.code, *kept))
        serving, code = worker_of(site, student), student.code
        os.kill(serving, signal.SIGKILL)
        student.wait_until_closed()
        student.reopen()
        student.read(lambda: student.sees("Step 2 of"))
        assert worker_of(site, student) != serving and student.code == code
        student.read(lambda: student.has_widget("Next"))
        assert not student.has_widget("Commit") and not student.has_widget(
            "Skip"
        )  # it stays predicted
        student.set("Free lab", "Free lab")
        student.read(lambda: not student.sees("Step 2 of"))
        assert student.find("Path")["value"] == "clover" and student.find("K2")["value"] == 44.0
