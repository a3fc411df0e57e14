"""Formulas that students type: the same verdict here and on a page without a server."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.lessons.derivation.judged import judged, points_of, value_of
from onpath.lessons.derivation.typed import LONGEST, evaluated, read_formula, spellings
from onpath.lessons.schema import Derivation, DerivedLine
from onpath.models.control.laws.expressions import read
from onpath.models.errors import CodedError, Message

QUESTIONS: list[dict[str, Any]] = json.loads(
    Path(__file__).with_name("formulas.json").read_text("utf-8")
)
"""Questions with typed answers; each is "right", "wrong", or refused: why, and from where on.
tests/assets/web/lessons/typed.test.ts judges the same ones."""
NAMES = ("K1", "e", "theta")


def asked(question: dict[str, Any]) -> Derivation:
    line = DerivedLine(question="", formula=question["formula"], answer="")
    return Derivation(question="", line=(line,), answer="", names=question["names"])


@pytest.mark.parametrize("question", QUESTIONS, ids=[each["formula"] for each in QUESTIONS])
def test_each_answer_is_judged_or_refused_where_it_is_not_understood(
    question: dict[str, Any],
) -> None:
    block = asked(question)
    values = {name: each.tolist() for name, each in points_of(block).items()}
    assert question["values"] == values
    for typed, wanted in question["cases"]:
        try:
            read_formula(typed, spellings(block.names), ",")
        except CodedError as error:
            reason, place = (error.message.arguments[name] for name in ("reason", "place"))
            assert isinstance(reason, Message) and isinstance(place, int)
            found = f"{reason.code.removeprefix('formula.')} {place - 1}"
            assert str(error)
        else:
            ((only,),) = (state.tries for state in judged(block, typed))
            found = only.verdict
        assert found == wanted, typed


def test_there_are_two_hundred_answers() -> None:
    assert sum(len(each["cases"]) for each in QUESTIONS) >= 200


FORMULAS = st.recursive(
    st.sampled_from((*NAMES, "2", "0.5", "13")),
    lambda inside: st.one_of(
        st.tuples(inside, st.sampled_from("+-*/"), inside).map(lambda t: f"({t[0]}{t[1]}{t[2]})"),
        st.tuples(st.sampled_from(("sin", "cos", "sqrt", "tanh")), inside).map(
            lambda t: f"{t[0]}({t[1]})"
        ),
        st.tuples(inside, st.sampled_from("0234")).map(lambda t: f"({t[0]})**{t[1]}"),
        inside.map(lambda text: f"(-{text})"),
    ),
    max_leaves=6,
)


@given(FORMULAS, st.integers(0, 2**32))
@settings(max_examples=150, deadline=None)
def test_what_a_typed_law_says_is_read_alike(text: str, seed: int) -> None:
    """Whatever both can read has the same value, with CasADi as an oracle."""
    if len(text) > LONGEST:
        return
    values = {name: np.random.default_rng(seed).uniform(0.1, 2.0, 3) for name in NAMES}
    with np.errstate(all="ignore"):
        found = evaluated(read_formula(text, spellings(NAMES)), values, 3)
    if not np.isfinite(found).all():
        return
    law = read(f"along = {text}", NAMES, ("along",))
    symbols = {name: ca.SX.sym(name) for name in NAMES}
    function = ca.Function("law", [*symbols.values()], [law(symbols)["along"]])
    wanted = [float(function(*each)) for each in zip(*values.values(), strict=True)]
    np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-9)


@given(st.text(alphabet="K1e_θ23.,()+-*/^²√ sincoqrtlambda:;='\"\\[]\n", max_size=30))
@settings(max_examples=300, deadline=None)
def test_any_text_is_read_or_refused_within_it(text: str) -> None:
    try:
        formula = read_formula(text, spellings(NAMES), ",")
    except CodedError as error:
        place = error.message.arguments["place"]
        assert isinstance(place, int) and 1 <= place <= len(text) + 1 and str(error)
    else:
        evaluated(formula, dict.fromkeys(NAMES, np.ones(2)), 2)


def test_a_value_that_is_not_finite_is_wrong() -> None:
    block = asked(QUESTIONS[0])
    for typed in ("1/0", "sqrt(-1)", "v0/(e√K1) + 0/0"):
        assert judged(block, typed)[0].tries[0].verdict == "wrong"
    assert np.isfinite(value_of(block.line[0].formula, points_of(block))).all()
