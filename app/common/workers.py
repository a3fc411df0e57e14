"""Simulations by several processes of this computer, or of a cluster: whatever joblib is set to.

    with joblib.parallel_config("dask"):
        onpath.sweep(...)

Without such a setting there is one process for each processor, if that is worth it. Items of one
kind, which need the same compiled loop, go to a process together.
"""

from __future__ import annotations

import io
import sys
import threading
import uuid
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass
from itertools import groupby
from types import CodeType
from typing import Any, Generic, TypeVar

import cloudpickle
from joblib import Parallel, delayed
from joblib.parallel import BACKENDS, DEFAULT_BACKEND, get_active_backend
from typing_extensions import override

from onpath.models.closed_loop.simulation import forget_kernels
from onpath.models.control.laws.law import Law
from onpath.models.control.laws.registry import add_law, law_named
from onpath.models.systems.catalogue import robot_named
from onpath.models.systems.robots import RobotEntry

LARGEST = 25  # items that a process gets at once: as many may be lost with it
SHARES = 4  # each process gets at least so many batches, if there are enough items

Item = TypeVar("Item")
Result = TypeVar("Result")

_HERE, _ONE_AT_A_TIME = uuid.uuid4().hex, threading.Lock()
_LAWS = dict[str, bytes]()  # by name, as another process has sent them


@dataclass(frozen=True, slots=True)
class WorkerContext:
    """What a worker needs besides an item.

    Attributes:
        origin: the process that has sent it.
        laws: the user's own laws by name, pickled.
        robots: the robots that the items name.
        folders: where modules are found.
    """

    origin: str
    laws: dict[str, bytes]
    robots: tuple[RobotEntry, ...]
    folders: tuple[str, ...]

    def install(self) -> None:
        """Make laws and robots known in this process.

        Raises:
            ValueError: another robot has the name of one of these.
        """
        if self.origin == _HERE:
            return
        sys.path += [folder for folder in self.folders if folder not in sys.path]
        for name, law in self.laws.items():
            if _LAWS.get(name) != law:
                add_law(cloudpickle.loads(law), name)
                _LAWS[name] = law
                forget_kernels()  # of another law of that name
        for robot in self.robots:
            if robot_named(robot.name) != robot:
                raise ValueError(f"{robot.name}: this process has another robot of that name")


@dataclass(frozen=True, slots=True, kw_only=True)
class Job(Generic[Item, Result]):
    """Items, and what is done with them.

    Attributes:
        items: what each call of `work` is given; it must be possible to pickle it.
        kinds: of each item; those of one kind go together.
        work: a function of a module, which is called with each item.
        lost: the result of an item whose process has died, again and again.
        laws, robots: those that the items need.
        title: of the progress bar.
        is_small: whether it takes less time than processes take to start; then it is done in this
            one, unless joblib is set to something.
    """

    items: Sequence[Item]
    kinds: Sequence[Any]
    work: Callable[[Item], Result]
    lost: Callable[[Item], Result]
    laws: Iterable[str]
    robots: Iterable[RobotEntry]
    title: str
    is_small: bool = False

    def results(self) -> Iterator[tuple[int, Result]]:
        """The number of each item, and its result, in the order in which they are finished.

        If a process is lost, what it has not finished is done again.

        Raises:
            ValueError: a law cannot be sent to another process.
        """
        shown = sys.stderr.isatty() or "ipykernel" in sys.modules
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a notebook without widgets shows a line of text
            from tqdm.auto import tqdm

            bar = tqdm(total=len(self.items), desc=self.title, disable=not shown, leave=False)
        with bar:
            for found in self._results():
                bar.update()
                yield found

    def _results(self) -> Iterator[tuple[int, Result]]:
        backend, chosen = get_active_backend()
        unset = chosen is None and isinstance(backend, BACKENDS[DEFAULT_BACKEND])
        jobs = chosen or (1 if unset and self.is_small else -1)
        workers = max(1, backend.effective_n_jobs(jobs))
        context = context_of(self.laws if workers > 1 else (), self.robots)
        waiting, losses = self._batches(workers), 0
        while waiting:
            sent, done = list[int](), set[int]()

            def calls(batches: list[list[int]] = waiting, sent: list[int] = sent) -> Iterator[Any]:
                for number, batch in enumerate(batches):
                    sent.append(number)
                    yield delayed(_worked)(context, self.work, self._given(batch), number)

            try:
                for number, results in _parallel(jobs)(calls()):
                    done.add(number)
                    yield from zip(waiting[number], results, strict=True)
                return
            except Exception as error:
                if not _is_loss(error):
                    raise
            losses += 1
            left = [batch for number, batch in enumerate(waiting) if number not in done]
            if losses > 1:  # something kills the processes: find out what
                held = [waiting[number] for number in sent if number not in done]
                for i in (i for batch in held for i in batch):
                    yield i, self._alone(context, i)
                left = [batch for batch in left if batch not in held]
            waiting = left

    def _alone(self, context: WorkerContext, i: int) -> Result:
        """The result of an item that may kill its process."""
        call = delayed(_worked)(context, self.work, self._given([i]), 0)
        try:
            ((_, (result,)),) = _parallel(2)([call])
        except Exception as error:
            if not _is_loss(error):
                raise
            return self.lost(self.items[i])
        return result

    def _given(self, batch: list[int]) -> list[Item]:
        return [self.items[i] for i in batch]

    def _batches(self, workers: int) -> list[list[int]]:
        """Numbers of items of one kind each, a kind's batches one after the other."""
        size = min(LARGEST, max(1, -(-len(self.items) // (SHARES * workers))))
        order = {kind: number for number, kind in enumerate(dict.fromkeys(self.kinds))}
        numbers = sorted(range(len(self.items)), key=lambda i: order[self.kinds[i]])
        batches = list[list[int]]()
        for _, alike in groupby(numbers, key=lambda i: order[self.kinds[i]]):
            together = list(alike)
            batches += [together[i : i + size] for i in range(0, len(together), size)]
        return batches


def context_of(laws: Iterable[str], robots: Iterable[RobotEntry]) -> WorkerContext:
    """The context of a job.

    Raises:
        ValueError: a law cannot be pickled.
    """
    own = [law for law in map(law_named, dict.fromkeys(laws)) if law.origin is not None]
    return WorkerContext(
        origin=_HERE,
        laws={law.name: _pickled(law) for law in own},
        robots=tuple(dict.fromkeys(robots)),
        folders=tuple(sys.path),
    )


def _pickled(law: Law) -> bytes:
    file = io.BytesIO()
    try:
        _WithFiles(file).dump(law)
    except Exception as error:  # of whatever it consists
        raise ValueError(f"{law.name} cannot be sent to another process: {error}") from error
    return file.getvalue()


class _WithFiles(cloudpickle.Pickler):
    """Keeps the names of the files of code, which messages tell."""

    @override
    def reducer_override(self, obj: Any) -> Any:
        if isinstance(obj, CodeType) and obj.co_filename:
            return _in_file, (obj.replace(co_filename=""), obj.co_filename)
        return super().reducer_override(obj)


def _in_file(code: CodeType, file: str) -> CodeType:
    return code.replace(co_filename=file)


def _worked(
    context: WorkerContext, work: Callable[[Any], Any], items: list[Any], number: int
) -> tuple[int, list[Any]]:
    """The number of a batch and its results: what a process does."""
    with _ONE_AT_A_TIME:  # a cluster's process may have several threads
        context.install()
        return number, [work(item) for item in items]


def _parallel(jobs: int) -> Parallel:
    """What joblib is set to, with results as they come if it can do that."""
    try:
        return Parallel(n_jobs=jobs, batch_size=1, return_as="generator_unordered")
    except ValueError:  # such as Ray's
        return Parallel(n_jobs=jobs, batch_size=1)


def _is_loss(error: Exception) -> bool:
    """Whether an error says that a process has died: loky's, or dask's."""
    return isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker"
