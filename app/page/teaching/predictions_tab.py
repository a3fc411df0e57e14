"""Tab of the teacher's page: the step for all, and the class's answers to it.

What leads the class is in a folder that stays in sight above the answers; the way to join and the
menus are below. The step's demonstration can be played in the teacher's own lab, which is put back
when another step is chosen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import viser

from onpath.app.classroom.classroom import Display
from onpath.app.classroom.results import prediction_at
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.lesson_labels import lesson_titles, step_label, step_titles
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.page.panels.widgets import Post, note, on_press, on_user_update, put
from onpath.app.page.teaching.route_sender import RouteSender
from onpath.app.page.teaching.sketch_choice import SketchChoice
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class PredictionsTab:
    """Back and next for all, peer instruction, the answers, and menus of lessons and steps.

    Asking again hides the answers, so that nobody follows the majority during the discussion.

    Args:
        post: receives the commands for the teacher's own lab.
        look_again: updates the page.

    Attributes:
        code: shows how students join.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        course: Course,
        teaching: TeacherContext,
        post: Post,
        look_again: Callable[[], None],
    ) -> None:
        self._words, self._course, self._look_again = words, course, look_again
        self._teaching, self._post = teaching, post
        self._class, self._steps = teaching.classroom, StepsForAll(course, words.language)
        self._answers = ClassAnswers(course, words, teaching)
        self._lessons = lesson_titles(course, words)
        self._titles = {name: title for title, name in self._lessons.items()}
        display = self._class.display
        lesson, index = self._steps.shown(display)
        steps = self._step_titles(lesson)

        icons = viser.Icon
        with gui.add_folder(words("class.lead")):  # widgets.css keeps it in sight
            self._back = gui.add_button(
                words("class.back"), color="gray", icon=icons.PLAYER_SKIP_BACK, visible=False
            )
            self._next = gui.add_button(words("class.next"), icon=icons.PLAYER_SKIP_FORWARD)
            self._message = gui.add_html("")
            self._shown = gui.add_checkbox(words("class.show_answers"), display.shown)
            self._revealed = gui.add_checkbox(words("class.truth"), display.revealed)
            again = gui.add_button(words("class.ask_again"), color="gray", icon=icons.REPEAT)
            self._play = gui.add_button(
                words("class.play"), color="gray", icon=icons.PLAYER_PLAY, visible=False
            )
            self._put_back = gui.add_button(
                words("class.put_back"), color="gray", icon=icons.ARROW_BACK_UP, visible=False
            )
        self._prediction = gui.add_html("")
        self.code = gui.add_html("")
        self._lesson = gui.add_dropdown(
            words("class.lesson"), list(self._lessons), initial_value=self._titles[lesson]
        )
        self._step = gui.add_dropdown(words("class.step_head"), steps, initial_value=steps[index])
        push = gui.add_button(words("class.push_step"), color="gray", icon=icons.SEND)
        self._sketches = SketchChoice(gui, words, teaching.chosen, look_again)
        RouteSender(gui, words, course, self._class)
        large = gui.add_checkbox(words("lesson.presenting"), teaching.presents())

        on_press(self._back, lambda: self._lead(-1))
        on_press(self._next, lambda: self._lead(1))
        on_press(again, self._ask_again)
        on_press(self._play, self._demonstrate)
        on_press(self._put_back, self._put_lab_back)
        on_press(push, lambda: self._push(TakeStep(*self._steps.shown(self._class.display))))
        on_user_update(self._shown, lambda on: self._show(shown=on))
        on_user_update(self._revealed, self._show_truth)
        on_user_update(self._lesson, lambda label: self._choose(self._lessons[label], 0))
        on_user_update(self._step, self._choose_step)
        on_user_update(large, lambda on: post(c.Set("presenting", on)))

    def look(self, large: bool) -> None:
        """Show what the class displays now, which may have been chosen in another window."""
        display, words = self._class.display, self._words
        lesson, index = self._steps.shown(display)
        steps = self._step_titles(lesson)
        put(self._lesson, value=self._titles[lesson])
        if tuple(self._step.options) != tuple(steps):
            self._sketches.clear()  # another step has other ones
            self._step.options = steps
        if self._step.value != steps[index]:
            self._sketches.clear()
            self._step.value = steps[index]
        put(self._shown, value=display.shown)
        put(self._revealed, value=display.revealed)
        put(self._play, visible=self._steps.demonstration(display) is not None)
        put(self._put_back, visible=self._demonstrates)
        for button, by in ((self._back, -1), (self._next, 1)):
            step = self._steps.beside(display, self._class.orders, by)
            put(button, visible=step is not None)
            if step is not None and by > 0:
                there = self._course.lesson(step.lesson, words.language)
                label = step_label(there, step.step, words, large)
                if step.lesson != lesson:
                    label = f"{self._titles[step.lesson]}, {label}"
                put(button, label=words("class.next_step", step=label))
        put(self._prediction, content=self._answers.view(large))

    def _step_titles(self, lesson: str) -> list[str]:
        return step_titles(self._course.lesson(lesson, self._words.language), self._words)

    def _lead(self, by: int) -> None:
        """Take the class one step on, or back."""
        step = self._steps.beside(self._class.display, self._class.orders, by)
        if step is not None:
            self._push(step)

    def _push(self, step: TakeStep) -> None:
        self._put_lab_back()
        self._class.push(step)
        self._tell(self._words("class.sent", count=len(self._class.members())))

    def _ask_again(self) -> None:
        name, index = self._steps.shown(self._class.display)
        found = prediction_at(self._course.lesson(name, self._words.language), index)
        if found is None:
            self._tell(self._words("class.no_prediction"))
        else:
            self._push(TakeStep(name, found[0], again=True))

    @property
    def _demonstrates(self) -> bool:
        """Whether the teacher's own lab is in a step."""
        return bool(self._teaching.progress().lesson)

    def _demonstrate(self) -> None:
        """Play the demonstration in the teacher's own lab, and show that lab."""
        step = self._steps.demonstration(self._class.display)
        if step is not None:
            self._teaching.chosen.followed = ""
            self._post(step)
            self._look_again()

    def _put_lab_back(self) -> None:
        if self._demonstrates:
            self._post(c.CloseLesson())
            self._look_again()

    def _tell(self, text: str) -> None:
        self._message.content = note(text)
        self._look_again()

    def _choose(self, lesson: str, step: int) -> None:
        """Display a step, with its answers hidden."""
        self._put_lab_back()
        self._class.show(Display(lesson, step))
        self._message.content = ""
        self._look_again()

    def _choose_step(self, label: str) -> None:
        lesson, _ = self._steps.shown(self._class.display)
        steps = self._step_titles(lesson)
        if label in steps:
            self._choose(lesson, steps.index(label))

    def _show_truth(self, on: bool) -> None:
        """The truth is shown among the answers."""
        self._show(revealed=on, **({"shown": True} if on else {}))

    def _show(self, **changes: bool) -> None:
        self._class.show(replace(self._class.display, **changes))
        self._look_again()
