"""The check of the parts of viser that we touch, on the installed viser and on doctored ones."""

from __future__ import annotations

import ast
import logging
import re
import shutil
from collections import deque
from collections.abc import Iterator
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest
import viser

from onpath.app.common import error_log
from onpath.app.viser_adapter import viser_parts
from onpath.app.viser_adapter.viser_parts import PAGE, TESTED, TOUCHED, untested_parts
from tests.support.checkout import ROOT
from tests.support.private_names import foreign_private_names

INSTALLED = Path(viser.__file__).parent
ADAPTER = ROOT / "app/viser_adapter"


@pytest.fixture
def doctored(tmp_path: Path) -> Path:
    """A copy of what is looked at in viser."""
    for file in ("__init__.py", PAGE, *TOUCHED):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(INSTALLED / file, tmp_path / file)
    return tmp_path


def change(file: Path, old: str, new: str) -> None:
    """Replace a text wherever it occurs in a file."""
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_the_tested_viser_has_all_that_we_touch(doctored: Path) -> None:
    assert (untested_parts(doctored) == []) == (viser.__version__ == TESTED)


def test_another_version_is_named(doctored: Path) -> None:
    change(doctored / "__init__.py", f'"{viser.__version__}"', '"1.1.9"')
    assert f"viser 1.1.9 is untested, {TESTED} is tested" in untested_parts(doctored)


@pytest.mark.parametrize("file", TOUCHED)
def test_a_missing_name_is_named_with_its_file(doctored: Path, file: str) -> None:
    name = TOUCHED[file].split()[-1]
    change(doctored / file, name, "renamed")
    assert f"{file} has no {name}" in untested_parts(doctored)


def test_a_missing_module_is_named(doctored: Path) -> None:
    (doctored / "_scene_handles.py").unlink()
    names = ", ".join(TOUCHED["_scene_handles.py"].split())
    assert f"_scene_handles.py has no {names}" in untested_parts(doctored)


def test_another_page_is_noticed(doctored: Path) -> None:
    change(doctored / PAGE, "<title>Viser</title>", "<title>viser</title>")
    assert "its page is not the tested one" in untested_parts(doctored)
    (doctored / PAGE).unlink()
    assert "its page is missing" in untested_parts(doctored)


def test_a_start_with_another_viser_logs_one_line_and_goes_on(
    doctored: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    change(doctored / "__init__.py", f'"{viser.__version__}"', '"1.1.9"')
    change(doctored / "_scene_handles.py", "click_cb", "renamed")
    package = ModuleSpec("viser", None, is_package=True)
    package.submodule_search_locations = [str(doctored)]
    monkeypatch.setattr(viser_parts, "find_spec", lambda _: package)
    monkeypatch.setattr(error_log, "_warned", deque(maxlen=10))  # others have warned as well
    with caplog.at_level(logging.WARNING):
        viser_parts.check_viser()
    (record,) = caplog.records
    assert "viser 1.1.9 is untested" in record.getMessage()
    assert "_scene_handles.py has no click_cb" in record.getMessage()


def touched_names(file: Path) -> Iterator[str]:
    """Names of viser's private parts in a module: attributes, and what it takes from modules."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    modules = set[str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("viser"):
            private_module = any(part.startswith("_") for part in (node.module or "").split("."))
            yield from (alias.name for alias in node.names if private_module)
            private = [each for each in node.names if each.name.startswith("_")]
            modules |= {alias.asname or alias.name for alias in private}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", "") in modules:
            yield node.attr
    yield from foreign_private_names(tree)


def test_the_table_has_every_private_part_that_the_adapter_uses() -> None:
    known = {name for names in TOUCHED.values() for name in names.split()}
    used = {name for file in ADAPTER.glob("*.py") for name in touched_names(file)}
    assert len(used) > 30
    assert used - known - {"_read_ready_cb"} == set()


def test_the_table_has_nothing_that_the_adapter_no_longer_uses() -> None:
    files = [file for file in ADAPTER.glob("*.py") if file.name != "viser_parts.py"]
    used = {name for file in files for name in re.findall(r"\w+", file.read_text("utf-8"))}
    assert {name for names in TOUCHED.values() for name in names.split()} <= used
