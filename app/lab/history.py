"""The last minute of a simulation: checkpoints to rewind to, samples to plot, inputs to replay.

A segment stores the states at its beginning and all inputs of the loop, so that every millisecond
can be recomputed exactly, for instance for an export.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from itertools import groupby
from math import prod
from mmap import ACCESS_COPY, mmap
from operator import gt
from typing import Any

import numpy as np
from msgspec.structs import replace

from onpath.app.lab.segments import HistoryCopy, HistoryFrame, Segment, segment_at
from onpath.models.arrays import Array

SECONDS = 60.0
LONGEST = 17  # maximum ticks in a segment
RECENT = 10.0  # [s] stored at the full rate, which plots show; older segments are merged
COARSE = 4 * LONGEST  # maximum ticks in an older segment
MOST = 7200
BATCH = 16  # maximum frames to collect before they are stored together, which is much faster
FIRST, MORE = 1024, 256  # segments: first capacity, and by how many it is enlarged
FULL = 0.9  # fraction of the capacity in use from which it is enlarged


class History:
    """Segments of the last minute, oldest first, stored as one array per field.

    The rows from `_begin` to `_end` are in use; when they reach the end of the arrays they are
    moved to the front, and older ones are merged, four frames of the lab into one. The latest
    frames are buffered until they are needed.

    Args:
        sample: computes plotted values, shape (n, fields), from log rows, shape (n, row size), and
            distances from the path, shape (n,), [m].
    """

    def __init__(self, sample: Callable[[Array, Array], Array]) -> None:
        self._sample = sample
        self._lock = threading.Lock()  # a page that is being built reads it, too
        self.clear()

    def __len__(self) -> int:
        self.settle()
        return self._end - self._begin

    def clear(self) -> None:
        """Delete everything."""
        with self._lock:
            self._waiting: list[HistoryFrame] = []
            self._columns: dict[str, np.ndarray] = {}
            self._list: list[Segment] | None = None
            self._begin = self._end = 0
            self._before = 0  # number of rows ever removed from the front

    def append(self, frame: HistoryFrame) -> None:
        """Add the frame just simulated. Frames older than a minute are dropped eventually."""
        with self._lock:
            waiting = self._waiting
            if waiting and frame.has_inputs_of(waiting[-1]):
                together = waiting[-1].ticks + frame.ticks
                if together <= LONGEST:
                    waiting[-1] = replace(waiting[-1], ticks=together)
                    return
            waiting.append(frame)
        if len(waiting) >= BATCH:
            self.settle()

    def settle(self) -> None:
        """Store the buffered frames, before anything changes that the samples depend on.

        If another thread is storing them, this waits for it.
        """
        with self._lock:
            frames, self._waiting = self._waiting, []
            if frames:
                self._put(frames)

    def _put(self, frames: Sequence[HistoryFrame]) -> None:
        self._list = None
        for _, alike in groupby(frames, _sizes_of):
            self._put_alike(list(alike))
        reached = self._find(frames[-1].time - SECONDS, "right") - 1
        self._begin = max(self._begin, reached, self._end - MOST)

    def _put_alike(self, frames: Sequence[HistoryFrame]) -> None:
        """Store frames whose loops have vectors of the same sizes."""
        states, rows, distances, most = _columns_of(frames)
        samples = self._sample(rows.reshape(-1, rows.shape[-1]), distances.ravel())
        samples = samples.reshape(*distances.shape, -1)
        values = _values_of(frames)
        widths = states.shape[1], values.shape[1]
        room = len(self._columns["time"]) - self._end if self._columns else 0
        if len(frames) > room or any(map(gt, widths, self._widths())):
            self._make_room(len(frames), widths, samples.shape[1:])
        columns, new = self._columns, slice(self._end, self._end + len(frames))
        columns["time"][new] = [frame.time for frame in frames]
        columns["ticks"][new] = [frame.ticks for frame in frames]
        columns["inputs"][new] = [frame.inputs for frame in frames]
        columns["values"][new, : widths[1]] = values
        columns["values"][new, widths[1] :] = 0.0
        columns["state"][new, : widths[0]] = states
        columns["most"][new] = most
        columns["sample"][new] = samples
        self._end = new.stop

    def all(self) -> list[Segment]:
        """All segments, oldest first; the same objects until something changes."""
        self.settle()
        if self._list is None:
            self._list = [segment_at(self._columns, row) for row in range(self._begin, self._end)]
        return list(self._list)

    def copy(self) -> HistoryCopy:
        """A copy of everything, for use in another thread or process."""
        self.settle()
        rows = slice(self._begin, self._end)
        return HistoryCopy({name: column[rows].copy() for name, column in self._columns.items()})

    def span(self) -> float:
        """Length of the recorded time, [s]."""
        if not len(self):
            return 0.0
        return float(self._ends(self._end - 1) - self._columns["time"][self._begin])

    def at(self, time: float) -> Segment | None:
        """The segment that contains `time`, or the nearest one; None if there is none."""
        if not len(self):
            return None
        return segment_at(self._columns, max(self._find(time, "right") - 1, self._begin))

    def before(self, segment: Segment) -> History:
        """A copy of everything before `segment`."""
        self.settle()
        copy = History(self._sample)
        with self._lock:
            copy._columns = {name: column.copy() for name, column in self._columns.items()}
            copy._begin, copy._end = self._begin, self._find(segment.time, "left")
            copy._before = self._before
        return copy

    def samples(
        self, begin: float, end: float, most: int, fields: slice = slice(None)
    ) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) and samples (n, robots, fields) with begin <= time <= end, n <= most."""
        self.settle()
        low, high = self._find(begin, "left"), self._find(end, "right")
        if low >= high:
            return np.zeros(0), np.zeros((0, 0, 0))
        step = max(1, -(-(high - low) // most))
        first = low + (-low - self._before) % step  # the same rows from call to call
        chosen, columns = slice(first, high, step), self._columns
        return columns["time"][chosen].copy(), columns["sample"][chosen, :, fields].copy()

    def _find(self, time: float, side: Any) -> int:
        """Row at which `time` would be inserted."""
        if self._begin == self._end:
            return self._end
        times = self._columns["time"][self._begin : self._end]
        return self._begin + int(times.searchsorted(time, side))

    def _widths(self) -> tuple[int, int]:
        """Lengths of the rows of states and of values."""
        columns = self._columns
        return (columns["state"].shape[1], columns["values"].shape[1]) if columns else (0, 0)

    def _make_room(self, frames: int, widths: tuple[int, int], sample: tuple[int, ...]) -> None:
        """Make free rows at the end: merge older rows, and enlarge the arrays if necessary.

        Args:
            widths: lengths of the states and of the values of the next rows; all are padded to the
                longest.
            sample: shape of a sample, (robots, fields).
        """
        kept, old = self._kept(), self._columns
        size, widest = len(old.get("time", ())), self._widths()
        if len(kept):
            old["ticks"][kept] = np.add.reduceat(old["ticks"][: self._end], kept)
        rows = max(size + MORE, FIRST) if len(kept) + frames > FULL * size else size
        if rows > size or any(map(gt, widths, widest)):
            self._columns = _empty_columns(rows, tuple(map(max, widths, widest)), sample)
        for name, column in old.items():
            part = tuple(map(slice, (len(kept), *column.shape[1:])))
            self._columns[name][part] = column[kept]
        self._columns["inputs"][len(kept) :] = None  # release references
        self._before += self._end - len(kept)
        self._begin, self._end = 0, len(kept)

    def _kept(self) -> np.ndarray:
        """Rows to keep: all recent ones, and older ones unless they merge into the previous one."""
        if self._begin == self._end:
            return np.zeros(0, dtype=int)
        inside = slice(self._begin, self._end)
        times, ticks, inputs = (self._columns[n][inside] for n in ("time", "ticks", "inputs"))
        values = self._columns["values"][inside].view(np.int64)
        ends = times + ticks * np.array([each.dt for each in inputs])
        joins = (inputs[1:] == inputs[:-1]) & (np.abs(times[1:] - ends[:-1]) < 1e-6)
        joins &= (values[1:] == values[:-1]).all(axis=1) & (times[1:] < times[-1] - RECENT)
        kept, joined, last = np.ones(len(times), dtype=bool), 0, -1
        for row in (1 + np.flatnonzero(joins)).tolist():
            joined = joined if row == last + 1 else int(ticks[row - 1])
            last, together = row, joined + int(ticks[row])
            kept[row] = together > COARSE
            joined = int(ticks[row]) if kept[row] else together
        return self._begin + np.flatnonzero(kept)

    def _ends(self, row: int) -> float:
        """Time at which a row ends, [s]."""
        columns = self._columns
        return columns["time"][row] + columns["ticks"][row] * columns["inputs"][row].dt


def _empty_columns(
    rows: int, widths: tuple[int, ...], sample: tuple[int, ...]
) -> dict[str, np.ndarray]:
    """Columns for some segments, filled with zeros.

    The numbers are in a mapping of their own, not on the heap: unused rows take no memory, and all
    of it returns to the system as soon as it is freed.

    Args:
        widths: lengths of the states and of the values.
        sample: shape of a sample, (robots, fields).
    """
    kinds = {
        "time": (np.float64, (rows,)),
        "ticks": (np.int64, (rows,)),
        "values": (np.float64, (rows, widths[1])),
        "state": (np.float64, (rows, widths[0])),
        "most": (np.float64, (rows, sample[0])),
        "sample": (np.float32, (rows, *sample)),
    }
    sizes = [prod(shape) * np.dtype(kind).itemsize for kind, shape in kinds.values()]
    block = np.frombuffer(mmap(-1, sum(sizes), access=ACCESS_COPY), dtype=np.uint8)
    parts = np.split(block, np.cumsum(sizes)[:-1])
    columns = {"inputs": np.empty(rows, dtype=object)}
    for part, (name, (kind, shape)) in zip(parts, kinds.items(), strict=True):
        columns[name] = part.view(kind).reshape(shape)
    return columns


def _values_of(frames: Sequence[HistoryFrame]) -> Array:
    """`HistoryFrame.values` of all frames, padded with zeros to the longest, a row for each."""
    size = max(len(frame.values) for frame in frames)
    padded = b"".join([frame.values.ljust(size, b"\0") for frame in frames])
    return np.frombuffer(padded).reshape(len(frames), size // 8)


def _sizes_of(frame: HistoryFrame) -> list[tuple[int, int, int]]:
    """For each loop, sizes of the recorded part of its state, of its state and of its record."""
    return [
        (recorded.size, states.size, states.records.shape[1])
        for (states, _), recorded in zip(frame.slots, frame.inputs.of, strict=True)
    ]


def _columns_of(frames: Sequence[HistoryFrame]) -> tuple[Array, Array, Array, Array]:
    """States as recorded, log rows, distances and largest distances of frames of the same sizes.

    Returns:
        Shapes (frames, size), (frames, robots, row size), and twice (frames, robots).
    """
    flat = np.concatenate([states.records[i] for frame in frames for states, i in frame.slots])
    records, begin = flat.reshape(len(frames), -1), 0
    states, rows, numbers = list[Array](), list[Array](), list[Array]()
    for recorded, size, width in _sizes_of(frames[0]):
        part = records[:, begin : begin + width]
        begin += width
        states.append(part[:, :recorded])
        rows.append(part[:, size:-2])
        numbers.append(part[:, -2:])
    log_rows = np.concatenate(rows, axis=1).reshape(len(frames), len(rows), -1)
    both = np.concatenate(numbers, axis=1)
    return np.concatenate(states, axis=1), log_rows, both[:, ::2], both[:, 1::2]
