"""Names with a leading underscore that a module uses of objects that are not its own."""

from __future__ import annotations

import ast
from collections.abc import Iterator

PUBLIC = {"_asdict", "_exit", "_replace"}
"""Of named tuples and of os: documented, in spite of their names."""
BY_NAME = ("getattr", "setattr", "hasattr", "delattr")


def is_private(name: str) -> bool:
    """Whether a name begins with one underscore, and is not one of `PUBLIC`."""
    return name.startswith("_") and not name.startswith("__") and name not in PUBLIC


def own_names(tree: ast.AST) -> set[str]:
    """Names that a module defines: functions, classes, fields, and attributes of self and cls."""
    found = set[str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.add(node.target.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and _is_own(node):
            found.add(node.attr)
    return found


def foreign_private_names(tree: ast.AST, forbidden: frozenset[str] = frozenset()) -> Iterator[str]:
    """Private names that a module uses of others' objects.

    An object of which nothing is known but its name may be one of the module's own classes, if that
    defines the name, too.

    Args:
        forbidden: names that no object but self may be asked for, even if the module defines them.
    """
    own = own_names(tree) - forbidden
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and not _is_own(node):
            names = [node.attr]
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") in BY_NAME:
            texts = [each.value for each in node.args if isinstance(each, ast.Constant)]
            names = [text for text in texts if isinstance(text, str)]
        else:
            continue
        yield from (name for name in names if is_private(name) and name not in own)


def _is_own(node: ast.Attribute) -> bool:
    value = node.value
    is_self = isinstance(value, ast.Name) and value.id in ("self", "cls")
    is_super = isinstance(value, ast.Call) and getattr(value.func, "id", "") == "super"
    return is_self or is_super
