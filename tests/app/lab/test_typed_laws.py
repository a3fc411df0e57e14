"""A law that a user types moves the robot, everything carries it, and wrong texts do nothing."""

from __future__ import annotations

import csv
import io
import string
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.exports.files import csv_bytes
from onpath.app.exports.history_figure import draw_history
from onpath.app.exports.recording import record_scene
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.commands.scripts import ScriptLaws
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.share_code import LONGEST_TEXT, decode, encode
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.app.lab.snapshots.snapshot import MARKER
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.storage.lab_state import keep, put_back
from onpath.lessons.action_schema import Laws, StepSetup
from onpath.lessons.sides import law_label, law_text, robot_names, side_titles
from onpath.lessons.vocabulary.setups import setup_faults
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import settings_of_start
from onpath.models.closed_loop.start import Start
from onpath.models.control.laws.expressions import LONGEST
from onpath.models.control.laws.own import MEANINGS, PATH_FOLLOWING, SPACE_MEANINGS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.systems.catalogue import FLEXIBLE
from tests.support.lab import FRAME, assert_sound, do, run, states
from tests.support.some_setups import CALM

LOOP_CACHE = LoopCache(at_once=True)
SLOW = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"
CHASING = "across = -K1*min(xi, 1) - K2*dxi; along = -9*(theta - theta_r) - 6*(dtheta - speed)"
TORQUES = "u1 = -0.02*v1; u2 = 0.01*sin(t)"


def typed(left: str = "", right: str = "", seconds: float = 0.3) -> Lab:
    """A lab under typed laws that has run for some time."""
    lab = Lab(LOOP_CACHE)
    run(lab, 0.3)
    do(lab, *[c.TypeLaw(side, law) for side, law in ((LEFT, left), (RIGHT, right)) if law])
    run(lab, seconds)
    assert not lab.refused
    return lab


def test_typed_path_following_moves_the_robot_as_path_following_does() -> None:
    lab, other = typed(left=PATH_FOLLOWING.replace("; ", "\n")), Lab(LOOP_CACHE)
    run(other, 0.3)
    do(other, c.ChooseLaw(LEFT, "path_following"))
    run(other, 0.3)
    assert lab.simulation.laws == {**DEFAULT_LAWS, LEFT: PATH_FOLLOWING}
    for each in (lab, other):
        do(each, c.Hold(on=True), c.Set("K1", 700.0))
        run(each, 0.5)
    mine, known = (each.simulation.runs[LEFT].fields() for each in (lab, other))
    for name, value in known.items():
        assert np.array_equal(mine[name], value), name
    assert_sound(lab)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("across = -K1*xii; along = 0", "line 1, column 14: there is no 'xii': did you mean xi?"),
        ("across = 1\nalong = (2", "line 2"),
        ("across = 1", "along"),
        ("xi", "a line begins with one of"),
        ("path_following", "there is no 'path_following'"),
        ("", "no line"),
        ("u1 = 0; u2 = 0; u3 = 0", "not possible with this robot"),
        ("across = xi2; along = 0", "not possible with this robot"),
        ("across = __import__('os'); along = 0", "line 1"),
        ("across = xi.real; along = 0", "line 1"),
        ("x" * 10_000_000, "at most 500 characters"),
        ("across = " + "-" * 300 + "xi; along = 0", "too complicated"),
        ("across = 9**9**9; along = 0", "exponent"),
        ("across = 1/0; along = 0", "not a finite number"),
    ],
)
def test_a_wrong_text_is_told_and_changes_nothing(text: str, said: str) -> None:
    lab = typed(left=SLOW, seconds=0.1)
    before, time = capture(lab.simulation), lab.simulation.time
    do(lab, c.TypeLaw(LEFT, text))
    assert said in lab.refused[LEFT] and said in lab.message
    assert len(lab.message) < 300 and lab.message_level == "warning"
    assert take_snapshot(lab, 1.0).refused == lab.refused
    assert capture(lab.simulation) == before and lab.simulation.chosen_laws[LEFT] == SLOW
    run(lab, 0.1)
    assert lab.simulation.time > time
    do(lab, c.TypeLaw(LEFT, PATH_FOLLOWING))
    assert lab.refused == {} and lab.message == ""
    assert lab.simulation.laws[LEFT] == PATH_FOLLOWING


def test_an_unknown_side_is_refused() -> None:
    lab = Lab(LOOP_CACHE)
    do(lab, c.TypeLaw("middle", PATH_FOLLOWING))
    assert "unknown side" in lab.message and lab.refused == {}


def test_a_law_that_gives_no_number_stops_the_robot_and_says_so() -> None:
    lab = typed(left="across = -K1*xi - K2*dxi; along = sqrt(0.1 - t)")
    assert "typed law" in lab.message and "Own law" in lab.message
    assert lab.simulation.runs[LEFT].diverged is not None
    assert lab.simulation.runs[RIGHT].diverged is None
    assert_sound(lab)
    do(lab, c.ChooseLaw(LEFT, "path_following"), c.Reset())
    run(lab, 0.2)
    assert lab.simulation.runs[LEFT].diverged is None


def test_titles_labels_and_texts() -> None:
    for words, own in ((Words("en"), "Own law"), (Words("de"), "Eigenes Gesetz")):
        assert law_label(SLOW, words) == law_label("own", words) == own
        assert law_text(SLOW, words) == SLOW
        assert side_titles({LEFT: SLOW, RIGHT: "path_following"}, words)[LEFT] == own
        both = side_titles({LEFT: SLOW, RIGHT: CHASING}, words)
        assert len(set(both.values())) == 2 and all(own in title for title in both.values())
        assert side_titles({LEFT: (SLOW, CHASING, SLOW)}, words) == {LEFT: own}
        assert robot_names({LEFT: SLOW}, words)["tracker"] == own


def test_an_event_tells_that_a_law_was_typed_and_not_its_text() -> None:
    lab = typed(left=SLOW)
    event = lab.simulation.events.last
    assert event is not None
    assert (event.name, event.detail, event.sides) == ("law", "own", (LEFT,))


def test_the_marker_is_what_the_law_aims_at() -> None:
    lab = typed(left=SLOW, right=CHASING)
    simulation, shown = lab.simulation, take_snapshot(lab, 1.0)
    for side, aim in ((LEFT, "theta"), (RIGHT, "theta_ref")):
        at = simulation.runs[side].shown()[aim]
        place = simulation.robot.position(
            simulation.robot.frame.lift(simulation.editor.curve.at(at))
        )
        assert shown.robots[side].points[MARKER] == pytest.approx(place[0], abs=1e-6)


# What carries it.


def test_a_set_up_carries_it_by_code_and_by_the_kept_lab() -> None:
    lab = typed(left=SLOW, right=TORQUES)
    setup = capture(lab.simulation)
    assert setup.laws == {LEFT: SLOW, RIGHT: TORQUES}
    assert decode(encode(setup)) == setup == from_data(to_data(setup))
    other, kept = Lab(LOOP_CACHE), list[Any]()
    do(other, c.UseShared(encode(setup)))
    keep(lab, kept.append)
    back = Lab(LOOP_CACHE)
    put_back(back, msgspec.json.decode(msgspec.json.encode(kept[0]())))
    for each in (other, back):
        assert each.simulation.laws == setup.laws and capture(each.simulation) == setup
        run(each, 0.2)
        assert_sound(each)


def test_the_code_of_the_longest_laws_can_be_pasted() -> None:
    terms = " + ".join(f"{n}.{n * n}*sin({n}*xi)" for n in range(1, 99))
    laws = {side: f"across = {terms}"[: LONGEST - 20] for side in SIDES}
    laws = {side: law[: law.rindex(" +")] + f"; along = {len(side)}" for side, law in laws.items()}
    code = encode(Setup(laws=laws))
    assert decode(code).laws == laws and len(code) < LONGEST_TEXT


@pytest.mark.parametrize(
    "law",
    ["across = 1", "across = evil(); along = 0", "a=" * 251, 7, None, ["u1 = 0"], "=", "own"],
)
def test_hostile_data_is_refused_and_changes_nothing(law: Any) -> None:
    lab = typed(left=SLOW, seconds=0.0)
    before = capture(lab.simulation)
    with pytest.raises(ValueError, match=r"."):
        from_data({"defaults": 2, "laws": {LEFT: law}})
    if law != "own":  # a name like that of a law that is not here any more
        with pytest.raises(ValueError, match=r"."):
            put_back(lab, {"setup": {"defaults": 2, "laws": {LEFT: law}}, "lessons": {}})
    assert capture(lab.simulation) == before


def test_a_set_up_of_several_lines_is_put_on_one() -> None:
    data = {"defaults": 2, "laws": {LEFT: "\n across = -xi \r\n\n along = 1;; "}}
    assert from_data(data).laws == {LEFT: "across = -xi; along = 1"}


@pytest.mark.thorough
def test_history_replay_and_files() -> None:
    lab = Lab(LOOP_CACHE)
    seen: list[tuple[float, np.ndarray]] = []
    for law in (CHASING, "set_point", SLOW):
        lab.simulation.change_law(LEFT, law)
        for _ in range(15):
            run(lab, FRAME)
            seen.append((lab.simulation.time, lab.simulation.runs[LEFT].shown()["u"].copy()))
    history = lab.simulation.history.all()
    parts = replay(lab.simulation.robot, history)[LEFT]
    assert [part.law for part in parts] == [CHASING, "set_point", SLOW]
    u = np.concatenate([part.fields["u"] for part in parts])
    for time, torque in seen:
        assert np.array_equal(u[round(time * 1e3) - 1], torque)
    rows = list(csv.DictReader(io.StringIO(csv_bytes(lab.simulation.robot, history).decode())))
    names = dict.fromkeys(row["law"] for row in rows if row["side"] == LEFT)
    assert list(names) == [CHASING, "set_point", SLOW]
    assert draw_history(replay(lab.simulation.robot, history)).startswith(b"\x89PNG")
    assert record_scene(lab.simulation.robot, history).rstrip().endswith(b"</html>")


def test_going_on_from_before_a_typed_law_and_back() -> None:
    lab = typed(left=SLOW)
    end = states(lab.simulation)
    do(lab, c.LookAt(0.4))
    assert take_snapshot(lab, 1.0).laws == DEFAULT_LAWS
    do(lab, c.GoOn())
    assert lab.simulation.laws[LEFT] == SLOW
    run(lab, 0.2)
    do(lab, c.UndoGoOn())
    for side, state in states(lab.simulation).items():
        assert np.array_equal(state, end[side])
    assert_sound(lab)


def test_it_goes_with_the_robot_if_it_suits_and_else_the_usual_law_comes() -> None:
    lab = typed(left=SLOW, right=TORQUES)
    do(lab, c.ChooseRobot(FLEXIBLE.name))
    assert lab.simulation.laws == {LEFT: SLOW, RIGHT: DEFAULT_LAWS[RIGHT]}
    assert "Own law" in lab.message
    run(lab, 0.2)
    assert_sound(lab)


def test_torques_for_an_output_that_takes_none() -> None:
    """Composite control takes accelerations alone; the parameter can be changed under a law."""
    lab, law = Lab(LOOP_CACHE), "u1 = -xi; u2 = 0; u3 = 0"
    do(lab, c.ChooseRobot(FLEXIBLE.name), c.Set("output", "redefined"))
    do(lab, c.TypeLaw(LEFT, law))
    run(lab, 0.05)
    assert lab.simulation.laws[LEFT] == law
    do(lab, c.Set("output", "composite"))
    run(lab, 0.1)
    assert lab.simulation.laws == DEFAULT_LAWS and "not possible" in lab.message
    do(lab, c.TypeLaw(LEFT, law))
    assert "not possible" in lab.refused[LEFT] and lab.simulation.chosen_laws == DEFAULT_LAWS
    assert_sound(lab)


def test_lessons_take_it() -> None:
    setup = StepSetup(laws=Laws(left="across = -K1*xi - K2*dxi\nalong = 1"))
    assert list(setup_faults(setup, "five_bar")) == []
    wrong = StepSetup(laws=Laws(left="across = -K1*xii; along = 1"))
    (fault,) = setup_faults(wrong, "five_bar")
    assert "did you mean xi" in fault
    lab = Lab(LOOP_CACHE)
    do(lab, ScriptLaws(setup.laws))
    assert lab.simulation.laws[LEFT] == "across = -K1*xi - K2*dxi; along = 1"
    run(lab, 0.1)
    assert_sound(lab)


@pytest.mark.thorough
def test_a_set_up_begins_with_it_even_if_its_loop_has_to_be_made() -> None:
    loop_cache = LoopCache()
    lab, wanted = Lab(loop_cache), "across = -K1*xi - 41*dxi; along = 1"
    run(lab, 0.2)
    do(lab, c.UseShared(encode(Setup(laws={LEFT: wanted}))))
    assert lab.simulation.chosen_laws[LEFT] == wanted
    while lab.simulation.time == 0:
        run(lab, FRAME)
    assert lab.simulation.laws[LEFT] == wanted
    other = Lab(LOOP_CACHE)
    do(other, c.UseShared(encode(Setup(laws={LEFT: wanted}))))
    for each in (lab, other):
        run(each, 0.5 - each.simulation.time)
        assert not [event for event in each.simulation.events if event.name == "law"]
    ticks = min(lab.simulation.time, other.simulation.time)
    assert ticks == pytest.approx(0.5, abs=2 * FRAME)
    loop_cache.close()


def test_a_start_with_a_lead_of_the_clock_is_that_of_the_law() -> None:
    loop_cache, start = LoopCache(), Start(theta=1.0, beside=0.01, along=0.1, clock_offset=0.4)
    wanted = "across = -K1*e1 - 42*dxi; along = -9*(theta - theta_r)"
    lab, known = Lab(loop_cache), Lab(LOOP_CACHE)
    for each in (lab, known):
        each.simulation.set(**settings_of_start(start))
        each.simulation.reset({LEFT: wanted})
    while lab.simulation.laws[LEFT] != wanted:
        run(lab, FRAME)
        assert lab.simulation.time == 0 or lab.simulation.laws[LEFT] == wanted
    known.simulation.simulate(round(1e3 * lab.simulation.time))
    assert np.array_equal(lab.simulation.runs[LEFT].state, known.simulation.runs[LEFT].state)
    assert known.simulation.runs[LEFT].fields()["theta_ref"][0] > 1.39
    loop_cache.close()


def test_a_teacher_sends_it() -> None:
    lab, setup = Lab(LOOP_CACHE), Setup(laws={RIGHT: CHASING})
    do(lab, c.TakeSetup(from_data(to_data(setup))))
    assert lab.simulation.laws == {**DEFAULT_LAWS, RIGHT: CHASING}
    assert capture(lab.simulation) == setup


def test_every_name_is_explained() -> None:
    for value in (*MEANINGS, *SPACE_MEANINGS):
        assert value.names and value.meaning and value.unit


# Anything that is typed.

TOKENS = [*"+-*/()<>,=;\n .0123", "**", "xi", "dxi", "K1", "across = ", "along = ", "u1 = ", "if "]
TOKENS += ["else ", "sin(", "sign(", "min(", "1e9", "t", "e1", "theta", "and ", "not ", "é", "\x00"]
TEXTS = st.one_of(
    st.text(max_size=600),
    st.text(string.printable, max_size=100),
    st.lists(st.sampled_from(TOKENS), max_size=60).map("".join),
    st.lists(st.sampled_from(TOKENS), max_size=20).map(
        lambda parts: f"across = {''.join(parts)}; along = 1"
    ),
)


@pytest.mark.thorough
@settings(CALM, max_examples=150)
@given(TEXTS)
def test_any_text_is_a_law_or_is_refused(text: str) -> None:
    lab = FUZZED
    before = lab.simulation.chosen_laws
    do(lab, c.TypeLaw(LEFT, text))
    run(lab, 2 * FRAME)
    if LEFT in lab.refused:
        assert lab.simulation.chosen_laws == before and lab.refused[LEFT]
    else:
        law = lab.simulation.laws[LEFT]
        assert decode(encode(capture(lab.simulation))).laws.get(LEFT, law) == law
    assert lab.simulation.laws[RIGHT] == DEFAULT_LAWS[RIGHT]
    assert_sound(lab)
    do(lab, c.ChooseLaw(LEFT, DEFAULT_LAWS[LEFT]), c.Reset())


FUZZED = Lab(LOOP_CACHE)
