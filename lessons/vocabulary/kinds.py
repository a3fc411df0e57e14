"""Faults in the kind of a value: a string in place of a number."""

from __future__ import annotations

from collections.abc import Iterator

from onpath.lessons.action_schema import Value
from onpath.models.systems.parameter_specs import Spec


def kind_faults(name: str, value: Value, spec: Spec) -> Iterator[str]:
    """The fault of a number in quotes, which a lab's own files and links would read as a number."""
    numeric = not any(isinstance(option, str) for option in spec.options)
    if numeric and isinstance(value, str):
        yield f"{name} = {value!r}: a number stands without quotes"
