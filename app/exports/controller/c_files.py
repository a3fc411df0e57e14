"""A controller as C: source, header, and a replay of runs of the lab."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import partial
from importlib.metadata import version
from string import Template

import numpy as np

from onpath.app.exports.controller.recorded_runs import SEGMENT, RecordedRun, recorded_runs
from onpath.assets import asset_path
from onpath.models.arrays import Array
from onpath.models.control.laws.own import law_title
from onpath.models.control.settable import specs
from onpath.models.controller.c_code import (
    Place,
    c_array,
    c_function,
    c_name,
    c_number,
    elements_of,
    fields_of,
)
from onpath.models.controller.design import Design
from onpath.models.controller.functions import REFUSALS
from onpath.models.layout import Layout
from onpath.models.paths.curves import ORDERS, Curve
from onpath.models.paths.spline_curves import WINDOW, SplineCurve

REFINEMENTS = 4
"""Steps of the search for the closest point."""
COMPUTED = "computed by OnPath from robot, path and gains"
MEANINGS = {
    "position": "1: go to target; 0: keep the speed",
    "target": "theta where to stop",
    "speed": "wanted speed of theta",
    "ramp": "how quickly the wanted speed changes; 0: at once",
    "speed_limit": COMPUTED,
    "tracker_integral": "1: a law with a clock uses K3, too",
    "plane": COMPUTED,
    "level_centre": COMPUTED,
    "level_weights": COMPUTED,
    "level_constant": COMPUTED,
    "plan": COMPUTED,
    "pieces": COMPUTED,
    "hold_ticks": "ticks of a control interval",
    "dt": "length of a tick [s]: not to be changed",
    "look_ahead": "the law is evaluated for a state so much later [s]",
    "delay_ticks": "ticks from a measurement to its torque, which the observer knows",
    "model": "parameters of the robot as the law knows them",
    "at_fault": "after a refusal: 0 no torque, 1 the last one, 2 against the velocities",
    "fastest": "largest rate of a joint that is not refused [rad/s], or [m/s] if it slides",
    "torque_limit": "motors give no more than this; 1e300: no limit",
    "observer_time": "in which the observer forgets its errors",
    "encoder_filter": "time constant of the filter that finds velocities without an observer",
    "q": "coordinates as measured last",
    "v": "velocities, measured or found",
    "theta": "parameter of the closest point [rad]",
    "theta_ref": "reference point of a law that has one [rad]",
    "torque": "as given last",
    "code": "why the last step was refused",
}
"""What the fields mean whose declarations do not say it."""


def controller_files(
    design: Design, robot: str, stem: str, guesses: Sequence[str] = ()
) -> dict[str, str]:
    """Source, header and replay by the names of their files.

    Args:
        robot: its label.
        stem: of the files' names; also the prefix of all names in C.
        guesses: what is guessed about the robot, in sentences.

    Raises:
        CodedError: the law has an operation that cannot be translated.
    """
    name = c_name(stem)
    runs = recorded_runs(design)
    values = _values(design, robot, name) | {
        "guesses": "".join(f"   {_comment(each)}\n" for each in guesses),
        "segment": str(SEGMENT),
        "header": f"{stem}.h",
        "source": f"{stem}.c",
        "replay": f"{stem}_replay.c",
    }
    layout = design.functions.state
    written = [_run(f"run{i}", each, layout, name) for i, each in enumerate(runs, 1)]
    values["runs"] = "\n\n".join(written)
    values["calls"] = "\n".join(_call(f"run{i}", each) for i, each in enumerate(runs, 1))
    return {
        f"{stem}.h": _filled("law.h", values),
        f"{stem}.c": _filled("law.c", values),
        f"{stem}_replay.c": _filled("replay.c", values),
    }


def _filled(template: str, values: Mapping[str, str]) -> str:
    text = asset_path(f"templates/controller/{template}").read_text("utf-8")
    return Template(text).substitute(values)


def _values(design: Design, robot: str, name: str) -> dict[str, str]:
    """What the templates insert."""
    functions, system = design.functions, design.robot.system
    rows, points = functions.table_shape
    columns = functions.step.size_in(2)[1]
    curves = [*design.paths.values()]
    grid = max(curve.grid for curve in curves)
    numbers = functions.step.size1_in(2)
    terms = WINDOW * ORDERS if functions.spline else points
    settings = [design.settings(curve) for curve in curves]
    title = f"{law_title(design.law)} for {robot}"
    observer = "an observer with the robot's model" if design.kind.observer else "a filter"
    return {
        "name": name,
        "upper": name.upper(),
        "guard": f"{name.upper()}_H",
        "title": _comment(title),
        "version": version("onpath"),
        "tick": f"{settings[0][functions.settings.slices['dt']][0]:g}",
        "operations": f"{design.operations:,}",
        "search": f"{(grid + REFINEMENTS) * design.operations_at_a_point:,}",
        "observer": observer,
        "n": str(system.n),
        "m": str(system.m),
        "coordinates": _comment("q: " + ", ".join(system.coordinate_names)),
        "motors": "torque [N m], or force [N] of a motor that slides",
        "paths": str(len(curves)),
        "path_names": _comment(", ".join(design.paths)),
        "codes": _codes(design, name.upper()),
        "settings": _members(functions.settings, design),
        "state": _members(functions.state, design),
        "rows": str(rows),
        "terms": str(terms),
        "columns": str(columns),
        "numbers": str(numbers),
        "grid": str(grid),
        "refinements": str(REFINEMENTS),
        "first": c_number(-np.pi),
        "spacing": c_number(2 * np.pi / (grid if curves[0].closed else grid - 1)),
        "raised_count": str(max(1, *(len(_raised(curve)) for curve in curves))),
        "raised": _links(curves),
        "table_size": str(rows * points),
        "tables": _tables(curves),
        "defaults": _structs(functions.settings, settings),
        "functions": _functions(design, name),
        "evaluation": _EVALUATION[functions.spline],
        "following": _following(functions.settings, settings),
    }


def _comment(text: str) -> str:
    """A text that cannot end a comment, in one line."""
    return re.sub(r"\s+", " ", text).replace("*/", "* /").replace("/*", "/ *").replace("\\", "/")


def _codes(design: Design, upper: str) -> str:
    """The members of the enumeration of codes."""
    meanings = [("OK", "")]
    meanings += [(each.upper(), _reason(design, i)) for i, each in enumerate(REFUSALS, 1)]
    count = len(design.robot.reasons(None, design.parameters))
    for i in range(1, count + 1):
        code = len(REFUSALS) + i
        meanings.append((f"LIMIT_{i}", _reason(design, code)))
    lines = [f"    {upper}_{each} = {i}" for i, (each, _) in enumerate(meanings)]
    texts = [f" /* {text} */" if text else "" for _, text in meanings]
    commas = [","] * (len(lines) - 1) + [""]
    return "\n".join(map("".join, zip(lines, commas, texts, strict=True)))


def _reason(design: Design, code: int) -> str:
    nowhere = np.full(design.robot.system.n, np.nan)
    return _comment(str(design.reason(code, nowhere)))


def _members(layout: Layout, design: Design) -> str:
    """The members of a struct, with what is known of each."""
    declared, lines = specs(design.parameters), list[str]()
    for name, size in layout.fields:
        member = c_name(name) if size == 1 else f"{c_name(name)}[{size}]"
        spec, text = declared.get(name), MEANINGS.get(name, "")
        if name == "model":
            text += f": {', '.join(design.robot.system.parameter_names)}"
        if spec is not None:
            text = f"{text or spec.help}{f' [{spec.unit}]' if spec.unit else ''}"
        lines.append(f"    double {member};" + (f" /* {_comment(text)} */" if text else ""))
    return "\n".join(lines)


def _tables(curves: Sequence[Curve]) -> str:
    return "{\n" + ",\n".join(c_array(curve.table().tolist()) for curve in curves) + "\n}"


def _raised(curve: Curve) -> tuple[tuple[float, float], ...]:
    return curve.raised if isinstance(curve, SplineCurve) else ()


def _links(curves: Sequence[Curve]) -> str:
    """The raised links of each path, padded with NaN."""
    most = max(1, *(len(_raised(curve)) for curve in curves))
    nothing = (np.nan, np.nan)
    padded = [[*_raised(curve), *[nothing] * (most - len(_raised(curve)))] for curve in curves]
    rows = ["{" + ", ".join(c_array(pair) for pair in each) + "}" for each in padded]
    return "{\n" + ",\n".join(rows) + "\n}"


def _structs(layout: Layout, vectors: Sequence[Array]) -> str:
    """Initial values of an array of structs."""
    return "{\n" + ",\n".join(_struct(layout, vector) for vector in vectors) + "\n}"


def _struct(layout: Layout, vector: Array) -> str:
    lines = list[str]()
    for where in layout.slices.values():
        numbers = vector[where].tolist()
        lines.append(c_number(numbers[0]) if len(numbers) == 1 else c_array(numbers))
    return "{\n    " + ",\n    ".join(lines) + "\n}"


def _following(layout: Layout, settings: Sequence[Array]) -> str:
    """The statements that take over the settings which differ between the paths."""
    lines = list[str]()
    for name, where in layout.slices.items():
        differs = any(not np.array_equal(each[where], settings[0][where]) for each in settings)
        if not differs:
            continue
        for i in range(where.stop - where.start):
            member = c_name(name) + (f"[{i}]" if where.stop - where.start > 1 else "")
            lines.append(f"    c->settings.{member} = settings_of[path].{member};\n")
    return "".join(lines)


def _functions(design: Design, name: str) -> str:
    """The functions of a controller in C."""
    functions, owner = design.functions, law_title(design.law)
    state, settings = (f"const {name}_state *state", f"const {name}_settings *settings")
    kept = fields_of(functions.state, "state->"), fields_of(functions.settings, "settings->")
    q, v, values = map(elements_of, ("q", "v", "values"))
    sample = fields_of(functions.sample, "")
    translated = partial(c_function, owner=owner)
    basis = [elements_of("basis"), elements_of("pieces")][: functions.basis.n_out()]
    pieces = ", double *pieces" if len(basis) > 1 else ""
    texts = [
        translated(
            functions.begin,
            f"static void begin({name}_state *state, double t, const double *q, const double *v,\n"
            "                  double theta)",
            [_single("t"), q, v, _single("theta")],
            [fields_of(functions.state, "state->")],
        ),
        translated(
            functions.due,
            f"static double due({state}, {settings}, double t)",
            [*kept, _single("t")],
            [_single("const double missed")],
        ).removesuffix("}")
        + "    return missed;\n}",
        translated(
            functions.basis,
            f"static void basis_at({state}, {settings}, double *basis{pieces})",
            kept,
            basis,
        ),
        translated(
            functions.step,
            f"static void tick({name}_state *state, {settings}, const double *values,\n"
            "                 double t, const double *q, const double *v, double has_q,\n"
            "                 double has_v, double *torque)",
            [*kept, values, sample],
            [fields_of(functions.state, "state->"), elements_of("torque")],
        ),
        translated(
            functions.near,
            f"static void closer({settings}, const double *values, double theta, const double *q,\n"
            "                   double *better, double *squared)",
            [kept[1], values, _single("theta"), q],
            [_single("*better"), _single("*squared")],
        ),
    ]
    return "\n\n".join(texts)


def _single(text: str) -> Place:
    return lambda _: text


_SERIES = """    int column, row, k;

    basis_at(state, &c->settings, basis);
    for (column = 0; column < COLUMNS; column++) {
        for (row = 0; row < NUMBERS; row++) {
            double sum = 0.0;
            for (k = 0; k < TERMS; k++) {
                sum += c->path[NUMBERS * k + row] * basis[TERMS * column + k];
            }
            values[NUMBERS * column + row] = sum;
        }
    }"""
_PIECES = """    double pieces[COLUMNS];
    int column, order, row, k;

    basis_at(state, &c->settings, basis, pieces);
    for (column = 0; column < COLUMNS; column++) {
        const double *points = c->path + ROWS * (int)pieces[column];
        for (order = 0; order < NUMBERS / ROWS; order++) {
            const double *shares = basis + TERMS * column + order * (TERMS / (NUMBERS / ROWS));
            for (row = 0; row < ROWS; row++) {
                double sum = 0.0;
                for (k = 0; k < TERMS / (NUMBERS / ROWS); k++) {
                    sum += points[ROWS * k + row] * shares[k];
                }
                values[NUMBERS * column + ROWS * order + row] = sum;
            }
        }
    }"""
_EVALUATION = {False: _SERIES, True: _PIECES}


def _run(run: str, recorded: RecordedRun, layout: Layout, name: str) -> str:
    rows = ",\n".join(c_array(row.tolist()) for row in recorded.rows)
    text = f"static const double {run}[{len(recorded.rows)}][1 + 2 * N + M] = {{\n{rows}\n}};"
    if not recorded.states:
        return text
    states = _structs(layout, recorded.states)
    return f"{text}\n\nstatic const {name}_state {run}_states[] = {states};"


def _call(run: str, recorded: RecordedRun) -> str:
    states = f"{run}_states" if recorded.states else "NULL"
    has_v, theta = int(recorded.has_v), c_number(recorded.theta)
    given = f'"{recorded.title}", {run}, {len(recorded.rows)}, {states}, {has_v}, {theta}'
    return f"    wrong |= replay({given});"
