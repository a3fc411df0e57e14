"""A digest of what a custom law is made of, which is the same in another process."""

from __future__ import annotations

import hashlib
import io
from types import CodeType
from typing import Any

import cloudpickle
from typing_extensions import override

OF_A_CLASS = ("__dict__", "__weakref__", "__firstlineno__", "__static_attributes__", "__module__")
"""Members of a class that depend on where it stands."""


def digest(value: Any) -> str:
    """A digest of code and numbers: of a function, a class or an object, with what they refer to.

    It does not depend on the lines in which the code stands, so that a notebook that is run again
    gives the same one. What is imported counts by its name alone.

    Raises:
        TypeError, PicklingError: something cannot be pickled.
    """
    file = io.BytesIO()
    _Contents(file).dump(value)
    return hashlib.sha256(file.getvalue()).hexdigest()


class _Contents(cloudpickle.Pickler):
    @override
    def reducer_override(self, obj: Any) -> Any:
        if isinstance(obj, CodeType):
            code = (obj.co_code, obj.co_consts, obj.co_names, obj.co_varnames)
            return tuple, ((*code, obj.co_freevars, obj.co_argcount, obj.co_flags),)
        found: Any = super().reducer_override(obj)
        if isinstance(obj, type) and isinstance(found, tuple):  # it cannot be imported
            members = {name: each for name, each in vars(obj).items() if name not in OF_A_CLASS}
            return _none, (obj.__name__, obj.__bases__), members  # which may refer to the class
        return found


def _none(*_: Any) -> None:
    """Stands for a class; a digest is never read."""
