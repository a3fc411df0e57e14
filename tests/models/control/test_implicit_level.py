"""A path with an equation s(z) = 0 is followed by s itself where s is an output, or refused."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

import onpath
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.implicit_level import ImplicitLevel, check_level, implicit_level
from onpath.models.studies.experiments import experiments, run
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.catalogue import FIVE_BAR

SQUARE = "implicit (z1/0.05)**4 + (z2/0.04)**4 - 1"
EGG = "implicit 400*z1**2 + 600*z2**2 + 3000*z1*z2**2 - 1"


def s_of(text: str, y: np.ndarray) -> np.ndarray:
    """s at points, by Python's own arithmetic."""
    names = {"z1": y[..., 0], "z2": y[..., 1]}
    return eval(text.removeprefix("implicit"), {"__builtins__": {}}, names)


def off(path: str, beside: float = 0.006) -> np.ndarray:
    """A start beside a path."""
    curve = curve_from_text(path)
    first = curve.at(np.array(0.4), 1)
    normal = np.array([-first[1], first[0]]) / np.linalg.norm(first)
    return curve.at(np.array(0.4)) + beside * normal


@pytest.mark.thorough
@pytest.mark.parametrize("path", [SQUARE, EGG])
def test_the_end_point_comes_to_where_s_is_0(path: str) -> None:
    found = onpath.simulate(path=path, across="level_set", start=off(path), duration=4.0, speed=3.0)
    s = np.abs(s_of(path, found.y))
    assert s[0] > 0.1 and s[-1000:].max() < 2e-4
    by_distance = onpath.simulate(path=path, start=off(path), duration=4.0, speed=3.0)
    assert s[-1000:].max() < np.abs(s_of(path, by_distance.y))[-1000:].max() / 3


@pytest.mark.parametrize("path", [SQUARE, EGG])
def test_it_is_in_metres_and_positive_on_the_left(path: str) -> None:
    start = off(path, 0.002)
    found = onpath.simulate(path=path, across="level_set", start=start, duration=0.01)
    assert np.ravel(found.xi)[0] == pytest.approx(0.002, rel=0.5)
    values = {"duration": 0.01, "across": "level_set"}
    experiment = experiments()["obstruction"].along(curve_from_text(path)).with_values(values)
    logged = run(experiment, "path_following")
    assert not logged.level_set  # so that its column is xi1_m


def test_the_equation_of_a_circle_leads_the_same_way_as_the_circle() -> None:
    start, values = np.array([0.058, 0.0]), {"duration": 2.0, "across": "level_set"}
    known = onpath.simulate(path="circle", start=start, **values)
    typed = onpath.simulate(path="implicit 0.0025 - z1**2 - z2**2", start=start, **values)
    assert typed.y == pytest.approx(known.y, abs=2e-5)
    factor = known.xi[0] / typed.xi[0]
    assert typed.xi * factor == pytest.approx(known.xi, abs=1e-3 * np.abs(known.xi).max())


def test_gradient_and_curvature_are_derivatives() -> None:
    level = implicit_level(curve_from_text(EGG))
    assert isinstance(level, ImplicitLevel)
    z, rate, t = ca.SX.sym("z", 2), ca.SX.sym("rate", 2), ca.SX.sym("t")
    value, gradient = level.at(z)
    function = ca.Function("f", [z, rate], [value, gradient, level.bent(z, rate)])
    along = ca.Function("g", [z, rate, t], [level.at(z + t * rate)[0]])
    rng, h = np.random.default_rng(3), 1e-4
    for _ in range(20):
        here, step = rng.uniform(-0.06, 0.06, 2), rng.normal(size=2)
        before, now, after = (float(along(here, step, k * h)) for k in (-1, 0, 1))
        found, slope, bend = (np.asarray(each, dtype=float) for each in function(here, step))
        assert float(found[0, 0]) == pytest.approx(now, abs=1e-12)
        assert slope[:, 0] @ step == pytest.approx((after - before) / (2 * h), rel=1e-4, abs=1e-6)
        assert bend[0, 0] == pytest.approx((after - 2 * now + before) / h**2, rel=1e-3, abs=1e-3)


def test_the_compiled_loop_is_the_interpreted_one() -> None:
    curve = curve_from_text(SQUARE)
    parameters = FIVE_BAR.parameters(across="level_set")
    kind = kind_of("path_following", parameters, curve)
    assert kind.level_set and kind.level == implicit_level(curve)
    experiment = experiments()["position"].along(curve)
    log = run(experiment.with_values({"duration": 0.2, "across": "level_set"}), "path_following")
    assert log.stopped_at is None
    assert translate_loop(kernel_of(FIVE_BAR.make(parameters), kind)).layouts.changed > 0


def test_a_slanted_plane_has_it_too() -> None:
    found = onpath.simulate(
        "flexible", path=SQUARE, across="level_set", duration=2.0, output="composite"
    )
    assert found.distance[-500:].max() < 2e-3


@pytest.mark.parametrize(
    ("equation", "why"),
    [
        ("(z1**2 + z2**2)*(z1**2 + z2**2 - 0.0025)", "gradient of s no longer points away"),
        ("sqrt(z1**2 + z2**2) - 0.05", "only a polynomial"),
        ("abs(z1)**2 + z2**2 - 0.0025", "only a polynomial"),
        ("1 - 0.0025/(z1**2 + z2**2)", "only a polynomial"),
        ("z1**2 + z2**2 - 0.0025 if z1 > 0 else z1**2 + z2**2 - 0.0025", "only a polynomial"),
    ],
)
def test_where_s_is_no_output_it_is_refused_in_words(equation: str, why: str) -> None:
    path = f"implicit {equation}"
    with pytest.raises(ValueError, match=why):
        onpath.simulate(path=path, across="level_set", duration=0.01)
    assert onpath.simulate(path=path, duration=0.01).distance.max() < 1e-3


def test_how_far_the_gradient_points_away_is_measured() -> None:
    """s = r² (r² - a²) turns round at r = a / √2, 15 mm inside a circle of 50 mm."""
    with pytest.raises(ValueError, match=r": 1[45678] mm beside it.* 50 mm wide"):
        check_level(curve_from_text("implicit (z1**2 + z2**2)*(z1**2 + z2**2 - 0.0025)"))
