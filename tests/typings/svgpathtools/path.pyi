from collections.abc import Iterator

class Line:
    start: complex
    end: complex
    def bpoints(self) -> tuple[complex, ...]: ...

class Arc:
    start: complex
    end: complex
    center: complex
    radius: complex
    rotation: float
    theta: float
    delta: float

class Path:
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Line | Arc]: ...
