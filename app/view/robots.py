"""The robots to choose from, each with a picture and what is special about it."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from msgspec import structs, to_builtins

from onpath.app.channel.sheet_messages import ChooseTip, RobotCard, RobotSheet
from onpath.app.common.robot_files import GivenFile, built_with, given_file
from onpath.app.lab.commands import ChooseRobot
from onpath.app.lab.commands.command_codec import message_of
from onpath.app.view.robot_sketch import robot_sketch
from onpath.assets import asset_path
from onpath.lessons.labels import robot_label, robot_text
from onpath.lessons.words import Words
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.guessed_numbers import guess_sentences
from onpath.models.systems.robots import RobotEntry


def robot_sheet(words: Words) -> RobotSheet:
    """All robots of the catalogue, in its order, and those that their files suggest besides."""
    cards = [robot_card(entry, words) for entry in tuple(ROBOTS.values())]
    return RobotSheet(robots=[*cards, *_not_built(cards, words)])


def _not_built(cards: Sequence[RobotCard], words: Words) -> Iterator[RobotCard]:
    """The tips that files suggest and nobody has chosen yet."""
    offered = set[tuple[Path, str]]()
    for card in cards:
        given = given_file(card.name)
        if given is None:
            continue
        for tip in given.tips:
            key = given.file, tip
            if key not in offered and not built_with(given.with_tip(tip)):
                offered.add(key)
                yield structs.replace(
                    card,
                    differs=words("robots.tip", tip=shown(tip)),
                    text=words("robots.build"),
                    tip=tip,
                    is_built=False,
                    send=_choosing_tip(card.name, tip),
                )


def robot_card(entry: RobotEntry, words: Words) -> RobotCard:
    """A robot, and what is special about it; one from a file has only its text."""
    text, given = robot_text(entry, words), given_file(entry.name)
    tip = _tip(given)
    text = words("robots.tip", tip=shown(tip)) if tip else text
    return RobotCard(
        name=entry.name,
        label=robot_label(entry.name, words),
        differs=words.get(f"robots.differs_{entry.name}", text),
        text=about_robot(entry, words),
        picture=picture_of(entry),
        tip=tip,
        send=choosing(entry.name),
    )


def choosing(robot: str) -> dict[str, Any]:
    """The message that chooses a robot of the catalogue."""
    tip = _tip(given_file(robot))
    return _choosing_tip(robot, tip) if tip else message_of(ChooseRobot(robot))


def _choosing_tip(robot: str, tip: str) -> dict[str, Any]:
    return to_builtins(ChooseTip(robot=robot, tip=tip))


def _tip(given: GivenFile | None) -> str:
    """The tip of a robot from a file that suggests several; else ""."""
    return "" if given is None or len(given.tips) < 2 else given.tip


def about_robot(entry: RobotEntry, words: Words) -> str:
    """What a robot is, and what is guessed about it, with what settles it."""
    text = robot_text(entry, words)
    return " ".join([text, *guess_sentences(entry.guesses, words.language)])


@lru_cache(maxsize=32)
def picture_of(entry: RobotEntry) -> str:
    """A data URI: an asset, or else a sketch of the robot's bars and joints."""
    if entry.picture:
        return _data("image/webp", asset_path(entry.picture).read_bytes())
    return _data("image/svg+xml", robot_sketch(entry.make(entry.parameters())).encode())


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"
