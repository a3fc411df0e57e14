"""The plant's end of the datagrams between a controller and its plant."""

from __future__ import annotations

import numpy as np

from onpath.app.plant.datagrams import ANSWER, HEAD, MEASUREMENT, TORQUE, Measured
from onpath.models.arrays import Array


def measurement(measured: Measured) -> bytes:
    """The datagram of a measurement."""
    numbers = measured.q if measured.v is None else np.concatenate([measured.q, measured.v])
    head = HEAD.pack(MEASUREMENT, measured.sequence, measured.t)
    return head + numbers.astype("<f8").tobytes()


def torque_in(datagram: bytes, m: int) -> tuple[int, int, Array] | None:
    """Sequence, code and torques in a datagram for a plant with m motors; None: there are none."""
    if len(datagram) != ANSWER.size + 8 * m or not datagram.startswith(TORQUE):
        return None
    _, sequence, code = ANSWER.unpack_from(datagram)
    return sequence, code, np.frombuffer(datagram, "<f8", offset=ANSWER.size).astype(float)
