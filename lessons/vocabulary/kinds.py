"""Faults in the kind of a value: a string in place of a number or a switch."""

from __future__ import annotations

from collections.abc import Iterator

from onpath.lessons.action_schema import Value
from onpath.models.systems.parameter_specs import Spec


def kind_faults(name: str, value: Value, spec: Spec) -> Iterator[str]:
    """The fault of a number in quotes, which a lab's own files and links would read as a number."""
    text = any(isinstance(option, str) for option in spec.options)
    if isinstance(value, str) and not text:
        what = "true or false" if spec.kind == "switch" else "a number"
        yield f"{name} = {value!r}: {what} stands without quotes"
