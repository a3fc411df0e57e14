from typing import Protocol

class Backend(Protocol):
    def effective_n_jobs(self, n_jobs: int) -> int: ...

BACKENDS: dict[str, type]
DEFAULT_BACKEND: str

def get_active_backend() -> tuple[Backend, int | None]: ...
