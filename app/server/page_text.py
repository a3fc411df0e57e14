"""What a page says: its texts, the lab's state, and the open lesson."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from msgspec.structs import replace

from onpath.app.channel.messages import StoredName
from onpath.app.channel.state_messages import StateMessage
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.common.work_thread import WorkThread
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.view.captions import Captions
from onpath.app.view.first_minute import KEPT_AS, FirstMinute
from onpath.app.view.lesson_column import LessonColumn
from onpath.app.view.narration import Narration
from onpath.app.view.preferences import Preferences
from onpath.app.view.state_message import Projection, state_message
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class PageText:
    """Follows the lab that a page shows. Call it in the simulation thread.

    Args:
        course: all lessons.
        student: code of the lab; see `LessonColumn`.
        kept: what the browser has kept, by name, which is not trusted.
        keep: has the browser keep the value of a name.
        teaching: of a teacher's page, which has the teacher's language and size, whichever lab it
            shows, and neither lessons nor an introduction; None on other pages.

    Attributes:
        words: of the page, in its language.
        narration: what it says beyond the lab's message.
        column: what it tells of the lessons; None on a teacher's page.
        first_minute: the introduction; None on a teacher's page.
        preferences: the browser's.
        submit: runs a function in another thread, one after another.
    """

    def __init__(
        self,
        course: Course,
        student: str,
        kept: Mapping[str, str] = {},
        keep: Callable[[StoredName, str], None] = lambda *_: None,
        teaching: TeacherContext | None = None,
    ) -> None:
        self._course, self._student, self._teaching = course, student, teaching
        self._thread, self._shown = WorkThread("text"), 0
        self.submit = self._thread.submit
        self.preferences = Preferences(kept, keep)
        self.first_minute: FirstMinute | None = None
        if teaching is None:
            lesson = next(iter(course.lessons), "")
            self.first_minute = FirstMinute(lesson, kept.get(KEPT_AS, ""), partial(keep, KEPT_AS))
        self._speak(Words())

    def follow(self, snapshot: PageSnapshot) -> None:
        """Follow a snapshot; of the lab that it shows, in order of time."""
        teaching = self._teaching
        language = (teaching.progress() if teaching else snapshot.key).language
        if (language, snapshot.key.student) != (self.words.language, self._shown):
            self._shown = snapshot.key.student
            self._speak(Words(language))
        self._captions.follow(snapshot)
        if self.first_minute is not None:
            self.first_minute.follow(snapshot)
        self.narration.follow(snapshot)
        if self.column is not None:
            self.column.measure(snapshot.lesson)

    def state(self, snapshot: PageSnapshot, seen: Projection, scene: int) -> StateMessage:
        """The message of the lab's state.

        Args:
            seen: how the picture shows the robots.
            scene: see `StateMessage`.
        """
        state = state_message(
            snapshot, self.words, captions=self._captions.shown, said=self.narration.said, seen=seen
        )
        teaching = self._teaching
        presenting = state.presenting if teaching is None else teaching.presents()
        return replace(state, presenting=presenting, scene=scene)

    def end_introduction(self) -> None:
        """Show no more invitations, nor when this browser comes again."""
        if self.first_minute is not None:
            self.first_minute.end()

    def close(self) -> None:
        """Start no further work."""
        self._thread.close()

    def _speak(self, words: Words) -> None:
        """Start over in a language."""
        self.words = words
        self._captions = Captions(words)
        self.narration = Narration(words, self.preferences, self._captions, self.first_minute)
        self.column = None
        if self._teaching is None:
            self.column = LessonColumn(self._course, words, self._student, self._thread.submit)
