"""A folder with the results of simulations, so that a study that was interrupted goes on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from onpath.models.control.laws.law import Law
from onpath.models.control.laws.law_digest import digest
from onpath.models.control.laws.registry import law_named
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.studies.experiments import Experiment

VERSION = version("onpath")
FILE = "results.jsonl"
"""A line for each result: its key, and the result as JSON."""


class ResultFolder:
    """The results of simulations in a folder, by key; the folder is made if there is none.

    Args:
        folder: None: nothing is kept.

    Raises:
        OSError: the folder cannot be made, or its file cannot be read.
    """

    def __init__(self, folder: str | Path | None) -> None:
        self._file: Path | None = None
        self._known = dict[str, Any]()
        if folder is None:
            return
        path = Path(folder).expanduser()
        path.mkdir(exist_ok=True)
        self._file = path / FILE
        for line in self._file.read_bytes().splitlines() if self._file.exists() else ():
            try:
                key, result = json.loads(line)
            except ValueError:
                continue  # the process was killed while it wrote this line
            self._known[key] = result

    @property
    def keeps(self) -> bool:
        """Whether there is a folder."""
        return self._file is not None

    def find(self, key: str) -> Any | None:
        """The result of this key, or None."""
        return self._known.get(key)

    def keep(self, key: str, result: Any) -> None:
        """Write a result, which must be possible as JSON; infinity is, too.

        Raises:
            OSError: it cannot be written.
        """
        if self._file is None:
            return
        with self._file.open("ab") as file:
            file.write(b"\n" * bool(file.tell()) + json.dumps([key, result]).encode())
        self._known[key] = result


def key_of(experiment: Experiment, law: str, *others: str) -> str:
    """A digest of all that determines the result of a run.

    Args:
        others: what else it depends on.

    Raises:
        ValueError: nobody can tell what the law is made of.
    """
    data, curve, source = experiment.data(), experiment.curve(), experiment.entry.source
    duration = curve.duration if isinstance(curve, SplineCurve) else 1.0
    made_of = (
        VERSION,
        experiment.entry.name,
        None if source is None else source.mechanics(),
        sorted(data["settings"].items()),
        data["own_gains"],
        sorted(data["schedule"].items(), key=str),
        data["start"].tobytes(),
        (curve.closed, curve.equation, curve.coefficients.tobytes(), duration),
        _made_of(law_named(law)),
        others,
    )
    return hashlib.sha256(repr(made_of).encode()).hexdigest()[:32]


@lru_cache(maxsize=64)
def _made_of(law: Law) -> str:
    if law.origin is None:
        return law.name
    try:
        return digest(replace(law, name="", origin=None))
    except Exception as error:  # of whatever it consists
        raise ValueError(f"{law.name}: its runs cannot be kept in a folder: {error}") from error
