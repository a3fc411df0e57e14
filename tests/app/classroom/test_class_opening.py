"""The classes of a server follow from the teachers' keys, which nobody sees."""

from __future__ import annotations

import io
import os
import sys
import threading
from pathlib import Path

import platformdirs
import pytest
from typing_extensions import override

from onpath.app.classroom.admission import CODE_LENGTH, class_code_of, class_id_of
from onpath.app.classroom.class_keeper import ClassKeeper
from onpath.app.classroom.class_opening import KEY, MOST, given_keys, key_file, open_classes
from onpath.app.cli.serve import print_classes
from onpath.app.common.access_codes import ALPHABET, new_code, shown
from onpath.app.common.qr_code import qr_text
from onpath.app.storage.records import Records

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
    assert all(set(room.code) <= set(ALPHABET) for room in rooms)
    assert all(len(room.code) == CODE_LENGTH for room in rooms)
    assert len({room.code for room in rooms} | {class_id_of(key) for key in KEYS}) == 4


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's data folder, which does not exist yet."""
    folder = tmp_path / "data"
    monkeypatch.setattr(platformdirs, "user_data_dir", lambda _: str(folder))
    return folder


def test_without_a_key_this_computer_has_a_class_that_stays_the_same(home: Path) -> None:
    (first,), (second,) = open_classes([]), open_classes([])
    assert (first.key, first.code) == (second.key, second.code) and first.key not in KEYS
    if sys.platform != "win32":
        assert key_file().stat().st_mode & 0o777 == 0o600
        assert home.stat().st_mode & 0o777 == 0o700
    key_file().unlink()
    (other,) = open_classes([])
    assert other.key != first.key


@pytest.mark.parametrize("broken", [b"", b"k7mf", b"\xff\x00", b"a\n" * 99])
def test_a_broken_key_is_replaced(home: Path, broken: bytes) -> None:
    open_classes([])
    key_file().write_bytes(broken)
    (first,), (second,) = open_classes([]), open_classes([])
    assert first.key == second.key


def test_without_a_data_folder_there_is_a_class_as_long_as_the_server(home: Path) -> None:
    home.write_text("a file, and no folder", encoding="utf-8")
    (first,), (second,) = open_classes([]), open_classes([])
    assert first.key != second.key


def test_another_process_has_the_class_as_it_was(home: Path) -> None:
    (room,) = open_classes([])
    records = Records()
    keeper = ClassKeeper(room, records, lambda: None)
    assert keeper.open()
    teacher = room.admit(shown(room.key), "desk")
    room.join("a" * 12, room.code, "Ada")
    keeper.check()
    records.give_up()
    records.close()
    (again,) = open_classes([])
    records = Records()
    assert ClassKeeper(again, records, lambda: None).open()
    assert [member.name for member in again.members().values()] == ["Ada"]
    assert again.code == room.code and again.is_pass(teacher)
    records.close()


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


def test_keys_that_were_given_are_not_printed_and_addresses_are(
    capsys: pytest.CaptureFixture[str],
) -> None:
    print_classes(open_classes(KEYS), "https://lab.example.org", key_is_known=True)
    said = capsys.readouterr().out
    for line, key, number in zip(said.splitlines(), KEYS, (1, 2), strict=True):
        assert f"https://lab.example.org/c/{class_code_of(key)}/" in line
        assert line.endswith(f"teacher's key {number}")
        assert key not in said and shown(key) not in said


@pytest.mark.parametrize(
    ("site", "encoding", "is_shown"),
    [
        ("http://192.0.2.7:8080", "utf-8", True),
        ("http://192.0.2.7:8080", "cp1252", False),
        ("http://localhost:8080", "utf-8", False),
        ("http://[::1]:8080", "utf-8", False),
    ],
)
def test_a_terminal_shows_the_address_as_a_qr_code_if_a_phone_can_open_it(
    home: Path, monkeypatch: pytest.MonkeyPatch, site: str, encoding: str, is_shown: bool
) -> None:
    terminal = io.TextIOWrapper(io.BytesIO(), encoding)
    monkeypatch.setattr(terminal, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stdout", terminal)
    (room,) = open_classes([])
    print_classes([room], site, key_is_known=False)
    terminal.seek(0)
    said = terminal.read()
    assert f"{site}/c/{room.code}/" in said and shown(room.key) not in said
    assert str(key_file()) in said
    assert (qr_text(f"{site}/c/{room.code}/") in said) == is_shown
    assert ("--host 0.0.0.0" in said) == ("192" not in site)


class Terminal(io.StringIO):
    """A terminal on which somebody types."""

    @override
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_the_key_when_somebody_presses_enter(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (room,) = open_classes([])
    for typed, is_shown in (("\n", True), ("", False)):  # Enter, and the end of the input
        terminal = Terminal()
        monkeypatch.setattr(sys, "stdout", terminal)
        monkeypatch.setattr(sys, "stdin", Terminal(typed))
        print_classes([room], "http://192.0.2.7:8080", key_is_known=False)
        for thread in [each for each in threading.enumerate() if each.name == "key"]:
            thread.join()
        assert (shown(room.key) in terminal.getvalue()) == is_shown


def test_a_key_that_no_file_has_is_printed(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (room,) = open_classes([])
    key_file().unlink()
    print_classes([room], "http://192.0.2.7:8080", key_is_known=False)
    assert shown(room.key) in capsys.readouterr().out


def test_a_class_without_an_output_to_print_on_is_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdout", None)
    print_classes(open_classes(KEYS[:1]), "https://lab.example.org", key_is_known=True)
