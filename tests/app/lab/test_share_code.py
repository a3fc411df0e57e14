"""Share codes are decoded without loss, and everything else is rejected."""

from __future__ import annotations

import base64
import json
import string
import time
import tracemalloc
import zlib
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.common.access_codes import ALPHABET, as_meant, new_code, normalised, shown
from onpath.app.lab.commands import DrawPath, Set, UseShared
from onpath.app.lab.setups import share_code
from onpath.app.lab.setups.capture import capture, capture_path
from onpath.app.lab.setups.setup import RobotSetup, Setup, plain
from onpath.app.lab.setups.share_code import LONGEST_TEXT, decode, encode
from onpath.models.control.settable import specs
from onpath.models.paths.drawing_design import from_curve
from onpath.models.paths.spline_curves import MOST_PIECES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawings import random_drawing
from tests.support.lab import do, new_lab
from tests.support.some_setups import CALM, PRESETS, setups, wave

SENT = "ONPATH1-OVJGQYADAC4AYAFKWEWN4IBA-"  # only its form


def drawn_lab() -> Setup:
    lab = new_lab()
    points = wave(0.7, 1.0, closed=True).curve.at(wave(0.0, 0.0, True).curve.sample(80))
    do(lab, DrawPath(points))
    do(lab, Set("K3", 150.0))
    assert lab.simulation.editor.design.name == "drawn"
    return capture(lab.simulation)


def forged(plain: Any) -> str:
    """A code with a right checksum for anything."""
    data = plain if isinstance(plain, bytes) else json.dumps(plain).encode()
    squeeze = zlib.compressobj(9, wbits=-15, zdict=share_code._KNOWN)
    return sealed(squeeze.compress(data) + squeeze.flush())


def sealed(packed: bytes) -> str:
    body = base64.b32encode(packed).decode().rstrip("=")
    return f"ONPATH1-{body}-{share_code._checksum(body)}"


@CALM
@given(setups())
def test_round_trip(setup: Setup) -> None:
    code = encode(setup)
    assert decode(code) == setup
    assert encode(decode(code)) == code == encode(setup)
    assert set(code) <= set(string.ascii_uppercase + string.digits + "-")


def test_codes_are_short() -> None:
    assert len(encode(Setup())) < 40
    assert len(encode(capture(new_lab().simulation))) < 60
    assert len(encode(drawn_lab())) < 400
    path = capture_path(from_curve(random_drawing(3, pieces=220)), PRESETS)
    assert len(encode(Setup(robots={"five_bar": RobotSetup(path=path)}))) < 2000


def test_codes_of_version_1_stay_readable() -> None:
    """They are in people's notes: a change that breaks this one is another version."""
    old = "ONPATH1-VNDISD44OEAPFARBFBKIATVKAUAA-GZ47G5I"
    side = decode(old).robots["five_bar"]
    assert side.parameters == {
        "K3": 100.0,
        "tracker_integral": "on",
        "at_limit_for": "path_following",
        "observer_time": 0.0,
        "observer_bound": 10.0,
    }


@CALM
@given(setups(), st.data())
def test_a_single_wrong_character_is_noticed(setup: Setup, data: st.DataObject) -> None:
    code = encode(setup)
    at = data.draw(st.integers(0, len(code) - 1))
    wrong = data.draw(st.characters().filter(lambda c: as_meant(c).upper() != code[at]))
    with pytest.raises(ValueError):
        decode(code[:at] + wrong + code[at + 1 :])


@pytest.mark.thorough
def test_every_single_wrong_character_is_noticed() -> None:
    code = encode(drawn_lab())
    for at in range(len(code)):
        for wrong in string.printable + "ſıK–":
            if as_meant(wrong).upper() != code[at]:
                with pytest.raises(ValueError):
                    decode(code[:at] + wrong + code[at + 1 :])


def test_every_truncation_and_swap_is_noticed() -> None:
    code = encode(drawn_lab())
    for length in range(len(code)):
        for rest in ("", " then so on, as agreed"):
            with pytest.raises(ValueError, match="share code"):
                decode(code[:length] + rest)
    for at in range(len(code) - 1):
        swapped = code[:at] + code[at + 1] + code[at] + code[at + 2 :]
        if swapped != code:
            with pytest.raises(ValueError):
                decode(swapped)


@pytest.mark.parametrize(
    "around", ["{}", "  {}\n", "Try this: {}", "({}).", '"{}", said she', "{}and more", "> {} <"]
)
def test_words_around_and_breaks_inside_do_not_matter(around: str) -> None:
    setup = drawn_lab()
    code = encode(setup)
    broken = "\r\n".join(code[i : i + 40] for i in range(0, len(code), 40))
    spaced = "\u200b".join(code[i : i + 7] for i in range(0, len(code), 7))
    for text in (code, broken, spaced, code.lower(), " ".join(code)):
        assert decode(around.format(text)) == setup


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no share code"),
        ("hello", "no share code"),
        ("ONPATH", "no share code"),
        ("ONPATHX-AAAA-BBBBBBB", "no share code"),
        ("ONPATH1-", "not complete"),
        ("ONPATH1-AAAA", "not complete"),
        ("ONPATH1-A0A1-BBBBBBB", "not complete"),
        ("ONPATH2-AAAA-BBBBBBB", "newer OnPath"),
        ("ONPATH2-~new~form~", "newer OnPath"),
        ("ONPATH0-AAAA-BBBBBBB", "mistyped"),
        ("ONPATH01-AAAA-BBBBBBB", "mistyped"),
        ("ONPATH1-AAAA-BBBBBBB", "mistyped"),
        ("ONPATH" + "9" * 6000 + "-AAAA-BBBBBBB", "no share code"),
        ("ONPATH1-" + "A" * 10_000_000, "too long"),
        (" " * 10_000_000, "too long"),
        ("\0", "no share code"),
        ("\ud800", "no share code"),
    ],
    ids=lambda text: text[:20],
)
def test_each_mistake_has_its_message(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        decode(text)


NOT_A_GAIN = {"parameters": {"K1": 1e9}}
HOSTILE: dict[str, Any] = {
    "not JSON": b"hello",
    "not text": b'{"robot":"\xff\xfe"}',
    "UTF-16": '{"rate":2.0}'.encode("utf-16"),
    "nothing": b"",
    "null": None,
    "array": [1, 2],
    "nested arrays": b"[" * 15_000,
    "nested objects": b'{"benches":' * 1500,
    "nested and closed": b"[" * 9_000 + b"]" * 9_000,
    "unknown field": {"admin": True},
    "unknown inner field": {"benches": {"five_bar": {"code": "import os"}}},
    "unknown robot": {"robot": "six_bar"},
    "unknown side": {"benches": {"six_bar": {}}},
    "script": {"benches": {"five_bar": {"parameters": {"<script>alert(1)</script>": 1}}}},
    "out of range": {"benches": {"five_bar": NOT_A_GAIN}},
    "NaN": b'{"rate":NaN}',
    "infinity": b'{"rate":Infinity}',
    "1e999": b'{"rate":1e999}',
    "nan as text": {"benches": {"five_bar": {"parameters": {"K1": "nan"}}}},
    "rate": {"rate": 1e300},
    "rate of another type": {"rate": "fast"},
    "huge integer": b'{"benches":{"five_bar":{"parameters":{"K1":' + b"9" * 5000 + b"}}}}",
    "truth": {"benches": {"five_bar": {"parameters": {"K1": True}}}},
    "copy": {"copy": 1},
    "points": {"benches": {"five_bar": {"path": {"name": "edited", "numbers": [1e300, 0]}}}},
    "many": {"benches": {"five_bar": {"path": {"name": "drawn", "numbers": [0] * 5000}}}},
    "many sides": {"benches": {f"r{i}": {} for i in range(1000)}},
}


@pytest.mark.parametrize("case", HOSTILE)
def test_a_forged_code_is_refused_and_not_quoted(case: str) -> None:
    with pytest.raises(ValueError, match="share code") as caught:
        decode(forged(HOSTILE[case]))
    assert "<" not in str(caught.value) and len(str(caught.value)) < 300
    assert str(caught.value).endswith(".")


@pytest.mark.parametrize("packed", [b"\xff" * 50, b"", b"\x00", bytes(range(256))])
def test_what_cannot_be_inflated_is_refused(packed: bytes) -> None:
    with pytest.raises(ValueError, match="contains no set-up"):
        decode(sealed(packed))


def test_more_after_the_end_is_refused() -> None:
    squeeze = zlib.compressobj(wbits=-15)
    with pytest.raises(ValueError, match="contains no set-up"):
        decode(sealed(squeeze.compress(b"{}") + squeeze.flush() + b"more"))


def test_a_bomb_is_not_inflated() -> None:
    bomb = forged(b'{"robot":"' + b" " * 25_000_000 + b'"}')
    assert len(bomb) < share_code.LONGEST_TEXT
    tracemalloc.start()
    began = time.thread_time()
    with pytest.raises(ValueError, match="contains no set-up"):
        decode(bomb)
    passed, peak = time.thread_time() - began, tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert passed < 1.0 and peak < 2_000_000


@settings(CALM, max_examples=300)
@given(st.binary(max_size=200))
def test_random_bytes_with_a_right_checksum(data: bytes) -> None:
    for code in (sealed(data), forged(data)):
        with pytest.raises(ValueError, match="share code"):
            decode(code)


@settings(CALM, max_examples=300)
@given(st.text())
@example("222222222222")
def test_random_text(text: str) -> None:
    for code in (text, "ONPATH1-" + text, SENT + text):
        with pytest.raises(ValueError, match=r"share code|code of a lab"):
            decode(code)


def test_the_fullest_lab_fits() -> None:
    path = capture_path(from_curve(random_drawing(1, pieces=MOST_PIECES)), PRESETS)
    full = {
        name: {
            "parameters": {
                field: spec.options[0] if spec.options else spec.low + 0.123456 * spec.high
                for field, spec in specs(entry.parameters()).items()
            },
            "path": plain(path),
        }
        for name, entry in ROBOTS.items()
    }
    code = forged({"benches": full, "robot": "flexible", "rate": 0.25, "copy": False})
    assert len(decode(code).robots) == len(ROBOTS)
    again = encode(decode(code))
    assert len(again) < LONGEST_TEXT and decode(again) == decode(code)


def test_session_codes_are_forgiving_and_unambiguous() -> None:
    codes = {new_code() for _ in range(500)}
    assert len(codes) == 500
    for code in codes:
        assert set(code) <= set(ALPHABET) and not set(code) & set("01ilo")
        assert normalised(shown(code)) == code
        assert normalised(f"  {shown(code).upper().replace('-', ' – ')}\n") == code
    assert shown("k7mf2xqa9tzr") == "k7mf-2xqa-9tzr"


@pytest.mark.parametrize(
    "text", ["", "abc", "k7mf-2xqa-9tz0", "k7mf-2xqa-9tzrr", "é" * 12, "x" * 10**7]
)
def test_an_invalid_session_code_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="lab code"):
        normalised(text)


def test_who_sets_up_a_lab_is_told_so_and_a_lab_s_code_is_called_one() -> None:
    lab = new_lab()
    do(lab, UseShared(shown(new_code())))
    assert "code of a lab" in lab.message
    code = encode(drawn_lab())
    do(lab, UseShared(code))
    assert encode(capture(lab.simulation)) == code and "set up from the code" in lab.message
