"""Objects created for one thread are never returned to another."""

from __future__ import annotations

from threading import Thread

from onpath.app.common.per_thread import per_thread


@per_thread
def made(name: str, of: int = 0) -> object:
    return [name, of]


def test_each_thread_has_its_own_and_keeps_it() -> None:
    mine, theirs = made("a"), list[object]()
    asking = Thread(target=lambda: theirs.extend([made("a"), made("a")]))
    asking.start()
    asking.join()
    assert made("a") is mine and theirs[0] is theirs[1] is not mine
    assert made("b") is not mine and made("a", of=1) == ["a", 1]
