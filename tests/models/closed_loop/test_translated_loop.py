"""What LLVM runs is what CasADi's virtual machine runs, instruction by instruction."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path

import casadi as ca
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import LoopLayouts, loop_layouts
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import FREE, kernel_of, kind_of
from onpath.models.closed_loop.translated_loop import (
    fastest_loop,
    translate,
    translate_loop,
)
from onpath.models.control.laws.registry import LAWS, NAMES
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.paths.space_curves import saddle
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.flexible_robot import FlexibleParameters, robot_for
from onpath.models.systems.robots import Robot, RobotEntry
from tests.support.scalar_operations import logging_kernel

PLANTS = ("unit_modes", "lagrangian")


def flexible(plant: str) -> Robot:
    return robot_for(replace(FlexibleParameters(), modes=1, plant=plant))


@pytest.mark.thorough
@pytest.mark.parametrize("stiction", [False, True])
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_a_compiled_loop_keeps_the_layouts_and_not_the_graphs(name: str, stiction: bool) -> None:
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    kind = Kind(NAMES[0], delay=stiction, noise=stiction, stiction=stiction)
    kernel = kernel_of(robot, kind)
    layouts = translate_loop(kernel).layouts
    assert type(layouts) is LoopLayouts and layouts == loop_layouts(robot.system, kind)
    inputs = [kernel.advance.numel_in(i) for i in range(2)]
    outputs = [kernel.advance.numel_out(i) for i in range(2)]
    assert (inputs, outputs) == (
        [layouts.changed, layouts.settings.size],
        [layouts.changed, layouts.log.size],
    )


def test_an_operation_without_a_translation_is_named() -> None:
    x = ca.SX.sym("x", 2)
    kernel = replace(logging_kernel([ca.SX.unary(ca.OP_ERFINV, x[0])], x), law="erring")
    with pytest.raises(CodedError, match=r"^erring uses .*OP_ERFINV.* LLVM$"):
        translate(kernel)
    assert isinstance(fastest_loop(kernel), InterpretedLoop)


@pytest.mark.thorough
@pytest.mark.parametrize("law", NAMES)
@pytest.mark.parametrize("encoder", [False, True])
@pytest.mark.parametrize("free", [False, True])
def test_every_loop_of_every_robot_can_be_translated(law: str, encoder: bool, free: bool) -> None:
    paths = [(True, False), (True, True), (False, False)]
    for closed, level_set in paths:
        kind = Kind(law, closed, level_set, encoder, free)
        assert "onpath_run" in translate(kernel_of(RIGID_FIVE_BAR, kind))
        for plant, output in product(PLANTS, ("redefined", "composite")):
            assert translate(kernel_of(flexible(plant), replace(kind, output=output)))


@pytest.mark.thorough
@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_no_law_takes_a_third_more_operations_than_path_following(entry: RobotEntry) -> None:
    robot, curve = entry.make(entry.parameters()), circle(0.05)
    curves = [curve] if robot.frame.space is None else [curve, saddle(curve, 0.02)]
    for path in curves:
        kinds = (
            kind_of(name, entry.parameters(), path, FREE)
            for name, law in LAWS.items()
            if law.suits(robot.system)
        )
        counts = {kind.law: operations(kernel_of(robot, kind)) for kind in kinds}
        most = {"velocity_field": 2.0, "time_optimal_tracking": 1.8}  # plan at three places
        for name, count in counts.items():
            assert count <= most.get(name, 1.3) * counts["path_following"], (name, path)


def operations(kernel: Kernel) -> int:
    """Of a compiled tick; the rows of the curve's table are summed side by side."""
    return len(re.findall(r" = (?:fadd|fsub|fmul|fdiv|fneg|fcmp|call) ", translate(kernel)))


@pytest.mark.thorough
def test_llvm_is_loaded_only_where_it_is_needed() -> None:
    script = """
import sys
import onpath.app.server.lab_server
assert not any("llvm" in name for name in sys.modules)
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    subprocess.run([sys.executable, "-c", script], check=True, env=environment)


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform != "linux", reason="reads the resident memory from /proc")
def test_a_compiled_loop_keeps_its_machine_code_and_not_its_compiler() -> None:
    kernel = kernel_of(RIGID_FIVE_BAR, Kind("path_following"))
    loops = [translate_loop(kernel) for _ in range(4)]
    before = resident()
    loops += [translate_loop(kernel) for _ in range(24)]
    assert resident() - before < 24 * 0.6e6  # [B]


def resident() -> int:
    """Memory of this process, [B]."""
    return int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]) * os.sysconf(
        "SC_PAGE_SIZE"
    )
