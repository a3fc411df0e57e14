from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from typing import Any

from . import parallel as parallel

class Parallel:
    def __init__(
        self, n_jobs: int | None = None, *, batch_size: int = 1, return_as: str = "list"
    ) -> None: ...
    def __call__(self, calls: Iterable[Any]) -> Iterable[Any]: ...

def delayed(function: Callable[..., Any]) -> Callable[..., Any]: ...
def parallel_config(
    backend: str | None = None, *, n_jobs: int | None = None
) -> AbstractContextManager[Any]: ...
