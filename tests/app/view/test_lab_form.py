"""The form of a lab: what is in it, and what a page that sets a field is told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.form_messages import (
    AskForm,
    FieldValue,
    FormMessage,
    SetField,
    ValuesMessage,
)
from onpath.app.channel.messages import encoded
from onpath.app.channel.reading import read_message
from onpath.app.lab.commands import AddPoint, ChooseLaw, ChoosePath, Redo, TypeLaw, Undo
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.page_form import PageForm
from onpath.app.view.forms import ELSEWHERE
from onpath.app.view.lab_form import OF_PAGE, PULLS, form_of, refusals_in, values_in
from onpath.app.view.laws import suitable
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import NO_LESSONS
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.lab_settings import SETTINGS, lab_specs
from onpath.models.control.laws.own import OWN, PATH_FOLLOWING
from onpath.models.control.laws.registry import LAWS, OWN_GAINS
from onpath.models.control.settable import specs
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import checked
from tests.support.lab import FRAME, do, loop_cache, new_lab, run


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
        assert all(field.help for field in found if field.kind not in ("note", "poles"))
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
    switches = set[str]()
    form = PageForm(lab.post, at_once, switches)
    overlays = SimpleNamespace(shape=None, rank_map=None)
    page: Any = SimpleNamespace(overlays=overlays, pull=PULLS[0])

    def news() -> list[Any]:
        found = list(form.news(take_page_snapshot(lab, 1.0), page, NO_LESSONS, ENGLISH))
        for each in found:
            if isinstance(each, ValuesMessage):
                each.values.pop("poles", None)
                each.values.pop("pole_plane", None)
        return found

    form.hear(AskForm(), True)
    first = news()
    assert [type(each) for each in first] == [*[FormMessage] * 3, ValuesMessage]
    assert [each.place for each in first[:3]] == ["lab", "step", "class"]
    assert first[1].groups == first[2].groups == ()
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
    form = PageForm(lab.post, at_once, set())

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


@settings(max_examples=4)
@given(robot=st.sampled_from(list(ROBOTS)), data=st.data())
def test_gains_of_single_laws_are_there_while_a_side_has_the_law(
    robot: str, data: st.DataObject
) -> None:
    lab = Lab(loop_cache(), ROBOTS[robot])
    offered = st.sampled_from(suitable(lab.simulation.robot))
    laws = {side: data.draw(offered) for side in SIDES}
    snapshot = take_page_snapshot(lab, 1.0)
    snapshot = replace(snapshot, run=replace(snapshot.run, laws=laws))
    shown = {field.name for field in fields(form_of(snapshot, None, ENGLISH))}
    acting = {gain for law in laws.values() for gain in LAWS[law].gain_names}
    assert shown & {*OWN_GAINS} == acting & {*OWN_GAINS}


@pytest.mark.parametrize("robot", ROBOTS)
def test_every_number_is_at_first_within_the_ends_of_its_slider(robot: str) -> None:
    snapshot = take_page_snapshot(Lab(loop_cache(), ROBOTS[robot]), 1.0)
    values = values_in(snapshot, {}, (), ENGLISH)
    for field in fields(form_of(snapshot, None, ENGLISH)):
        if field.kind == "number":
            value = values[field.name]
            assert isinstance(value, float | int)
            assert field.low <= value <= field.high, field.name


@pytest.mark.parametrize("robot", ROBOTS)
def test_every_option_of_a_setting_is_taken_as_a_browser_sends_it(robot: str) -> None:
    snapshot = take_page_snapshot(Lab(loop_cache(), ROBOTS[robot]), 1.0)
    known = lab_specs(ROBOTS[robot].parameters)
    for field in fields(form_of(snapshot, None, ENGLISH)):
        for option in field.options if field.name in known else ():
            told = read_message(encoded(SetField(field.name, option.value, 1)).decode())
            assert isinstance(told, SetField)
            assert checked(known[field.name], field.name, told.value) == option.value


def test_a_path_of_ones_own_is_an_option_while_it_is_followed() -> None:
    lab = Lab(loop_cache())

    def shown() -> tuple[FieldValue, list[FieldValue]]:
        snapshot = take_page_snapshot(lab, 1.0)
        field = next(f for f in fields(form_of(snapshot, None, ENGLISH)) if f.name == "path")
        chosen = values_in(snapshot, {}, (), ENGLISH)["path"]
        return chosen, [option.value for option in field.options]

    assert shown() == ("circle", [*presets()])
    do(lab, AddPoint())
    own, options = shown()
    assert options == [*presets(), own] and own not in presets()
    do(lab, ChoosePath("ellipse"))
    assert shown() == ("ellipse", [*presets()])


class Typing:
    """A page on which a law is typed; its lab moves on when the test says so."""

    def __init__(self) -> None:
        self.lab = new_lab(0.1)
        self.form = PageForm(self.lab.post, at_once, set())
        self.form.hear(AskForm(), True)
        self.values, self.refused = dict[str, FieldValue](), dict[str, str]()
        self._number = 0

    def set(self, name: str, value: FieldValue) -> None:
        self._number += 1
        self.form.hear(SetField(name, value, self._number), True)

    def follow(self, frames: int = 4) -> None:
        """Advance the lab, and hear what the page is told."""
        for _ in range(frames):
            run(self.lab, FRAME)
            snapshot = take_page_snapshot(self.lab, 1.0)
            for each in self.form.news(snapshot, None, NO_LESSONS, ENGLISH):
                if isinstance(each, ValuesMessage):
                    self.values |= each.values
                    self.refused |= each.refused


SLOW = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"


def test_who_types_a_law_begins_with_path_following_and_the_lab_keeps_its_law() -> None:
    page = Typing()
    page.set(LEFT, OWN)
    page.follow()
    assert page.values[LEFT] == OWN and page.lab.simulation.laws == DEFAULT_LAWS
    assert page.values[f"typed_{LEFT}"] == PATH_FOLLOWING.replace("; ", "\n")
    assert page.values[RIGHT] == DEFAULT_LAWS[RIGHT]
    page.set(LEFT, "path_following")
    page.follow()
    assert page.values[LEFT] == page.lab.simulation.laws[LEFT] == "path_following"


def test_a_typed_law_is_used_and_one_that_is_refused_changes_nothing() -> None:
    page = Typing()
    page.set(LEFT, OWN)
    page.set(f"typed_{LEFT}", "across = -K1*xii; along = 0")
    page.follow()
    assert "did you mean xi?" in page.refused[f"typed_{LEFT}"]
    assert page.values[LEFT] == OWN and page.lab.simulation.chosen_laws == DEFAULT_LAWS
    page.set(f"typed_{LEFT}", SLOW.replace("; ", "\n"))
    page.follow()
    assert page.lab.simulation.laws == {**DEFAULT_LAWS, LEFT: SLOW}
    assert page.refused[f"typed_{LEFT}"] == "" and page.values[LEFT] == OWN


def test_an_own_law_right_after_another_one_stays_chosen() -> None:
    page = Typing()
    page.set(LEFT, "waiting_clock")
    page.set(LEFT, OWN)
    while page.lab.simulation.laws[LEFT] != "waiting_clock":
        page.follow(1)
    page.follow()
    assert page.values[LEFT] == OWN


def test_a_law_from_elsewhere_is_shown() -> None:
    page = Typing()
    do(page.lab, TypeLaw(LEFT, SLOW))
    page.follow()
    assert page.values[LEFT] == OWN
    assert page.values[f"typed_{LEFT}"] == SLOW.replace("; ", "\n")
    do(page.lab, ChooseLaw(LEFT, DEFAULT_LAWS[LEFT]))
    page.follow()
    assert page.values[LEFT] == DEFAULT_LAWS[LEFT]


@pytest.mark.parametrize("side", SIDES)
def test_why_a_typed_law_is_refused_is_told_once_where_it_is_typed(side: str) -> None:
    lab = Lab(loop_cache())
    lab.post(TypeLaw(side, "across = nothing"))
    lab.drain()
    assert refusals_in(take_page_snapshot(lab, 1.0)) == {f"typed_{side}": lab.message}
    assert lab.message


def test_an_edit_can_be_undone_once_there_is_one() -> None:
    lab = Lab(loop_cache())

    def offered() -> tuple[Any, ...]:
        values = values_in(take_page_snapshot(lab, 1.0), {}, (), ENGLISH)
        return values["can_undo"], values["can_redo"]

    assert offered() == (False, False)
    for command, then in (
        (ChoosePath("rounded square"), (True, False)),
        (Undo(), (False, True)),
        (Redo(), (True, False)),
    ):
        command.apply(lab)
        assert offered() == then
