"""What a page asks of its server besides commands: what sheets show, another lab, a class."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from msgspec import Struct

from onpath.app.channel.sheet_messages import (
    Ask,
    AskPlace,
    AskSummary,
    ChooseTip,
    CompareLaws,
    EnterLab,
    ForgetMe,
    Freehand,
    IdentifyMyself,
    JoinClass,
    LeaveClass,
    LinkWord,
    Prefer,
    Request,
    ResetView,
    Seat,
    SeatAnswer,
    SeatRequest,
    Teach,
    Told,
)
from onpath.app.common.access_codes import shown
from onpath.app.exports.exporter import Exporter
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.scene.client_scene import ClientScene
from onpath.app.server.page_context import ClassSeat, PageContext
from onpath.app.view.comparing import compare_sheet, compared
from onpath.app.view.sheets import SheetContext, sheet_of
from onpath.lessons.words import Words
from onpath.models.errors import CodedError
from onpath.models.studies.comparison import OBSTRUCTIONS

Tell = Callable[[Struct], None]
"""Sends an answer, from any thread."""


class PageRequests:
    """Serves one page's requests. Call it in the simulation thread.

    Args:
        exporter: compares laws.
    """

    def __init__(self, context: PageContext, exporter: Exporter) -> None:
        self._context, self._exporter, self._text = context, exporter, context.text
        self._sheets = SheetContext(
            course=context.course,
            code=shown(context.code),
            days=context.keep_days,
            preferences=self._text.preferences,
        )

    def serve(
        self, request: Request, snapshot: PageSnapshot, scene: ClientScene | None, tell: Tell
    ) -> None:
        """Serve a request; what takes long is answered later.

        Args:
            scene: the robots' picture, if it is there.
        """
        text, words = self._text, self._text.words
        match request:
            case Ask(what=what):
                text.submit(lambda: tell(sheet_of(what, snapshot, words, self._sheets)))
            case Prefer(name=name, on=on):
                text.preferences.set(name, on)
            case Freehand():
                if scene is not None:
                    scene.draw()
            case ResetView():
                if scene is not None:
                    scene.reset_view()
            case AskSummary():
                text.narration.ask_summary()
            case EnterLab(code=code):
                refuse = lambda why: tell(Told(of="keep", text=why))  # noqa: E731
                self._press(lambda: self._context.enter(code), refuse, words)
            case ChooseTip(robot=robot, tip=tip):
                choose = self._context.choose_tip
                self._press(lambda: choose(robot, tip), self._context.remark, words)
            case CompareLaws(laws=laws, obstruction=obstruction):
                self._compare(laws, obstruction, snapshot, words, tell)
            case _:
                self._sit(request, words, tell)

    def _sit(self, request: SeatRequest, words: Words, tell: Tell) -> None:
        """Change the lab's place in the class."""
        of, act = _seat_act(request, self._context.seat or _NO_SEAT)
        self._press(
            lambda: tell(SeatAnswer(of=of, address=act())),
            lambda why: tell(SeatAnswer(of=of, why=why)),
            words,
        )

    def _press(self, act: Callable[[], None], refuse: Callable[[str], None], words: Words) -> None:
        """Do what may take long, or show another page; tell the user why not, if it is refused."""

        def guarded() -> None:
            try:
                act()
            except (ValueError, OSError) as error:
                refuse(words.sentence(error))

        if not self._context.presses.run(guarded):
            refuse(words.sentence(CodedError("error.hurry")))

    def _compare(
        self,
        laws: list[str],
        obstruction: str,
        snapshot: PageSnapshot,
        words: Words,
        tell: Tell,
    ) -> None:
        robot, laws = robot_of(snapshot), list(dict.fromkeys(laws))
        offered = compare_sheet(robot, snapshot.run.laws, words)
        known = {law.name for law in offered.laws}
        if not known.issuperset(laws) or obstruction not in OBSTRUCTIONS:
            tell(Told(of="compare", text=words("compare.count", most=offered.most)))
            return
        self._exporter.outcomes(
            laws,
            obstruction,
            show=lambda results: tell(compared(results, laws, obstruction, robot, words)),
            refuse=lambda why: tell(Told(of="compare", text=why)),
        )


def _no_class(*_: str) -> NoReturn:
    raise CodedError("error.not_the_class_code")


_NO_SEAT = ClassSeat(join=_no_class, leave=_no_class, teach=_no_class)


def _seat_act(request: SeatRequest, seat: ClassSeat) -> tuple[Seat, Callable[[], str]]:
    """The name of a request, and what it does; that returns the address to go to, or nothing."""
    match request:
        case JoinClass(code=code, name=name):
            return "join", lambda: seat.join(seat.code or code, name)
        case LeaveClass():
            return "leave", lambda: seat.leave() or ""
        case AskPlace():
            return "ask_place", lambda: seat.ask_place() or ""
        case ForgetMe():
            return "forget_me", lambda: seat.forget() or ""
        case IdentifyMyself(typed=typed):
            return "identify", lambda: seat.identify(typed) or ""
        case LinkWord(word=word):
            return "link", lambda: seat.link(word) or ""
        case Teach(key=key):
            return "teach", lambda: seat.teach(key)
