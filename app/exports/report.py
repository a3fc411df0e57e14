"""A student's record of the lessons as one page: what was predicted, what happened, what is done.

What a lesson's author wrote in markdown is safe HTML already; everything else is escaped here.
"""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from html import escape

import numpy as np

from onpath.app.common.access_codes import shown
from onpath.app.common.palette import AMBER, FOLLOWER, GREEN, GREY, INK
from onpath.app.exports.report_facts import Chapter, chapters, predictions, quizzes
from onpath.app.exports.report_plot import draw_prediction, number
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.progress import Answer, Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Option, Prediction, Quiz, Sketch, Task
from onpath.lessons.words import DEFAULT, Words

POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
STYLE = f"""
@page {{ size: A4; margin: 18mm 20mm; }}
body {{ max-width: 44em; margin: 2.5em auto; padding: 0 1.2em; color: {INK.hex}; background: #fff;
  font: 16px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }}
h1 {{ font-size: 1.9em; line-height: 1.2; margin: 0 0 0.2em; }}
h2 {{ font-size: 1.4em; line-height: 1.25; margin: 2em 0 0.2em; padding-top: 0.6em;
  border-top: 2px solid {FOLLOWER.hex}; }}
h3 {{ font-size: 1.1em; margin: 1.4em 0 0.4em; color: {FOLLOWER.hex}; }}
h4 {{ font-size: 1em; margin: 0 0 0.3em; }}
h2, h3, h4 {{ break-after: avoid; }}
p, figure {{ margin: 0.4em 0; }}
article {{ margin: 0.8em 0; padding: 0.6em 0.9em; border: 1px solid #d5dae1; border-radius: 6px;
  break-inside: avoid; overflow-wrap: anywhere; }}
.soft {{ color: {GREY}; }}
h4 .soft {{ font-weight: 400; font-size: 0.9em; margin-left: 0.4em; }}
.ask, .label, .right, .wrong {{ font-weight: 700; }}
.ask, article div {{ margin: 0.3em 0; }}
.right {{ color: {GREEN}; }}
.wrong {{ color: {AMBER}; }}
.table {{ overflow-x: auto; }}
table {{ border-collapse: collapse; width: 100%; margin: 1.2em 0; font-size: 0.92em; }}
th, td {{ padding: 0.4em 0.6em; border-bottom: 1px solid #d5dae1; text-align: left; }}
th {{ vertical-align: bottom; border-bottom: 2px solid {INK.hex}; }}
td + td, th + th {{ text-align: right; font-variant-numeric: tabular-nums; }}
td + td {{ white-space: nowrap; }}
th:first-child {{ min-width: 9em; }}
img {{ display: block; max-width: 100%; margin: 0.4em auto; }}
figcaption {{ font-size: 0.9em; }}
code {{ font-size: 1.05em; }}
@media print {{
  body {{ margin: 0; padding: 0; max-width: none; font-size: 10.5pt; }}
  section {{ break-before: page; }}
  h2 {{ margin-top: 0; }}
  * {{ print-color-adjust: exact; -webkit-print-color-adjust: exact; }}
}}
"""


def report(run: LessonState, code: str, made: datetime) -> bytes:
    """The record as a page that stands alone; the same record gives the same bytes.

    Args:
        code: of the session, as it is kept; empty for none.
        made: the date it bears.
    """
    words, found = Words(run.progress.language), chapters(run)
    title = words("report.title")
    page = (
        f'<!DOCTYPE html>\n<html lang="{words.language}">\n<head>\n<meta charset="utf-8" />\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}" />\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1" />\n'
        f"<title>OnPath: {title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f"<h1>{title}</h1>\n{_origin(code, made, words)}{_overview(found, words)}"
        f"{_gone(run, words)}{''.join(_chapter(c, words) for c in found if c.opened)}"
        "</body>\n</html>\n"
    )
    return page.encode("utf-8", "replace")


def _origin(code: str, made: datetime, words: Words) -> str:
    facts = ["OnPath", words("report.made", date=made.strftime(words("report.date")))]
    if code:
        facts.append(words("report.code", code=f"<code>{escape(shown(code))}</code>"))
    return f'<p class="soft">{" · ".join(facts)}</p>\n'


def _overview(found: list[Chapter], words: Words) -> str:
    """A line for each lesson."""
    if not any(chapter.opened for chapter in found):
        return f"<p>{words('report.none')}</p>\n"
    heads = "".join(
        f'<th scope="col">{words(f"report.{key}")}</th>'
        for key in ("lesson", "seen", "tasks", "made_of", "right_of")
    )
    rows = "".join(_row(chapter, words) for chapter in found)
    return (
        f'<div class="table"><table>\n<thead><tr>{heads}</tr></thead>\n'
        f"<tbody>\n{rows}</tbody>\n</table></div>\n"
    )


def _row(chapter: Chapter, words: Words) -> str:
    lesson, notes, chosen = chapter.lesson, chapter.notes, chapter.chosen()
    made = sum(not answer.skipped for answer in notes.answers.values())
    counts = (
        (notes.seen, len(lesson.steps)),
        (len(notes.tasks), len(lesson.tasks())),
        (made, len(predictions(lesson))),
        (sum(chosen), len(chosen)),
    )
    cells = "".join(
        f"<td>{words('report.part', part=part, all=all_) if all_ else '–'}</td>"
        for part, all_ in counts
    )
    return f"<tr><td>{chapter.number}. {escape(lesson.front.title)}</td>{cells}</tr>\n"


def _gone(run: LessonState, words: Words) -> str:
    """What was begun and is not in the course."""
    return "".join(
        _soft(words("report.gone", name=escape(name)))
        for name in sorted(set(run.progress.notes) - set(run.course.lessons))
    )


def _chapter(chapter: Chapter, words: Words) -> str:
    """All that was asked in one lesson."""
    lesson, notes = chapter.lesson, chapter.notes
    predicted = (
        _article(_prediction(chapter, key, block, words), _place(chapter, key, words))
        for key, block in predictions(lesson).items()
    )
    tasks = (_article(_task(task, notes.tasks.get(task.id), words)) for task in lesson.tasks())
    asked = (
        _article(_ask(block.question) + _quiz(block, notes.quiz.get(key), words))
        for key, block in quizzes(lesson).items()
    )
    strange = words("report.strange", count=chapter.strange) if chapter.strange else ""
    foreign = lesson.language == DEFAULT != words.language
    other = words("lesson.english") if foreign else ""
    return (
        f"<section>\n<h2>{chapter.number}. {escape(lesson.front.title)}</h2>\n"
        f"<p>{escape(lesson.front.summary)}</p>\n{_soft(other)}{_soft(strange)}"
        f"{_group(words('report.predictions'), predicted)}"
        f"{_group(words('report.to_do'), tasks)}"
        f"{_group(words('report.questions'), asked)}</section>\n"
    )


def _prediction(chapter: Chapter, key: str, block: Prediction, words: Words) -> str:
    answer, truth = chapter.notes.answers.get(key), chapter.notes.truths.get(key)
    parts = [_ask(block.question)]
    if answer is None or answer.skipped:
        parts.append(_soft(words("report.not_predicted" if answer is None else "lesson.skipped")))
    if isinstance(block, Sketch):
        parts.append(_sketch(block, answer, truth, words))
    elif truth is not None:
        parts.append(_options(block.options, answer.option if answer else None, words))
    elif answer is not None and answer.option is not None:
        parts.append(_said(words("report.chosen"), block.options[answer.option].text))
    if truth is None:
        parts.append(_soft(words("report.not_happened")))
    return "".join(parts)


def _sketch(block: Sketch, answer: Answer | None, truth: Truth | None, words: Words) -> str:
    """What was drawn and what happened, on the same axes, and the peaks in words."""
    unit, said = QUANTITIES[block.quantity], list[str]()
    if answer is not None and answer.times:
        value, time = _peak(answer.times, answer.values, words)
        said.append(words("report.drawn", value=value, unit=unit, time=time))
    if truth is not None:
        peaks = {}
        for robot, values in (("tracker", truth.tracker), ("follower", truth.follower)):
            value, time = _peak(truth.times, values, words)
            name = words(f"robot.{robot}")
            peaks[robot] = words("report.peak", robot=name, value=value, unit=unit, time=time)
        said.append(words("report.happened", first=peaks["tracker"], second=peaks["follower"]))
    if not said:
        return ""
    robot, quantity = words(f"robot.{block.robot}"), words(f"quantity.{block.quantity}")
    name = words("report.curve", robot=robot, quantity=quantity)
    picture = draw_prediction(block, answer, truth, words)
    return (
        f'<figure><img alt="{escape(name)}" src="{picture}" />\n'
        f"<figcaption>{escape(' '.join(said))}</figcaption></figure>\n"
    )


def _peak(times: tuple[float, ...], values: tuple[float, ...], words: Words) -> tuple[str, str]:
    """The value furthest from zero and its time, as they are written."""
    at = int(np.argmax(np.abs(values)))
    return number(values[at], words), number(times[at], words)


def _quiz(block: Quiz, chosen: int | None, words: Words) -> str:
    if chosen is None:
        return _soft(words("report.not_answered"))
    return _options(block.options, chosen, words)


def _options(options: tuple[Option, ...], chosen: int | None, words: Words) -> str:
    """What was chosen, what is right, and why."""
    own = None if chosen is None else options[chosen]
    parts: list[str] = []
    if own is not None:
        verdict = words("lesson.right" if own.right else "lesson.not_quite")
        parts.append(_said(words("report.chosen"), own.text))
        parts.append(_said(verdict, own.answer, "right" if own.right else "wrong"))
    if own is None or not own.right:
        right = next(option for option in options if option.right)
        parts += [_said(words("report.right"), right.text, "right"), _div(right.answer)]
    return "".join(parts)


def _task(task: Task, best: float | None, words: Words) -> str:
    if best is None:
        said = f'<p class="soft">○ {words("report.not_passed")}</p>\n'
    else:
        unit = QUANTITIES.get(task.best, "")
        passed = words("lesson.passed")
        if task.best:
            passed = words("lesson.passed_best", best=number(best, words), unit=unit)
        said = f'<p class="right">✓ {passed}</p>\n'
    return _ask(task.text) + said


# Pieces. A lesson's words may be whole paragraphs, so they stand in no <p>.


def _place(chapter: Chapter, key: str, words: Words) -> str:
    steps = chapter.lesson.steps
    counted = words("lesson.step", step=int(key) + 1, steps=len(steps))
    title = escape(steps[int(key)].title)
    return f'<h4>{title} <span class="soft">{counted}</span></h4>\n'


def _group(title: str, articles: Iterable[str]) -> str:
    content = "".join(articles)
    return f"<h3>{title}</h3>\n{content}" if content else ""


def _article(content: str, head: str = "") -> str:
    return f"<article>\n{head}{content}</article>\n"


def _ask(question: str) -> str:
    return f'<div class="ask">{question}</div>\n'


def _said(label: str, content: str, kind: str = "label") -> str:
    return f'<div><span class="{kind}">{label}</span> {content}</div>\n'


def _div(content: str) -> str:
    return f"<div>{content}</div>\n"


def _soft(text: str) -> str:
    return f'<p class="soft">{text}</p>\n' if text else ""
