"""What takes long to import and is not needed for the first picture, imported when that is shown.

Who asks for it sooner gets it by the imports inside the functions that need it.
"""

from __future__ import annotations

import time
from importlib import import_module
from threading import Thread

LATER = ("app.figures", "app.report", "app.sketch_board", "scipy.signal")
REST = 3.0  # [s] for the first browser to open its lab


def warm_up(rest: float = REST) -> Thread:
    """Import the rest in a thread, after a while."""

    def work() -> None:
        time.sleep(rest)
        for name in LATER:
            import_module(name)

    thread = Thread(target=work, name="warm-up", daemon=True)
    thread.start()
    return thread
