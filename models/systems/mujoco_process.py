"""Lets MuJoCo read a model in a process of its own, which has limits of time and memory.

MuJoCo is a large library, and a file that makes it crash, hang or take all memory must end neither
a notebook nor a lab. This module is both ends: `read_model` starts it as a program, which answers
with plain arrays.
"""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from types import SimpleNamespace
from typing import Any
from zipfile import BadZipFile

import msgspec
import numpy as np

from onpath.models.errors import CodedError
from onpath.models.systems.xml_elements import shown

SECONDS = 30  # [s] of processor time
PATIENCE = 120.0  # [s] until the answer, on a busy machine
MEMORY = 2 << 30  # [B]
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


class Reading(msgspec.Struct, frozen=True):
    """What the process reads: a model, the files that it names, and its time limit, [s]."""

    text: str
    files: dict[str, bytes]
    seconds: int


def read_model(
    text: str, files: Mapping[str, bytes], file: str, seconds: int = SECONDS
) -> tuple[Any, tuple[str, ...]]:
    """The arrays of a model as MuJoCo reads it, by their names in MuJoCo, and its warnings.

    The names are in `body_names`, `joint_names`, `site_names` and `key_names`; "" for none.

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
    path = os.pathsep.join(map(os.path.abspath, filter(None, sys.path)))
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    try:
        ended = subprocess.run(
            [sys.executable, "-P", "-m", __name__],
            input=msgspec.msgpack.encode(Reading(text, dict(files), seconds)),
            capture_output=True,
            check=True,
            cwd=os.path.abspath(os.sep),
            env={**os.environ, **threads, "PYTHONPATH": path},
            timeout=PATIENCE,
        )
        with np.load(io.BytesIO(ended.stdout), allow_pickle=False) as answer:
            arrays = {name: answer[name] for name in FIELDS if name in answer}
            told = json.loads(str(answer["told"]))
    except subprocess.TimeoutExpired:
        raise CodedError("robot_file.mujoco_slow", file=file, seconds=seconds) from None
    except subprocess.CalledProcessError as error:
        if error.returncode == -getattr(signal, "SIGXCPU", 0):
            raise CodedError("robot_file.mujoco_slow", file=file, seconds=seconds) from None
        raise CodedError("robot_file.mujoco_ended", file=file) from None
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):  # it ended within its answer
        raise CodedError("robot_file.mujoco_ended", file=file) from None
    if told["refused"]:
        raise CodedError("robot_file.mjcf", file=file, reason=_one_line(told["refused"]))
    return SimpleNamespace(**arrays, **told["names"]), tuple(map(_one_line, told["warnings"]))


def _one_line(text: str) -> str:
    """What MuJoCo says, as it may appear in a message."""
    return shown(" ".join(text.split()), 200)


def main() -> None:
    """Read a job from stdin, and write the answer to stdout."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the library prints must not be mixed with the answer
    job = msgspec.msgpack.decode(sys.stdin.buffer.read(), type=Reading)
    _limit(job.seconds)
    arrays, told = _read(job)
    answer = io.BytesIO()
    save: Any = np.savez  # whose types do not know arrays by name
    save(answer, told=np.array(json.dumps(told)), **arrays)
    answers.write(answer.getvalue())
    answers.flush()
    os._exit(0)  # without running what a damaged library would do at its end


def _limit(seconds: int) -> None:
    with suppress(ImportError, ValueError, OSError):  # platforms without these limits
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))


def _read(job: Reading) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    warnings = list[str]()
    try:
        mujoco: Any = import_module("mujoco")
        mujoco.set_mju_user_warning(warnings.append)  # else they go to a file in the current folder
        model = mujoco.MjModel.from_xml_string(job.text, job.files)
    except Exception as error:
        refused = str(error) or type(error).__name__
        return {}, {"refused": refused, "warnings": [], "names": {}}
    names = {
        f"{kind}_names": [getattr(model, kind)(i).name for i in range(getattr(model, count))]
        for kind, count in NAMED.items()
    }
    arrays = {name: np.array(getattr(model, name)) for name in FIELDS}
    return arrays, {"refused": "", "warnings": warnings, "names": names}


if __name__ == "__main__":
    main()
