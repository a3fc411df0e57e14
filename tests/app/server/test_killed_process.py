"""kill -9 in the midst of a lesson: everybody is back within 10 s, and at most 5 s are lost.

Both bounds are promised in seconds, and so asserted, unlike other durations; see tests/README.md.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from math import inf

import pytest

from onpath.app.classroom.class_state import SETTLED
from tests.support.own_socket import OwnSocket
from tests.support.site import HOST, needs_nginx
from tests.support.site_class import KEYS, Class, Running, quiet, return_to
from tests.support.student import Student

pytestmark = [pytest.mark.thorough, needs_nginx]

BACK, LOST = 10.0, 5.0  # [s] at most
EVERY = 0.15  # [s] between the values of a slider that is being moved
CHOICE = 4  # index of a step of the first lesson, which asks for a prediction with options
ANSWERED = "1 of 2 here have answered"


@contextmanager
def come_in(running: Running, key: str) -> Iterator[Class]:
    """A class with all of its people; afterwards nobody is there, and both processes are."""
    with ExitStack() as stack:
        klass = Class(running, stack, key)
        klass.come_in()
        yield klass
    quiet(running)
    for ended in [each for each in running.site.processes if each.process.poll() is not None]:
        ended.start_again()
        return_to(ended, running, klass.prefix)


def move(klass: Class, who: Student, seconds: float) -> dict[float, float]:
    """Let somebody move a slider.

    Returns:
        When each value was sent, in the order of sending; each value is greater than the last.
    """
    slider, end = who.fields["K2"], time.monotonic() + seconds
    sent: dict[float, float] = {}
    while time.monotonic() < end:
        value = slider["low"] + (len(sent) + 1) * slider["step"]
        assert value <= slider["high"]
        sent[value] = time.monotonic()
        who.set("K2", value)
        klass.until(lambda: time.monotonic() > sent[value] + EVERY)
    return sent


def lose_the_process(klass: Class, who: Student, seconds: float = LOST) -> None:
    """The process is killed when somebody moves a slider; all come back on the other one.

    Args:
        who: whose slider it is.
        seconds: how long it has been moved by then: what was done before is to be found again.
    """
    site, people = klass.running.site, {who, *klass.names}
    klass.until(lambda: who.values)
    sent = move(klass, who, seconds)
    killed, codes = site.serving(), [each.code for each in people]
    end = time.monotonic()
    killed.kill()
    klass.come_back()
    back = time.monotonic() - end
    assert site.serving() is not killed and [each.code for each in people] == codes
    found = who.value("K2")
    lost = min(
        (end - when for value, when in sent.items() if value == pytest.approx(found)), default=inf
    )
    assert back < BACK and lost < LOST


def choose_the_step(klass: Class) -> None:
    """The teacher looks at the step that asks for a prediction, of the first lesson."""
    klass.teacher.set("class.step", CHOICE)


def wall_of(klass: Class) -> OwnSocket:
    """A wall of the class."""
    return OwnSocket(f"ws://{HOST}/{klass.prefix}/wall", through=klass.running.site.port)


def asked_on(wall: OwnSocket) -> str:
    """The question on a wall, as it was told last."""
    told = (each["asked"] for each in reversed(list(wall.told)) if each["is"] == "wall")
    return next(told, "")


def stopped(klass: Class) -> list[bool]:
    """Which students are told that the teacher has stopped all labs."""
    return [each.sees("stopped all labs") for each in klass.names]


def test_what_students_did_5_s_before_a_kill_is_in_the_class_which_is_back_within_10_s(
    running: Running,
) -> None:
    with come_in(running, KEYS[0]) as klass:
        ada, teacher, until = klass.ada, klass.teacher, klass.until
        choose_the_step(klass)
        teacher.lead("send_step")
        until(lambda: all(each.sees(f"Step {CHOICE + 1} of") for each in klass.names))
        wall = wall_of(klass)
        until(lambda: asked_on(wall) and "frame" in wall.kinds())
        asked = asked_on(wall)
        ada.tell({"do": "Predict", "option": 0})
        until(lambda: ANSWERED in teacher.values.get("class.answers", ""))
        ada.press("Leave the lesson")
        until(lambda: not ada.sees(f"Step {CHOICE + 1} of"))
        lose_the_process(klass, ada, LOST + SETTLED)  # by then the step is known to be given her
        with wall_of(klass) as again:  # as its page does by itself
            until(lambda: asked_on(again) == asked and "frame" in again.kinds())
        choose_the_step(klass)
        until(lambda: ANSWERED in teacher.values.get("class.answers", ""))
        until(lambda: f"step {CHOICE + 1}" in teacher.values["class.standing"])
        until(lambda: klass.bob.sees(f"Step {CHOICE + 1} of"))
        assert not ada.sees(f"Step {CHOICE + 1} of")  # the step is not opened for her once more


def test_what_the_teacher_ordered_5_s_before_a_kill_still_holds(running: Running) -> None:
    with come_in(running, KEYS[1]) as klass:
        klass.teacher.lead("freeze")
        klass.until(lambda: stopped(klass) == [True, True])
        lose_the_process(klass, klass.teacher)  # whose own lab is not stopped
        klass.until(lambda: stopped(klass) == [True, True])
        klass.teacher.lead("thaw")
        klass.until(lambda: stopped(klass) == [False, False])
