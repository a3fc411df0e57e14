"""The navigation buttons below a step's text: next, back, set up again, free lab."""

from __future__ import annotations

from typing import Any

import viser

from onpath.app.lab import commands as c
from onpath.app.page import lesson_html as page
from onpath.app.page.concept_test.entry import answered_line
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panels.widgets import Post, add_buttons, on_press


def add_navigation(gui: viser.GuiApi, run: LessonView, post: Post) -> list[Any]:
    """The buttons that lead from the open step to others; returns their handles."""
    handles: list[Any] = []
    if run.is_test:
        handles.append(gui.add_html(page.remark(answered_line(run))))
    if not run.may_go(1):
        handles.append(gui.add_html(page.remark(run.words("lesson.wait"), italic=True)))
    elif run.at_end:
        label = run.words("test.hand_in" if run.is_test else "lesson.finish")
        handles.append(_button(gui, post, label, c.FinishLesson(), None, viser.Icon.CHECK))
    else:
        handles += _add_next(gui, run, post)
    if others := _others(run):
        handles.append(add_buttons(gui, "", others, post))
    return handles


def _add_next(gui: viser.GuiApi, run: LessonView, post: Post) -> list[Any]:
    unseen = run.step is not None and run.step.script is not None and not run.has_played()
    label, colour = run.words("lesson.next"), "gray" if run.shows_next else None
    if run.waits or unseen:
        colour = "gray"
        label = run.words("lesson.skip" if run.waits else "lesson.next_unseen")
    forward = _button(gui, post, label, c.GoToStep(1), colour, viser.Icon.ARROW_RIGHT)
    past, command = run.past_optional(), c.FinishLesson()
    if past is None or not run.may_go(past):
        return [forward]
    label = run.words("lesson.finish")
    if past:  # past the optional steps that come next; else to the end
        label = run.words("lesson.past_optional", step=run.index + 1 + past)
        command = c.GoToStep(past)
    skip = _button(gui, post, label, command, "gray", viser.Icon.PLAYER_TRACK_NEXT)
    return [forward, skip]


def _others(run: LessonView) -> dict[str, c.Command]:
    """The smaller buttons: back, set up again, free lab."""
    lesson = run.lesson
    first = lesson is None or run.beside(-1) == (lesson.name, run.index)
    commands = {"back": c.GoToStep(-1), "again": c.BeginStepAnew(), "close": c.CloseLesson()}
    missing = {
        "back": first or not run.may_go(-1),
        "again": run.is_test,
        "close": run.pace is not None,
    }
    return {
        run.words(f"lesson.{key}"): command for key, command in commands.items() if not missing[key]
    }


def _button(
    gui: viser.GuiApi,
    post: Post,
    label: str,
    command: c.Command,
    colour: Any,
    icon: viser.IconName,
) -> viser.GuiButtonHandle:
    button = gui.add_button(label, color=colour, icon=icon)
    on_press(button, lambda: post(command))
    return button
