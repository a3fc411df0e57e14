"""Whether the frames of the simulation are on time; long work in other threads waits for them.

The interpreter runs one thread at a time, so work in other threads makes frames late.
"""

from __future__ import annotations

from threading import Event

_on_time = Event()
_on_time.set()


def note_lateness(late: bool) -> None:
    """Note whether frames are late. The simulation thread calls this in every frame."""
    if late:
        _on_time.clear()
    else:
        _on_time.set()


def wait_until_on_time(most: float) -> bool:
    """Wait for at most `most` seconds until frames are on time; returns whether they are."""
    return _on_time.wait(most)
