"""What lessons, README and help say of the lab is so, and a change that makes it false is seen."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from onpath.app.cli.main import run_command
from onpath.app.lab import closed_loop_run, path_editor
from onpath.app.lab.commands import path as path_commands
from onpath.app.lab.dry_runs.behaviour_check import behaviour_faults, page_faults
from onpath.app.lab.dry_runs.sentence_check import sentence_faults
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.lab import Lab
from onpath.assets.messages import catalogue
from onpath.lessons.action_schema import Action, Script
from onpath.lessons.course import BUILT_IN, REFERENCE, read_plays
from onpath.lessons.parse import read_lesson
from onpath.lessons.schema import Lesson
from onpath.models.errors import Message
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.studies import identification
from tests.support.built_in import built_in_course
from tests.support.cases import some
from tests.support.lab import loop_cache
from tests.support.lesson_texts import LESSON, write_lesson

COURSE = built_in_course()[0]
FORMULA = "$$\\dot x = v$$"
PLAYS = {
    "crossing": Script((Action(at=0.1, path="figure of eight"),), 0.2),
    "bend": Script((Action(at=0.1, move=(0, 60.0, 0.0)),), 0.2),
    "spun": Script((Action(set={"K1": 2500.0, "K2": 200.0, "control_rate": 50}),), 2.0),
}
Patch = pytest.MonkeyPatch


def faults(name: str) -> list[tuple[int, str]]:
    """What is wrong in a built-in lesson, by the beginning of its name."""
    (found,) = (each for each in COURSE.lessons if each.startswith(f"{name}-"))
    home, said = BUILT_IN / found, list[tuple[int, str]]()
    for lesson in COURSE.lessons[found].values():
        said += page_faults(lesson, (home / f"{lesson.language}.md").read_text("utf-8"))
    lesson = COURSE.lesson(found, "en")
    return said + list(behaviour_faults(lesson, read_plays(home / REFERENCE), loop_cache()))


def listed_faults() -> list[str]:
    """What is wrong with the sentences of the list, and with those that are not in it."""
    folder = Path(os.path.relpath(BUILT_IN))  # however the folder is named
    return [str(each) for each in sentence_faults(COURSE, folder, loop_cache())]


NUMBERS = [name.partition("-")[0] for name in COURSE.lessons]


@pytest.mark.thorough
@pytest.mark.parametrize("name", some(NUMBERS, ("03", "08")))
def test_a_lesson_says_what_the_lab_does(name: str) -> None:
    assert not faults(name)


@pytest.mark.thorough
def test_every_other_sentence_is_listed_and_so_are_those_of_readme_and_help() -> None:
    assert not listed_faults()


@pytest.mark.parametrize(
    ("mark", "fault"),
    [
        ("follows figure of eight after crossing", ""),
        ("says fault.crosses after crossing", ""),
        ("no says fault.bends after crossing", ""),
        ("refuses fault.bends after bend", ""),
        ("stops follower after spun", ""),
        ("runs tracker", ""),
        ("control K1", ""),
        ("no plot across", ""),
        ("max distance tracker during held > 40", ""),
        ("refuses fault.crosses after crossing", "it is not refused; heard: fault.crosses"),
        ("follows circle after crossing", "the path is 'figure of eight'"),
        ("no says fault.crosses after crossing", "heard: fault.crosses"),
        ("says fault.narrow after crossing", "heard: fault.crosses"),
        ("stops follower", "the follower is not stopped"),
        ("runs follower after spun", "the follower is stopped"),
        ("stops follower stop.unstable after spun", "the reason is another one"),
        ("says fault.bends after nothing", "there is no play 'nothing'"),
        ("plot across", "the plots of the step are none"),
        ("no control K1", "the controls of the step are K1, hold"),
        ("label run.reset", "on the page it is Reset"),
        ("control hold", "the control is called Hold both back"),
        ("max distance tracker during held < 40", "max distance tracker is 4"),
        ("max distance tracker during pulled < 40", "the tracker is never pulled"),
    ],
)
def test_a_mark_is_played(tmp_path: Path, mark: str, fault: str) -> None:
    text = LESSON.replace(FORMULA, f"See {{{{K1 across = {mark}}}}}.")
    text = text.replace('path = "ellipse"', "").replace(
        "```script\nuntil = 1.0\n```",
        "```script\nuntil = 2.0\ndo = [{ at = 0.5, hold = true }]\n```",
    )
    file = write_lesson(tmp_path, text)
    lesson = read_lesson(file)
    plays = {name: script for name, script in PLAYS.items() if mark.endswith(f"after {name}")}
    found = [*behaviour_faults(lesson, plays, loop_cache()), *page_faults(lesson, text)]
    assert bool(found) == bool(fault), found
    if fault:
        ((line, said),) = found
        assert fault in said and "{{" in text.split("\n")[line - 1]


def test_a_mark_is_shown_as_plain_words_and_compared_with_the_translation(tmp_path: Path) -> None:
    marked = LESSON.replace(FORMULA, "It {{stops = runs tracker}}.")
    file = write_lesson(tmp_path, marked)
    steps = read_lesson(file).steps
    assert "It stops." in str(next(step for step in steps if step.kind == "explain").blocks[0])
    file.with_name("de.md").write_text(marked.replace("runs tracker", "stops tracker"))
    assert run_command(["lessons", "check", str(tmp_path)]) == 1


@pytest.mark.thorough
def test_a_course_without_a_list_is_told_how_many_sentences_nobody_plays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_lesson(tmp_path, LESSON.replace(FORMULA, "The lab stops it."))
    assert run_command(["lessons", "check", str(tmp_path)]) == 0
    assert "1 sentence about the lab that no mark plays" in capsys.readouterr().out
    (tmp_path / "sentences.toml").write_text("")
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    assert "nobody plays 'The lab stops it.'" in capsys.readouterr().err


# Behaviours that are broken, one by one


def refuse_nothing(patch: Patch) -> None:
    patch.setattr(path_editor, "curve_faults", lambda *_: [])


def refuse_crossings(patch: Patch) -> None:
    def strict(margin: object, curve: object) -> list[object]:
        return [*curve_faults(margin, curve), *ambiguities(curve)]  # type: ignore[arg-type]

    patch.setattr(path_editor, "curve_faults", strict)


def keep_quiet_about_crossings(patch: Patch) -> None:
    patch.setattr(path_commands, "ambiguities", lambda _: ())


def rename_a_plot(patch: Patch) -> None:
    patch.setitem(catalogue("en")._messages, "axis-across", "lateral offset")


def rename_a_button(patch: Patch) -> None:
    patch.setitem(catalogue("de")._messages, "run-hold_both", "Bremsen")


def change_what_is_said(patch: Patch) -> None:
    patch.setitem(catalogue("de")._messages, "stop-unstable", "der Roboter ist instabil")


def hide_the_map(patch: Patch) -> None:
    setup_at = Lesson.setup_at
    patch.setattr(Lesson, "setup_at", lambda self, at: replace(setup_at(self, at), show=()))


def stop_nobody(patch: Patch) -> None:
    patch.setattr(closed_loop_run.ClosedLoopRun, "stop", lambda *_: None)


def stop_for_another_reason(patch: Patch) -> None:
    patch.setattr(closed_loop_run, "explained", lambda *_: Message("stop.range"))


def release_the_brake(patch: Patch) -> None:
    patch.setattr(ExternalForces, "hold", lambda *_, **__: None)


def never_let_go(patch: Patch) -> None:
    hold = ExternalForces.hold

    def held_for_good(self: ExternalForces, names: Sequence[str], on: bool, *rest: Any) -> None:
        if on:
            hold(self, names, on, *rest)

    patch.setattr(ExternalForces, "hold", held_for_good)


def pull_nothing(patch: Patch) -> None:
    patch.setattr(ExternalForces, "grab", lambda *_: None)
    patch.setattr(ExternalForces, "pull", lambda *_: None)


def identify_at_all_costs(patch: Patch) -> None:
    patch.setattr(identification, "WORST_ERROR", 1e9)


def foresee_nothing(patch: Patch) -> None:
    patch.setattr(Lab, "_foreseen", lambda _: None)


BREAKS: list[tuple[Callable[[Patch], None], str]] = [
    (refuse_nothing, "02"),
    (refuse_crossings, "03"),
    (keep_quiet_about_crossings, "08"),
    (rename_a_plot, "04"),
    (rename_a_button, "01"),
    (change_what_is_said, "07"),
    (hide_the_map, "04"),
    (stop_nobody, "01b"),
    (stop_for_another_reason, "06"),
    (release_the_brake, "01"),
    (never_let_go, "01"),
    (pull_nothing, "02"),
    (identify_at_all_costs, "06"),
    (foresee_nothing, "list"),
]


@pytest.mark.thorough
@pytest.mark.parametrize(("broken", "where"), BREAKS)
def test_a_broken_behaviour_makes_a_sentence_false(
    monkeypatch: Patch, broken: Callable[[Patch], None], where: str
) -> None:
    broken(monkeypatch)
    assert listed_faults() if where == "list" else faults(where)
