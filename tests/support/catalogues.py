"""The catalogues of messages as syntax trees."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from fluent.syntax import FluentParser, ast

from onpath.assets import asset_path

COMPLETE = ("en", "de")
"""Languages in which everything is said. Another one may be begun: what it lacks is in English."""


@lru_cache
def entries(language: str) -> tuple[ast.EntryType, ...]:
    """All entries of a language's file in order; invalid syntax is `ast.Junk`."""
    text = (asset_path("words") / f"{language}.ftl").read_text("utf-8")
    return tuple(FluentParser().parse(text).body)


@lru_cache
def messages(language: str) -> dict[str, ast.Message]:
    """Messages by identifier."""
    return {each.id.name: each for each in entries(language) if isinstance(each, ast.Message)}


def arguments(message: ast.Message) -> set[str]:
    """Names of a message's arguments."""
    found = _nodes(message)
    return {node.id.name for node in found if isinstance(node, ast.VariableReference)}


def counts(message: ast.Message) -> set[str]:
    """Names of the arguments that select a plural form."""
    return {
        node.selector.id.name
        for node in _nodes(message)
        if isinstance(node, ast.SelectExpression)
        and isinstance(node.selector, ast.VariableReference)
        and any(getattr(variant.key, "name", "") == "one" for variant in node.variants)
    }


def _nodes(node: object) -> Iterator[ast.BaseNode]:
    if isinstance(node, ast.BaseNode):
        yield node
        for inner in vars(node).values():
            yield from _nodes(inner)
    elif isinstance(node, list):
        for item in node:
            yield from _nodes(item)
