"""The project's architecture rules, checked on the syntax trees."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
import viser

from onpath.models.systems.catalogue import ROBOTS
from tests.support.checkout import ROOT
from tests.support.private_names import foreign_private_names, is_private, own_names

TOPS = ("app", "models", "lessons", "assets")
# Every folder may import those that stand below it here, and nothing else of the project.
ORDER = [
    "app.cli",
    "app.server",
    "app.plant",
    "app.notebook",
    "app.exports",
    "app.classroom",
    "app.scene",
    "app.simulation",
    "app.storage",
    "app.view",
    "app.channel",
    "app.lab",
    "app.viser_adapter",
    "app.steps",
    "app.common",
    "lessons",
    "models.path_files",
    "models.studies",
    "models.standalone",
    "models.controller",
    "models.closed_loop",
    "models.control",
    "models.systems",
    "models.robot_files",
    "models.paths",
    "models",
    "assets",
]
MATHEMATICS = ("models", "lessons")
FOREIGN = {"viser", "threading", "time", "asyncio", "datetime", "random"}
DRAWING = ("app.scene",)
LIVE = ("lab", "simulation", "history", "lesson_run", "snapshots.take_snapshot")
"""Modules of app.lab that know a lab as it lives: what draws is given snapshots of it."""


@cache
def sources() -> list[Path]:
    files = [file for folder in TOPS for file in (ROOT / folder).rglob("*.py")]
    assert len(files) > 10
    return sorted(files)


def offenders(fault: Callable[[Path], object]) -> list[str]:
    """Files with a fault, and what it is."""
    found = {file.relative_to(ROOT): fault(file) for file in sources()}
    return [f"{file}: {told}" for file, told in found.items() if told]


@cache
def parse(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def imports(tree: ast.AST) -> Iterator[str]:
    """Dotted names of the modules that a module imports, wherever in it, for types too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def packages(tree: ast.AST) -> set[str]:
    """Top-level packages that a module imports."""
    return {name.partition(".")[0] for name in imports(tree)}


def folder_of(name: str) -> str:
    """The folder of `ORDER` in which a module of the project lies."""
    name = name.removeprefix("onpath.")
    return next(
        (
            folder
            for folder in sorted(ORDER, key=len, reverse=True)
            if name == folder or name.startswith(folder + ".")
        ),
        name,
    )


def module_of(file: Path) -> str:
    return ".".join(file.relative_to(ROOT).with_suffix("").parts)


def test_imports_go_down_the_list_of_folders() -> None:
    def upward(file: Path) -> set[str]:
        own = folder_of(module_of(file))
        below = ORDER[ORDER.index(own) :] if own in ORDER else []
        ours = {folder_of(name) for name in imports(parse(file)) if name.startswith("onpath.")}
        return ours - {*below, own}

    assert offenders(upward) == []


def test_the_project_is_imported_as_one_package() -> None:
    assert offenders(lambda file: packages(parse(file)) & {*TOPS, "tests"}) == []


def graph() -> dict[str, set[str]]:
    """The project's modules that each of them imports."""
    files = {module_of(file).removesuffix(".__init__"): file for file in sources()}
    edges: dict[str, set[str]] = {}
    for module, file in files.items():
        wanted = [name.removeprefix("onpath.") for name in imports(parse(file))]
        inner = {name if name in files else name.rpartition(".")[0] for name in wanted}
        edges[module] = inner & set(files) - {module}
    return edges


def folder_graph() -> dict[str, set[str]]:
    """The folders from which each folder's modules import; a folder may use what is inside it."""
    edges: dict[str, set[str]] = {}
    for module, inner in graph().items():
        own = place_of(module)
        others = {place_of(each) for each in inner}
        wanted = {each for each in others if each != own and not each.startswith(f"{own}.")}
        edges.setdefault(own, set()).update(wanted)
    return edges


def place_of(module: str) -> str:
    """The folder of a module; a package is its own."""
    is_package = (ROOT / module.replace(".", "/") / "__init__.py").is_file()
    return module if is_package else module.rpartition(".")[0]


def in_circles(edges: dict[str, set[str]]) -> set[str]:
    """Modules or folders that import each other, directly or by way of others."""
    while free := [module for module, inner in edges.items() if not inner & set(edges)]:
        for module in free:
            del edges[module]
    while free := [m for m in edges if not any(m in inner for inner in edges.values())]:
        for module in free:
            del edges[module]
    return set(edges)


def test_no_module_imports_itself_by_way_of_others() -> None:
    assert in_circles(graph()) == set()


def test_no_folder_imports_itself_by_way_of_others() -> None:
    assert in_circles(folder_graph()) == set()


def test_no_class_name_is_used_twice() -> None:
    named = Counter(
        node.name
        for file in sources()
        for node in parse(file).body
        if isinstance(node, ast.ClassDef)
    )
    assert [name for name, count in named.items() if count > 1] == []


def branches(tree: ast.AST) -> Iterator[ast.expr]:
    """What decides which way a module goes, and which values a list has."""
    for node in ast.walk(tree):
        if isinstance(node, (ast.If, ast.IfExp)):
            yield node.test
        elif isinstance(node, ast.comprehension):
            yield from node.ifs


def robots_by_name(tree: ast.AST) -> list[str]:
    """Branches that know a robot of the catalogue by its name."""
    return [
        ast.unparse(each)
        for condition in branches(tree)
        for each in ast.walk(condition)
        if isinstance(each, ast.Compare)
        and any(isinstance(part, ast.Constant) and part.value in ROBOTS for part in ast.walk(each))
    ]


@pytest.mark.thorough
def test_no_test_makes_an_exception_for_a_robot_by_its_name() -> None:
    """A law for every robot asks what kind it is: a new one may be of that kind, too."""
    files = sorted((ROOT / "tests").rglob("*.py"))
    found = {file.name: robots_by_name(parse(file)) for file in files}
    assert {name: found for name, found in found.items() if found} == {}
    assert robots_by_name(ast.parse("x = 1 if robot.name != 'five_bar' else 2"))
    assert robots_by_name(ast.parse("y = [n for n in ROBOTS if n not in ('flexible', 'other')]"))


def test_the_simulated_lab_knows_nothing_of_its_user() -> None:
    edges, needed, new = graph(), set[str](), {"app.lab.simulation"}
    while new:
        needed |= new
        new = {module for each in new for module in edges[each]} - needed
    assert {folder_of(module).partition(".")[0] for module in needed} <= {"app", "models", "assets"}
    assert not needed & {"app.lab.lab", "app.lab.commands", "app.lab.lesson_run"}


def test_what_draws_knows_no_lab_but_snapshots() -> None:
    live = tuple(f"app.lab.{module}." for module in LIVE)

    def known(file: Path) -> set[str]:
        if folder_of(module_of(file)) not in DRAWING:
            return set()
        tree = parse(file)
        modules = {f"{name.removeprefix('onpath.')}." for name in imports(tree)}
        attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
        simulation = "app.simulation.simulation_thread"
        return {m for m in modules if m.startswith((simulation, *live))} | (
            attributes & {"lab", "simulation"}
        )

    assert offenders(known) == []


def test_mathematics_knows_no_viewer_thread_or_clock() -> None:
    def foreign(file: Path) -> set[str]:
        is_pure = file.relative_to(ROOT).parts[0] in MATHEMATICS
        return packages(parse(file)) & FOREIGN if is_pure else set()

    assert offenders(foreign) == []


ADAPTER = "app.viser_adapter"
INSIDE = ("viser", "websockets", "asyncio")


@cache
def names_of_viser() -> frozenset[str]:
    """The private names that viser's own modules define, by which its objects are known."""
    folder = Path(viser.__file__).parent
    files = [file for file in folder.rglob("*.py") if "client" not in file.parts]
    found = {name for file in files for name in own_names(parse(file))}
    return frozenset(name for name in found if is_private(name))


def private_parts(tree: ast.AST) -> list[str]:
    """What a module uses of the private parts of viser and of what viser is made of."""
    named = [name for name in imports(tree) if name.partition(".")[0] in INSIDE]
    modules = [
        name
        for name in named
        if name.startswith(("websockets", "viser.infra")) or any(map(is_private, name.split(".")))
    ]
    bases = [
        ast.unparse(base)
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        for base in node.bases
    ]
    subclasses = [base for base in bases if base.startswith("viser.")]
    return [*modules, *subclasses, *foreign_private_names(tree, names_of_viser())]


@pytest.mark.thorough
def test_only_the_adapter_uses_private_parts_of_viser() -> None:
    def touched(file: Path) -> list[str]:
        folder = folder_of(module_of(file))
        is_elsewhere = folder.startswith("app.") and folder != ADAPTER
        return private_parts(parse(file)) if is_elsewhere else []

    assert offenders(touched) == []
    assert offenders(lambda file: is_outside_app(file) and "viser" in packages(parse(file))) == []


def is_outside_app(file: Path) -> bool:
    return file.relative_to(ROOT).parts[0] != "app"


@pytest.mark.parametrize(
    "text",
    [
        "from viser._messages import HotkeyKey",
        "from viser import _messages as wire",
        "import viser._viser",
        "from viser.infra import WebsockServer",
        "from websockets.frames import CloseCode",
        "loop.call(server._websock_server.stop)",
        "class A:\n    def f(self, client):\n        self._loop = client._websock_connection",
        "class A:\n    def __init__(self, s):\n        self._event_loop = s._event_loop",
        "class Film(viser.ViserServer):\n    pass",
        "getattr(handle, '_impl')",
        "transport._read_ready_cb = None",
    ],
)
def test_uses_of_private_parts_would_be_noticed(text: str) -> None:
    assert private_parts(ast.parse(text))


def test_public_parts_and_own_private_names_are_no_private_parts() -> None:
    assert {"_websock_server", "_impl", "_live_connections", "_thread_executor"} <= names_of_viser()
    public = "import viser\nfrom viser import transforms\nserver.on_client_connect(self._greet)"
    own = "class A:\n    def copy(self, other):\n        self._rows = other._rows"
    assert private_parts(ast.parse(public)) == private_parts(ast.parse(own)) == []


def test_rules_would_notice() -> None:
    bad = ast.parse("import threading\nfrom viser import x\ndef f():\n    import app.cli.main\n")
    assert packages(bad) == {"threading", "viser", "app"}
    assert folder_of("onpath.app.lab.simulation") == "app.lab"
    assert folder_of("onpath.models.arrays.Array") == "models"
    first = sources()[0].relative_to(ROOT)
    assert offenders(lambda file: file == sources()[0] and "bad") == [f"{first}: bad"]
