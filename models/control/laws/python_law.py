"""Custom laws in Python: an object with `command(view)`, or a function that is called."""

from __future__ import annotations

import copy
import dataclasses
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from importlib.util import module_from_spec, spec_from_file_location
from inspect import getdoc
from pathlib import Path
from types import ModuleType
from typing import Any

import cloudpickle

from onpath.models.arrays import Array
from onpath.models.control.laws.law import ControlAction, Law, OwnGain, View
from onpath.models.control.laws.law_digest import digest
from onpath.models.control.laws.law_error import error_in
from onpath.models.control.laws.path_following import followed
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name

CALLED = "called"
"""The field of a law's memory that holds the result of its function."""
MOST = 3  # numbers that a function returns
IN_FILE = re.compile(r"(?P<file>.+\.py):(?P<name>[^\W\d]\w*)")
GIVEN = {f.name for f in dataclasses.fields(Law)} - {"name", "command", "origin", "called"}
"""Fields of `Law` that an object may have besides its name and its command."""


@dataclass(frozen=True, slots=True)
class Now:
    """The argument of a law that is a function, which is called once in every control interval.

    As for other laws, all quantities are those that the controller knows, predicted to the middle
    of the tick. p is the number of outputs, n that of coordinates.

    Attributes:
        t: time since the start, [s].
        interval: until the next call, [s].
        q, v: coordinates and their rates, each shape (n,).
        y, y_rate: the controlled output and its rate, each shape (p,), [m], [m/s].
        theta, theta_rate: parameter of the closest point, [rad], and its rate, [rad/s].
        xi, xi_rate: distances from the path and their rates, each shape (p - 1,), [m], [m/s].
        speed: wanted rate of theta, [rad/s].
        torque, torque_gain: the torques of a command are torque + torque_gain @ command, shapes
            (m,), [N m], and (m, p).
        torque_limit: the largest of each, shape (m,), [N m]; infinite without a limit.
        K1, K2, K3, K4, K5: the gains as they are set.
    """

    t: float
    interval: float
    q: Array
    v: Array
    y: Array
    y_rate: Array
    theta: float
    theta_rate: float
    xi: Array
    xi_rate: Array
    speed: float
    torque: Array
    torque_gain: Array
    torque_limit: Array
    K1: float
    K2: float
    K3: float
    K4: float
    K5: float


def python_law(given: Any) -> Law:
    """The law that an object describes; for the same object, the same law.

    Args:
        given: one of
            - a `Law`;
            - an object with `command(view)`, see `Law.command`, which may also have other fields of
              `Law`, such as `gains` and `memory`, or the class of such an object, which is created
              without arguments;
            - for studies, a function of `Now` that returns θ'' and λ'', p numbers in [rad/s²] and
              [m/s²], or a callable object, which each run copies as it is when the run begins, or
              the class of such objects, of which each run creates one.

    Raises:
        CodedError: it does not describe a law; the message has file and line.
    """
    compiled = hasattr(given, "command") and not isinstance(given, type | Law)
    made_of = _digest(given) if compiled else ""  # numbers of a callable object may change
    if id(given) not in _KNOWN or _KNOWN[id(given)][1] != made_of:
        _KNOWN[id(given)] = given, made_of, _law_of(given)
    return _KNOWN[id(given)][2]


_KNOWN = dict[int, tuple[Any, str, Law]]()
"""Objects with their digest and law, by `id`; they are kept so that no other gets that `id`."""


def _digest(given: Any) -> str:
    """The digest of an object whose command is compiled; "" if it cannot be told."""
    try:
        return digest(given)
    except Exception:  # of whatever it consists
        return ""


def copied(given: Any) -> Any:
    """A copy of a law with its memory, for a run.

    Raises:
        TypeError: it cannot be copied; the message names what.
    """
    try:
        return copy.deepcopy(given)
    except Exception as error:
        for name, value in getattr(given, "__dict__", {}).items():
            try:
                copy.deepcopy(value)
            except Exception:
                what = f"its {name}, of type {type(value).__name__}, cannot be"
                break
        else:
            what = str(error)
        raise TypeError(
            f"each run begins with a copy of it, but {what}. Give a class, of which each run"
            " creates one object"
        ) from error


def _law_of(given: Any) -> Law:
    file, line = _where(given)
    name = _name(given)
    try:
        if isinstance(given, Law):
            return dataclasses.replace(given, origin=(file, line))
        if hasattr(given, "command"):
            made = given() if isinstance(given, type) else _as_it_is(given)
            return _compiled(name, made, (file, line))
        if isinstance(given, type) and any("__call__" in vars(kind) for kind in given.__mro__[:-1]):
            return _called(name, given, given, (file, line))
        if callable(given) and not isinstance(given, type):
            copied(given)
            return _called(name, partial(copied, given), given, (file, line))
    except (Exception, SystemExit) as error:
        raise error_in(name, error, file, line) from error
    raise CodedError("error.law_no_text", kind=type(given).__name__)


def law_in(text: str) -> Law:
    """The law of a file, as FILE.py:NAME; the file is run, again after every change.

    Never call it with a text from a browser.

    Raises:
        CodedError: there is no such file or name, or running it fails; the message has the line.
    """
    found = IN_FILE.fullmatch(text)
    if found is None:
        raise CodedError("error.law_of_file", law=text)
    path = Path(found["file"]).resolve()
    if not path.is_file():
        raise CodedError("error.law_no_file", file=found["file"])
    state, name = path.stat(), found["name"]
    try:
        module = _module_of(path, (state.st_mtime_ns, state.st_size))
    except (Exception, SystemExit) as error:
        raise error_in(name, error, str(path)) from error
    if name not in vars(module):
        own = [each for each, value in vars(module).items() if _is_of(value, module.__name__)]
        raise unknown_name(name, own, f"law in {path.name}")
    law = python_law(vars(module)[name])
    return dataclasses.replace(law, source=path.name) if not law.source else law


@lru_cache(maxsize=64)
def _module_of(path: Path, _state: tuple[int, int]) -> ModuleType:
    """A file that has been run, once for all its laws."""
    spec = spec_from_file_location(f"onpath_law_{path.stem}", path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[module.__name__] = module  # dataclasses look there
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))  # modules beside it, as for a script
    exec(compile(path.read_bytes(), str(path), "exec"), vars(module))
    cloudpickle.register_pickle_by_value(module)  # another computer does not have the file
    return module


def _is_of(value: Any, module: str) -> bool:
    """Whether a value of a module may be a law that is defined there."""
    return isinstance(value, Law) or (callable(value) and value.__module__ == module)


def _as_it_is(given: Any) -> Any:
    """An object that later changes of the user's do not reach; itself if it cannot be copied."""
    try:
        return copy.deepcopy(given)
    except Exception:  # of whatever it consists
        return given


def _compiled(name: str, made: Any, origin: tuple[str, int]) -> Law:
    given: dict[str, Any] = {f: getattr(made, f) for f in GIVEN if hasattr(made, f)}
    for field in ("gains", "own_gains"):
        given[field] = tuple(given.get(field, ()))
    if odd := [each for each in given["own_gains"] if not isinstance(each, OwnGain)]:
        raise TypeError(f"own_gains has {odd[0]!r}, which own_gain(...) has not made")
    if odd := [each for each in given["gains"] if each not in ("K1", "K2", "K3", "K4", "K5")]:
        raise ValueError(f"gains has {odd[0]!r}, which is not one of K1 to K5")
    given["memory"] = tuple((str(field), int(size)) for field, size in given.get("memory", ()))
    texts = {"label": _title(name), "text": _first_line(made), "source": ""}
    given |= {field: str(given.get(field) or text) for field, text in texts.items()}
    if not callable(made.command):
        raise TypeError("command is no function")
    given["command"] = made.command
    return Law(**given, name=name, origin=origin)


def _called(
    name: str,
    make: Callable[[], Callable[[Now], Any]],
    given: Any,
    origin: tuple[str, int],
) -> Law:
    return Law(
        name=name,
        label=_title(name),
        text=_first_line(given),
        source="",
        command=_returned,
        aim="theta",
        gains=(),
        memory=((CALLED, MOST),),
        origin=origin,
        called=make,
    )


def _returned(view: View) -> ControlAction:
    """The command that the function returned at its last call."""
    numbers, p = view.clock.memory[CALLED], view.frame.p
    direction = view.output.acceleration_per_along
    action = followed(view, numbers[0], numbers[1:p], direction)
    return dataclasses.replace(action, memory={CALLED: numbers})


def _where(given: Any) -> tuple[str, int]:
    """File and line of the code of a law."""
    code = given.command if isinstance(given, Law) or hasattr(given, "command") else given
    if isinstance(code, type):
        code = next((vars(k)["__call__"] for k in code.__mro__ if "__call__" in vars(k)), code)
    while isinstance(code, partial):
        code = code.func
    body = getattr(code, "__code__", None)
    if body is None:
        body = getattr(type(code).__call__, "__code__", None)
    return (body.co_filename, body.co_firstlineno) if body is not None else ("?", 1)


def _name(given: Any) -> str:
    own = given.name if isinstance(getattr(given, "name", None), str) else ""
    text = own or getattr(given, "__name__", "") or type(given).__name__
    return re.sub(r"\W+", "_", text).strip("_")[:40] or "law"


def _title(name: str) -> str:
    return name.replace("_", " ")


def _first_line(given: Any) -> str:
    doc = given.__doc__ if isinstance(given.__doc__, str) else ""
    return (getdoc(given) or "").splitlines()[0] if doc.strip() else "A custom law."
