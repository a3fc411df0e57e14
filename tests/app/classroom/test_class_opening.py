"""The classes of a server follow from the teachers' keys, which nobody sees."""

from __future__ import annotations

import os

import pytest

from onpath.app.classroom.admission import CODE_LENGTH, class_code_of, class_id_of
from onpath.app.classroom.class_opening import KEY, MOST, given_keys, open_classes
from onpath.app.cli.serve import Serve
from onpath.app.common.access_codes import ALPHABET, new_code, shown

KEYS = ["k7mf2xqa9tzr", "bn4ws8cd3vyp"]


@pytest.mark.parametrize("between", [" ", ",", ", ", "\n"])
def test_each_key_has_a_class_whose_code_every_process_finds(
    monkeypatch: pytest.MonkeyPatch, between: str
) -> None:
    monkeypatch.setenv(KEY, between.join([shown(KEYS[0]).upper(), KEYS[1], KEYS[0]]))
    assert given_keys() == KEYS
    assert KEY not in os.environ  # no child inherits it
    rooms = open_classes(KEYS)
    assert [room.code for room in rooms] == [class_code_of(key) for key in KEYS]
    assert all(room.has_address and set(room.code) <= set(ALPHABET) for room in rooms)
    assert all(len(room.code) == CODE_LENGTH for room in rooms)
    assert len({room.code for room in rooms} | {class_id_of(key) for key in KEYS}) == 4


def test_without_a_key_there_is_one_class_with_a_key_of_its_own() -> None:
    (first,), (second,) = open_classes([]), open_classes([])
    assert not first.has_address and first.key != second.key and first.code != second.code


@pytest.mark.parametrize("typed", ["short", "k7mf2xqa9tz0", f"{KEYS[0]} x"])
def test_a_malformed_key_is_refused_without_being_repeated(
    monkeypatch: pytest.MonkeyPatch, typed: str
) -> None:
    monkeypatch.setenv(KEY, typed)
    with pytest.raises(ValueError, match="12 letters and digits") as refused:
        given_keys()
    assert typed not in str(refused.value)


def test_there_are_not_too_many_classes() -> None:
    with pytest.raises(ValueError, match="at most"):
        open_classes([new_code() for _ in range(MOST + 1)])


def test_a_key_that_was_given_is_not_printed_and_an_address_is(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(KEY, KEYS[0])
    Serve(classroom=True, origin=("https://lab.example.org",))._classrooms()
    said = capsys.readouterr().out
    assert f"https://lab.example.org/c/{class_code_of(KEYS[0])}/" in said
    assert KEYS[0] not in said and shown(KEYS[0]) not in said and "key" not in said
