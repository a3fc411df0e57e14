"""Columns of files with arrays: .npy and .npz of NumPy, .mat of MATLAB (up to version 7).

Rows are samples: as many as most of the numbers belong to. A vector is a column with the name of
the array, and a matrix q has the columns q1, q2 and so on, those of a .npy file 1, 2 and so on. A
matrix that lies on its side is turned. Arrays of another length, and of anything but real numbers,
do not count.

Nothing in the files is run: pickled objects are refused.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError

ENDINGS = (".npy", ".npz", ".mat")


def is_array_file(path: Path) -> bool:
    """Whether a file has arrays, by the ending of its name."""
    return path.suffix.lower() in ENDINGS


def array_columns(path: Path) -> Mapping[str, Array]:
    """The columns of a file by name, all of the same length, at least one.

    Raises:
        CodedError: it has another form.
        OSError: it cannot be read.
    """
    numeric = {name: each for name, each in _arrays(path).items() if each.dtype.kind in "iufb"}
    arrays = {name: np.atleast_1d(np.squeeze(each)) for name, each in numeric.items()}
    flat = [each for each in arrays.values() if each.ndim < 3 and each.size]
    numbers = Counter[int]()  # in the arrays of each length
    for each in flat:
        numbers[max(each.shape)] += each.size
    if not numbers:
        raise CodedError("error.array_file", reason=f"no vector or matrix in {path.name}")
    rows = max(numbers, key=numbers.__getitem__)
    columns = dict[str, Array]()
    for name, each in arrays.items():
        turned = each.T if each.ndim == 2 and len(each) != rows else each
        if turned.ndim == 1 and len(turned) == rows:
            columns[name or "1"] = turned.astype(float)
        elif turned.ndim == 2 and len(turned) == rows:
            columns |= {f"{name}{i}": c.astype(float) for i, c in enumerate(turned.T, 1)}
    return columns


def _arrays(path: Path) -> Mapping[str, Any]:
    try:
        if path.suffix.lower() == ".mat":
            from scipy.io import loadmat  # slow to import

            found = loadmat(path)
            return {name: np.asarray(each) for name, each in found.items() if name[:2] != "__"}
        loaded: Any = np.load(path, allow_pickle=False)
        if hasattr(loaded, "files"):
            with loaded:
                return {name: loaded[name] for name in loaded.files}
        names = loaded.dtype.names
        return {"": loaded} if names is None else {name: loaded[name] for name in names}
    except OSError:
        raise
    except Exception as error:  # of hostile files, whatever it is
        raise CodedError("error.array_file", reason=f"{error}"[:100]) from None
