"""What opens over a page: what it asks for, and what the sheets show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

# From the page

SheetName = Literal["robots", "laws", "compare", "keep", "lessons", "help", "display", "index"]
"""What a page can open, and the index of its search."""

Typed = Annotated[str, Meta(max_length=200)]
"""A code or a name as somebody has typed it."""


class Freehand(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="freehand"):
    """The next stroke around a robot becomes the path; asked for again, no stroke does."""


class Ask(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="ask"):
    """Tell what a sheet shows; the answer's `is` is its name."""

    what: SheetName


class Prefer(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="prefer"):
    """Keep a switch in the browser; see `app.view.preferences`."""

    name: Literal["speaks", "sounds"]
    on: bool


class ResetView(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="view"):
    """Show the robots as at the beginning."""


class AskSummary(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="summary"):
    """Describe what is on the screen."""


class EnterLab(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="enter"):
    """Go to the lab of a code; if that is refused, `Told` says why."""

    code: Typed


class ChooseTip(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="choose_tip"):
    """Have the robot of a file with another of the tips that the file suggests.

    It may have to be built first; the lab says how far that is, and why if it fails.

    Attributes:
        robot: the name of a robot of the file.
    """

    robot: Typed
    tip: Annotated[str, Meta(max_length=2000)]


class CompareLaws(
    Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="compare_laws"
):
    """Compare laws under an obstruction; `Compared` tells the results, and `Told` why not."""

    laws: Annotated[list[Annotated[str, Meta(max_length=2000)]], Meta(min_length=1, max_length=6)]
    obstruction: Annotated[str, Meta(max_length=80)]


class JoinClass(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="join"):
    """Join a class; answered by `SeatAnswer`.

    Attributes:
        code: of the class; only needed where the page's address has none.
        name: the nickname.
    """

    code: Typed
    name: Typed


class LeaveClass(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="leave"):
    """Leave the class; answered by `SeatAnswer`."""


class AskPlace(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="ask_place"):
    """Ask the teacher for the place of the same name that is away; see `ClassMessage.away`."""


class ForgetMe(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="forget_me"):
    """Delete the lab with everything that is stored of the student, and leave the class."""


class IdentifyMyself(
    Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="identify"
):
    """Say by what a platform knows the student, if the teacher has asked for it; or take it back.

    Answered by `SeatAnswer`.
    """

    typed: Typed


class LinkWord(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="link"):
    """Give a word of the student's own, which links two tests, or take it back with an empty one.

    Answered by `SeatAnswer`.
    """

    word: Typed


class Teach(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="teach"):
    """Open the teacher's page with the teacher's key.

    Answered by `SeatAnswer`, unless the page becomes the teacher's.
    """

    key: Typed


SeatRequest = JoinClass | LeaveClass | AskPlace | ForgetMe | IdentifyMyself | LinkWord | Teach
"""What changes the lab's place in the class."""

Request = (
    Ask
    | Freehand
    | Prefer
    | ResetView
    | AskSummary
    | EnterLab
    | ChooseTip
    | CompareLaws
    | SeatRequest
)
"""What the page asks of its server, without a change of the lab."""


# To the page

Sent = Annotated[Mapping[str, Any], Meta(extra={"typescript": "Command | PageMessage"})]
"""A command or another message that a button of the page sends."""


class RobotCard(Struct, frozen=True, kw_only=True):
    """A robot to choose.

    Attributes:
        differs: what is special about it, in a few words.
        text: what it is, in a sentence or two.
        picture: a data URI.
        tip: the end-point of a robot from a file that suggests several.
        is_built: whether it is in the catalogue; else the name is that of the robot with another
            tip.
        send: what chooses it.
    """

    name: str
    label: str
    differs: str
    text: str
    picture: str
    send: Sent
    tip: str = ""
    is_built: bool = True


class RobotSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="robots"):
    """All robots."""

    robots: list[RobotCard]


class LawDescription(Struct, frozen=True, kw_only=True):
    """A law in four sentences, and its source."""

    name: str
    label: str
    does: str
    good: str
    limits: str
    objection: str
    source: str


class NameMeaning(Struct, frozen=True, kw_only=True):
    """Names that a typed law may use, which mean the same in several spellings."""

    names: str
    means: str
    unit: str


class LawSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="laws"):
    """The laws that suit the robot; what bounds all of them; how to type one."""

    laws: list[LawDescription]
    bounds: str
    own: list[str]
    names: list[NameMeaning]


class ShownKey(Struct, frozen=True, kw_only=True):
    """A keyboard shortcut.

    Attributes:
        key: as a browser names it, in small letters.
        control: whether the control or command key is held down with it.
        shown: the name of the shortcut on a keyboard.
        does: what it does, in a sentence.
        send: the message to send.
    """

    name: str
    key: str
    control: bool
    shown: str
    does: str
    send: Sent


class GlossaryEntry(Struct, frozen=True, kw_only=True):
    """One idea in the lessons' words and in the field's."""

    plain: str
    term: str
    means: str
    lesson: str


class HelpSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="help"):
    """The glossary in the lessons' order."""

    glossary: list[GlossaryEntry]


class LessonCard(Struct, frozen=True, kw_only=True):
    """A lesson or a test to open.

    Attributes:
        number: empty for a test.
        picture: a data: URL, or empty.
        facts: how long it takes, and the like.
        done: share of what is required that is done.
        begun, finished: how far the student is.
    """

    name: str
    number: str
    picture: str
    title: str
    summary: str
    facts: list[str]
    done: float
    begun: bool
    finished: bool


class RouteCard(Struct, frozen=True, kw_only=True):
    """A route to follow."""

    name: str
    title: str
    summary: str
    minutes: str
    stops: list[str]


class LessonSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="lessons"):
    """The course, in its order; `open` is the name of the open lesson, or empty."""

    open: str
    lessons: list[LessonCard]
    routes: list[RouteCard]


class KeepSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="keep"):
    """The code of the lab, and a sentence for how long it is kept; both empty if it is not."""

    code: str
    until: str


class LanguageName(Struct, frozen=True, kw_only=True):
    """A language and its name in it."""

    code: str
    name: str


class DisplaySheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="display"):
    """The languages, and the browser's switches."""

    languages: list[LanguageName]
    speaks: bool
    sounds: bool


class Found(Struct, frozen=True, kw_only=True):
    """Something that the search finds besides settings.

    Attributes:
        kind: "robot", "law", "path", "lesson" or "key".
        label: its name.
        text: a sentence.
        send: the messages that it sends when it is chosen.
    """

    kind: str
    label: str
    text: str
    send: list[Sent]


class Index(Struct, frozen=True, kw_only=True, tag_field="is", tag="index"):
    """Everything that the search finds besides settings, and the keys."""

    found: list[Found]
    keys: list[ShownKey]


class LawChoice(Struct, frozen=True, kw_only=True):
    """A law that can be compared; a typed one is its own name. `chosen`: at first."""

    name: str
    label: str
    text: str
    chosen: bool


class ObstructionChoice(Struct, frozen=True, kw_only=True):
    """An obstruction."""

    name: str
    label: str


class CompareSheet(Struct, frozen=True, kw_only=True, tag_field="is", tag="compare"):
    """What can be compared, and at most how many laws at once."""

    laws: list[LawChoice]
    obstructions: list[ObstructionChoice]
    most: int


class ComparedLaw(Struct, frozen=True, kw_only=True):
    """A law under an obstruction, at its worst place each.

    Attributes:
        distance, delay, force: the largest, [mm], [s] and [N]; 0 if it was stopped.
        stopped: whether its motion diverged.
        beyond: what it asks of the motors beyond the limits of the robot's file; may be empty.
        step: between the points of its curve, [s].
        curve: distance to the path over time, where it becomes largest, [mm].
    """

    law: str
    label: str
    distance: float
    delay: float
    force: float
    stopped: bool
    beyond: str
    step: float
    curve: list[float]


class Compared(Struct, frozen=True, kw_only=True, tag_field="is", tag="compared"):
    """The results so far, of `all` laws; `acts`: from when until when the obstruction acts, [s]."""

    rows: list[ComparedLaw]
    all: int
    acts: tuple[float, float]


class Told(Struct, frozen=True, kw_only=True, tag_field="is", tag="told"):
    """Says something in an open sheet, whose name is `of`."""

    of: Literal["keep", "compare"]
    text: str


Seat = Literal["join", "leave", "ask_place", "forget_me", "identify", "link", "teach"]
"""The names of what `SeatRequest` asks for."""


class ClassMessage(Struct, frozen=True, kw_only=True, tag_field="is", tag="class"):
    """The lab's place in a class: when the page connects, and when it changes.

    Attributes:
        membership: "none": there is nothing to join, or the page is a teacher's; "elsewhere": the
            server has classes at other addresses; "guest": the page's address is that of a class,
            which the lab has not joined; "member": it has.
        code: the class's, as on the projector; empty if the address has none.
        name: the nickname of a member.
        longest: how many visible characters a nickname may have.
        stored: what is stored of a student, and for how long.
        privacy: the address of the site's privacy notice; empty if it has none.
        away: the nickname of somebody who is away, and may be the same student; else empty.
        asked: whether the teacher has been asked to give that place back.
        asks: by what a member is to identify oneself, as the label of the field; empty: by nothing.
        identification: what the member has typed there.
        linked: whether the member has given the word that links two tests; "shared": so that
            another one has.
    """

    membership: Literal["none", "elsewhere", "guest", "member"]
    code: str = ""
    name: str = ""
    longest: int = 0
    stored: str = ""
    privacy: str = ""
    away: str = ""
    asked: bool = False
    asks: str = ""
    identification: str = ""
    linked: Literal["", "own", "shared"] = ""


class SeatAnswer(Struct, frozen=True, kw_only=True, tag_field="is", tag="seat"):
    """What has come of a `SeatRequest`.

    Attributes:
        of: the request.
        why: it was refused: a sentence in the page's language; else empty.
        address: where the page of the class is, if it is another one; else empty.
    """

    of: Seat
    why: str = ""
    address: str = ""
