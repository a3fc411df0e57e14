"""The lab inside Jupyter, as started by jupyter-server-proxy."""

from __future__ import annotations

import sys
from typing import Any


def server() -> dict[str, Any]:
    """Return the configuration for jupyter-server-proxy.

    The lab listens on a Unix socket that only its user can open: through a port, other users of the
    same machine could bypass Jupyter's login.
    """
    return {
        "command": [sys.executable, "-P", "-m", "onpath", "serve", "--socket", "{unix_socket}"],
        "unix_socket": True,
        "timeout": 60,
        "launcher_entry": {"title": "OnPath", "path_info": "onpath/"},
        "new_browser_tab": True,
    }
