"""What a controller is made of: robot, law, settings and paths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.simulation import (
    FREE,
    check_level_set,
    kernel_of,
    kind_of,
    raised,
    settings_vector,
)
from onpath.models.controller.c_code import operations_in
from onpath.models.controller.functions import (
    AT_FAULT,
    REFUSALS,
    Functions,
    controller_functions,
    controller_kind,
)
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameter
from onpath.models.paths.spline_curves import WINDOW
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Design:
    """A controller's robot, law, settings and paths. Make it with `design`.

    Attributes:
        robot, law, parameters: as in a closed loop.
        paths: by name, at least one; the first is followed first.
        at_fault: one of `AT_FAULT`.
        fastest: largest rate of a joint that is not refused, [rad/s], or [m/s] if it slides.
        kind: of the loop that the controller is a part of.
        functions: of the controller.
    """

    robot: Robot
    law: str
    parameters: Parameters
    paths: Mapping[str, Curve]
    at_fault: str
    fastest: float
    kind: Kind
    functions: Functions

    def settings(self, curve: Curve) -> Array:
        """The controller's settings on a path, shape (functions.settings.size,)."""
        kernel = kernel_of(self.robot, self.kind)
        whole = settings_vector(self.robot, kernel.layouts, self.parameters, curve, FREE)
        layout, fields = self.functions.settings, kernel.settings.unpack(whole)
        own = {"at_fault": float(AT_FAULT.index(self.at_fault)), "fastest": self.fastest}
        used = {name: fields[name] for name, _ in layout.fields if name in fields}
        return layout.pack(used | own)

    @property
    def operations(self) -> int:
        """Operations on numbers in a tick."""
        functions = self.functions
        scalar = sum(map(operations_in, (functions.due, functions.step)))
        return scalar + self._at_places

    @property
    def operations_at_a_point(self) -> int:
        """Operations on numbers for a point in a search for the closest one."""
        return operations_in(self.functions.near) + self._at_places

    @property
    def _at_places(self) -> int:
        """Operations that evaluate the path: those of the basis, and the products with it."""
        functions = self.functions
        terms = WINDOW if functions.spline else functions.table_shape[1]
        return operations_in(functions.basis) + 2 * terms * functions.step.numel_in(2)

    def changed(self, robot: Robot, parameters: Parameters, paths: Mapping[str, Curve]) -> Design:
        """The same controller with other settings or paths, as for `design`.

        Raises:
            CodedError: see `design`; or it needs other functions.
        """
        curves, kind = _kind(self.law, parameters, paths)
        if kind != self.kind or robot.core is not self.robot.core:
            raise CodedError("error.controller_differs")
        return replace(self, robot=robot, parameters=parameters, paths=curves)

    def closest(self, curve: Curve, q: Array) -> float:
        """θ of the path's point that is closest to the end-point at q, [rad]."""
        return closest_parameter(self.robot.frame, curve, self.robot.endpoint(q))

    def reason(self, code: int, q: Array) -> Message | None:
        """Why a step was refused; None if it was not.

        Args:
            code: from the controller's state.
            q: the configuration, shape (n,).
        """
        if code == 0:
            return None
        if code <= len(REFUSALS):
            return [*REFUSALS.values()][code - 1]
        where = q if np.isfinite(q).all() else None
        return self.robot.reasons(where, self.parameters)[code - len(REFUSALS) - 1]


def design(
    robot: Robot,
    law: str,
    parameters: Parameters,
    paths: Mapping[str, Curve],
    at_fault: str,
    fastest: float,
) -> Design:
    """The controller of a robot under a law.

    Args:
        law: name of a law; not of one that is a Python function.
        paths: by name, without the rise of the parameters.
        at_fault, fastest: as in `Design`.

    Raises:
        CodedError: the law does not suit the robot, or a path has no level set; the paths are of
            different kinds; or the speed has a profile.
    """
    curves, kind = _kind(law, parameters, paths)
    return Design(
        robot=robot,
        law=law,
        parameters=parameters,
        paths=curves,
        at_fault=at_fault,
        fastest=fastest,
        kind=kind,
        functions=controller_functions(robot.core, kind),
    )


def _kind(
    law: str, parameters: Parameters, paths: Mapping[str, Curve]
) -> tuple[dict[str, Curve], Kind]:
    """The paths with the rise of the parameters, and the kind of the controller; see `design`."""
    if profile_of(parameters) is not None:
        raise CodedError("error.controller_profile")
    curves = {name: raised(curve, parameters) for name, curve in paths.items()}
    for curve in curves.values():
        check_level_set(parameters, curve)
    observer = parameters.observer_time > 0
    kinds = [controller_kind(kind_of(law, parameters, each), observer) for each in curves.values()]
    if any(kind != kinds[0] for kind in kinds):
        raise CodedError("error.controller_paths")
    return curves, kinds[0]
