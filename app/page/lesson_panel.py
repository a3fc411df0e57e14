"""The panel of the open lesson, docked on the left: text, prediction, tasks and navigation."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page import lesson_html as page
from onpath.app.page.answer_boxes import AnswerBox, PredictionForm, add_quiz, discuss
from onpath.app.page.concept_test.end import add_test_end
from onpath.app.page.lesson_chart import PredictionChart
from onpath.app.page.lesson_end import LessonEnd
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panels.widgets import Post, on_press
from onpath.app.page.sketch_answer import SketchAnswer
from onpath.app.page.step_navigation import add_navigation
from onpath.app.scene.scene import Scene
from onpath.lessons.course import Course
from onpath.lessons.schema import (
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
    Text,
)
from onpath.lessons.task_schema import Task
from onpath.lessons.words import Words

WIDTH, WIDE = 400, 560  # [px]


class LessonPanel:
    """Shows the open step, and redraws it when the state of the lessons has changed.

    Args:
        change: changes widgets in another thread; see `RebuildThread.change`.
        tab: parent of the widgets; if None, they get a separate panel on the left.
        report: requests the record of all lessons.
        student: session code of the lab; decides the order of options, see `option_order`.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        words: Words,
        post: Post,
        course: Course,
        scene: Scene,
        change: Callable[[Callable[[], None]], None],
        first: PageSnapshot,
        report: Callable[[], None],
        tab: viser.GuiTabHandle | None = None,
        student: str = "",
    ) -> None:
        self._client, self._gui, self._post, self._change = client, client.gui, post, change
        self._scene, self._words, self._course, self._student = scene, words, course, student
        self._report = report
        self._handles: list[Any] = []
        self._tasks: list[tuple[Task, viser.GuiHtmlHandle]] = []
        self._chart: PredictionChart | None = None
        self._sketching: SketchAnswer | None = None
        self._typed: dict[str, Any] = {}  # typed answers by question; see `AnswerBox`
        self._busy, self._version, self._reading = False, -1, -1
        self._panel = None
        if tab is None:
            self._panel = self._gui.add_panel(order=0)
            tab = self._panel.add_tab(words("lesson.lessons"), viser.Icon.SCHOOL)
            self._panel.dock_above(client.gui.main_panel)
        self._tab = tab
        self._width = 0
        forward = self._gui.add_command(words("lesson.next"), hotkey="pagedown")
        forward.on_trigger(_turns(post, 1))
        back = self._gui.add_command(words("lesson.back"), hotkey="pageup")
        back.on_trigger(_turns(post, -1))
        self._build(self._view(first))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Redraw what has changed; measured values are always updated."""
        if self._busy:
            return
        run = self._view(snapshot)
        if run.version != self._version:
            self._busy = True
            self._change(lambda: self._rebuild(run))
            return
        for task, handle in self._tasks:
            content = page.task(task, run.verdicts.get(task.id, []), run)
            if handle.content != content:
                handle.content = content
        if self._chart is not None and run.playing:
            self._chart.show(run.truth)
        board = self._sketching  # another thread may remove it
        if board is not None:
            board.draw()

    def _view(self, snapshot: PageSnapshot) -> LessonView:
        return LessonView(self._course, self._words, snapshot.lesson, self._student)

    def _rebuild(self, run: LessonView) -> None:
        try:
            if run.lesson is not None:
                self._clear()
                self._build(run)
        finally:
            self._busy = False

    def _clear(self) -> None:
        for handle in self._handles:
            handle.remove()
        self._handles, self._tasks, self._chart = [], [], None
        if self._sketching is not None:
            self._sketching.remove()
            self._sketching = None

    def _build(self, run: LessonView) -> None:
        self._version = run.version
        lesson, step = run.lesson, run.step
        assert lesson is not None and step is not None
        width = WIDE if run.progress.presenting else WIDTH
        if self._panel is not None and width != self._width:
            self._width = width
            self._panel.set_width(width)
        with self._tab:
            if run.ended:
                if run.is_test:
                    self._handles += add_test_end(self._gui, run, self._post, self._report)
                else:
                    end = LessonEnd(self._gui, run, self._post, self._report)
                    self._handles += end.handles
                return
            self._html(page.heading(lesson, step, run))
            if run.index == 0 and (aims := page.aims(lesson, run.words)):
                self._html(aims)
            if step.kind == "run":
                self._add_run(run)
            if step.kind != "run" or run.has_played() or self._reading == run.index:
                for number, block in enumerate(step.blocks):
                    self._add(number, block, run)
            else:
                self._add_reading(run)
            self._handles += add_navigation(self._gui, run, self._post)

    def _add_reading(self, run: LessonView) -> None:
        """A button that shows the text before the experiment has run."""

        def read() -> None:
            self._reading, self._version = run.index, -1

        button = self._gui.add_button(run.words("lesson.read"), color="gray", icon=viser.Icon.BOOK)
        on_press(button, read)
        self._handles.append(button)

    def _add(self, number: int, block: object, run: LessonView) -> None:
        if isinstance(block, Text):
            if (shown := run.text(number, block)) is not None:
                self._html(page.text(shown))
                for link in block.links:
                    self._button(link.label, c.Act(link.actions), "gray", viser.Icon.POINTER)
        elif isinstance(block, Task):
            self._add_task(block, run)
        elif isinstance(block, Quiz):
            self._handles += add_quiz(self._gui, block, number, run, self._post)
        elif isinstance(block, Prediction):
            self._add_prediction(block, run)
        elif isinstance(block, NumberQuestion | OpenQuestion):
            self._add_question(number, block, run)

    def _add_question(
        self, place: int, block: NumberQuestion | OpenQuestion, run: LessonView
    ) -> None:
        """A question that is answered with a number or in the student's own words."""
        key, words = f"{run.index}.{place}", run.words
        box = AnswerBox(
            gui=self._gui,
            words=words,
            post=self._post,
            place=place,
            name=f"{run.progress.lesson} {key}",
        )
        if isinstance(block, NumberQuestion):
            given = run.notes.numbers.get(key)
            self._html(page.number_question(block, given, words))
            self._handles += box.add_number(block, given or 0.0, self._typed)
        else:
            text = run.notes.written.get(key, "")
            self._html(page.open_question(block, text, words))
            self._handles += box.add_text(text, self._typed)

    def _add_task(self, task: Task, run: LessonView) -> None:
        verdicts = run.verdicts.get(task.id, [])
        self._tasks.append((task, self._html(page.task(task, verdicts, run))))
        left = len(task.hints) - run.notes.hints.get(task.id, 0)
        if left > 0:
            label = run.words("lesson.hint", left=left)
            self._button(label, c.ShowHint(task.id), "gray", viser.Icon.BULB)

    def _add_prediction(self, block: Prediction, run: LessonView) -> None:
        answer, first = run.answer(), run.first_answer()
        if answer is None and first is not None:
            self._html(page.remark(discuss(block, first, run)))
        if isinstance(block, Sketch):
            self._html(page.asked(block))
            if answer is None:
                self._add_form(block, run)
            else:
                self._add_let_happen(run)
                self._add_reasons(block, run)
                self._add_chart(block, run)
            return
        chosen, order = answer.option if answer else None, run.order(block)
        if answer is not None:
            self._add_let_happen(run)
        self._html(
            page.question(
                block,
                order,
                chosen,
                revealed=False,
                words=run.words,
                unknown=run.is_unknown(),
                pressable=answer is None,
            )
        )
        if answer is None:
            self._add_form(block, run)
        else:
            self._add_reasons(block, run)

    def _add_let_happen(self, run: LessonView) -> None:
        """After a prediction: the next action, which assets/page/steps.js brings into view."""
        if not run.shows_next:
            return
        self._html(page.next_act(run.words))
        label = run.words("lesson.play")
        button = self._gui.add_button(label, icon=viser.Icon.PLAYER_PLAY)

        def let_happen() -> None:
            self._post(c.GoToStep(1))
            self._post(c.PlayStep())

        on_press(button, let_happen)
        self._handles.append(button)

    def _add_form(self, block: Prediction, run: LessonView) -> None:
        form = PredictionForm(
            client=self._client, scene=self._scene, block=block, run=run, post=self._post
        )
        self._handles += form.handles
        self._sketching = form.sketching

    def _add_reasons(self, block: Prediction, run: LessonView) -> None:
        """How sure the student was, and why, if the student has said so."""
        unknown = isinstance(block, Sketch) and run.is_unknown()
        if reasons := page.confidence(block, run.answer(), run.words, unknown):
            self._html(reasons)

    def _add_run(self, run: LessonView) -> None:
        """The prediction next to the measured result, and the button that runs the experiment."""
        found, truth = run.prediction(), run.truth
        if run.step is not None and run.step.watch and not run.waits:
            self._html(page.watch(run.step.watch))
        if run.playing:
            self._html(page.remark(run.words("lesson.playing"), italic=True))
        else:
            label = run.words("lesson.replay" if truth else "lesson.play")
            colour = "gray" if truth else None  # the primary action is then the next step
            button = self._button(label, c.PlayStep(), colour, viser.Icon.PLAYER_PLAY)
            button.disabled = run.waits
        if found is None:
            return
        if run.waits:
            self._html(page.remark(run.words("lesson.predict_before"), italic=True))
        block, answer = found[1], run.answer()
        if answer is not None and answer.skipped and not run.is_unknown():
            self._html(page.remark(run.words("lesson.skipped"), italic=True))
        if isinstance(block, Sketch):
            self._add_chart(block, run)
        elif truth is not None and not run.playing:
            chosen = answer.option if answer else None
            self._html(
                page.question(
                    block,
                    run.order(block),
                    chosen,
                    revealed=True,
                    words=run.words,
                    unknown=run.is_unknown(),
                )
            )
        self._add_reasons(block, run)

    def _add_chart(self, block: Sketch, run: LessonView) -> None:
        answer = run.answer()
        if run.truth is None and (answer is None or answer.skipped):
            return
        self._chart = PredictionChart(
            gui=self._gui,
            sketch=block,
            answer=answer,
            laws=run.laws_shown,
            words=run.words,
            truth=run.truth,
        )
        self._handles.append(self._chart)

    def _html(self, content: str) -> viser.GuiHtmlHandle:
        handle = self._gui.add_html(content)
        self._handles.append(handle)
        return handle

    def _button(
        self, label: str, command: c.Command, colour: Any, icon: viser.IconName | None
    ) -> viser.GuiButtonHandle:
        button = self._gui.add_button(label, color=colour, icon=icon)
        on_press(button, lambda: self._post(command))
        self._handles.append(button)
        return button


def _turns(post: Post, by: int) -> Callable[[Any], Coroutine[Any, Any, None]]:
    async def turn(_: Any) -> None:
        post(c.GoToStep(by))

    return turn
