"""The teacher's tab: the class on the left; in the scene, the teacher's or a student's lab."""

from __future__ import annotations

import viser
from typing_extensions import override

from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import PageKey
from onpath.app.page.page import Page
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.widgets import Post
from onpath.app.page.teaching.teacher_controls import FollowedStudent, TeacherControls
from onpath.app.page.teaching.teacher_panel import TeacherPanel
from onpath.app.scene.client_scene import ClientScene
from onpath.lessons.words import Words


class TeacherPage(Page):
    """The teacher's page. A followed lab is read-only.

    For a projector, the lab's controls are folded, and those of the class are beside the stage.
    The page is in the teacher's language, whichever lab is shown.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        first: PageSnapshot,
        context: PageContext,
        teaching: TeacherContext,
    ) -> None:
        self._teaching = teaching
        super().__init__(client, first, context)

    @override
    def _key(self, key: PageKey) -> tuple[object, ...]:
        scene = ClientScene._key(self, key)
        return (
            *scene,
            self._wanted_narrow,
            key.fields,
            self._teaching.progress().language,
            self._presents,
        )

    @override
    def _words_for(self, snapshot: PageSnapshot) -> Words:
        return Words(self._teaching.progress().language)

    @override
    def _post_for(self, snapshot: PageSnapshot) -> Post:
        return _ignore if snapshot.key.student else self._context.post

    @override
    def _is_folded(self, snapshot: PageSnapshot) -> bool:
        return self._presents

    @property
    def _presents(self) -> bool:
        """Whether the teacher presents, whichever lab is shown."""
        return self._teaching.presents()

    @override
    def _build_panels(self, first: PageSnapshot, words: Words, post: Post) -> None:
        gui, teaching = self._client.gui, self._teaching
        if first.key.student:
            self._parts.append(FollowedStudent(gui, words, teaching))
            self._parts.append(self._controls(words, post).show())
        else:
            self._parts.append(TeacherControls(gui, words, teaching))
            self._build_menus(first, words, post)
            self._parts += self._controls(words, post).beside_strip(first)
        panel = TeacherPanel(
            client=self._client,
            words=words,
            post=self._context.post,
            course=self._context.course,
            teaching=teaching,
            submit=self._rebuilds.submit,
        )
        self._parts.append(panel)


def _ignore(_: c.Command) -> None:
    """Discard a command, since a followed lab is read-only."""
