"""The course's tasks on a site: a reader passes each by what its author does, as in the lab."""

from __future__ import annotations

import pytest

from onpath.app.exports.standalone.setting_numbers import Unsupported
from onpath.app.lab.dry_runs.course_check import lab_at, solved
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.course import BUILT_IN, REFERENCE, read_references
from tests.support.built_in import built_in_course
from tests.support.site_scripts import needs_node, play_on_site
from tests.support.site_tasks import ONLY_IN_LAB, ROUGH

pytestmark = [pytest.mark.thorough, needs_node]

COURSE = built_in_course()[0]


@pytest.mark.parametrize("name", COURSE.lessons)
def test_it_is_passed_and_failed_with_the_lab_s_words(name: str) -> None:
    lesson, loop_cache = COURSE.lesson(name, "en"), LoopCache(at_once=True)
    references, _ = read_references(lesson, BUILT_IN / name / REFERENCE)
    for index, step in enumerate(lesson.steps):
        for task in step.tasks():
            scripts = references[task.id].solution, references[task.id].failure
            if task.id in ONLY_IN_LAB:
                with pytest.raises(Unsupported):
                    play_on_site(lesson, index, [(scripts[0], task)])
                continue
            found = play_on_site(lesson, index, [(script, task) for script in scripts])
            assert [each["passed"] for each in found] == [True, False], task.id
            for here, script in zip(found, scripts, strict=True):
                _, there = solved(lab_at(lesson, step, loop_cache), script, task)
                if task.id not in ROUGH:  # looks at other instants
                    said = [(each.passed, each.words) for each in there]
                    assert [(v["passed"], v["words"]) for v in here["verdicts"]] == said
