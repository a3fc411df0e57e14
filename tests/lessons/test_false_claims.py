"""What a text once told and is not so is told nowhere again, in no language."""

from __future__ import annotations

import re

import pytest

from tests.support.checkout import ROOT

TOLD = sorted(
    [ROOT / "README.md"]
    + [file for folder in ("lessons", "models") for file in (ROOT / folder).rglob("*.md")]
    + list((ROOT / "assets" / "words").glob("*.ftl"))
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
    "the height of a jump depends on K2, too: K2 = 2 √K1": re.compile(
        r"K1 and the difference of the two frictions set|K1 und der Unterschied der beiden \w+ best"
    ),
    "too heavy a model costs stability first where sampling is slow": re.compile(
        r"(costs accuracy first|kostet zuerst Genauigkeit)"
    ),
    "the curves of figures 6 and 7 are not known": re.compile(
        r"(reproduces|as) the paper's figures 6|wie es die Bilder 6"
    ),
    "a stiff tracker gets less far from the circle": re.compile(
        r"No gain decides how far the tracker|Keine Verstärkung entscheidet, wie weit der Na"
    ),
    "a wall is a spring": re.compile(r"solid on its hatched side|schraffierte Seite ist fest"),
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
        "K1 and the difference of the two frictions set the height of a jump, K3 only how long",
        "K1 und der Unterschied der beiden Reibungen bestimmen die Höhe eines Sprungs",
        "A wrong model costs accuracy first, and stability only much later.",
        "Ein falsches Modell kostet zuerst Genauigkeit und erst viel später die Stabilität.",
        "it reproduces the paper's figures 6 and 7",
        "No gain decides how far the tracker gets while it is held.",
        "a **wall** across the path, solid on its hatched side",
    ],
)
def test_the_false_sentences_would_be_noticed(said: str) -> None:
    """These are sentences of former editions."""
    assert sum(bool(claim.search(said)) for claim in FALSE.values()) == 1
