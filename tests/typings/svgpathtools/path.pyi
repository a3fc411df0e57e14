from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

class Segment:
    start: complex
    end: complex
    def point(self, t: float) -> complex: ...

class Line(Segment): ...

class Path:
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Segment]: ...

def transform(curve: Path, tf: NDArray[np.float64]) -> Path: ...
