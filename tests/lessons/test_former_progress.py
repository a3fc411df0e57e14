"""Progress that earlier versions have stored says the same today."""

from __future__ import annotations

import json
from typing import Any

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.given import Answer
from onpath.lessons.progress import read_progress

PREDICTED, ASKED, TASKS = ("1", "3"), ("5.0", "7.0", "7.1", "7.2"), ("hold", "carry")
answers = st.builds(Answer, option=st.none() | st.integers(0, 3), why=st.sampled_from(["", "so"]))


def of(keys: tuple[str, ...], values: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, Any]]:
    return st.dictionaries(st.sampled_from(keys), values, max_size=3)


@st.composite
def stored(draw: st.DrawFn) -> dict[str, Any]:
    """Notes as they were: an item has one kind of answer, and what counts may have been kept, too,
    among all that was given."""
    kinds = {key: draw(st.sampled_from(["quiz", "numbers", "written"])) for key in ASKED}
    asked = {
        "quiz": draw(of(ASKED, st.integers(0, 3))),
        "numbers": draw(of(ASKED, st.floats(-9, 9))),
        "written": draw(of(ASKED, st.sampled_from(["so", "because"]))),
    }
    notes: dict[str, Any] = {
        name: {key: each for key, each in found.items() if kinds[key] == name}
        for name, found in asked.items()
    }
    notes["answers"] = draw(of(PREDICTED, answers))
    notes["second"] = draw(of(PREDICTED, answers))
    notes["asked_again"] = [*notes["second"], *draw(st.lists(st.sampled_from(PREDICTED)))]
    notes["tasks"] = draw(of(TASKS, st.floats(0, 9)))
    notes["ways"] = {key: draw(st.integers(0, 2)) for key in notes["tasks"]}
    done = [*notes["quiz"], *notes["numbers"]]
    notes["twice"] = draw(st.lists(st.sampled_from(done), unique=True)) if done else []
    events = list[dict[str, Any]]()
    for key, answer in notes["answers"].items():
        if draw(st.booleans()):
            events += [{"item": key}] if answer.skipped else [{"item": key, "answer": answer}]
            events[-1].setdefault("answer", Answer())
    for key, option in notes["quiz"].items():
        if draw(st.booleans()):
            earlier = [{"item": key, "answer": Answer(option=3 - option)}]
            events += earlier if key in notes["twice"] else []
            events.append({"item": key, "answer": Answer(option=option), "time": 1.5})
    notes["given"] = events
    return json.loads(msgspec.json.encode({"step": 3, **notes}))


@given(stored())
def test_what_counted_counts(notes: dict[str, Any]) -> None:
    found = read_progress({"notes": {"01-a": notes}}).notes["01-a"]
    for name in ("answers", "second"):
        wanted = {key: msgspec.convert(each, Answer) for key, each in notes[name].items()}
        assert getattr(found, name) == wanted
    for name in ("quiz", "numbers", "written", "tasks", "ways"):
        assert getattr(found, name) == notes[name], name
    assert found.twice == set(notes["twice"]) and found.step == 3
    again = read_progress(json.loads(msgspec.json.encode({"notes": {"01-a": found}})))
    assert again.notes["01-a"] == found  # what is stored today is read as it is
