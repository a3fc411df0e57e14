"""Reads a file of `write_csv` with Python's own reader."""

from __future__ import annotations

import csv
from typing import TextIO

import numpy as np

from onpath.models.arrays import Array

TEXTS = ("side", "law")


def read_csv(file: TextIO) -> dict[str, dict[str, Array]]:
    """Columns by the side, or the law if there is none: column name -> array."""
    rows: dict[str, list[dict[str, str]]] = {}
    for row in csv.DictReader(file):
        rows.setdefault(row.get("side", row["law"]), []).append(row)
    return {
        name: {
            column: np.array([float(row[column]) for row in own])
            for column in own[0]
            if column not in TEXTS
        }
        for name, own in rows.items()
    }
