"""What a text once told and is not so is told nowhere again, in no language."""

from __future__ import annotations

import re

import pytest

from tests.support.checkout import ROOT

TOLD = sorted(
    [ROOT / "README.md"]
    + [file for folder in ("lessons", "models") for file in (ROOT / folder).rglob("*.md")]
)
FALSE = {
    "a force along the path can take the robot off; only commands cannot": re.compile(
        r"(whatever|was auch immer) (happens|geschieht) (along|längs)"
        r"|nothing (that is done )?along the path takes"
        r"|nichts,? was (man )?(längs|entlang) der Bahn (geschieht|tut|getan wird)",
        re.IGNORECASE,
    ),
    "η₂ = (θ, θ̇): the speed alone is not η₂": re.compile(
        r"\\dot ?\\eta_2|(\\eta_2\$?|η₂) (is the speed|ist die Geschwindigkeit)"
    ),
    "a clock that waits does not run away either": re.compile(
        r"difference is that there is \*?no\*? clock|Unterschied ist, dass es \*?keine\*? Uhr"
    ),
    "leaning less along the path helps: K5": re.compile(
        r"Nothing along the path helps|Nichts (längs|entlang) der Bahn hilft", re.IGNORECASE
    ),
    "at 99 % of the reach the cosine is 0.14": re.compile(r"99 % (there is )?0[.,]12"),
}


@pytest.mark.parametrize("truth", FALSE)
def test_no_text_says_it(truth: str) -> None:
    assert len(TOLD) > 20
    for file in TOLD:
        text = " ".join(file.read_text(encoding="utf-8").split())
        assert not (said := FALSE[truth].search(text)), f"{file}: {said}: {truth}"


@pytest.mark.parametrize(
    "said",
    [
        "on the curve, $\\lambda = 0$ stays $0$ whatever happens along it",
        "Then nothing that is done along the path takes the robot off.",
        "and $\\eta_2$ is the speed along",
        "$$\\dot\\eta_2 = -K_5\\,(\\eta_2 - \\text{wanted speed})$$",
        "What makes the difference is that there is *no* clock.",
        "Der Unterschied ist, dass es *keine* Uhr gibt.",
        "Nothing along the path helps much: you need something that resists",
        "At 96 % there is 0.29, at 99 % 0.12, and at 100 % nothing",
    ],
)
def test_the_false_sentences_would_be_noticed(said: str) -> None:
    """These are the sentences of the first edition."""
    assert sum(bool(claim.search(said)) for claim in FALSE.values()) == 1
