"""The trial that collections of robots are put to, with arms of our own."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from tests.collections.trial import verdict_of
from tests.support.robot_files import HEAVY, LEG, PLANAR, SEVEN, Link, urdf

FIVE = SEVEN[:5]
WEAK = [replace(link, effort=0.1) for link in FIVE]
NARROW = [replace(link, limit=0.7 if i == 4 else link.limit) for i, link in enumerate(FIVE)]


def scaled(link: Link, factor: float) -> Link:
    x, y, z = (factor * each for each in link.at)
    a, b, c = (factor * each for each in link.end)
    return replace(link, at=(x, y, z), end=(a, b, c), mass=factor * link.mass)


ARMS = {
    "seven": urdf("seven", SEVEN),
    "six joints": urdf("six", SEVEN[:6]),
    "five joints": urdf("five", FIVE),
    "narrow": urdf("narrow", NARROW),
    "small": urdf("small", [scaled(link, 0.3) for link in FIVE]),
    "large": urdf("large", [replace(scaled(link, 2.0), effort=200.0) for link in FIVE]),
    "leg": urdf("leg", LEG),
    "on the floor": urdf("floor", [replace(PLANAR[0], at=(0, 0, 0)), *PLANAR[1:]]),
    "without masses": re.sub("<inertial>.*?</inertial>", "", urdf("bare", PLANAR)),
    "without limits": re.sub("<limit [^>]*>", "", urdf("free", PLANAR)),
    "impossible inertias": re.sub('ixx="[^"]*"', 'ixx="-0.01"', urdf("strange", PLANAR)),
    "two": urdf("two", PLANAR[:2]),
}


def verdict(folder: Path, text: str | Sequence[Link]) -> str:
    file = folder / "arm.urdf"
    file.write_text(text if isinstance(text, str) else urdf("arm", text), "utf-8")
    return verdict_of(file).verdict


@pytest.mark.thorough
@pytest.mark.parametrize("name", ARMS)
def test_arms_of_every_kind_run(tmp_path: Path, name: str) -> None:
    assert verdict(tmp_path, ARMS[name]) == "runs"


@pytest.mark.thorough
def test_what_does_not_run_is_said(tmp_path: Path) -> None:
    assert "more than the 0.1 N m" in verdict(tmp_path, WEAK)
    assert verdict(tmp_path, HEAVY[:1]) == "refused"
