"""The messages of a page's data channel, in both directions; here alone they are defined.

A message is a JSON object, whose `is` names its kind. Commands, which have `do` instead, are those
of `app/lab/commands`. `assets/web/channel/messages.ts` is made of all of them by `typescript.py`.
Lists of robots have the left one first.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from onpath.app.channel.class_messages import Lead
from onpath.app.channel.sheet_messages import (
    ClassMessage,
    Compared,
    CompareSheet,
    DisplaySheet,
    HelpSheet,
    Index,
    KeepSheet,
    LawSheet,
    LessonSheet,
    Request,
    RobotSheet,
    SeatAnswer,
    Told,
)
from onpath.app.lab.setups.share_code import LONGEST_TEXT
from onpath.lessons.checks import Verdict

JointSymbol = Literal["q_1", "q_2", "delta", "rho"]
"""The symbols of lessons whose meaning depends on the kind of robot."""
LONGEST_NAME = 200  # of a file, [characters]

# From the page

Kept = Annotated[str, Meta(max_length=500)]
"""What a browser has kept; empty if nothing."""


Typed = Annotated[str, Meta(max_length=LONGEST_TEXT)]
"""A law, for instance, or a share code."""


class Hello(
    Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="is", tag="hello"
):
    """The first message of a page.

    Attributes:
        page: a random number of its own, by which viser's websocket is known to be the same page's.
        labs: the codes of the browser's labs, newest first, separated by commas.
        teacher: the pass of a teacher of the class at the page's address.
        site: where the browser has opened the site.
        dark: whether the browser asks for dark pages.
        plain: whether it draws in software, so that the scene must be quickly drawn.
        upright: whether its window is so; letters in the scene are larger then.
        speaks, sounds, first_minute: see `Store`.
    """

    page: Annotated[str, Meta(pattern="^[0-9a-f]{32,64}$")]
    labs: Kept = ""
    teacher: Kept = ""
    site: Kept = ""
    dark: bool = False
    plain: bool = False
    upright: bool = False
    speaks: Kept = ""
    sounds: Kept = ""
    first_minute: Kept = ""


class Seen(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="seen"):
    """The page is drawn: comes every two seconds. A lab that nobody sees rests."""


class Dark(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="dark"):
    """The browser now asks for dark pages, or for light ones."""

    on: bool


class Resized(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="resized"):
    """The canvas has another size: the camera is then fitted to it.

    Attributes:
        upright: see `Hello`.
    """

    upright: bool = False


class Skip(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="skip"):
    """The user wants no introduction any more."""


class AskForm(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="fields"):
    """Tell the form and the values of its fields, from now on."""


class SetField(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="set"):
    """A field of the form has another value.

    Attributes:
        number: larger than that of all messages before; see `ValuesMessage.heard`.
    """

    name: Annotated[str, Meta(max_length=60)]
    value: bool | Annotated[float, Meta(ge=-1e9, le=1e9)] | Typed
    number: int


class Light(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="light"):
    """Tell where a symbol is found on the robots, until another one is asked for.

    Attributes:
        symbol: "bars" for the ends of all bars, two for each; empty to be told nothing more.
    """

    symbol: JointSymbol | Literal["bars", ""]


class Plot(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="plots"):
    """Tell more of each sample, also of the past, until another one comes.

    Attributes:
        fields: that the page plots; see `ASKED` in app/lab/plot_rows.py.
    """

    fields: Annotated[tuple[str, ...], Meta(max_length=20)]


class PathFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="path"):
    """A file with a path that the robots are to follow.

    Attributes:
        size: of the path, [mm]; 0: as the file states it.
        radius: with which its corners are rounded, [mm]; 0: it is smoothed.
        opened: whether it is open, although its ends meet.
    """

    size: Annotated[float, Meta(ge=0, le=400)] = 100.0
    radius: Annotated[float, Meta(ge=0, le=100)] = 0.0
    opened: bool = False


class SendFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="send"):
    """A file will come in parts: the first after the answer to this, `FileMessage`, and each
    further one after the answer to the one before.

    Attributes:
        number: names the file in what follows.
        name: of the file.
        size: [B].
        use: what is done with it.
    """

    number: int
    name: Annotated[str, Meta(max_length=LONGEST_NAME)]
    size: Annotated[int, Meta(ge=0)]
    use: PathFile


class SendPart(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="part"):
    """The next part of a file.

    Attributes:
        number: of the file.
        content: at most 180 kB, in base64.
    """

    number: int
    content: bytes


class DropFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="drop"):
    """No more of a file will come.

    Attributes:
        number: of the file.
    """

    number: int


class MakeFile(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="make"):
    """Make a file for a download; one at a time. Answered by `DownloadMessage`.

    Attributes:
        file: a table of the last minute (CSV), a picture of its plots (PNG), a page with the scene
            of its last seconds, or a page with the record of all lessons.
        with_code: whether the record shows the lab's code, which then opens the lab.
    """

    file: Literal["table", "picture", "film", "report"]
    with_code: bool = False


PageMessage = (
    Hello
    | Seen
    | Dark
    | Resized
    | Skip
    | AskForm
    | SetField
    | Light
    | Plot
    | SendFile
    | SendPart
    | DropFile
    | MakeFile
    | Lead
    | Request
)
"""What a page sends besides commands; `Hello` comes first, and only once."""


# To the page

SentCommand = Annotated[Mapping[str, Any], Meta(extra={"typescript": "Command"})]
"""A command that a button of the page sends."""


class LabCode(Struct, frozen=True, tag_field="is", tag="lab"):
    """The code of the page's lab, which its browser keeps before those of its other labs."""

    code: str


StoredName = Literal["teacher", "speaks", "sounds", "first_minute"]
"""Names of what a browser keeps; see `Store`."""


class Store(Struct, frozen=True, tag_field="is", tag="store"):
    """The browser is to keep a value for `Hello`, or to forget it if it is empty.

    Attributes:
        key: "teacher": a pass, of the class at the page's address; "speaks" and "sounds": "yes" or
            "no"; "first_minute": how many of the invitations it has shown.
    """

    key: StoredName
    value: str


class Wait(Struct, frozen=True, tag_field="is", tag="wait"):
    """The page has no lab yet: the server is full.

    Attributes:
        text: says so to the user.
    """

    text: str


class WordsMessage(Struct, frozen=True, tag_field="is", tag="words"):
    """The page's texts by key; when its language changes."""

    language: str
    words: dict[str, str]


class FrameMessage(Struct, tag_field="is", tag="frame", omit_defaults=True):
    """The samples since the last frame; 20 times a second while anything in it changes, less often
    under load or if the page reads slowly.

    A row is `[time, flags, …left robot, …right robot]`. The flags are bits: left held, right held,
    left pulled, right pulled. A robot has p + p + 3 numbers, where p is 2 or 3: its distance from
    the path, θ of the closest point, θ of the reference point, end-point (p), external force on it
    (p). Times are in 0.1 ms, lengths in 10 µm, angles in 0.1 mrad, forces in 10 mN. End-points are
    coordinates of the output space, `Robot.position` of which is where they are drawn. After both
    robots come the numbers of `fields`, all of the left robot, then all of the right one; null
    where ξ had another unit than now.

    Attributes:
        rows: 60 per second, the oldest first; the last one is the present. They replace all samples
            of the page from the time of the first one on.
        running: whether time runs.
        past: the past instant that the lab shows [s], or null.
        anew: whether the page must forget all its samples first; `rows` has the last minute.
        fields: with `anew`: for each field that the page has asked for and the robots have, its
            name, how many of its numbers are told, and how many units an SI unit has.
        straight: only for a link that bends: for each of the last rows, where the end-points would
            be if it did not, as end-points are given in a row.
    """

    rows: list[list[int | None]]
    running: bool
    past: float | None
    anew: bool = False
    fields: list[tuple[str, int, float]] | UnsetType = UNSET
    straight: list[list[int]] | UnsetType = UNSET


class PathMessage(Struct, frozen=True, tag_field="is", tag="path"):
    """The drawn path, when it changes.

    Attributes:
        points: of the output space, at evenly spaced θ from -π to π, in 10 µm. A closed path is
            periodic, an open one goes on along its end tangents.
        closed: whether it is closed.
        right, up: two unit vectors at right angles, in which the path is seen from in front.
    """

    points: list[list[int]]
    closed: bool
    right: list[float]
    up: list[float]


class LitMessage(Struct, frozen=True, tag_field="is", tag="lit"):
    """Where the symbol is found that is asked for, whenever the robots have moved, at most 20
    times a second.

    Attributes:
        symbol: what is asked for.
        lines: for each robot the points of a line, or one point for a joint, in 10 µm of the output
            space.
    """

    symbol: str
    lines: list[list[list[int]]]


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
        together: whether pulling and holding act on both robots.
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
        scene: how many times the page had asked for a picture of the robots when it asked for the
            present one; 0 without one.
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
    together: bool
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
    rows: Annotated[list[dict[str, Any]], Meta(extra={"typescript": "RowData[]"})]
    laws: list[str]
    shared: str
    scene: int = 0


class LessonMessage(Struct, frozen=True, kw_only=True, tag_field="is", tag="lesson"):
    """The open step of a lesson, or its end; when another one is open, or anything is noted in it.
    A teacher's page has none.

    What is right is told only once the student has answered, or has seen what happens; in a test
    never.

    Attributes:
        lesson: its name; empty: no lesson is open, and the other fields but `version` are, too.
        version: changes with every message.
        index: number of the open step, from 0.
        ended: whether the end is shown.
        test: whether it is the concept test.
        playing: whether the lab plays the step's script.
        symbols: names of the lesson's symbols that mean something on this robot, and what they
            mean.
        head, pager: HTML of what stands above and below the text. A button's `data-send` has the
            messages that it sends.
        sections: HTML by number of the step: the open one, and the one whose prediction it shows;
            `end` for the end of a lesson. Both come from `assets/templates/step`, as on the course
            site.
        steps: what the script needs of each step; parts and plots only of those in `sections`.
        notes: the answers of the open step.
        charts: at the end: the curves of each prediction, in the order of the elements
            `[data-chart]`.
    """

    lesson: str
    version: int
    index: int = 0
    ended: bool = False
    test: bool = False
    playing: bool = False
    symbols: dict[str, str] = {}
    head: str = ""
    pager: str = ""
    sections: dict[str, str] = {}
    steps: Annotated[list[dict[str, Any]], Meta(extra={"typescript": "StepData[]"})] = []
    notes: Annotated[dict[str, Any], Meta(extra={"typescript": "Notes"})] | UnsetType = UNSET
    charts: Annotated[list[dict[str, Any]], Meta(extra={"typescript": "ChartData[]"})] = []


class MeasuredMessage(Struct, frozen=True, tag_field="is", tag="measured"):
    """What is measured in the open step of a lesson, at most ten times a second.

    Attributes:
        verdicts: on each check of each task.
        truth: while a script runs: the curves so far of the predicted quantity, three times a
            second; else null.
    """

    verdicts: dict[str, list[Verdict]]
    truth: Annotated[dict[str, Any], Meta(extra={"typescript": "Curves"})] | None


FieldValue = float | str | bool
"""The value of a field, in the unit in which it is kept."""


class FormNeed(Struct, frozen=True, omit_defaults=True):
    """A condition under which a field acts: another one has one of these values.

    Attributes:
        of: none: any but 0, "off" and false.
    """

    name: str
    of: tuple[FieldValue, ...] = ()


class FormOption(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A value that may be chosen.

    Attributes:
        picture: an outline: a path of SVG in a square from -50 to 50, up is negative.
    """

    value: FieldValue
    label: str
    help: str = ""
    picture: str = ""


class FormField(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A row of a form. Its value is told by its name; a note's is what it says. The value of
    `poles` has a line for each pole: its channel, its real and its imaginary part, [1/s]; that of
    "html" comes from a template that escapes what users have typed.

    Attributes:
        help: what one will see, in a sentence.
        low, high, step: range of a number.
        limit: of a number: the name of the value above which it is unstable.
        factor: how many of `unit` make one unit of the value.
        needs: what it needs in order to act: of each, one suffices.
        on: the number to which a switch sets it, if 0 is off.
        default: to which one goes back; None: there is no way back.
        mark: the value of a lesson's step.
        act: the command that a button sends.
        asks: the question that it asks before it does.
        tone: of a note or a button: "main", "warning" or none; of a note also the side whose colour
            it has, "of_left" or "of_right", or "ranks", below the colours of the rank test's map.
        picture: the address of a button's picture.
        section: a heading above all fields of the same section.
    """

    name: str
    kind: Literal["number", "choice", "switch", "button", "text", "note", "poles", "html"]
    label: str
    symbol: str = ""
    unit: str = ""
    help: str = ""
    low: float = 0.0
    high: float = 0.0
    step: float = 0.0
    limit: str = ""
    factor: float = 1.0
    scale: Literal["linear", "log"] = "linear"
    on: float | None = None
    options: tuple[FormOption, ...] = ()
    needs: tuple[tuple[FormNeed, ...], ...] = ()
    default: FieldValue | None = None
    mark: FieldValue | None = None
    act: Mapping[str, Any] | None = None
    asks: str = ""
    tone: str = ""
    section: str = ""
    picture: str = ""


class FormGroup(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """Fields that belong together.

    Attributes:
        level: "first": seen at once; "deeper": to be opened.
        states: names of the fields whose values make its line while it is closed.
        rest: its line while nothing in it is on.
    """

    name: str
    title: str
    fields: tuple[FormField, ...]
    level: Literal["first", "deeper"] = "first"
    states: tuple[str, ...] = ()
    rest: str = ""


class FormMessage(
    Struct, frozen=True, omit_defaults=True, kw_only=True, tag_field="is", tag="form"
):
    """All fields of a place; without groups, there is no such place now."""

    place: Literal["lab", "step", "figure", "class"]
    groups: tuple[FormGroup, ...]


class ValuesMessage(Struct, frozen=True, omit_defaults=True, tag_field="is", tag="values"):
    """Values of fields: all of them at first, then those that have changed.

    Attributes:
        refused: why the last value of a setting was refused; empty: it was not.
        heard: of each setting of the page, the number of its last message that counts here.
    """

    values: dict[str, FieldValue]
    refused: dict[str, str] = {}
    heard: dict[str, int] = {}


FORMS: tuple[type[Struct], ...] = (FormMessage, ValuesMessage)
"""Messages that the data of pages without a server have, too."""


class FileMessage(Struct, frozen=True, tag_field="is", tag="file"):
    """How far the server is with a file of the page.

    Attributes:
        number: of the file.
        state: more of it is awaited, it is being read, it has been used, or it is refused.
        received: how much has come, [B].
        why: it is refused: a sentence in the page's language; else empty.
    """

    number: int
    state: Literal["awaited", "reading", "used", "refused"]
    received: int = 0
    why: str = ""


class DownloadMessage(Struct, frozen=True, tag_field="is", tag="download"):
    """How far the server is with a file for the page.

    Attributes:
        number: names the file in what follows.
        name: of the file.
        state: it is being made, its parts come now, or it cannot be made.
        text: the same in the page's language.
        size: of a file whose parts come now, [B]; else 0.
    """

    number: int
    name: str
    state: Literal["making", "coming", "failed"]
    text: str
    size: int = 0


class DownloadPart(Struct, frozen=True, tag_field="is", tag="part"):
    """The next part of a file for the page.

    Attributes:
        number: of the file.
        content: in base64.
    """

    number: int
    content: bytes


class Alive(Struct, frozen=True, tag_field="is", tag="alive"):
    """Comes whenever nothing else has been told for a second."""


class Refused(Struct, frozen=True, tag_field="is", tag="refused"):
    """A message of the page was refused.

    What a command cannot do is told in `StateMessage.message`.

    Attributes:
        why: in English, for programmers.
    """

    why: str


LabMessage = (
    LabCode
    | Store
    | Wait
    | WordsMessage
    | FrameMessage
    | PathMessage
    | LitMessage
    | StateMessage
    | LessonMessage
    | MeasuredMessage
    | FormMessage
    | ValuesMessage
    | FileMessage
    | DownloadMessage
    | DownloadPart
    | Alive
    | Refused
    | RobotSheet
    | LawSheet
    | CompareSheet
    | KeepSheet
    | LessonSheet
    | HelpSheet
    | DisplaySheet
    | Index
    | Compared
    | Told
    | ClassMessage
    | SeatAnswer
)
"""What the server sends."""

BY_CHANGES: tuple[type[Struct], ...] = (StateMessage,)
"""Messages of which, after the first one, only changed fields are sent; see `changes`."""


def changes(message: Struct, before: Struct | None) -> dict[str, Any]:
    """The fields of a message that differ from the one before; empty if there are none."""
    names = message.__struct_fields__
    return {
        name: value
        for name in names
        if (value := getattr(message, name)) != getattr(before, name, UNSET)
    }


def encoded(message: Struct) -> bytes:
    """A message as text."""
    return _encoder.encode(message)


def encoded_changes(kind: type[Struct], fields: Mapping[str, Any]) -> bytes:
    """A message with only the fields that have changed, as text."""
    config = kind.__struct_config__
    return _encoder.encode({config.tag_field: config.tag, **fields})


_encoder = msgspec.json.Encoder(enc_hook=str)  # texts that are safe HTML
