"""What a page computes of paths and poles is what Python computes, step by step."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.evaluated import evaluated
from onpath.models.paths.curve_blend import blend
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.curve_fit import closed_through
from onpath.models.paths.curves import Curve, SeriesCurve, circle, ellipse, from_terms
from onpath.models.paths.path_checks import SAMPLES
from onpath.models.paths.path_design import REACH, presets
from onpath.models.standalone.edit import CHECKS, ROW, edit_scans
from onpath.models.systems.catalogue import ROBOTS

Checks = Callable[[Curve], dict[str, Array]]
"""Curve -> check -> where it fails."""


@cache
def page_checks(name: str, closed: bool) -> Checks:
    """What a page without a server finds wrong with a curve."""
    entry = ROBOTS[name]
    robot = entry.make(entry.parameters())
    kind = kind_of("path_following", entry.parameters(), circle(0.05) if closed else LINE)
    scans = edit_scans(robot, kind)
    check = scans["check"].step.mapaccum(SAMPLES + 1)
    none = np.zeros(SAMPLES + 1)
    i, j = np.triu_indices(SAMPLES, 1)
    strands = scans["strands"].step.map(len(i))

    def found(curve: Curve) -> dict[str, Array]:
        every = np.tile(curve.table(), SAMPLES + 1)
        _, rows = evaluated(check, np.zeros(4), none, every)
        state = np.zeros((len(i), 5))
        state[:, 4] = rows[-1, 2]
        both = np.hstack([rows[:-1], rows[1:]])
        after, _ = evaluated(strands, state, both[i], both[j])
        for end in (i, j):
            np.maximum.at(rows[:, ROW - 1], end, after[:, 0])
        crossings = after[after[:, 1] > 0, 2:4]
        failed = {
            each: rows[:SAMPLES, :2][bad]
            for k, each in enumerate(CHECKS)
            if (bad := rows[:SAMPLES, 3 + k] > 0).any()
        }
        if len(crossings):
            failed.pop("narrow", None)
            failed["crosses"] = crossings
        return failed

    return found


@cache
def lab_checks(name: str) -> Checks:
    """What the lab finds wrong with it, for the same robot."""
    entry = ROBOTS[name]
    margin = entry.make(entry.parameters()).margin

    def found(curve: Curve) -> dict[str, Array]:
        faults = curve_faults(margin, curve) + ambiguities(curve)
        return {fault.check: fault.points for fault in faults}

    return found


LINE = presets()["segment"].curve


def agreed(name: str, curve: Curve) -> set[str]:
    """The checks that a curve fails, the same ones in the same places in lab and page."""
    lab, page = lab_checks(name)(curve), page_checks(name, curve.closed)(curve)
    assert list(lab) == list(page)
    for check, points in lab.items():
        if check != "crosses":  # a page marks one crossing for each point of the curve
            np.testing.assert_array_equal(points, page[check])
    return set(lab)


@pytest.mark.thorough
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_a_curve_is_refused_for_the_lab_s_reasons_and_in_the_same_places(name: str) -> None:
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    rng, seen = np.random.default_rng(3), set[str]()
    for design in (presets()[preset] for preset in ("clover", "segment", "figure of eight")):
        for index in range(8):
            aside = robot.reach * rng.uniform(-0.5, 0.5, 2)
            moved = design.moved(index % len(design.points), aside)
            seen |= agreed(name, moved.curve)
    corners = REACH * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])
    beyond = {"outside"} if (robot.margin(corners) == 0).any() else set[str]()
    assert seen >= {"bends", "crosses"} | beyond
    assert agreed(name, presets()["clover"].moved(0, np.array([0.03, 0.0])).curve)


def wavy(rng: np.random.Generator) -> Curve:
    """A random closed or open curve, some of them as good paths as the presets."""
    start = presets()[str(rng.choice(["circle", "clover", "segment", "figure of eight"]))].curve
    assert isinstance(start, SeriesCurve)
    terms = start.terms().copy()
    terms[:9] += rng.normal(0, rng.choice([0.0, 0.002, 0.02]), terms[:9].shape)
    return from_terms(start.closed, rng.uniform(0.5, 1.5) * terms)


WAIST = [[8, 0], [5, 3], [0, 0.6], [-5, 3], [-8, 0], [-5, -3], [0, -0.6], [5, -3]]
"""Control points of a path with a waist of 12 mm, [cm]."""


def flat(half_width: float) -> Curve:
    return ellipse((0.06, half_width))


@pytest.mark.thorough
def test_lab_and_page_agree_on_both_sides_of_every_threshold() -> None:
    """Where a check changes its mind on the way from one curve to another, to the last bit."""
    rng, seen, name = np.random.default_rng(1), set[str](), "five_bar"
    pinched, apart = (closed_through(np.array(WAIST) * (0.01, each)) for each in (0.01, 0.03))
    ways = [(wavy(rng), wavy(rng)) for _ in range(10)]
    ways += [(circle(0.05), circle(0.15)), (circle(0.05), flat(0.004)), (flat(1e-3), flat(1e-5))]
    ways += [(apart, pinched), (apart, presets()["figure of eight"].curve)]
    for begin, end in ways:
        if begin.closed == end.closed:
            for check in agreed(name, begin) ^ agreed(name, end):
                sides = threshold(name, check, begin, end)
                before, after = (agreed(name, blend(begin, end, share)) for share in sides)
                assert check in before ^ after
                seen.add(check)
    assert seen == {*CHECKS, "crosses"}


def threshold(name: str, check: str, begin: Curve, end: Curve) -> tuple[float, float]:
    """Neighbouring shares of the way between which a check of the lab changes its mind."""
    low, high, first = 0.0, 1.0, check in lab_checks(name)(begin)
    while low < (middle := (low + high) / 2) < high:
        same = (check in lab_checks(name)(blend(begin, end, middle))) == first
        low, high = (middle, high) if same else (low, middle)
    return low, high
