"""Reads the meshes of a robot's file in a process of its own, before the server listens."""

from __future__ import annotations

import logging
from pathlib import Path

from onpath.app.exports.export_process import ExportError, ExportProcess
from onpath.app.scene.body_meshes import is_own, keep_shapes, read_shapes
from onpath.models.errors import Message
from onpath.models.robot_files.chain import Chain

log = logging.getLogger(__name__)
LONGEST = 60.0  # [s] that reading the shapes of a robot may take


def prepare_shapes(chain: Chain) -> None:
    """Read the meshes of a chain; those that cannot be read are left out, with a warning."""
    if is_own(chain):
        return
    log.info("reading the meshes")
    process = ExportProcess()
    try:
        shapes, left_out = process.call(LONGEST, read_shapes, chain)
    except ExportError as error:
        lines = str(error).splitlines()
        files = {Path(s.file).name for body in chain.bodies for s in body.shapes if s.file}
        shapes, left_out = [None] * (chain.n + 1), [(", ".join(sorted(files)), lines[-1])]
    finally:
        process.stop()
    for mesh, reason in left_out:
        told = Message("robot_file.mesh_unreadable", {"mesh": mesh, "reason": reason})
        log.warning("%s", told)
    keep_shapes(chain, shapes)
