"""What the search finds besides settings: robots, laws, paths, lessons, and what keys do."""

from __future__ import annotations

from collections.abc import Iterator

from onpath.app.channel.sheet_messages import Found, Index
from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import message_of
from onpath.app.view.keys import shown_keys
from onpath.app.view.laws import suitable
from onpath.app.view.robots import choosing
from onpath.lessons.course import Course
from onpath.lessons.labels import path_label, robot_label, robot_text
from onpath.lessons.sides import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import Robot

BESIDE_PLANT = ("undo", "redo", "summary", "view")
"""Keys of a lab of which one robot is a plant elsewhere."""


def index(robot: Robot, course: Course, words: Words, plant: bool = False) -> Index:
    """The index of a lab with a robot.

    Args:
        plant: whether a robot is a plant elsewhere.
    """
    keys = shown_keys(words, next(iter(course.lessons), ""))
    if plant:
        return Index(found=[*_paths(words)], keys=[key for key in keys if key.name in BESIDE_PLANT])
    found = [*_robots(words), *_laws(robot, words), *_paths(words), *_lessons(course, words)]
    found += [Found(kind="key", label=key.does, text=key.shown, send=[key.send]) for key in keys]
    return Index(found=found, keys=keys)


def _robots(words: Words) -> Iterator[Found]:
    for entry in tuple(ROBOTS.values()):
        yield Found(
            kind="robot",
            label=robot_label(entry.name, words),
            text=robot_text(entry, words),
            send=[choosing(entry.name)],
        )


def _laws(robot: Robot, words: Words) -> Iterator[Found]:
    """Each law once for each side."""
    for name in suitable(robot):
        for side in SIDES:
            yield Found(
                kind="law",
                label=f"{law_label(name, words)}: {words(f'side.{side}')}",
                text=law_text(name, words),
                send=[message_of(c.ChooseLaw(side, name))],
            )


def _paths(words: Words) -> Iterator[Found]:
    for name in presets():
        yield Found(
            kind="path",
            label=path_label(name, words),
            text="",
            send=[message_of(c.ChoosePath(name))],
        )


def _lessons(course: Course, words: Words) -> Iterator[Found]:
    for name, number in course.numbers().items():
        front = course.lesson(name, words.language).front
        yield Found(
            kind="lesson",
            label=f"{number}. {front.title}",
            text=front.summary,
            send=[message_of(c.OpenLesson(name))],
        )
