"""The datagrams between a controller and its plant: numbers in little-endian order, without gaps.

    measurement   "OPM1"  sequence  t      q (n)   or q (n) and v (n)
    torque        "OPT1"  sequence  code   torque (m)

Four letters, an unsigned integer of 32 bits, and then numbers of 64 bits: a signed integer for the
code, floating point for all others, in SI units. v is missing if it is not measured. A torque has
the sequence of the measurement that it answers, or the last one.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array

MEASUREMENT, TORQUE = b"OPM1", b"OPT1"
HEAD, ANSWER = struct.Struct("<4sId"), struct.Struct("<4sIq")
LARGEST = 2048  # [B] of a datagram; what is larger is cut, and then unreadable


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """A measurement.

    Attributes:
        sequence: its number, which increases.
        t: time of the plant's clock, [s].
        q: coordinates, shape (n,).
        v: velocities, shape (n,); None: not measured.
    """

    sequence: int
    t: float
    q: Array
    v: Array | None

    @property
    def finite(self) -> bool:
        """Whether all its numbers are finite."""
        return bool(np.isfinite([self.t, *self.q, *([] if self.v is None else self.v)]).all())


def measured_in(datagram: bytes, n: int) -> Measured | None:
    """The measurement in a datagram from a plant with n coordinates; None if there is none."""
    numbers, rest = divmod(len(datagram) - HEAD.size, 8)
    if rest or numbers not in (n, 2 * n) or not datagram.startswith(MEASUREMENT):
        return None
    _, sequence, t = HEAD.unpack_from(datagram)
    values = np.frombuffer(datagram, "<f8", offset=HEAD.size).astype(float)
    return Measured(sequence, t, values[:n], values[n:] if numbers == 2 * n else None)


def torque_datagram(sequence: int, code: int, torque: Array) -> bytes:
    """The datagram of torques, [N m]; code: 0, or why they are what the user chose for a fault."""
    return ANSWER.pack(TORQUE, sequence, code) + torque.astype("<f8").tobytes()
