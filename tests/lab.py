"""What the tests of the lab share: a session without a compiler, driven by hand."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from app.commands import Command
from app.loop_store import LoopStore
from app.session import Session

FRAME = 1 / 60
FOLLOWER, TRACKER = "path_following", "trajectory_tracking"


@lru_cache(maxsize=1)
def store() -> LoopStore:
    """Interpreted loops only, built once."""
    return LoopStore(compiler=None, folder=Path("unused"))


def new_session(seconds: float = 0.0) -> Session:
    """A lab that has run for a while."""
    session = Session(store())
    run(session, seconds)
    return session


def run(session: Session, seconds: float) -> None:
    """Frame after frame, as the simulation thread does it."""
    for _ in range(round(seconds / FRAME)):
        session.drain()
        session.advance(session.rate * FRAME)


def do(session: Session, *commands: Command) -> None:
    """Apply commands at once."""
    for command in commands:
        session.post(command)
    session.drain()


def states(session: Session) -> dict[str, np.ndarray]:
    """Copies of both robots' states."""
    return {name: run.state.copy() for name, run in session.runs.items()}


def y(session: Session, name: str) -> np.ndarray:
    """Where an end-point is, (p,), [m]."""
    return session.robot.endpoint(session.runs[name].fields()["q"])
