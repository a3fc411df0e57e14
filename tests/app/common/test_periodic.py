"""A periodic call waits without work while nobody needs it."""

from __future__ import annotations

import threading

from onpath.app.common.periodic import Periodic


def test_nothing_is_called_until_it_is_awake_and_a_stop_wakes_it() -> None:
    called = threading.Event()
    rounds = Periodic("rounds", 0.001, called.set)
    rounds.awake.clear()
    rounds.start()
    assert not called.wait(0.05)
    rounds.awake.set()
    assert called.wait(5)
    rounds.awake.clear()
    rounds.stop()
    assert not any(each.name == "rounds" for each in threading.enumerate())


def test_what_is_due_is_called_at_once() -> None:
    called = threading.Event()
    rounds = Periodic("rounds", 3600.0, called.set)
    rounds.start()
    for _ in range(3):
        assert not called.is_set()
        rounds.due.set()
        assert called.wait(5)
        called.clear()
    rounds.stop()
