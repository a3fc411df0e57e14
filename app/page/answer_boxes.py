"""Widgets with which a student answers: how sure and why, a number, a text in own words."""

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
"""Decimals of a number that a student types."""


class SureAndWhy:
    """How sure the student is of a prediction, and why; both may be left unsaid.

    Attributes:
        handles: all widgets, each with `remove`.
    """

    def __init__(self, gui: viser.GuiApi, block: Prediction, words: Words) -> None:
        unsaid = words("answer.not_said")
        self._sure = {unsaid: "", **{words(f"sure.{sure}"): sure for sure in SURENESS}}
        menu = gui.add_dropdown(words("answer.how_sure"), list(self._sure), initial_value=unsaid)
        self._menu, self._why = menu, None
        self._reasons: dict[str, int | None] = {unsaid: None}
        self._reasons |= {reason: i for i, reason in enumerate(block.reasons)}
        because = words("answer.because")
        if block.reasons:
            self._why = gui.add_dropdown(because, list(self._reasons), initial_value=unsaid)
        elif block.why:
            self._why = gui.add_text(because, "", multiline=True)
        self.handles: list[Any] = [each for each in (menu, self._why) if each is not None]

    def beside(self, answer: c.Predict) -> c.Predict:
        """The answer with what is said beside it."""
        said: Any = "" if self._why is None else self._why.value
        reason = self._reasons.get(said)
        why = "" if len(self._reasons) > 1 else said
        return replace(answer, sure=self._sure[self._menu.value], reason=reason, why=why)


class PredictionForm:
    """Widgets with which a prediction is made and submitted.

    Attributes:
        handles: all widgets, each with `remove`.
        sketching: with which a sketch is drawn, or None.
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
            self._said = gui.add_html(page.remark(words("lesson.draw_first")))
            self.handles.append(self._said)
            self.sketching = SketchAnswer(client, scene, block, run, self._drawn)
        beside = SureAndWhy(gui, block, words)
        commit = gui.add_button(words("lesson.commit"), icon=viser.Icon.LOCK)
        commit.disabled = True
        on_press(commit, lambda: post(beside.beside(self._draft)))
        self._commit = commit
        self.handles += [*beside.handles, commit]

    def _chosen(self, option: int, letter: str) -> None:
        self._draft = c.Predict(option=option)
        self._commit.label = f"{self._words('lesson.commit')}: {letter}"
        self._commit.disabled = False

    def _drawn(self, times: np.ndarray, values: np.ndarray) -> None:
        self._draft = c.Predict(None, tuple(times.tolist()), tuple(values.tolist()))
        self._commit.disabled = False
        self._said.content = page.remark(self._words("lesson.drawn"))


def discuss(block: Prediction, first: Answer, run: LessonView) -> str:
    """That a prediction is asked again, with the letter that the student chose first."""
    if isinstance(block, Sketch) or first.option not in range(len(block.options)):
        return run.words("lesson.discuss")
    letter = LETTERS[run.order(block).index(first.option)]
    return run.words("lesson.discuss_letter", letter=letter)


def add_letters(
    gui: viser.GuiApi, order: tuple[int, ...], act: Callable[[int, str], None]
) -> viser.GuiButtonGroupHandle:
    """A button for each option, in the order in which they are shown.

    On a page they are pressed by the options themselves, if these come right before them; see
    assets/page/answers.js.

    Args:
        act: is given the option's index and its letter.
    """
    options = {LETTERS[place]: option for place, option in enumerate(order)}
    chosen = {letter: (option, letter) for letter, option in options.items()}
    return add_buttons(gui, "", chosen, lambda pair: act(*pair))


def add_quiz(
    gui: viser.GuiApi, block: Quiz, place: int, run: LessonView, post: Post
) -> list[viser.GuiHtmlHandle | viser.GuiButtonGroupHandle]:
    """A question of a step, and what answers it.

    Args:
        place: of the question in its step.
    """
    key = f"{run.index}.{place}"
    chosen, order = run.notes.quiz.get(key), run.order(block, key)
    told = chosen is not None and not run.is_test
    shown = chosen, told, run.words, run.is_unknown(key)
    asked = gui.add_html(page.question(block, order, *shown, pressable=True))
    return [asked, add_letters(gui, order, lambda at, _: post(c.AnswerQuiz(place, at)))]


@dataclass(frozen=True, slots=True)
class AnswerBox:
    """A field for an answer and the button that sends it.

    What is typed survives a rebuild of the page: both methods take `typed`, a dict from a question
    to what is in its field.

    Attributes:
        place: of the question in its step.
        name: of the question among all of them.
    """

    gui: viser.GuiApi
    words: Words
    post: Post
    place: int
    name: str

    def add_number(
        self, block: NumberQuestion, given: float, typed: dict[str, Any]
    ) -> list[viser.GuiInputHandle[Any] | viser.GuiButtonHandle]:
        """A field for a number and a button that checks it; returns both."""
        unit = {"unit": block.unit} if block.unit else {}
        label = self.words("answer.type_unit" if unit else "answer.type_number", **unit)
        field = self.gui.add_number(label, float(typed.get(self.name, given)))
        field.precision = DIGITS  # viser's is that of the first value, 0, and drops the decimals
        on_user_update(field, lambda value: typed.update({self.name: value}))
        button = self.gui.add_button(
            self.words("answer.check"), color="gray", icon=viser.Icon.CHECK
        )
        on_press(button, lambda: self.post(c.AnswerNumber(self.place, field.value)))
        return [field, button]

    def add_text(
        self, text: str, typed: dict[str, Any]
    ) -> list[viser.GuiInputHandle[Any] | viser.GuiButtonHandle]:
        """A field for a text and a button that keeps it; returns both."""
        label, shown = self.words("answer.type_words"), str(typed.get(self.name, text))
        field = self.gui.add_text(label, shown, multiline=True)
        on_user_update(field, lambda value: typed.update({self.name: value}))
        button = self.gui.add_button(
            self.words("answer.keep"), color="gray", icon=viser.Icon.PENCIL
        )
        on_press(button, lambda: self.post(c.AnswerInWords(self.place, field.value)))
        return [field, button]
