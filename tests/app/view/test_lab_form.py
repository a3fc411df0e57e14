"""The form of a lab: what is in it, and what a page that sets a field is told."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from onpath.app.channel.messages import (
    AskForm,
    FieldValue,
    FormMessage,
    SetField,
    ValuesMessage,
)
from onpath.app.lab.commands import TypeLaw
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.page_form import PageForm
from onpath.app.view.forms import ELSEWHERE
from onpath.app.view.lab_form import OF_PAGE, PULLS, form_of, refusals_in, values_in
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import NO_LESSONS
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.laws.registry import OWN_GAINS
from onpath.models.control.settable import specs
from onpath.models.control.sides import SIDES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import loop_cache


def at_once(work: Callable[[], None]) -> None:
    work()


def fields(form: FormMessage) -> list[Any]:
    return [field for group in form.groups for field in group.fields]


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_lab_has_all_that_can_act_once_and_in_words(robot: str) -> None:
    lab = Lab(loop_cache(), ROBOTS[robot])
    snapshot = take_page_snapshot(lab, 1.0)
    known = specs(ROBOTS[robot].parameters)
    for language in ("en", "de"):
        words = Words(language)
        found = fields(form_of(snapshot, None, words))
        names = [field.name for field in found]
        assert len(names) == len(set(names))
        values = values_in(snapshot, {}, (), words)
        needs = [{one.name for one in each} for field in found for each in field.needs]
        assert all(each & {*values} for each in needs)
        drawn = {field.name for field in found if field.kind == "switch"} - {*SETTINGS}
        told = {field.name for field in found if field.kind != "button"}
        assert told - drawn <= {*values, *SETTINGS, *OF_PAGE}
        assert all(field.label for field in found if field.kind != "note")
        assert all(field.limit in values for field in found if field.limit)
        declared = {*known, *SETTINGS} - {*OWN_GAINS, *ELSEWHERE, "larger", "K4"}
        assert declared <= {*names}, declared - {*names}
    assert form_of(snapshot, None, words) is form_of(snapshot, None, words)  # told once


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_mouse_pulls_in_the_planes_that_the_form_offers(robot: str) -> None:
    entry = ROBOTS[robot]
    snapshot = take_page_snapshot(Lab(loop_cache(), entry), 1.0)
    offered = {field.name: field for field in fields(form_of(snapshot, None, ENGLISH))}.get("pull")
    planes = stage_of(entry.make(entry.parameters())).pulls
    assert (PULLS if offered else PULLS[:1]) == tuple(planes)


def test_a_step_has_what_it_names_and_marks_its_values() -> None:
    snapshot = take_page_snapshot(Lab(loop_cache()), 1.0)
    setup = StepSetup(controls=("K1", "hold", "wall", "alpha"), set={"K1": 900.0})
    found = {field.name: field for field in fields(form_of(snapshot, setup, ENGLISH))}
    assert list(found) == [
        "K1",
        "wall",
        "wall_z1",
        "wall_z2",
        "wall_angle",
        "wall_forces",
        "controls",
    ]
    assert (found["K1"].mark, found["K1"].default) == (900.0, 400.0)


def test_a_page_hears_of_a_value_when_it_counts_and_of_what_has_changed() -> None:
    lab = Lab(loop_cache())
    form, switches = PageForm(lab.post, at_once), set[str]()
    overlays = SimpleNamespace(shape=None, rank_map=None)
    page: Any = SimpleNamespace(switches=switches, overlays=overlays, pull=PULLS[0])

    def news() -> list[Any]:
        found = list(form.news(take_page_snapshot(lab, 1.0), page, NO_LESSONS, ENGLISH))
        for each in found:
            if isinstance(each, ValuesMessage):
                each.values.pop("poles", None)
                each.values.pop("pole_plane", None)
        return found

    form.hear(AskForm(), True)
    first = news()
    assert [type(each) for each in first] == [FormMessage, FormMessage, ValuesMessage]
    assert [each.place for each in first[:2]] == ["lab", "step"] and first[1].groups == ()
    assert news() == []
    form.hear(SetField("K1", 905.0, 7), True)
    assert news() == []  # it does not count yet
    lab.drain()
    assert news() == [ValuesMessage({"K1": 905.0}, {}, {"K1": 7})]
    form.hear(SetField("K1", 9e6, 8), True)
    lab.drain()
    (told,) = news()
    assert told.values == {} and "2500" in told.refused["K1"] and told.heard == {"K1": 8}
    form.hear(SetField("K1", 400.0, 9), True)
    lab.drain()
    assert news() == [ValuesMessage({"K1": 400.0}, {"K1": ""}, {"K1": 9})]
    form.hear(SetField("tube", True, 10), True)
    assert news()[0].values == {"tube": True} and switches == {"tube"}
    form.hear(SetField("show_zone", True, 10), True)
    assert news()[0].values == {"show_zone": True} and switches == {"tube", "zone"}
    form.hear(SetField("pull", PULLS[1], 10), True)
    assert news()[0].values == {"pull": PULLS[1]} and page.pull == PULLS[1]
    form.hear(SetField("pull", "no plane", 11), True)
    assert news()[0].values == {} and page.pull == PULLS[1]
    form.hear(SetField("K2", 55.0, 11), False)  # another lab is shown
    lab.drain()
    assert news() == [ValuesMessage({}, {}, {"K2": 11})]
    lab.frozen = True
    form.hear(SetField("K2", 55.0, 12), True)
    lab.drain()
    assert news() == [ValuesMessage({}, {}, {"K2": 12})]


def test_a_point_of_the_path_is_chosen_and_moved() -> None:
    lab = Lab(loop_cache())
    form = PageForm(lab.post, at_once)

    def told(name: str, value: FieldValue) -> dict[str, Any]:
        form.hear(SetField(name, value, 1), True)
        lab.drain()
        return values_in(take_page_snapshot(lab, 1.0), {}, (), ENGLISH)

    before = told("point", 3)
    assert before["point"] == 3
    moved = told("point_z1", float(before["point_z1"]) + 2e-3)
    assert moved["point_z1"] == pytest.approx(float(before["point_z1"]) + 2e-3)
    assert moved["point_z2"] == pytest.approx(float(before["point_z2"]))
    assert told("point", "a text")["point"] == 3
    assert told("point", 99)["point"] == 3
    assert told("point", 0)["point"] == 0


@pytest.mark.parametrize("side", SIDES)
def test_why_a_typed_law_is_refused_is_told_once_where_it_is_typed(side: str) -> None:
    lab = Lab(loop_cache())
    lab.post(TypeLaw(side, "across = nothing"))
    lab.drain()
    assert refusals_in(take_page_snapshot(lab, 1.0)) == {f"typed_{side}": lab.message}
    assert lab.message
