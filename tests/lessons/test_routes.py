"""Routes: files that name steps of lessons with times; what is wrong is named with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.app.lab.commands import (
    FinishLesson,
    FollowRoute,
    GoToStep,
    OpenLesson,
    Predict,
    TakeStep,
)
from onpath.app.lab.lab import Lab
from onpath.assets.messages import languages
from onpath.lessons.concept_test import on_route
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE
from onpath.lessons.course import Course, read_course
from onpath.lessons.minutes import step_minutes
from onpath.lessons.progress import Progress, read_progress
from onpath.lessons.routes import FOLDER
from tests.support.built_in import built_in_course
from tests.support.catalogues import COMPLETE
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import write_lesson

ROUTE = """
[title]
en = "Short"
[summary]
en = "For tests."
[[stop]]
lesson = "01-a"
steps = [2, 3]
minutes = 5
[[stop]]
lesson = "02-b"
steps = [6, 6]
minutes = 2.5
[[stop]]
lesson = "01-a"
steps = [7, 8]
minutes = 4
"""
STOPS = [("01-a", 1), ("01-a", 2), ("02-b", 5), ("01-a", 6), ("01-a", 7)]


def written(folder: Path, route: str = ROUTE) -> Course:
    for name in ("01-a", "02-b"):
        write_lesson(folder, name=name)
    (folder / FOLDER).mkdir(exist_ok=True)
    (folder / FOLDER / "short.toml").write_text(route, encoding="utf-8")
    course, problems = read_course([folder])
    assert problems == []
    return course


def place(lab: Lab) -> tuple[str, int]:
    """The open step."""
    return lab.lessons.progress.lesson, lab.lessons.index


def turn(lab: Lab, by: int) -> None:
    """Turn a page; a pending prediction is skipped by the first press."""
    before = place(lab)
    do(lab, GoToStep(by))
    if place(lab) == before:
        do(lab, GoToStep(by))


def test_a_route_is_followed_from_stop_to_stop_and_back(tmp_path: Path) -> None:
    lab = Lab(loop_cache(), course=written(tmp_path))
    do(lab, FollowRoute("short"))
    seen = [place(lab)]
    for _ in range(len(STOPS) - 1):
        turn(lab, 1)
        seen.append(place(lab))
    assert seen == STOPS and lab.lessons.at_end
    turn(lab, 1)
    assert place(lab) == STOPS[-1]
    for expected in STOPS[-2::-1]:
        turn(lab, -1)
        assert place(lab) == expected
    turn(lab, -1)
    assert place(lab) == STOPS[0]


def test_opening_a_lesson_leaves_the_route(tmp_path: Path) -> None:
    lab = Lab(loop_cache(), course=written(tmp_path))
    do(lab, FollowRoute("short"), OpenLesson("02-b"))
    assert lab.lessons.route is None
    turn(lab, 1)
    assert place(lab) == ("02-b", 1)


def test_the_teacher_opens_a_route_and_a_step_beside_it(tmp_path: Path) -> None:
    lab = Lab(loop_cache(), course=written(tmp_path))
    do(lab, TakeStep("01-a", 1, "short"))
    assert lab.lessons.progress.route == "short" and place(lab) == STOPS[0]
    do(lab, TakeStep("02-b", 0))  # it is not on the route, and goes on in its lesson
    assert place(lab) == ("02-b", 0) and lab.lessons.progress.route == "short"
    turn(lab, 1)
    assert place(lab) == ("02-b", 1)
    do(lab, TakeStep("02-b", 0, "no such route"))
    assert place(lab) == ("02-b", 0)


def test_an_unknown_route_is_refused(tmp_path: Path) -> None:
    lab = Lab(loop_cache(), course=written(tmp_path))
    do(lab, FollowRoute("shorts"))
    assert lab.message_level == "warning" and "short" in lab.message
    assert lab.lessons.lesson is None


def test_progress_of_earlier_versions_has_no_route() -> None:
    assert read_progress({"lesson": "01-a"}) == Progress(lesson="01-a", route="")


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ('lesson = "02-b"', 'lesson = "02-c"', "did you mean 02-b"),
        ("steps = [6, 6]", "steps = [6, 9]", "has 1 to 8"),
        ("steps = [6, 6]", "steps = [6, 5]", "it ends before it begins"),
        ("steps = [7, 8]", "steps = [2, 5]", "twice"),
        ("steps = [7, 8]", "steps = [5, 6]", "5 shows what 4 predicts"),
        ("steps = [2, 3]", "steps = [2, 4]", "4 is a prediction"),
        ("minutes = 2.5", "minutes = 0", "minutes"),
        ("minutes = 2.5", "mintes = 2.5", "mintes"),
        ('en = "Short"', 'de = "Kurz"', "title"),
        ("[[stop]]", "[[stop", "TOML"),
    ],
)
def test_what_is_wrong_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], right: str, wrong: str, said: str
) -> None:
    written(tmp_path)
    file = tmp_path / FOLDER / "short.toml"
    file.write_text(ROUTE.replace(right, wrong, 1), encoding="utf-8")
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"{file}:") and said in line


def test_the_built_in_routes_have_time_for_what_they_name() -> None:
    """And in self-study not much more, and no optional page.

    A demonstration is not read aloud, so it may be quicker.
    """
    course, problems = built_in_course()
    assert problems == [] and len(course.routes) == 3
    for name, route in course.routes.items():
        assert set(COMPLETE) <= set(route.title) == set(route.summary) <= set(languages())
        for stop in route.stop:
            steps = course.lesson(stop.lesson, "en").steps[stop.steps[0] - 1 : stop.steps[1]]
            estimated = sum(step_minutes(step).total for step in steps)
            assert "lecture" in name or stop.minutes >= estimated - 1, (name, stop, estimated)
            assert "self" not in name or stop.minutes <= estimated + 2, (name, stop, estimated)
            assert "self" not in name or not any(step.optional for step in steps), (name, stop)
    minutes = [route.minutes for route in course.routes.values()]
    assert minutes[0] <= 90 and minutes[1] <= 20


def test_a_route_begins_and_ends_with_the_concept_test() -> None:
    course, _ = built_in_course()
    (name,) = [name for name, route in course.routes.items() if route.test]
    lab = Lab(loop_cache(), course=course)
    do(lab, FollowRoute(name))
    assert place(lab) == (BEFORE, 0) and lab.lessons.progress.route == name
    do(lab, FinishLesson(), FollowRoute(name))
    first, *_, last = course.routes[name].stop
    assert place(lab) == (first.lesson, first.steps[0] - 1)
    do(lab, TakeStep(last.lesson, last.steps[1] - 1, name), Predict(option=0), FinishLesson())
    route = lab.lessons.route
    assert lab.lessons.ended and on_route.last_test(route, course, lab.lessons.progress) == AFTER
    do(lab, OpenLesson(AFTER), FinishLesson())
    assert on_route.last_test(route, course, lab.lessons.progress) == ""


def test_routes_are_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path)
    assert run_command(["lessons", "list", str(tmp_path)]) == 0
    assert "11.5 route: Short" in capsys.readouterr().out
