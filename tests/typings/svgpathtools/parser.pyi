import numpy as np
from numpy.typing import NDArray

def parse_transform(transform_str: str | None, strict: bool = ...) -> NDArray[np.float64]: ...
