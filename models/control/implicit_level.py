"""The polynomial of an implicit path as the output across it, as eq. (15) for a circle.

λ = s(z) / g. With the constant g, λ is the distance to first order, on average over the path:

    g = mean of |∇s| over the path, with the sign for which λ is positive on the left.

The virtual output (θ, λ) exists where ∇s is not orthogonal to the normal at the closest point of
the path. `check_level` requires that in the whole tube in which the closest point is unique.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws.expressions import read, syntax_tree
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.paths.tube import curve_frames, offset, tube_width

INSIDE = 0.9
"""Share of the tube that is checked: at its border the closest point is not unique."""
WIDEST = 0.1
"""Half the width of the strip that is checked, if the tube is wider, [m]."""
SAMPLES, LINES = 240, 41
LEAST = 0.02
"""Least slope of λ along the normal of the closest point; near the path it is 1."""
_OF_POLYNOMIALS = (
    *(ast.BinOp, ast.UnaryOp, ast.Name, ast.Constant),
    *(ast.operator, ast.unaryop, ast.expr_context),
)


@dataclass(frozen=True, slots=True)
class ImplicitLevel:
    """λ = s(z) / g, as `LevelSet` of models/control/virtual_output.py.

    Attributes:
        text: s, in z1 and z2.
        scale: g, [unit of s / m].
    """

    text: str
    scale: float

    def at(self, z: ca.SX) -> tuple[ca.SX, ca.SX]:
        """λ, (1, 1), [m], and its gradient, (2, 1)."""
        s, gradient, _ = _derivatives(self.text)(z)
        return s / self.scale, gradient / self.scale

    def bent(self, z: ca.SX, z_rate: ca.SX) -> ca.SX:
        """λ'' at z'' = 0, which is z'ᵀ (∂²λ/∂z²) z', (1, 1), [m/s²]."""
        hessian = _derivatives(self.text)(z)[2]
        return ca.dot(z_rate, hessian @ z_rate) / self.scale


def level_function(text: str) -> ca.Function:
    """The function z -> s(z) of a text such as "(z1/0.05)**4 + (z2/0.04)**4 - 1"; z (2, 1), [m].

    Raises:
        ValueError: it is not a formula of z1 and z2.
    """
    formulas = read(text, ("z1", "z2"), ("s",))
    z = ca.SX.sym("z", 2)
    return ca.Function("s", [z], [formulas({"z1": z[0], "z2": z[1]})["s"]])


@lru_cache(maxsize=64)
def _derivatives(text: str) -> ca.Function:
    """The function z -> s, ∇s (2, 1) and the Hessian (2, 2)."""
    z = ca.SX.sym("z", 2)
    s = level_function(text)(z)
    gradient = ca.densify(ca.gradient(s, z))
    return ca.Function("level", [z], [s, gradient, ca.densify(ca.jacobian(gradient, z))])


@lru_cache(maxsize=64)
def implicit_level(curve: Curve) -> ImplicitLevel | None:
    """λ of a curve that is given by an equation; None for any other curve."""
    if curve.equation is None:
        return None
    frames = curve_frames(curve, curve.sample(SAMPLES))
    across = _across(curve.equation, frames.sigma, frames.normals[:, 0])
    return ImplicitLevel(curve.equation, float(across.mean()))


@lru_cache(maxsize=64)
def check_level(curve: Curve) -> None:
    """Refuse a level set that is not an output everywhere in the tube of its path.

    Raises:
        CodedError: s is no polynomial, or λ does not grow along the normals of the path there.
    """
    level = implicit_level(curve)
    assert level is not None
    if not _is_polynomial(level.text):
        raise CodedError("error.level_no_polynomial")
    frames, width = curve_frames(curve, curve.sample(SAMPLES)), min(tube_width(curve), WIDEST)
    for beside in sorted(INSIDE * width * np.linspace(-1, 1, LINES), key=abs):
        points = offset(frames, np.full((SAMPLES, 1), beside))
        slope = _across(level.text, points, frames.normals[:, 0]) / level.scale
        if not slope.min() > LEAST:
            millimetres = f"{1e3 * abs(beside):.0f}", f"{1e3 * width:.0f}"
            raise CodedError("error.level_gradient", beside=millimetres[0], tube=millimetres[1])


def _is_polynomial(text: str) -> bool:
    """Whether s is a polynomial; `level_function` has read the text, so exponents are constant."""
    parts = list(ast.walk(syntax_tree(text.partition("=")[2].strip())))
    divisors = [p.right for p in parts if isinstance(p, ast.BinOp) and isinstance(p.op, ast.Div)]
    in_divisors = [part for each in divisors for part in ast.walk(each)]
    return all(isinstance(part, _OF_POLYNOMIALS) for part in parts) and not any(
        isinstance(part, ast.Name) for part in in_divisors
    )


def _across(text: str, points: Array, normals: Array) -> Array:
    """N · ∇s at some points, (n,)."""
    gradient = np.asarray(_derivatives(text).map(len(points))(points.T)[1], dtype=float)
    return (gradient.T * normals).sum(-1)
