"""`onpath.controller`: a control law alone, for a plant that is elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from onpath.app.common.atomic_file import check_file, whole_file
from onpath.app.common.own_laws import compiled_law
from onpath.app.exports.controller.c_files import controller_files
from onpath.app.notebook.arguments import array_of, check_number, curve_of, looked_up, path_name
from onpath.app.notebook.simulate import check_names, entry_named
from onpath.models.arrays import Array
from onpath.models.control.laws.own import law_title
from onpath.models.control.settable import with_values
from onpath.models.controller.design import Design, design
from onpath.models.controller.functions import AT_FAULT, REFUSALS
from onpath.models.controller.steps import Steps
from onpath.models.paths.curves import Curve
from onpath.models.studies.experiments import check_path
from onpath.models.systems.guessed_numbers import guess_sentences
from onpath.models.systems.parameter_specs import out_of_range, unknown_name
from onpath.models.systems.robots import FASTEST_JOINT, RobotEntry

GivenPath = str | Path | Curve


def controller(
    robot: str | Path | RobotEntry = "five_bar",
    path: GivenPath | Sequence[GivenPath] | Mapping[str, GivenPath] = "circle",
    law: Any = "path_following",
    *,
    at_fault: str = "zero",
    fastest: float = FASTEST_JOINT,
    **settings: Any,
) -> Controller:
    """A control law without a plant: `step` turns measurements into torques.

    What it does in a step is what `onpath.simulate` does in a tick, without the robot, so that both
    give the same torques, bit by bit. `save` writes it as C, which gives them, too.

    It checks each measurement: that its numbers are finite, that it comes in time, that no joint
    has jumped or is too fast, and that the robot is within its limits. It refuses what fails:
    `code` and `reason` say why, and the torque is what `at_fault` chose until `start` is called.

    It is no safety function: a real arm needs a stop that cuts the power, and its maker's limits.

    Args:
        robot, law: as for `onpath.simulate`; a law that is a Python function is refused.
        path: as for `onpath.simulate`, or several, which can be followed in turn: a list of them,
            or a mapping from names to them. All are closed, or none is.
        at_fault: after a measurement has been refused, "zero" torque, "hold" the last torque, or
            "damp": against the velocities, such that a motor alone slows down to 1/e in 0.1 s.
        fastest: largest rate of a joint, above which a measurement is refused, [rad/s], or [m/s] of
            one that slides.
        settings: as for `onpath.simulate`. Those of the plant, such as dry friction, are not used;
            `observer_time` is that of the observer which finds the velocities if they are not
            measured, or a filter does if it is 0.

    Raises:
        ValueError: an unknown name or an invalid value; the robot cannot follow a path.
        OSError: a file cannot be read.

    It gives the torques of a run of the lab for what was measured there:

    >>> import numpy as np, onpath
    >>> law = onpath.controller("two_link_arm", "circle", K1=900)
    >>> run = onpath.simulate("two_link_arm", "circle", K1=900, duration=0.1)
    >>> torques = [law.step(t, q, v) for t, q, v in zip(run.t, run.q, run.v)]
    >>> bool((torques == run.torque).all())
    True
    """
    entry, name = entry_named(robot), compiled_law(law)
    check_names(settings, entry, controller)
    if at_fault not in AT_FAULT:
        raise unknown_name(at_fault, [*AT_FAULT], "at_fault")
    check_number("fastest", fastest, "rad/s")
    if not 0 < fastest <= FASTEST_JOINT:
        raise out_of_range("fastest", f"{fastest:g}", "0", f"{FASTEST_JOINT:g} rad/s")
    parameters = with_values(entry.parameters(), settings)
    made = entry.make(parameters)
    curves = {key: _checked(given, made) for key, given in _named(path).items()}
    return Controller(design(made, name, parameters, curves, at_fault, fastest), entry)


class Controller:
    """A control law that runs beside a plant. Make it with `onpath.controller`.

    Attributes:
        design: what it is made of.
        entry: its robot.
        curve: the path that it follows.
    """

    def __init__(self, design: Design, entry: RobotEntry) -> None:
        self.design, self.entry = design, entry
        self.curve = next(iter(design.paths.values()))
        settings, table = design.settings(self.curve), self.curve.table()
        self._steps = Steps(design.functions, settings, table)

    def start(
        self, t: float, q: ArrayLike, v: ArrayLike | None = None, theta: float | None = None
    ) -> None:
        """Start at time t [s], or start again after a refusal.

        Args:
            q, v: measured coordinates and velocities, each shape (n,); None: at rest.
            theta: of the closest point of the path, [rad]; None: it is searched for.

        Raises:
            ValueError: they have another form.
        """
        place, rate = self._vector("q", q), self._vector("v", np.zeros(self._n) if v is None else v)
        where = self.design.closest(self.curve, place) if theta is None else theta
        self._steps.start(t, place, rate, where)

    def step(self, t: float, q: ArrayLike, v: ArrayLike | None = None) -> Array:
        """The torques of the motors from a measurement, shape (m,), [N m].

        The first step starts the controller. Later ones may come in every tick of 1 ms, or once in
        a control interval; the torque changes once in a control interval.

        Args:
            t: time of the measurement, [s].
            q: coordinates, shape (n,): angles of the joints [rad].
            v: their velocities, shape (n,), [rad/s]; None: they are not measured.

        Raises:
            ValueError: they have another form. What is wrong in their numbers is in `code`.
        """
        check_number("t", t, "s")
        place = self._vector("q", q)
        rate = None if v is None else self._vector("v", v)
        if not self._steps.started:
            self.start(t, place, rate)
        return self._steps.step(t, place, rate)

    def stop(self, reason: str = "stopped") -> None:
        """Refuse the next steps: their torque is what `at_fault` chose, until `start` is called.

        Args:
            reason: what `code` and `reason` are to tell: one of `REFUSALS`, such as "late" if no
                measurement comes.

        Raises:
            ValueError: it has not been started, or there is no such reason.
        """
        if not self._steps.started:
            raise ValueError("the controller has not been started")
        if reason not in REFUSALS:
            raise unknown_name(reason, [*REFUSALS], "reason")
        self._steps.refuse(reason)

    def follow(self, path: GivenPath) -> None:
        """Follow another path from the next step on, from its point closest to the end-point.

        Args:
            path: a name of `design.paths`, or any path of their kind, as for `onpath.simulate`.

        Raises:
            ValueError: the robot cannot follow it, or it is of another kind.
        """
        known = self.design.paths
        if not (isinstance(path, str) and path in known):
            made = _checked(path, self.design.robot)
            known = self._designed({"path": made}, self.design.parameters).paths
        self.curve = known.get(str(path), next(iter(known.values())))
        self._steps.settings = self.design.settings(self.curve)
        self._steps.table = self.curve.table()
        if self._steps.started:
            fields = self._steps.fields
            fields["theta"][:] = self.design.closest(self.curve, fields["q"])
            fields["theta_ref"][:] = fields["theta"]

    def set(self, **settings: Any) -> None:
        """Change settings from the next step on, such as `set(speed=3, K1=900)`.

        Raises:
            ValueError: an unknown name or an invalid value, or one that needs another controller.
        """
        check_names(settings, self.entry, controller)
        parameters = with_values(self.design.parameters, settings)
        self.design = self._designed(self.design.paths, parameters)
        self._steps.settings = self.design.settings(self.curve)

    @property
    def code(self) -> int:
        """Why the last step was refused; 0: it was not."""
        return int(self._steps.fields["code"][0]) if self._steps.started else 0

    @property
    def reason(self) -> str:
        """Why the last step was refused, in a sentence, or ""."""
        message = self.code and self.design.reason(self.code, self._steps.fields["q"])
        return str(message or "")

    @property
    def interval(self) -> float:
        """Time between two evaluations of the law, [s]."""
        return 1 / self.design.parameters.control_rate

    @property
    def v(self) -> Array:
        """Velocities in the last step, measured or found, shape (n,), [rad/s]."""
        return self._steps.fields["v"].copy() if self._steps.started else np.full(self._n, np.nan)

    @property
    def theta(self) -> float:
        """Parameter of the closest point of the path, [rad]."""
        return float(self._steps.fields["theta"][0]) if self._steps.started else np.nan

    @property
    def theta_ref(self) -> float:
        """Parameter of the reference point, of a law with a clock, [rad]."""
        return float(self._steps.fields["theta_ref"][0]) if self._steps.started else np.nan

    @property
    def draws(self) -> bool:
        """Whether the pen is down: not on a link between two strokes of a drawing."""
        curve = self.curve
        return bool(curve.draws(np.array(self.theta)))

    @property
    def operations(self) -> int:
        """Operations on numbers in a tick."""
        return self.design.operations

    def save(self, file: str | Path) -> Path:
        """Write it as C99: NAME.c, NAME.h, and NAME_replay.c, which compares it with the lab.

        Raises:
            ValueError: the name does not end in .c, or the law cannot be translated.
        """
        target = Path(file).expanduser()
        check_file(target, (".c",), "controller")
        guesses = guess_sentences(self.entry.guesses)
        files = controller_files(self.design, self.entry.label, target.stem, guesses)
        for name, text in files.items():
            with whole_file(target.parent / name) as scratch:
                scratch.write_text(text, "utf-8")
        return target

    def __repr__(self) -> str:
        name = f"{law_title(self.design.law)}, {self.entry.name}, {', '.join(self.design.paths)}"
        return f"<controller: {name}: .step(t, q, v), .save(file)>"

    @property
    def _n(self) -> int:
        return self.design.robot.system.n

    def _vector(self, name: str, values: ArrayLike) -> Array:
        """Numbers of any kind, also such that are not finite, shape (n,)."""
        form = f"{self._n} numbers"
        given = array_of(name, values, form).ravel()
        if given.shape != (self._n,):
            raise ValueError(f"{name}: expected {form}, got {values!r}")
        return given

    def _designed(self, paths: Mapping[str, Curve], parameters: Any) -> Design:
        """The same controller with other paths or parameters, if it has the same functions."""
        flat = {name: curve.plan for name, curve in paths.items()}
        return self.design.changed(self.entry.make(parameters), parameters, flat)


def _named(path: Any) -> Mapping[str, GivenPath]:
    if isinstance(path, Mapping):
        return path
    several = path if isinstance(path, list | tuple) else [path]
    return {_name(each, number): each for number, each in enumerate(several, 1)}


def _name(path: GivenPath, number: int) -> str:
    if isinstance(path, Curve):
        return f"path {number}"
    return path_name(path) if isinstance(path, str) else path.stem


def _checked(path: GivenPath, robot: Any) -> Curve:
    with looked_up("onpath.paths()"):
        curve = curve_of("path", path, robot)
    check_path(robot, curve, path if isinstance(path, str) else "")
    return curve
