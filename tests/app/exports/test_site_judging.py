"""The static site judges as the lab does."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest

from onpath.app.exports.site.task_data import check_data, check_words
from onpath.lessons.checks import verdict, way_of
from onpath.lessons.record import Record
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Better, Once, Only, Task, TaskWay
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.laws.own import OWN, short_name
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.path_design import presets
from tests.support.node_page import NodePage, judging_page, needs_node
from tests.support.random_records import some_check, some_record

pytestmark = [pytest.mark.thorough, needs_node]
RECORDS = 2000


@pytest.fixture(scope="module")
def judging() -> Iterator[NodePage]:
    page = judging_page()
    yield page
    page.close()


JUDGE_ALL = """text => {
    const {cases, words} = JSON.parse(text)
    const begun = ({happenings, run}) => happenings.some(each => each.run === run)
    const nothing = {passed: true, words: "", share: null, broken: null}  // is left out
    return cases.map(({check, record}) =>
        judge([check], record, words)[0] ?? {...nothing, begun: begun(record)})
}"""


@pytest.mark.parametrize(("language", "records"), [("en", RECORDS), ("de", RECORDS // 10)])
def test_checks_say_and_decide_what_the_lab_s_do(
    judging: NodePage, language: str, records: int
) -> None:
    """On thousands of random records, among them ties and bounds that are met exactly."""
    rng, words = np.random.default_rng(20), Words(language)
    cases, expected = list[Any](), list[Any]()
    for _ in range(records):
        record, check = some_record(rng), some_check(rng)
        names = robot_names(record.laws, words)
        data = check_data(check, record.parameters, names, words)
        cases.append({"check": data, "record": as_data(record)})
        found = verdict(check, record, words)
        begun = any(event.run == record.run for event in record.happenings)
        expected.append(asdict(replace(found, begun=begun)))
    passed = sum(each["passed"] for each in expected)
    assert records / 10 < passed < records * 9 / 10
    for i in range(0, records, 500):
        text = json.dumps({"cases": cases[i : i + 500], "words": check_words(words)})
        assert judging.evaluate(JUDGE_ALL, text) == expected[i : i + 500]


WAYS_OF_ALL = """text => {
    const {cases, words} = JSON.parse(text)
    return cases.map(({ways, record}) => wayOf(ways, record, words))
}"""


def test_a_task_is_passed_in_the_way_that_the_lab_says(judging: NodePage) -> None:
    rng, cases, expected = np.random.default_rng(21), list[Any](), list[int]()
    for _ in range(RECORDS // 10):
        record = some_record(rng)
        drawn = (some_check(rng) for _ in range(3))
        checks = [each for each in drawn if not isinstance(each, Only | Better | Once)]
        names = robot_names(record.laws, ENGLISH)
        ways = [check_data(check, record.parameters, names, ENGLISH) for check in checks]
        cases.append({"ways": ways, "record": as_data(record)})
        task = Task(id="a", text="", check=(), way=tuple(TaskWay(check, "") for check in checks))
        expected.append(way_of(task, record))
    assert {0, 1, 2} <= set(expected)
    text = json.dumps({"cases": cases, "words": check_words(ENGLISH)})
    assert judging.evaluate(WAYS_OF_ALL, text) == expected


def as_data(record: Record) -> dict[str, Any]:
    """A record as the page keeps one."""
    laws = {side: short_name(law) for side, law in {**DEFAULT_LAWS, **record.laws}.items()}
    gains = {
        name: getattr(record.parameters, name) for name in ("K1", "K2", "task", "encoder_counts")
    }
    path = record.path if record.path in presets() else OWN
    own = {"path": path, "robot": record.robot, "length": record.length()}
    return {
        "times": record.times.tolist(),
        "end": record.end,
        "values": {r: {q: c.tolist() for q, c in own.items()} for r, own in record.values.items()},
        "happenings": [asdict(event) for event in record.happenings],
        "run": record.run,
        "settings": gains | laws | own,
        "changed": list(record.changed()),
    }
