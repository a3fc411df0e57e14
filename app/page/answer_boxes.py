"""Widgets for a student's answers: how sure and why, a number, a text in their own words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import viser

from onpath.app.lab import commands as c
from onpath.app.page import lesson_html as page
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panels.widgets import Post, add_buttons, on_press, on_user_update
from onpath.app.page.sketch_answer import SketchAnswer
from onpath.app.scene.scene import Scene
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import SURENESS, Answer
from onpath.lessons.schema import Choice, NumberQuestion, Prediction, Quiz, Sketch
from onpath.lessons.words import Words

DIGITS = 9
"""Decimals of a typed number."""


class SureAndWhy:
    """How sure the student is of a prediction, and why; both may be left open.

    Attributes:
        handles: all widgets, each with `remove`.
    """

    def __init__(self, gui: viser.GuiApi, block: Prediction, words: Words) -> None:
        no_answer = words("answer.not_said")
        self._sure = {no_answer: "", **{words(f"sure.{sure}"): sure for sure in SURENESS}}
        menu = gui.add_dropdown(words("answer.how_sure"), list(self._sure), initial_value=no_answer)
        self._menu, self._why = menu, None
        self._reasons: dict[str, int | None] = {no_answer: None}
        self._reasons |= {reason: i for i, reason in enumerate(block.reasons)}
        because = words("answer.because")
        if block.reasons:
            self._why = gui.add_dropdown(because, list(self._reasons), initial_value=no_answer)
        elif block.why:
            self._why = gui.add_text(because, "", multiline=True)
        self.handles: list[Any] = [menu]
        if self._why is not None:
            self.handles.append(self._why)

    def added_to(self, answer: c.Predict) -> c.Predict:
        """The answer with the sureness and the reason."""
        text: Any = "" if self._why is None else self._why.value
        reason = self._reasons.get(text)
        why = "" if len(self._reasons) > 1 else text
        return replace(answer, sure=self._sure[self._menu.value], reason=reason, why=why)


class PredictionForm:
    """Widgets with which a prediction is made and submitted.

    Attributes:
        handles: all widgets, each with `remove`.
        sketching: the widgets for a sketch, or None.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        scene: Scene,
        block: Prediction,
        run: LessonView,
        post: Post,
    ) -> None:
        gui, words = client.gui, run.words
        self.handles: list[Any] = []
        self._draft, self._words = c.Predict(), words
        self.sketching: SketchAnswer | None = None
        if isinstance(block, Choice):
            self.handles.append(add_letters(gui, run.order(block), self._chosen))
        else:
            self._remark = gui.add_html(page.remark(words("lesson.draw_first")))
            self.handles.append(self._remark)
            self.sketching = SketchAnswer(
                client=client, scene=scene, block=block, run=run, drawn=self._drawn
            )
        sure_and_why = SureAndWhy(gui, block, words)
        commit = gui.add_button(words("lesson.commit"), icon=viser.Icon.LOCK)
        commit.disabled = True
        on_press(commit, lambda: post(sure_and_why.added_to(self._draft)))
        self._commit = commit
        self.handles += [*sure_and_why.handles, commit]

    def _chosen(self, option: int, letter: str) -> None:
        self._draft = c.Predict(option=option)
        self._commit.label = f"{self._words('lesson.commit')}: {letter}"
        self._commit.disabled = False

    def _drawn(self, times: np.ndarray, values: np.ndarray) -> None:
        self._draft = c.Predict(None, tuple(times.tolist()), tuple(values.tolist()))
        self._commit.disabled = False
        self._remark.content = page.remark(self._words("lesson.drawn"))


def discuss(block: Prediction, first: Answer, run: LessonView) -> str:
    """The remark that a prediction is asked again, with the letter that was chosen first."""
    if isinstance(block, Sketch) or first.option not in range(len(block.options)):
        return run.words("lesson.discuss")
    letter = LETTERS[run.order(block).index(first.option)]
    return run.words("lesson.discuss_letter", letter=letter)


def add_letters(
    gui: viser.GuiApi, order: tuple[int, ...], act: Callable[[int, str], None]
) -> viser.GuiButtonGroupHandle:
    """A button for each option, in the order in which they are shown.

    On the page, the options themselves press them if they come right before them; see
    assets/page/answers.js.

    Args:
        act: called with the option's index and its letter.
    """
    options = {LETTERS[place]: option for place, option in enumerate(order)}
    return add_buttons(
        gui, "", {letter: letter for letter in options}, lambda letter: act(options[letter], letter)
    )


def add_quiz(
    gui: viser.GuiApi, block: Quiz, place: int, run: LessonView, post: Post
) -> list[viser.GuiHtmlHandle | viser.GuiButtonGroupHandle]:
    """Add a question of a step and its buttons.

    Args:
        place: of the question in its step.
    """
    key = f"{run.index}.{place}"
    chosen, order = run.notes.quiz.get(key), run.order(block, key)
    question = gui.add_html(
        page.question(
            block,
            order,
            chosen,
            revealed=chosen is not None and not run.is_test,
            words=run.words,
            unknown=run.is_unknown(key),
            pressable=True,
        )
    )
    letters = add_letters(gui, order, lambda option, _: post(c.AnswerQuiz(place, option)))
    return [question, letters]


@dataclass(frozen=True, slots=True)
class AnswerBox:
    """A field for an answer and the button that sends it.

    Both methods take `typed`, a dict from the names of questions to the contents of their fields,
    so that a typed answer survives a rebuild of the page.

    Attributes:
        place: of the question in its step.
        name: of the question, unique among all lessons.
    """

    gui: viser.GuiApi
    words: Words
    post: Post
    place: int
    name: str

    def add_number(
        self, block: NumberQuestion, given: float, typed: dict[str, Any]
    ) -> list[viser.GuiInputHandle[Any] | viser.GuiButtonHandle]:
        """Add a field for a number and a button that checks it; returns both."""
        unit = {"unit": block.unit} if block.unit else {}
        label = self.words("answer.type_unit" if unit else "answer.type_number", **unit)
        field = self.gui.add_number(label, float(typed.get(self.name, given)))
        field.precision = DIGITS  # viser takes that of the first value, 0, and drops the decimals
        on_user_update(field, lambda value: typed.update({self.name: value}))
        button = self.gui.add_button(
            self.words("answer.check"), color="gray", icon=viser.Icon.CHECK
        )
        on_press(button, lambda: self.post(c.AnswerNumber(self.place, field.value)))
        return [field, button]

    def add_text(
        self, text: str, typed: dict[str, Any]
    ) -> list[viser.GuiInputHandle[Any] | viser.GuiButtonHandle]:
        """Add a field for a text and a button that keeps it; returns both."""
        label, shown = self.words("answer.type_words"), str(typed.get(self.name, text))
        field = self.gui.add_text(label, shown, multiline=True)
        on_user_update(field, lambda value: typed.update({self.name: value}))
        button = self.gui.add_button(
            self.words("answer.keep"), color="gray", icon=viser.Icon.PENCIL
        )
        on_press(button, lambda: self.post(c.AnswerInWords(self.place, field.value)))
        return [field, button]
