"""A file is written whole or not at all, and an error names the file that was asked for."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from onpath.app.common.atomic_file import whole_file


def test_a_file_is_replaced_once_it_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("old", "utf-8")
    with whole_file(file) as scratch:
        scratch.write_text("new", "utf-8")
        assert file.read_text("utf-8") == "old" and scratch.suffix == ".csv"
    assert file.read_text("utf-8") == "new" and list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("named", [True, False])
def test_a_disk_that_fills_up_is_told_with_the_name_of_the_file(
    named: bool, tmp_path: Path
) -> None:
    file = tmp_path / "a.csv"
    with pytest.raises(OSError, match=r"a[.]csv") as caught, whole_file(file) as scratch:
        raise OSError(errno.ENOSPC, "No space left on device", *[str(scratch)] * named)
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(file))
    assert not list(tmp_path.iterdir())


def test_an_error_of_another_file_is_left_alone(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught, whole_file(tmp_path / "a.csv"):
        (tmp_path / "missing").read_bytes()
    assert caught.value.filename == str(tmp_path / "missing")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_takes_no_files_is_told_with_the_name_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "none" / "a.csv"
    with pytest.raises(FileNotFoundError) as caught, whole_file(file):
        pass
    assert caught.value.filename == str(file)
