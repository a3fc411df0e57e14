"""Commands of a page that cost as much as the limits allow, drawn at random."""

from __future__ import annotations

import json
import math
import random
from typing import Any

from onpath.app.lab.commands.command_codec import LONGEST
from onpath.app.lab.commands.lessons import MOST_ACTIONS
from onpath.app.lab.commands.path import MOST_STROKE_POINTS
from onpath.app.server.built_in_course import built_in_course
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import declared

MEGABYTE = 1_000_000


def dear_command(draw: random.Random) -> dict[str, Any]:
    """A command of a page, with the arguments that take longest."""
    return draw.choice(_KINDS)(draw)


def dear_message(draw: random.Random) -> str:
    """Such a command, or one that is larger than any other message may be."""
    if draw.random() < 0.03:
        return draw.choice([_actions, _stroke])(draw, MEGABYTE)
    return json.dumps(dear_command(draw), separators=(",", ":"))


def _actions(draw: random.Random, size: int) -> str:
    """Changes of the robot in bulk, in a message of some size."""
    robots = draw.sample([*ROBOTS], 2)
    one = ",".join(f'{{"robot":"{robot}"}}' for robot in robots)
    return f'{{"do":"Act","actions":[{",".join([one] * (size // (len(one) + 1) - 1))}]}}'


def _stroke(draw: random.Random, size: int) -> str:
    """A stroke of as many points as a message of some size has."""
    del draw
    return f'{{"do":"DrawPath","stroke":[{",".join(["[0,0]"] * (size // 6 - 10))}]}}'


def _act(draw: random.Random) -> dict[str, Any]:
    robots = draw.sample([*ROBOTS], 2)
    cheap = {"set": {"K1": 500.0}}
    kinds = [[{"robot": name} for name in robots], [{"reset": True}], [{"path": "clover"}, cheap]]
    some = draw.choice(kinds)
    return {"do": "Act", "actions": (some * MOST_ACTIONS)[:MOST_ACTIONS]}


def _draw(draw: random.Random) -> dict[str, Any]:
    count, noise = MOST_STROKE_POINTS, draw.choice([0.0, 0.001, 0.05])
    radius, waves = draw.uniform(0.02, 0.06), draw.randrange(2, 9)

    def point(k: int) -> list[float]:
        turn = 2 * math.pi * k / count
        r = radius * (1 + 0.3 * math.cos(waves * turn)) + draw.gauss(0, noise)
        return [round(r * math.cos(turn), 6), round(r * math.sin(turn), 6)]

    stroke = [point(k) for k in range(count)]
    assert len(json.dumps(stroke)) < LONGEST
    return {"do": "DrawPath", "stroke": stroke}


def _parameter(draw: random.Random) -> dict[str, Any]:
    """Any parameter of any robot, at an end of its range or anywhere."""
    specs = declared(draw.choice([*ROBOTS.values()]).parameters)
    name = draw.choice([*specs])
    spec = specs[name]
    values = spec.options or (spec.low, spec.high, draw.uniform(spec.low, spec.high))
    return {"do": "Set", "name": name, "value": draw.choice(values)}


def _law(draw: random.Random) -> dict[str, Any]:
    return {"do": "ChooseLaw", "side": draw.choice(["left", "right"]), "law": draw.choice([*LAWS])}


def _typed(draw: random.Random) -> dict[str, Any]:
    """A typed law that nobody has typed before, and that is as long as allowed."""
    terms = " + ".join(f"sin(K{1 + k % 5}*xi*{k})" for k in range(24))
    text = f"across = -K1*xi - K2*dxi - {draw.random():.9f}*({terms}); along = -K5*(dtheta - speed)"
    return {"do": "TypeLaw", "side": draw.choice(["left", "right"]), "text": text}


def _point(draw: random.Random) -> dict[str, Any]:
    far = {"first": draw.choice([-5.0, 5.0]), "second": draw.choice([-5.0, 5.0])}
    move = {"index": 0, "target": [draw.uniform(-1, 1), draw.uniform(-1, 1)], "finished": False}
    commands: list[dict[str, Any]] = [
        {"do": "SelectPoint", "index": draw.randrange(8)},
        {"do": "PlacePoint"} | far,
        {"do": "MovePoint"} | move,
        {"do": "AddPoint"},
        {"do": "MoveStart", "target": [draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1)]},
    ]
    return draw.choice(commands)


def _lesson(draw: random.Random) -> dict[str, Any]:
    commands: list[dict[str, Any]] = [
        {"do": "OpenLesson", "name": draw.choice([*built_in_course().lessons])},
        {"do": "GoToStep", "by": draw.choice([-1, 1])},
        {"do": "BeginStepAnew"},
        {"do": "PlayStep"},
        {"do": "CloseLesson"},
    ]
    return draw.choice(commands)


def _simple(draw: random.Random) -> dict[str, Any]:
    names = "Reset StepOnce ResetParameters Identify Share GoOn UndoGoOn Undo Redo ReplayBreakdown"
    return {"do": draw.choice(names.split())}


def _robot(draw: random.Random) -> dict[str, Any]:
    return {"do": "ChooseRobot", "name": draw.choice([*ROBOTS])}


def _path(draw: random.Random) -> dict[str, Any]:
    return {"do": "ChoosePath", "name": draw.choice([*presets()])}


_KINDS = (
    *(_act, _draw, _parameter, _parameter, _law, _typed, _point, _point),
    *(_lesson, _simple, _robot, _path),
)
