"""Smoke test of an installed OnPath: python smoke.py PATH_TO_ONPATH; needs no test packages."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path


def main() -> None:
    """A simulation, an experiment, a figure, then the lab's page, then a clean stop."""
    code = "import onpath; print(len(onpath.simulate(duration=0.1).t))"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "100\n"

    onpath = sys.argv[1]
    command = [onpath, "experiment", "obstruction", "--json"]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    laws = json.loads(output)["laws"]
    assert laws["path_following"]["max_distance_m"] <= 0.003, output
    assert laws["trajectory_tracking"]["max_distance_m"] >= 0.04, output

    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "figure.html"
        subprocess.run([onpath, "figure", str(page)], check=True)
        assert page.read_text("utf-8").count("<script") == 2

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    signal.signal(signal.SIGINT, signal.default_int_handler)  # heeded in the background, too
    server = subprocess.Popen([onpath, "--port", str(port)])
    try:
        page = _page(f"http://127.0.0.1:{port}/", patience=120.0)
        assert b"<html" in page.lower(), page[:200]
    finally:
        if sys.platform == "win32":  # no program there can press Ctrl-C for another one alone
            server.terminate()
        else:
            server.send_signal(signal.SIGINT)
        code = server.wait(timeout=60)
    assert code == 0 or sys.platform == "win32", f"the server stopped with {code}"
    sys.stdout.write("smoke test passed\n")


def _page(url: str, patience: float) -> bytes:
    end = time.monotonic() + patience
    while True:
        try:
            with urllib.request.urlopen(url, timeout=2) as reply:
                return reply.read()
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.2)


if __name__ == "__main__":
    main()
