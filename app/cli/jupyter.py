"""The lab inside Jupyter: what jupyter-server-proxy starts when somebody opens it there."""

from __future__ import annotations

import sys
from typing import Any


def server() -> dict[str, Any]:
    """The entry of jupyter-server-proxy.

    The lab listens on a Unix socket that only its user can open: on a port, everybody else on the
    same machine would get in past Jupyter's login.
    """
    return {
        "command": [sys.executable, "-P", "-m", "onpath", "serve", "--socket", "{unix_socket}"],
        "unix_socket": True,
        "timeout": 60,
        "launcher_entry": {"title": "OnPath", "path_info": "onpath/index.html"},
        "new_browser_tab": True,
    }
