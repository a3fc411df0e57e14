"""Runs every robot of collections of files, and writes a table of verdicts.

    pip download --no-deps example-robot-data rtb-data   # unpack them as zip files
    python -m tests.collections LIST FOLDER... > table.md

LIST is a CSV file with the columns `file` and `class`; the files are searched for in the folders.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from tests.collections.trial import Verdict, verdict_of

HEAD = (
    "| file | verdict | joints | reach, m | circle, mm | nearest to a stop, % of travel |"
    " off its path, mm: free, held; tracker held | guessed |\n|---|---|---|---|---|---|---|---|"
)


def found(name: str, folders: Sequence[Path]) -> Path | None:
    """A file by the end of its path."""
    parts = Path(name).parts
    for folder in folders:
        for file in sorted(folder.rglob(parts[-1])):
            if file.parts[-len(parts) + 1 :] == parts[1:]:
                return file
    return None


def line(name: str, verdict: Verdict) -> str:
    """A row of the table."""
    short = "/".join(Path(name).parts[-3:])
    if verdict.verdict == "refused":
        return f"| {short} | refused: {verdict.detail} | | | | | | |"
    off = f"{verdict.free:.1f}, {verdict.held:.1f}; {verdict.torn:.0f}"
    room = " ".join(each or "–" for each in verdict.room)
    return (
        f"| {short} | {verdict.verdict} | {verdict.joints} | {verdict.reach:.2f} |"
        f" {1e3 * verdict.circle:.0f} | {room} | {off} | {', '.join(verdict.guesses)} |"
    )


def main(table: str, *folders: str) -> None:
    """Print the table."""
    with Path(table).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    day = datetime.now(UTC).date().isoformat()
    print(f"Made on {day} at commit {commit}.\n\n{HEAD}")
    counts, runs = Counter[str](), Counter[str]()
    for row in rows:
        file = found(row["file"], [Path(each) for each in folders])
        if file is None:
            print(f"| {row['file']} | not found | | | | | | |", flush=True)
            continue
        verdict = verdict_of(file)
        counts[row["class"]] += 1
        runs[row["class"]] += verdict.verdict == "runs"
        print(line(row["file"], verdict), flush=True)
    print()
    for kind, count in counts.items():
        print(f"- {kind}: {runs[kind]} of {count} run")


if __name__ == "__main__":
    main(*sys.argv[1:])
