"""The end of a lesson: the student's own answers beside what happened, and how to go on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from msgspec.structs import replace

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.course import read_course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache, new_lab
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.student import PATIENCE, Student
from tests.support.waiting import wait_for

POINT = "Remember the path."
WITH_POINT = LESSON.replace("minutes = 1", f'minutes = 1\ntakeaway = ["{POINT}"]')
CURVE = Answer(times=(0.0, 1.0, 2.0), values=(0.0, 41.0, 5.0))
TRUTH = Truth("distance", (0.0, 0.5, 2.0), (0.0, 47.0, 1.0), (0.0, 2.0, 0.5))


@dataclass
class Site:
    """A student's browser, and the lab that it shows."""

    student: Student
    lab: Lab

    def sees(self, *texts: str) -> None:
        """Wait until all of these are shown."""
        self.student.read(lambda: all(self.student.sees(text) for text in texts))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    folder: Path = tmp_path_factory.mktemp("course")
    for name in ("01-a", "02-b"):
        write_lesson(folder, WITH_POINT, name=name)
    course, problems = read_course([folder])
    assert problems == []
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=course))
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.code)
        found = wait_for(lambda: server.registry.find(student.code), PATIENCE)
        yield Site(student, found.scheduled.lab)
    server.stop()


def curves(student: Student) -> list[list[str]]:
    """What the charts with predictions show."""
    return [
        [*(["truth"] if chart["truth"] else []), *(["you"] if chart["answer"] else [])]
        for chart in student.lesson["charts"]
    ]


def at_the_end(site: Site, answers: dict[str, Answer], truths: dict[str, Truth]) -> None:
    """At the end of the first lesson, with these answers."""
    site.lab.post(TakeStep("01-a", 7))
    site.sees("Step 8 of 8")
    given = notes_with(answers=answers, quiz={"7.0": 1}).given
    notes = replace(site.lab.lessons.notes, given=given, truths=truths)
    progress = site.lab.lessons.progress
    site.lab.lessons.progress = replace(progress, notes={**progress.notes, "01-a": notes})
    site.student.press("Finish")
    site.sees("What you predicted, and what happened", POINT)


@pytest.mark.thorough
def test_own_curves_and_what_is_right_are_beside_what_happened(site: Site) -> None:
    answers = {"1": CURVE, "3": Answer(option=0)}
    at_the_end(site, answers, {"1": TRUTH, "3": TRUTH})
    site.sees("0 of 1 choice right · 1 of 1 curve drawn · 0 of 1 task passed")
    site.sees("41 mm at 1 s", "Tracker 47 mm at 0.5 s", "Correct answer:</b> that", "Hold back.")
    assert curves(site.student) == [["truth", "you"]]


@pytest.mark.thorough
def test_what_has_not_been_seen_is_not_told(site: Site) -> None:
    at_the_end(site, {"1": CURVE, "3": Answer(option=0)}, {})
    site.sees("What really happens has not been seen yet")
    assert not site.student.sees("Correct answer:</b> that")
    assert curves(site.student) == [["you"]]


@pytest.mark.thorough
def test_it_leads_back_and_to_the_next_lesson(site: Site) -> None:
    at_the_end(site, {}, {})
    site.student.press("Back")
    site.sees("Step 8 of 8")
    site.student.press("Finish")
    site.student.press("Open lesson 2: A lesson")
    site.sees("Step 1 of 8")
    assert site.lab.lessons.progress.lesson == "02-b"
    site.lab.post(TakeStep("02-b", 7))
    site.student.press("Finish")
    site.sees("What you predicted, and what happened")
    assert not site.student.has_button("Open lesson 3")


def test_pages_are_turned_to_the_end_and_back(tmp_path: Path) -> None:
    write_lesson(tmp_path)
    course, _ = read_course([tmp_path])
    lab = Lab(loop_cache(), new_lab().simulation.entry, course)
    do(lab, TakeStep("01-a", 7), c.GoToStep(1))
    assert lab.lessons.ended and lab.lessons.index == 7
    do(lab, c.GoToStep(1))
    assert lab.lessons.ended
    do(lab, c.GoToStep(-1))
    assert not lab.lessons.ended and lab.lessons.index == 7
    do(lab, c.GoToStep(-1))
    assert lab.lessons.index == 6
    do(lab, c.FinishLesson(), c.CloseLesson(), c.OpenLesson("01-a"))
    assert not lab.lessons.ended
