"""A plant's measurements reach the controller once, in order, in time, and from one sender."""

from __future__ import annotations

import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.plant.datagrams import Measured, torque_datagram
from onpath.app.plant.plant_link import PlantLink
from onpath.models.controller.functions import AT_FAULT, REFUSALS
from tests.support.lab_log import lab_log
from tests.support.plant_end import measurement, torque_in

ARM: dict[str, Any] = {"robot": "two_link_arm", "path": "circle", "torque_limit": 5.0}
CODE = {name: number for number, name in enumerate(REFUSALS, 1)}
INTERVAL, PLANT = 4e-3, ("127.0.0.1", 5000)
LOG = lab_log(**ARM, law="path_following", duration=0.3)
IGNORED = {"repeat", "old", "foreign", "short", "letters", "nothing"}
EVENTS = ["next"] * 6 + [
    "lost",
    "late",
    "nan",
    "no time",
    "jump",
    "back",
    "silent",
    "stop",
    *IGNORED,
]


def at(sequence: int, tick: int, q: float = 0.0, t: float = 0.0) -> bytes:
    """What the plant measures in a tick, perhaps moved, or at another time."""
    return measurement(Measured(sequence, LOG.t[tick] + t, LOG.q[tick] + q, LOG.v[tick]))


def sent(event: str, sequence: int, tick: int) -> bytes:
    """The datagram of an event."""
    before = at(sequence - 1, tick - 4)
    return {
        "repeat": before,
        "old": at(0, tick - 4),
        "short": before[:-1],
        "letters": b"OPT1" + at(sequence, tick)[4:],
        "nothing": b"",
        "nan": at(sequence, tick, q=math.nan),
        "no time": at(sequence, tick, t=math.inf),
        "jump": at(sequence, tick, q=1.0),
        "back": at(sequence, tick, t=-0.02),
    }.get(event, at(sequence, tick))


@settings(max_examples=60)
@given(
    events=st.lists(st.sampled_from(EVENTS), max_size=15),
    at_fault=st.sampled_from(AT_FAULT),
    delays=st.lists(st.floats(0, 1e-3), min_size=15, max_size=15),
)
def test_the_controller_is_given_exactly_what_counts(
    events: list[str], at_fault: str, delays: list[float]
) -> None:
    """A controller that is given it directly gives the same torques and codes, to the last bit."""
    given = {**ARM, "control_rate": 250, "at_fault": at_fault}
    bare, link = onpath.controller(**given), PlantLink({"law": onpath.controller(**given)})
    tick, sequence, now, counted = 4, 1, 0.0, 0
    for event, delay in zip(["next", *events], [0.0, *delays], strict=False):
        ended = bare.code
        if event in ("silent", "stop"):
            bare.stop("late" if event == "silent" else "stopped")
            torque = bare.step(LOG.t[tick - 4], np.full(2, np.nan))
            answer = link.fall_silent() if event == "silent" else link.stop()
            assert answer == torque_datagram(sequence - 1, bare.code, torque)
        elif event in IGNORED or event == "foreign":
            sender = "other" if event == "foreign" else PLANT
            assert link.received(sent(event, sequence, tick), sender, now) is None
        else:
            tick += 8 if event == "lost" else 0
            now = LOG.t[tick] + delay + (0.02 if event == "late" else 0)
            datagram = sent(event, sequence, tick)
            if event == "late":
                bare.stop("late")
            _, _, t, *q = struct.unpack("<4sId4d", datagram)
            expected = bare.step(t, q[:2], q[2:])
            answer = link.received(datagram, PLANT, now)
            assert answer == torque_datagram(sequence, bare.code, expected)
            tick, sequence, counted = tick + 4, sequence + 1, counted + 1
        assert not ended or bare.code == ended  # it never goes on by itself
        assert link.ended == bool(bare.code)
        assert link.silent_at == (None if bare.code else pytest.approx(now + 2 * INTERVAL))
    report = link.report()
    assert report.answered == counted == len(report.rows) and report.code == bare.code
    ignored = [event for event in events if event in IGNORED or event == "foreign"]
    assert report.repeated + report.foreign + report.unreadable == len(ignored)


def test_what_is_no_finite_measurement_does_not_begin() -> None:
    link = PlantLink({"law": onpath.controller(**ARM)})
    for datagram in (at(1, 0, q=math.nan), at(1, 0, t=math.inf), b"OPM1", b"", at(1, 0) + b"more"):
        assert link.received(datagram, "somebody", 0.0) is None
    assert not link.started and link.silent_at is None
    assert link.received(at(0, 0), PLANT, 1.0) is not None


def test_lateness_is_that_after_the_fastest_measurement() -> None:
    """Whatever the plant's clock says, and also while it drifts away by 500 ppm."""
    link = PlantLink({"law": onpath.controller(**ARM, control_rate=250)})
    for k in range(70):
        now = 1e6 + 1.0005 * LOG.t[4 * k] + (3e-3 if k == 50 else 0)
        answer = link.received(at(k, 4 * k), PLANT, now)
        link.sent(now + 1e-4)
        assert answer is not None and struct.unpack_from("<4sIq", answer)[2] == 0
        if k == 49:
            assert link.report().late < 2e-4
    assert 3.05e-3 < link.report().latest < 3.15e-3


def test_another_law_goes_on_where_the_robot_is() -> None:
    laws = "path_following", "waiting_clock"
    given = {**ARM, "control_rate": 250}
    link = PlantLink({law: onpath.controller(**given, law=law) for law in laws})
    for k in range(30):
        link.received(at(k, 4 * k), PLANT, LOG.t[4 * k])
    before = link.report()
    link.use("waiting_clock")
    with pytest.raises(ValueError, match="waiting_clock"):
        link.use("waiting")
    alone = onpath.controller(**given, law="waiting_clock")
    alone.start(LOG.t[116], LOG.q[116], LOG.v[116], before.theta)
    for k in range(30, 40):
        answer = link.received(at(k, 4 * k), PLANT, LOG.t[4 * k])
        torque = alone.step(LOG.t[4 * k], LOG.q[4 * k], LOG.v[4 * k])
        assert answer == torque_datagram(k, 0, torque)
    link.stop()
    link.use("path_following")  # which would begin anew
    assert link.ended and link.report().code == CODE["stopped"]


def test_a_datagram_is_read_as_it_was_written() -> None:
    torque = np.array([0.1, -math.inf, 1e-300])
    read = torque_in(torque_datagram(2**32 - 1, 7, torque), 3)
    assert read is not None and read[:2] == (2**32 - 1, 7) and np.array_equal(read[2], torque)
    assert torque_in(torque_datagram(1, 0, torque), 2) is None
