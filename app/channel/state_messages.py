"""What the lab is called and set to, and what its page says about it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from msgspec import Meta, Struct

from onpath.app.channel.plant_messages import PlantMessage
from onpath.app.lab.plot_rows import RowData

SentCommand = Annotated[Mapping[str, Any], Meta(extra={"typescript": "Command"})]
"""A command that a button of the page sends."""


class Said(Struct, frozen=True):
    """What a page says beyond the lab's message.

    Attributes:
        voice: for a screen reader; empty if the user does not want it.
        summary: a description of the screen.
        summaries: number of requests for it so far.
        stopped: whether the message says why a robot has stopped.
        replays: whether its last moments are to be shown, unless the user wants less motion.
        earlier: label of the button that restores the last good settings; empty if there are none.
        sounds: whether the distances are to be heard.
        invitation: name of what a newcomer is invited to do; empty: nothing.
        act: the command that follows it; null: it is followed in the scene itself.
    """

    voice: str = ""
    summary: str = ""
    summaries: int = 0
    stopped: bool = False
    replays: bool = False
    earlier: str = ""
    sounds: bool = False
    invitation: str = ""
    act: SentCommand | None = None


class StateMessage(Struct, frozen=True, kw_only=True, tag_field="is", tag="state"):
    """What the lab is called and set to: everything at first, then what has changed, at most ten
    times a second.

    Attributes:
        language: of the texts.
        robot: its name.
        titles: of the robots: names of their control laws.
        names: what a lesson calls the robots; else the same.
        texts: what the laws do.
        captions: what each robot does now; may be empty.
        clocks: whether a law aims at the reference point by its clock; else it aims at the closest
            point.
        stopped: whether a robot has diverged and stands still.
        rate: simulated seconds per second, as wanted.
        achieved: what was reached lately.
        undo: whether a discarded past can be restored.
        message: for the user.
        level: how severe the message is; empty without one.
        messages: how many have been shown so far: the same one may be shown again.
        said: what is spoken, and what newcomers are invited to do.
        presenting: whether large type for a projector is on.
        height: how high a part of the scene the canvas shows, at the distance of the robots [m].
        cameras: for each robot, how the picture shows a point of the output space: three rows of p
            factors and a constant; the first two results divided by the third are right and down
            from the middle, as shares of the height.
        above: the point of the output space over which a robot's title stands.
        arrow: length of the arrow of a force [m/N].
        frozen: why the lab takes no commands, if the teacher has stopped it; else empty.
        machine: displayed name of the kind of robot.
        drawn: whether the picture shows these robots, as `cameras` tells.
        waits: that time waits for what takes long; else empty.
        own: whether commands are taken: not if a teacher looks at the lab of a student.
        rows: what can be plotted of these robots.
        laws: names of the robots' control laws; a typed one is its own name.
        shared: the share code that was made last; may be empty.
        sent: keys of the latest answers that are stored, and of those that cannot be taken: they
            need not be sent again.
        scene: how many times the page had asked for a picture of the robots when it asked for the
            present one; 0 without one.
        plant: that stands in the place of the right robot; null: none.
    """

    language: str
    robot: str
    titles: list[str]
    names: list[str]
    texts: list[str]
    captions: list[str]
    clocks: list[bool]
    stopped: list[bool]
    rate: float
    achieved: float
    undo: bool
    message: str
    level: str
    messages: int
    said: Said
    presenting: bool
    height: float
    cameras: list[list[list[float]]]
    above: list[float]
    arrow: float
    frozen: str
    machine: str
    drawn: bool
    waits: str
    own: bool
    rows: list[RowData]
    laws: list[str]
    shared: str
    sent: list[str]
    scene: int = 0
    plant: PlantMessage | None = None
