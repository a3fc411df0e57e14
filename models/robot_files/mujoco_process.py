"""Lets MuJoCo read a model in a process of its own, which opens no file.

This module is both ends: `read_model` starts it as a program, which answers with plain arrays.
"""

from __future__ import annotations

import io
import json
import math
import warnings
from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from types import SimpleNamespace
from typing import Any
from zipfile import BadZipFile

import msgspec
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.robot_files.limited_process import SECONDS, ProcessEnded, answer_of, serve
from onpath.models.robot_files.xml_elements import shown

NAMED = {"body": "nbody", "joint": "njnt", "site": "nsite", "key": "nkey"}
"""Kinds of elements whose names are read, and what counts them."""
FIELDS = (
    *("body_parentid", "body_pos", "body_quat", "body_ipos", "body_iquat", "body_inertia"),
    *("body_mass", "body_jntadr", "body_jntnum"),
    *("jnt_type", "jnt_pos", "jnt_axis", "jnt_dofadr", "jnt_qposadr", "jnt_bodyid", "jnt_limited"),
    *("jnt_range", "jnt_actfrclimited", "jnt_actfrcrange", "jnt_stiffness"),
    *("qpos0", "key_qpos", "dof_damping", "dof_armature"),
    *("geom_type", "geom_bodyid", "geom_dataid", "geom_group", "geom_size", "geom_rgba"),
    *("geom_pos", "geom_quat", "mesh_vertadr", "mesh_vertnum", "mesh_vert", "mesh_faceadr"),
    *("mesh_facenum", "mesh_face", "site_bodyid", "site_pos", "site_quat"),
    *("actuator_trnid", "actuator_gear", "actuator_forcelimited", "actuator_forcerange"),
)
"""The arrays of `mjModel` that are read."""


LEAST_INERTIA = 1e-12  # [kg m²], below which MuJoCo may refuse a principal moment
ROUNDING = 1e-9  # share of C by which A + B must exceed it, so that MuJoCo finds A + B ≥ C, too
USUAL_DENSITY = 1000.0  # [kg/m³], of geoms in MuJoCo


class Reading(msgspec.Struct, frozen=True):
    """What the process reads: a model, and the files that it names."""

    text: str
    files: dict[str, bytes]


def read_model(
    text: str, files: Mapping[str, bytes], file: str, seconds: int = SECONDS
) -> tuple[Any, tuple[str, ...]]:
    """The arrays of a model as MuJoCo reads it, by their names in MuJoCo, and its warnings.

    The names are in `body_names`, `joint_names`, `site_names` and `key_names`; "" for none. The
    numbers of bodies whose masses are from geoms, of none of which the file says how heavy it is,
    are in `weighed`. Inertias that the file states and no moving body can have, about the axes of
    <inertial>, are in `impossible` by the numbers of their bodies, in place of what `body_inertia`
    has for them.

    Args:
        text: an MJCF file.
        files: content of the files that it names.
        file: the name of the file for messages.
        seconds: of processor time that it may take.

    Raises:
        CodedError: MuJoCo is not installed, refuses the model, or has ended.
    """
    if find_spec("mujoco") is None:
        raise CodedError("robot_file.mujoco")
    job = msgspec.msgpack.encode(Reading(text, dict(files)))
    try:
        answered = answer_of(__name__, job, seconds)
        with np.load(io.BytesIO(answered), allow_pickle=False) as answer:
            arrays = {name: answer[name] for name in FIELDS if name in answer}
            told = json.loads(str(answer["told"]))
    except ProcessEnded as ended:
        if ended.slow:
            raise CodedError("robot_file.mujoco_slow", file=file, seconds=seconds) from None
        raise CodedError("robot_file.mujoco_ended", file=file) from None
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):  # it ended within its answer
        raise CodedError("robot_file.mujoco_ended", file=file) from None
    if told["refused"]:
        raise CodedError("robot_file.mjcf", file=file, reason=_one_line(told["refused"]))
    impossible = {number: np.array(inertia) for number, inertia in told["impossible"]}
    parts = {**told["names"], "weighed": told["weighed"], "impossible": impossible}
    model = SimpleNamespace(**arrays, **parts)
    return model, tuple(map(_one_line, told["warnings"]))


def _one_line(text: str) -> str:
    """What MuJoCo says, as it may appear in a message."""
    return shown(" ".join(text.split()), 200)


def _answer(job: bytes) -> bytes:
    arrays, told = _read(msgspec.msgpack.decode(job, type=Reading))
    answer = io.BytesIO()
    save: Any = np.savez  # whose types do not know arrays by name
    save(answer, told=np.array(json.dumps(told)), **arrays)
    return answer.getvalue()


def _read(job: Reading) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    said = list[str]()
    told: dict[str, Any] = {"names": {}, "weighed": [], "impossible": []}
    try:
        mujoco: Any = import_module("mujoco")
        _close_files()
        mujoco.set_mju_user_warning(said.append)  # else they go to a file in the current folder
        spec = mujoco.MjSpec.from_string(job.text, assets=job.files)
        told["weighed"] = _weighed(spec)
        impossible = dict(_impossible(spec))
        with warnings.catch_warnings(record=True, action="always") as caught:
            model = spec.compile()
    except Exception as error:
        return {}, {**told, "refused": str(error) or type(error).__name__, "warnings": []}
    for number, inertia in impossible.items():
        mass = float(spec.bodies[number].mass)
        scale = float(model.body_mass[number]) / mass if mass else 1.0  # of settotalmass
        told["impossible"].append((number, (scale * inertia).tolist()))
    told["names"] = {
        f"{kind}_names": [getattr(model, kind)(i).name for i in range(getattr(model, count))]
        for kind, count in NAMED.items()
    }
    arrays = {name: np.array(getattr(model, name)) for name in FIELDS}
    said += [str(each.message) for each in caught]
    return arrays, {**told, "refused": "", "warnings": [*dict.fromkeys(said)]}


def _impossible(spec: Any) -> Iterator[tuple[int, Array]]:
    """The inertias, (3, 3), that MuJoCo would refuse, by the numbers of their bodies.

    MuJoCo gets another one for these bodies.
    """
    kind = spec.compiler.inertiafromgeom.name
    if spec.compiler.balanceinertia or kind == "mjINERTIAFROMGEOM_TRUE":
        return
    for number, body in enumerate(spec.bodies):
        if not body.explicitinertial:
            continue
        xx, yy, zz, xy, xz, yz = (float(each) for each in body.fullinertia)
        inertia = np.diag([float(each) for each in body.inertia])
        if not math.isnan(xx):
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        least, middle, most = np.linalg.eigvalsh(inertia)
        if least < LEAST_INERTIA or least + middle < (1 + ROUNDING) * most:
            body.inertia, body.fullinertia = [1, 1, 1], [math.nan, 0, 0, 0, 0, 0]
            yield number, inertia


def _weighed(spec: Any) -> list[int]:
    """The numbers of bodies of which the file says neither a mass nor a density."""
    if spec.compiler.settotalmass > 0:
        return []
    always = spec.compiler.inertiafromgeom.name == "mjINERTIAFROMGEOM_TRUE"
    return [
        number
        for number, body in enumerate(spec.bodies)
        if body.geoms and (always or not body.explicitinertial)
        if all(map(_says_nothing, body.geoms))
    ]


def _says_nothing(geom: Any) -> bool:
    """Whether a geom has no mass, and the density that MuJoCo gives where there is none."""
    return math.isnan(geom.mass) and geom.density == USUAL_DENSITY


def _close_files() -> None:
    """From now on, this process can open no file and no connection."""
    with suppress(ImportError, ValueError, OSError):  # platforms without this limit
        import resource

        resource.setrlimit(resource.RLIMIT_NOFILE, (0, 0))


if __name__ == "__main__":
    serve(_answer)
