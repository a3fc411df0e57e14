"""Pieces of a lesson's page as HTML. What comes in is safe already or is escaped here."""

from __future__ import annotations

import html

from onpath.app.common.palette import AMBER, FOLLOWER, GREEN, GREY
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.checks import Verdict
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Choice, Lesson, Option, Quiz, Step, Task
from onpath.lessons.words import Words

LETTERS = "ABCDEFGH"
STYLE = """<style>
.op-text{padding:0 1em;font-size:1rem;line-height:1.55;color:#1f2937}
.op-text p{margin:0.55em 0}.op-text ul,.op-text ol{margin:0.4em 0;padding-left:1.4em}
.op-text li{margin:0.2em 0}.op-text img{max-width:100%;display:block;margin:0.6em auto}
.op-text table{border-collapse:collapse;margin:0.6em 0}
.op-text td,.op-text th{border:1px solid #d5dae1;padding:0.25em 0.55em;text-align:left}
.op-text math,.op-box math{font-size:1.15em}
.op-text math[display=block]{margin:0.7em 0;overflow-x:auto;overflow-y:hidden;max-width:100%}
.op-text blockquote{border-left:3px solid #b8c4d3;margin:0.6em 0;padding:0.1em 0.9em;color:#3b4a5f}
.op-text code{background:#eef1f5;padding:0 0.25em;border-radius:3px}
.op-text h2{font-size:1.08em;margin:0.8em 0 0.3em}
.op-box{margin:0.4em 1em;padding:0.6em 0.8em;border:1px solid #d5dae1;border-radius:6px;
background:#f7f9fb;line-height:1.45;color:#1f2937}
.op-box p{margin:0.3em 0}
</style>"""
LARGE = "<style>html{font-size:20px}.op-text{font-size:1.15rem;line-height:1.5}</style>"


def heading(lesson: Lesson, step: Step, run: LessonState) -> str:
    """Where one is: lesson, progress bar, kind and title of the step.

    By data-step, assets/page/steps.js sees that another step is open.
    """
    words, seen = run.words, run.notes.seen
    bars = "".join(
        f'<div title="{html.escape(each.title)}" style="flex:1;height:6px;border-radius:3px;'
        f'background:{_bar(i, run.index, seen)}"></div>'
        for i, each in enumerate(lesson.steps)
    )
    counted = words("lesson.step", step=run.index + 1, steps=len(lesson.steps))
    return (
        f"{STYLE}{LARGE if run.progress.presenting else ''}"
        f'<div class="op-text" data-step="{html.escape(lesson.name)}.{run.index}" '
        f'style="padding-top:0.6em"><div style="color:{GREY};'
        f'font-size:0.85em;margin-bottom:0.4em">{html.escape(lesson.front.title)} · {counted}</div>'
        f'<div style="display:flex;gap:3px;margin-bottom:0.7em">{bars}</div>'
        f'<div style="font-size:0.8em;font-weight:700;letter-spacing:0.04em;color:{FOLLOWER.hex}">'
        f"{words(f'kind.{step.kind}').upper()}</div>"
        f'<div role="heading" aria-level="1" style="font-size:1.3em;font-weight:700;'
        f'line-height:1.25">{html.escape(step.title)}</div></div>'
    )


def text(content: str) -> str:
    """Prose."""
    return f'<div class="op-text">{content}</div>'


def box(content: str, colour: str = "#d5dae1") -> str:
    """Something set apart."""
    return f'<div class="op-box" style="border-left:4px solid {colour}">{content}</div>'


def question(block: Choice | Quiz, chosen: int | None, revealed: bool, words: Words) -> str:
    """A question with lettered options; once revealed, with what is right and why.

    Args:
        chosen: index of the student's answer; None when there is none.
    """
    rows = "".join(
        _option(letter, option, i == chosen, revealed)
        for i, (letter, option) in enumerate(zip(LETTERS, block.options, strict=False))
    )
    content = f"<p><b>{block.question}</b></p>{rows}"
    if revealed:
        content += _answer(block.options, chosen, words)
    return box(content, FOLLOWER.hex)


def task(block: Task, verdicts: list[Verdict], run: LessonState) -> str:
    """What to do, how far it is done, and the hints shown so far."""
    words, best = run.words, run.notes.tasks.get(block.id)
    rows = "".join(
        f'<div style="display:flex;gap:0.5em;font-size:0.88em;color:{GREEN if v.passed else GREY}">'
        f"<span>{'✓' if v.passed else '○'}</span><span>{html.escape(v.words)}</span></div>"
        for v in verdicts
    )
    hints = "".join(
        f'<p style="color:{AMBER};font-size:0.92em">{hint}</p>'
        for hint in block.hints[: run.notes.hints.get(block.id, 0)]
    )
    passed = ""
    if best is not None:
        unit = QUANTITIES.get(block.best, "")
        said = words("lesson.passed_best", best=f"{best:.2f}", unit=unit) if block.best else None
        passed = f'<p style="color:{GREEN};font-weight:700">✓ {said or words("lesson.passed")}</p>'
    return box(
        f"<p><b>{block.text}</b></p>{rows}{hints}{passed}", GREEN if passed else FOLLOWER.hex
    )


def entry(lesson: Lesson, run: LessonState, number: int) -> str:
    """A line of the overview."""
    notes = run.progress.notes.get(lesson.name)
    tasks = lesson.tasks()
    done = sum(task.id in notes.tasks for task in tasks) if notes else 0
    finished = notes is not None and notes.seen >= len(lesson.steps) and done == len(tasks)
    facts = [
        run.words("lesson.minutes", minutes=lesson.front.minutes),
        run.words("lesson.tasks", done=done, all=len(tasks)),
    ]
    if lesson.language != run.words.language:
        facts.append(run.words("lesson.english"))
    tick = f'<span style="color:{GREEN}">✓</span> ' if finished else ""
    return (
        f'<div style="padding:0.7em 0 0.1em 0"><b>{tick}{number}. '
        f"{html.escape(lesson.front.title)}</b> "
        f'<span style="color:{GREY};font-size:0.85em">{" · ".join(facts)}</span>'
        f'<div style="font-size:0.9em;color:#445">{html.escape(lesson.front.summary)}</div></div>'
    )


def _option(letter: str, option: Option, chosen: bool, revealed: bool) -> str:
    colour = "#1f2937"
    if revealed and (option.right or chosen):
        colour = GREEN if option.right else AMBER
    weight = 700 if chosen else 400
    mark = ("✓" if option.right else "✗") if revealed and (option.right or chosen) else ""
    return (
        f'<div style="display:flex;gap:0.55em;margin:0.3em 0;color:{colour};font-weight:{weight}">'
        f"<span>{letter}</span><span>{option.text} {mark}</span></div>"
    )


def _answer(options: tuple[Option, ...], chosen: int | None, words: Words) -> str:
    right, said = next(option for option in options if option.right), ""
    if chosen is not None:
        own = options[chosen]
        verdict = words("lesson.right" if own.right else "lesson.not_quite")
        said = f"<p><b>{verdict}</b> {own.answer}</p>"
        if own.right:
            return said
    return said + f"<p>{words('lesson.the_answer', answer=right.answer)}</p>"


def _bar(index: int, here: int, seen: int) -> str:
    if index == here:
        return FOLLOWER.hex
    return "#9cc3de" if index < seen else "#dfe4ea"
