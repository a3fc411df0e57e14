"""The supplied nginx configuration, in front of two real processes, one of which is killed."""

from __future__ import annotations

import re
from contextlib import ExitStack

import pytest
from websockets.exceptions import InvalidStatus

from onpath.app.common.access_codes import new_code, shown
from tests.support.site import ORIGIN, needs_nginx
from tests.support.site_class import CODES, KEYS, Class, Running, quiet, return_to

pytestmark = [pytest.mark.thorough, needs_nginx]

LESSON = "08-challenge"  # whose second step is a prediction


def alone(running: Running) -> str:
    """The place of a new browser in no class."""
    reply = running.site.get()
    location = reply.getheader("Location") or ""
    assert reply.status == 302 and re.fullmatch("/l/[a-z0-9]{12}/", location)
    return location.strip("/")


def test_who_belongs_together_is_served_by_one_process_and_places_are_spread(
    running: Running,
) -> None:
    served: dict[str, set[int]] = {}
    while len(served) < 6 or len(set.union(*served.values())) < 2:
        assert len(served) < 40  # by chance all would be with one process once in 2^39 times
        prefix = alone(running)
        for _ in range(2):
            with running.site.student(prefix) as student:
                student.open()
                student.read(lambda: student.code)
                served.setdefault(prefix, set()).add(running.site.serving().port)
            quiet(running)
    assert all(len(ports) == 1 for ports in served.values())


def test_strangers_and_monsters_are_refused(running: Running) -> None:
    get = running.site.get
    for origin in ("https://evil.example", f"{ORIGIN}.evil.example", "null"):
        with pytest.raises(InvalidStatus) as refused:
            running.site.student(alone(running), origin).open()
        assert refused.value.response.status_code == 403
    assert get("/", host="evil.example").status == 421
    assert get("/", X="x" * 20_000).status == 400
    assert get("/" + "x" * 5_000).status == 414
    for path in ("/..%2f..%2fetc/passwd", f"/c/{CODES[0]}/..%2f..%2fetc/passwd"):
        assert get(path).status in (400, 404)
    assert get("/health").status == 200
    page = get(f"/c/{CODES[0]}/")
    assert page.status == 200 and b"<html" in page.read(400).lower()
    assert get(f"/c/{CODES[0].upper()}/").getheader("Location") == f"/c/{CODES[0]}/"


def test_a_student_whose_process_is_killed_goes_on_with_the_other(running: Running) -> None:
    prefix = alone(running)
    with running.site.student(prefix) as student:
        student.open()
        student.set("K2", 44.0)
        student.set("path", "clover")
        student.tell({"do": "OpenLesson", "name": LESSON})
        student.press("Next")
        student.read(lambda: student.sees("Step 2 of"))
        student.tell({"do": "Predict", "option": 1})
        student.read(lambda: student.has_button("Next") and not student.has_button("Commit"))
        kept = ("{'item': '1', ", "'K2': 44.0", "'clover'")
        student.read(lambda: running.has_kept(student.code, *kept))
        killed, code = running.site.serving(), student.code
        killed.kill()
        student.wait_until_closed()
        student.reopen()
        student.read(lambda: student.sees("Step 2 of"))
        assert running.site.serving() is not killed and student.code == code
        student.read(lambda: student.has_button("Next"))
        assert not student.has_button("Commit") and not student.has_button("Skip")  # predicted
        student.press("Leave the lesson")
        student.read(lambda: not student.sees("Step 2 of"))
        student.read(
            lambda: student.values.get("path") == "clover" and student.values["K2"] == 44.0
        )
        killed.start_again()
    quiet(running)
    return_to(killed, running, prefix)


def test_a_class_whose_process_is_killed_goes_on_with_the_other_and_stays(
    running: Running,
) -> None:
    with ExitStack() as stack:
        klass = Class(running, stack)
        klass.come_in()
        ada, bob, until, lead = klass.ada, klass.bob, klass.until, klass.teacher.lead
        codes = [ada.code, bob.code]
        lead("send_step")
        until(lambda: ada.sees("Step 1 of") and bob.sees("Step 1 of"))
        ada.press("Next")
        until(lambda: ada.sees("Step 2 of"))
        until(lambda: {each["taken"] for each in running.kept_class().get("members", [])} == {1})
        until(lambda: running.has_kept(ada.code, "'step': 1"))
        lead("freeze")
        until(lambda: bob.sees("stopped all labs"))
        until(lambda: running.kept_class().get("frozen"))
        killed = running.site.serving()
        killed.kill()
        klass.come_back()
        assert running.site.serving() is not killed and [ada.code, bob.code] == codes
        until(lambda: ada.sees("Step 2 of") and ada.sees("stopped all labs"))
        until(lambda: bob.sees("Step 1 of") and bob.sees("stopped all labs"))
        lead("thaw")
        until(lambda: not bob.sees("stopped all labs"))
        # The class stays where it is, also when somebody new is sent to the first process.
        killed.start_again()
        with running.site.student(f"c/{CODES[0]}") as late:
            late.reopen()
            klass.open = [*klass.all, late]
            until(lambda: late.code and late.may_join)
            assert not killed.connections() and [ada.code, bob.code] == codes
    quiet(running)


def test_a_class_is_joined_at_its_own_address_only(running: Running) -> None:
    with running.site.student(alone(running)) as student:
        student.open()
        assert student.join("", CODES[1])["address"] == f"../../c/{CODES[1]}/"
        assert student.teach(shown(KEYS[0]))["address"] == f"../../c/{CODES[0]}/"
        assert "not the teacher" in student.teach(shown(new_code()))["why"]
    with running.site.student("c/234567") as other:  # no class's
        other.open()
        assert "not the class code" in other.join("Eve")["why"]
    quiet(running)
