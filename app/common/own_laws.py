"""Laws as Python and the command line accept them: a name, a text, or code of the user's own."""

from __future__ import annotations

import dataclasses
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import FrameType
from typing import Any

from onpath.app.common.user_files import user_file
from onpath.models.control.laws.law import Law
from onpath.models.control.laws.python_law import IN_FILE, Now, law_in, python_law
from onpath.models.control.laws.registry import add_law, law_name, law_named
from onpath.models.errors import CodedError

LATE = 0.2  # [s] of processor time by which all calls together may exceed their intervals


def law_given(law: Any) -> str:
    """The name of a law, which is added to the laws if it is one's own.

    Never call it with a text from a browser: it runs files.

    Args:
        law: a name of `onpath.laws()`, a typed law, FILE.py:NAME, or what `python_law` takes.

    Raises:
        ValueError: there is no such law, or it has an error; the message has file and line.
        OSError: the file cannot be read.
    """
    if not isinstance(law, str):
        return add_law(_watched(python_law(law))).name
    if found := IN_FILE.fullmatch(law):
        given = f"{user_file(found['file']).resolve()}:{found['name']}"
        name = add_law(_watched(law_in(given))).name
        for earlier in [each for each, text in _FILES.items() if text == given]:
            del _FILES[earlier]  # of the file as it was
        _FILES[name] = given
        return name
    if law.endswith(".py"):
        raise CodedError("error.law_of_file", law=law)
    return law_name(law)


def compiled_law(law: Any) -> str:
    """The name of a law, as `law_given` returns it, unless the law is a Python function.

    Raises:
        ValueError: it is a function; or see `law_given`.
    """
    name = law_given(law)
    if law_named(name).called is not None:
        raise CodedError("error.law_is_called", law=name)
    return name


_FILES = dict[str, str]()  # contents of the laws' files, by name


def laws_of_files() -> dict[str, str]:
    """The laws that have been added from files, as they are now, for another process: `add_laws`.

    Returns:
        name -> FILE.py:NAME.
    """
    return dict(_FILES)


def only_here(law: str) -> bool:
    """Whether a law is known in this process alone: an object, or of a file that has changed."""
    return law_named(law).origin is not None and law not in _FILES


def as_given(law: str) -> str:
    """A law that is not `only_here`, as the command line takes it: name, text or FILE.py:NAME."""
    return _FILES.get(law, law)


def add_laws(laws: Mapping[str, str]) -> None:
    """Add the laws of `laws_of_files` of another process, under the same names."""
    for name, law in laws.items():
        add_law(_watched(law_in(law)), name)


def _watched(law: Law) -> Law:
    return law if law.called is None else dataclasses.replace(law, called=_Watched(law.called))


@dataclass(frozen=True, slots=True)
class _Watched:
    """`Law.called` of a law whose function is stopped if it takes longer than its interval."""

    make: Callable[[], Callable[[Now], Any]]

    def __call__(self) -> _Watch:
        return _Watch(self.make())


@dataclass(slots=True)
class _Watch:
    """A function that is stopped when its calls exceed their intervals by more than `LATE`.

    What counts is the processor time of this thread, so that a busy machine stops no law.

    Attributes:
        act: the function.
        late: by how much its calls have exceeded their intervals in all, [s].
    """

    act: Callable[[Now], Any]
    late: float = 0.0

    def __call__(self, now: Now) -> Any:
        """Call the function.

        Raises:
            TimeoutError: it took too long. It is stopped in the line that is running, even in an
                endless loop.
        """
        begin, allowed = time.thread_time(), LATE - self.late + now.interval
        reason = f"it takes longer than its interval of {1e3 * now.interval:g} ms"

        def watch(_frame: FrameType, _event: str, _argument: Any) -> Any:
            if time.thread_time() - begin > allowed:
                raise TimeoutError(reason)
            return watch

        tracer = sys.gettrace()
        if tracer is not None:  # a debugger, which takes its time
            return self.act(now)
        sys.settrace(watch)
        try:
            result = self.act(now)
        finally:
            sys.settrace(None)
        self.late = max(0.0, self.late + time.thread_time() - begin - now.interval)
        if self.late > LATE:
            raise TimeoutError(reason)
        return result
