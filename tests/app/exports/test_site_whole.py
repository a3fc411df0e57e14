"""Every step of the course has on the site what it has in the lab, and what its text names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from html import unescape
from typing import Any

import pytest

from onpath.app.exports.site.step_data import SiteStep, site_step
from onpath.app.exports.site.step_figures import STANDS_FOR
from onpath.lessons.course import BUILT_IN, REFERENCE, read_references
from onpath.lessons.labels import parameter_label
from onpath.lessons.schema import Lesson, Step, Text
from onpath.lessons.task_schema import Reference, Task
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough

COURSE = built_in_course()[0]
BUTTONS = {"hold": "run.hold_both", "run": "run.pause", "reset": "run.reset", "step": "run.step"}
STRONG = re.compile(r"<(?:strong|b)>(.*?)</(?:strong|b)>")
FOLDS = re.compile(r"<details.*?</details>", re.DOTALL)


@cache
def references_of(name: str) -> dict[str, Reference]:
    references, problems = read_references(COURSE.lesson(name, "en"), BUILT_IN / name / REFERENCE)
    assert not problems
    return references


@cache
def steps_of(name: str) -> list[SiteStep]:
    lesson, references = COURSE.lesson(name, "en"), references_of(name)
    return [site_step(lesson, i, references, ENGLISH) for i in range(len(lesson.steps))]


def fields_of(site: SiteStep) -> dict[str, Any]:
    """The fields of a step's form, by name."""
    groups = site.figure["form"]["groups"]
    return {field["name"]: field for group in groups for field in group["fields"]}


def can_act(field: dict[str, Any], site: SiteStep) -> bool:
    """Whether a field acts, or does so once another field of the form has another value."""
    values = {
        name: value for name, value in site.data["values"].items() if name not in fields_of(site)
    }
    return all(  # what the page does not know is as the step wants it
        any(values[each["name"]] in each.get("of", ()) for each in need if each["name"] in values)
        or any(each["name"] in fields_of(site) for each in need)
        or not any(each["name"] in values for each in need)
        for need in field.get("needs", ())
    )


def has_one_option(lesson: Lesson, name: str) -> bool:
    """Whether a control chooses among robots, of which no task of the lesson names one."""
    spec = specs(ROBOTS[lesson.front.robot].parameters).get(name)
    checks = [check for task in lesson.tasks() for check in task.check]
    return (
        spec is not None
        and bool(spec.options)
        and all(getattr(each, "name", "") != name for each in checks)
    )


def lacks_of(lesson: Lesson, step: Step, site: SiteStep) -> list[str]:
    """What a step has in the lab and not on the site."""
    setup = lesson.setup_at(site.number - 1)
    here = {*fields_of(site), *site.figure["controls"], *site.figure["drawings"]["shown"]}
    here |= {name for name in setup.controls if has_one_option(lesson, name)}
    tools = {"editor": "drag", "show": "labels"}
    lacks = list[str]()
    if step.kind not in ("predict", "quiz"):
        wanted = [each for name in setup.controls for each in STANDS_FOR.get(name, (name,))]
        lacks += [name for name in wanted if tools.get(name, name) not in here]
    lacks += [name for name in setup.show if name not in here]
    lacks += [f"plot {name}" for name in setup.plots if name not in site.data["plots"]]
    if len(site.figure["drawings"]["marks"]) != len(setup.marks):
        lacks.append("marks")
    if step.script is not None and site.data["script"] is None:
        lacks.append("script")
    for block, data in zip(step.blocks, site.data["blocks"], strict=True):
        if isinstance(block, Text):
            acting = zip(block.links, data["links"], strict=True)
            lacks += [link.label for link, acts in acting if not acts]
        if isinstance(block, Task) and "checks" not in data:
            lacks.append(block.id)
    return lacks


def named_in(lesson: Lesson, step: Step, words: Words, site: SiteStep) -> Iterator[str]:
    """Names of controls that a step's text sets in bold, outside of what is folded."""
    robot = lesson.setup_at(site.number - 1).robot or lesson.front.robot
    known = {parameter_label(n, s, words): n for n, s in specs(ROBOTS[robot].parameters).items()}
    known |= {parameter_label(n, each.spec, words): n for n, each in SETTINGS.items()}
    known |= {words(key): name for name, key in BUTTONS.items()}
    for block in step.blocks:
        texts = [block.html] if isinstance(block, Text) else []
        texts += [block.text, *block.hints] if isinstance(block, Task) else []
        for text in texts:
            for name in STRONG.findall(FOLDS.sub("", str(text))):
                if (found := known.get(unescape(name))) is not None:
                    yield found


@pytest.mark.parametrize("name", COURSE.lessons)
def test_a_step_has_what_its_text_names(name: str) -> None:
    lesson = COURSE.lesson(name, "en")
    for index, (step, site) in enumerate(zip(lesson.steps, steps_of(name), strict=True)):
        where, lacks = f"{name} {site.number}", lacks_of(lesson, step, site)
        if site.data["onlyLab"]:
            assert step.optional and lacks and all(site.data["onlyLab"].values()), where
            continue
        assert not lacks, where
        assert all(can_act(field, site) for field in fields_of(site).values()), where
        here = {*fields_of(site), *site.figure["controls"], *site.figure["changes"]["values"]}
        for language in ("en", "de"):
            if step.kind != "predict":
                other = COURSE.lesson(name, language)
                found = named_in(other, other.steps[index], Words(language), site)
                assert {*found} <= here, (where, language)


def test_few_steps_say_that_only_the_lab_can_do_them() -> None:
    only = [
        (name, site.number)
        for name in COURSE.lessons
        for site in steps_of(name)
        if site.data["onlyLab"]
    ]
    assert only == [
        ("01-path-or-timetable", 12),
        ("06-exact-cancellation", 8),
        ("06-exact-cancellation", 9),
    ]
