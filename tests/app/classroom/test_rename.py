"""A teacher renames and removes members, and shows how others join."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.classroom import class_html as page
from onpath.app.classroom.classroom import Classroom
from onpath.app.common.visible_text import comparison_key
from onpath.lessons.words import ENGLISH

HOSTILE = '"><script>alert(1)</script>'
ADDRESS = "http://192.0.2.7:8080/c/m63eyz/"


@pytest.mark.thorough
@given(st.lists(st.tuples(st.integers(0, 4), st.text(max_size=40)), max_size=8))
def test_however_members_are_renamed_they_are_told_apart(renamings: list[tuple[int, str]]) -> None:
    room = Classroom(key="k7mf2xqa9tzr")
    for i in range(4):
        room.join(f"lab {i}", room.code, "Ada")
    numbers = [member.number for member in room.members().values()]
    for i, name in renamings:
        before = room.members()
        try:
            room.rename(f"lab {i}", name)
        except ValueError:  # nothing visible
            assert room.members() == before
    names = [member.name for member in room.members().values()]
    assert len({comparison_key(name) for name in names}) == 4 and all(names)
    assert [member.number for member in room.members().values()] == numbers


def test_a_member_who_was_removed_leaves_the_name_to_others_and_may_come_back() -> None:
    room = Classroom()
    for lab, name in (("old", "Hana"), ("new", "Hana")):
        room.join(lab, room.code, name)
    room.leave("old")
    room.rename("new", "Hana")
    assert {lab: member.name for lab, member in room.members().items()} == {"new": "Hana"}
    room.rename("old", "Eve")  # who is not there any more
    assert "old" not in room.members()
    assert room.join("old", room.code, "Hana").name == "Hana 2"


@pytest.mark.parametrize("large", [False, True])
def test_the_projection_shows_how_to_join(large: bool) -> None:
    shown = page.class_code(ADDRESS, False, "m63eyz", 3, ENGLISH, large)
    assert ADDRESS in shown.replace("<wbr>", "") and "M63EYZ" in shown and "3 in the class" in shown
    assert shown.count("<svg") == 1 and ENGLISH("class.qr") in shown


def test_no_qr_code_leads_phones_to_themselves() -> None:
    shown = page.class_code("http://localhost:8080/c/m63eyz/", True, "m63eyz", 0, ENGLISH)
    assert "<svg" not in shown and "--host 0.0.0.0" in shown


def test_an_address_is_only_text() -> None:
    shown = page.class_code(f"https://x/{HOSTILE}", False, "m63eyz", 0, ENGLISH)
    assert "<script" not in shown
