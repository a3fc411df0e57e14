"""The house's rules, read from the syntax trees."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MAY_IMPORT = {
    "assets": set[str](),
    "models": {"assets"},
    "lessons": {"assets", "models"},
    "app": {"assets", "models", "lessons"},
}
MATHEMATICS = ("models", "lessons")
FOREIGN = {"viser", "threading", "time", "asyncio", "datetime", "random"}
PRINTING = {"app/cli.py", "app/cli_serve.py", "app/cli_experiment.py", "app/bench.py"}
LONGEST = 40


def sources() -> list[Path]:
    files = [file for folder in MAY_IMPORT for file in (ROOT / folder).rglob("*.py")]
    assert len(files) > 10
    return sorted(files)


FILES = pytest.mark.parametrize("file", sources(), ids=lambda file: str(file.relative_to(ROOT)))


def imports(tree: ast.AST) -> Iterator[str]:
    """Top-level packages that a module imports, wherever in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative import"
            yield (node.module or "").partition(".")[0]


def parse(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


@FILES
def test_imports_go_one_way(file: Path) -> None:
    package = file.relative_to(ROOT).parts[0]
    inner = set(imports(parse(file))) & set(MAY_IMPORT)
    assert inner <= MAY_IMPORT[package] | {package}


@FILES
def test_mathematics_knows_no_viewer_thread_or_clock(file: Path) -> None:
    if file.relative_to(ROOT).parts[0] in MATHEMATICS:
        assert not set(imports(parse(file))) & FOREIGN


@FILES
def test_only_the_command_line_prints(file: Path) -> None:
    names = {node.id for node in ast.walk(parse(file)) if isinstance(node, ast.Name)}
    assert "print" not in names or str(file.relative_to(ROOT)) in PRINTING


def lines(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines of a function without its docstring."""
    assert function.end_lineno is not None
    total = function.end_lineno - function.lineno + 1
    first = function.body[0]
    if ast.get_docstring(function) is not None and first.end_lineno is not None:
        total -= first.end_lineno - first.lineno + 1
    return total


@FILES
def test_functions_are_short(file: Path) -> None:
    long = {
        node.name: lines(node)
        for node in ast.walk(parse(file))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and lines(node) >= LONGEST
    }
    assert not long


@FILES
def test_modules_and_public_functions_say_what_they_are(file: Path) -> None:
    tree = parse(file)
    if not tree.body:
        return
    assert ast.get_docstring(tree)
    silent = [
        node.name
        for node in tree.body
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
        and not node.name.startswith("_")
        and not ast.get_docstring(node)
    ]
    assert not silent


def test_rules_would_notice() -> None:
    bad = ast.parse("import threading\nfrom viser import x\ndef f():\n    import app.cli\n")
    assert set(imports(bad)) == {"threading", "viser", "app"}
    long = ast.parse("def f():\n    '''a\n    b'''\n" + "    x = 1\n" * 50).body[0]
    assert isinstance(long, ast.FunctionDef) and lines(long) == 51
