"""Lessons as files: what is right is read, what is wrong is named with file, line and words."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fluent.syntax import ast
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.cli.main import run_command
from onpath.assets.messages import catalogue, identifier, languages
from onpath.lessons.action_schema import Action
from onpath.lessons.course import read_course
from onpath.lessons.formulas import to_html
from onpath.lessons.links import read_link
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.schema import Sketch, Text
from onpath.lessons.text_files import LARGEST
from onpath.lessons.words import ELSEWHERE, Words, language_name
from tests.support.built_in import built_in_course
from tests.support.catalogues import COMPLETE, arguments, entries, messages
from tests.support.checkout import ROOT
from tests.support.lesson_texts import LESSON, REFERENCE, write_lesson


def problems(path: Path) -> list[tuple[int, str]]:
    """Line and words of all that is wrong."""
    with pytest.raises(LessonError) as caught:
        read_lesson(path)
    return [(problem.line, problem.text) for problem in caught.value.problems]


def line_of(part: str, text: str) -> int:
    """Where a part of a text is, from 1."""
    return next(i for i, line in enumerate(text.split("\n"), 1) if part in line)


def test_a_lesson_is_read(tmp_path: Path) -> None:
    lesson = read_lesson(write_lesson(tmp_path))
    assert [step.kind for step in lesson.steps] == [
        *("play", "predict", "run", "predict", "run", "explain", "task", "quiz"),
    ]
    play = lesson.steps[0]
    assert play.setup is not None and play.setup.set == {"K1": 300}
    text = play.blocks[0]
    assert isinstance(text, Text) and "<math" in text.html and "<em>waits</em>" in text.html
    assert text.links[0].label == "set K3 to 100"
    assert text.links[0].actions == (Action(set={"K3": 100.0}),)
    assert isinstance(lesson.steps[1].predictions()[0], Sketch)
    assert lesson.tasks()[0].id == "hold"


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ('title = "A lesson"', 'tilte = "A lesson"', "tilte"),
        ("minutes = 1", 'minutes = "one"', "minutes"),
        ("minutes = 1", 'picture = "no.svg"', "no picture 'no.svg'"),
        ("minutes = 1", 'picture = "../no.svg"', "not in the lesson's folder"),
        ("# play: Look around", "# plai: Look around", "plai"),
        ("K1 = 300", "K1 = 30000", "K1"),
        ("K1 = 300", "K9 = 300", "K9"),
        ('controls = ["K1", "hold"]', 'controls = ["K1", "hodl"]', "did you mean hold"),
        ('quantity = "distance"\nseconds', 'quantity = "distnace"\nseconds', "did you mean"),
        ("top = 60.0", "top = -60.0", "top"),
        ("until = 2.0", "until = 2000.0", "until"),
        ("{ at = 0.5, hold = true }", "{ at = 0.5, hold = true, run = true }", "exactly one"),
        ("{ at = 0.5, hold = true }", "{ at = 0.5 hold = true }", "TOML"),
        ('path = "ellipse"', 'path = "elipse"', "did you mean ellipse"),
        ("least = 1.0", 'least = "long"', "least"),
        ('during = "held"', 'during = "hold"', "during"),
        ('kind = "bound"', 'kind = "bond"', "bond"),
        ("below = 5.0", "", "below or above"),
        ('answer = "yes", right = true', 'answer = "yes"', "one of them right"),
        ("```quiz\n", "```quizz\n", "did you mean quiz"),
        ("(lab:K3=100)", "(lab:K3=1e9)", "K3"),
        ("(lab:K3=100)", "(lab:explode)", "explode"),
        ("(lab:K3=100)", "(http://example.org)", "https://"),
        ("*waits*", "wai\x0bts", "control character"),
        ('title = "A lesson"', r'title = "A \u0001lesson"', "control character"),
        ('title = "A lesson"', 'title = "A \ufffelesson"', "control character"),
        ("*waits*", "![x](no.svg)", "no.svg"),
        ("*waits*", "![x](../../secret.svg)", "not in the lesson's folder"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(
    tmp_path: Path, right: str, wrong: str, said: str
) -> None:
    assert right in LESSON
    text = LESSON.replace(right, wrong, 1)
    found = problems(write_lesson(tmp_path, text))
    assert any(said in words for _, words in found), found
    first = wrong.split("\n")[0] or 'kind = "bound"'
    assert len(found) == 1, found
    assert 0 <= line_of(first, text) - found[0][0] <= 4, found  # its line, or its block's first


def test_a_fold_shows_its_title_and_keeps_the_rest(tmp_path: Path) -> None:
    own = "```fold If *you* <3 cannot\n$x^2$ and *more*, and [K3](lab:K3=1)\n```\n\n# predict: B"
    text = read_lesson(write_lesson(tmp_path, LESSON.replace("# predict: B", own, 1))).steps[0]
    *_, fold = text.blocks
    assert isinstance(fold, Text) and "<em>more</em>" in fold.html and "<math" in fold.html
    assert "<details><summary>If *you* &lt;3 cannot</summary><p>" in fold.html
    assert fold.links[0].actions == (Action(set={"K3": 1.0}),)
    assert "<details" not in str(text.blocks[0])
    (found,) = problems(
        write_lesson(
            tmp_path, LESSON.replace("# predict: B", own.replace(" If *you* <3 cannot", ""), 1)
        )
    )
    assert "needs a title" in found[1]


@pytest.mark.parametrize("kind", ["play", "predict", "run", "explain", "task"])
def test_a_lesson_without_one_of_its_parts_is_refused(tmp_path: Path, kind: str) -> None:
    text = LESSON.replace(f"# {kind}: ", "# quiz: ")
    assert any(f"no step `# {kind}" in words for _, words in problems(write_lesson(tmp_path, text)))


@pytest.mark.parametrize(
    ("heading", "said"),
    [
        ("# task: Do\n", "no step `# task: …` that is not optional"),
        ("# predict: Once more\n", "neither of them"),
        ("# run: See\n", "neither of them"),
    ],
)
def test_the_core_is_not_optional_and_a_prediction_is_shown_by_its_like(
    tmp_path: Path, heading: str, said: str
) -> None:
    optional = "```step\noptional = true\n```\n"
    text = LESSON.replace(heading, heading + optional, 1)
    (found,) = problems(write_lesson(tmp_path, text))
    assert said in found[1]
    misspelt = text.replace("optional =", "optinal =")
    ((line, words),) = problems(write_lesson(tmp_path, misspelt))
    assert "`optinal`" in words and line == line_of("optinal", misspelt)


def test_html_is_shown_as_it_is_typed() -> None:
    html = to_html("<img src=x onerror=alert(1)><script>alert(1)</script>")
    assert "<script" not in html and "<img" not in html and "&lt;script" in html
    assert "&lt;b" in to_html("a <b and c> d")


@pytest.mark.parametrize("address", ["javascript:alert(1)", "data:text/html,x", "JaVaScRiPt:x"])
def test_no_link_runs_anything(address: str) -> None:
    assert "href" not in to_html(f"[press]({address})")
    with pytest.raises(ValueError):
        read_link(address)


def test_a_decimal_comma_is_part_of_its_number() -> None:
    """Without spaces around it, and unlike the comma between two numbers."""
    assert "<mn>30,95</mn>" in to_html(r"$x = 30{,}95\ \mathrm{mm}$")
    assert "<mn>2</mn><mo>,</mo><mn>3</mn>" in to_html("$(2, 3)$")


@pytest.mark.thorough
@given(st.text(max_size=400))
@settings(max_examples=150, deadline=None)
def test_whatever_is_typed_gives_a_lesson_or_problems(text: str) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        file = write_lesson(Path(folder), LESSON)
        file.write_bytes(LESSON.replace("*waits*", text).encode("utf-8", "replace"))
        try:
            assert read_lesson(file).steps
        except LessonError as error:
            assert error.problems


@pytest.mark.parametrize("length", range(0, len(LESSON), 97))
def test_a_truncated_lesson_is_named(tmp_path: Path, length: int) -> None:
    assert problems(write_lesson(tmp_path, LESSON[:length]))


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"\xff\xfe\x00", "UTF-8"), (b"x" * (LARGEST + 1), "larger"), (b"", "+++")],
)
def test_no_text_at_all(tmp_path: Path, content: bytes, said: str) -> None:
    file = write_lesson(tmp_path)
    file.write_bytes(content)
    assert any(said in words for _, words in problems(file))


@pytest.mark.skipif(sys.platform == "win32", reason="no such files")
def test_a_device_is_not_read(tmp_path: Path) -> None:
    """It has no end, or does not begin."""
    file = write_lesson(tmp_path)
    for path, text in ((file, LESSON), (file.with_name("reference.toml"), REFERENCE)):
        path.unlink()
        os.mkfifo(path)
        assert [(each.path, each.text) for each in read_course([tmp_path])[1]] == [
            (str(path), "no file but a device, which may never end")
        ]
        path.unlink()
        path.write_text(text)


@pytest.mark.skipif(sys.platform == "win32", reason="no such files")
@pytest.mark.parametrize("kind", ["device", "link to itself", "folder"])
def test_what_is_no_picture_is_not_read(tmp_path: Path, kind: str) -> None:
    file = write_lesson(tmp_path)
    file.write_text(LESSON.replace("*waits*", "![x](no.svg)"))
    picture = file.with_name("no.svg")
    make = {"device": os.mkfifo, "folder": Path.mkdir, "link to itself": _link_to_itself}
    make[kind](picture)
    assert any("no picture 'no.svg'" in words for _, words in problems(file))


@pytest.mark.parametrize(
    ("text", "signs"),
    [
        ("A dot ![x](x.svg) waits.", 1),
        ("![x](x.svg)", 0),
        ("![x](x.svg)\n![x](x.svg)", 0),
        ("![x](x.svg)\nA dot, ![x](x.svg), waits\n![x](x.svg)", 1),
    ],
)
def test_a_picture_beside_text_is_a_sign(tmp_path: Path, text: str, signs: int) -> None:
    file = write_lesson(tmp_path, LESSON.replace("*waits*", f"\n\n{text}\n\n"))
    file.with_name("x.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    words = "".join(
        block.html
        for step in read_lesson(file).steps
        for block in step.blocks
        if isinstance(block, Text)
    )
    assert words.count("<img") == text.count("![x]") and words.count('class="sign"') == signs


def _link_to_itself(path: Path) -> None:
    path.symlink_to(path)


@pytest.mark.parametrize(
    ("value", "said"),
    [("[" * 5000 + "]" * 5000, "nested too deeply"), ("9" * 5000, "a number is too long")],
)
def test_toml_at_which_the_parser_fails_is_a_problem_of_its_file(
    tmp_path: Path, value: str, said: str
) -> None:
    file = write_lesson(tmp_path)
    file.write_text(LESSON.replace("minutes = 1", f"minutes = {value}"))
    assert any(said in words for _, words in problems(file))
    file.write_text(LESSON)
    reference = file.with_name("reference.toml")
    reference.write_text(f"hold = {value}")
    assert [(each.path, each.text) for each in read_course([tmp_path])[1]] == [
        (str(reference), f"TOML: {said}")
    ]


@pytest.mark.thorough
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_any_editor_will_do(tmp_path: Path, encoding: str, ending: str) -> None:
    """Windows' Notepad begins a file with a byte-order mark and ends lines with CR LF."""
    plain = read_lesson(write_lesson(tmp_path / "plain"))
    file = write_lesson(tmp_path / "own")
    for own in file.parent.iterdir():
        own.write_bytes(own.read_text().replace("\n", ending).encode(encoding))
    assert read_course([tmp_path / "own"])[1] == []
    assert read_lesson(file) == plain
    assert run_command(["lessons", "check", str(tmp_path / "own")]) == 0


def test_a_wrong_lesson_does_not_take_the_others_with_it(tmp_path: Path) -> None:
    write_lesson(tmp_path, name="01-good")
    write_lesson(tmp_path, "nothing", name="02-bad")
    course, found = read_course([tmp_path])
    assert list(course.lessons) == ["01-good"]
    assert {Path(problem.path).parent.name for problem in found} == {"02-bad"}


@pytest.mark.parametrize(
    ("reference", "said"),
    [
        ("", "no solution of task 'hold'"),
        (REFERENCE + REFERENCE.replace("hold.", "other."), "there is no task 'other'"),
        (REFERENCE.replace("hold = true", "hodl = true"), "hodl"),
        (REFERENCE.replace("until = 3.0", "until = 0.5"), "at = 1"),
        ("[hold", "TOML"),
    ],
)
def test_references_are_checked(tmp_path: Path, reference: str, said: str) -> None:
    write_lesson(tmp_path, reference=reference)
    _, found = read_course([tmp_path])
    assert found and (said in str(found) or said == "TOML")


def test_a_translation_that_does_something_else_is_named(tmp_path: Path) -> None:
    file = write_lesson(tmp_path)
    (file.parent / "de.md").write_text(LESSON.replace("Hold back.", "Halte fest."))
    assert read_course([tmp_path])[1] == []
    (file.parent / "de.md").write_text(LESSON.replace("below = 5.0", "below = 4.0"))
    (found,) = read_course([tmp_path])[1]
    assert found.path.endswith("de.md") and found.line == line_of("# task", LESSON)


@pytest.mark.parametrize(
    ("own", "theirs", "step"),
    [("top = 60.0", "top = 50.0", "# predict"), ("lab:K3=100", "lab:K3=10", "# play")],
)
def test_a_translation_with_other_axes_or_links_is_named(
    tmp_path: Path, own: str, theirs: str, step: str
) -> None:
    file = write_lesson(tmp_path)
    (file.parent / "de.md").write_text(LESSON.replace(own, theirs))
    (found,) = read_course([tmp_path])[1]
    assert found.path.endswith("de.md") and found.line == line_of(step, LESSON)


def test_a_translation_with_the_options_in_another_order_is_named(tmp_path: Path) -> None:
    """What a student has chosen is kept as a number."""
    turned = LESSON.replace('answer = "A", right = true', 'answer = "A"')
    turned = turned.replace('answer = "B"', 'answer = "B", right = true')
    file = write_lesson(tmp_path)
    (file.parent / "de.md").write_text(turned)
    (found,) = read_course([tmp_path])[1]
    assert found.path.endswith("de.md") and found.line == line_of("# quiz", LESSON)


@pytest.mark.parametrize(
    ("own", "theirs", "said"),
    [
        ('summary = "For tests."', 'summary = "For tests."\ngoals = "see"', "goals"),
        ('question = "Which?"', 'question = "Which?"\nask = "And why?"', "step"),
        ('question = "Draw the distance."', 'question = "D"\nusual = "nothing"', "step"),
        ('text = "Hold back."', 'text = "Hold back."\npassed = "Because."', "step"),
    ],
)
def test_a_translation_without_a_text_is_named(
    tmp_path: Path, own: str, theirs: str, said: str
) -> None:
    file = write_lesson(tmp_path, LESSON.replace(own, theirs))
    (file.parent / "de.md").write_text(LESSON)
    (found,) = read_course([tmp_path])[1]
    assert found.path.endswith("de.md") and said in found.text


def test_a_formula_in_the_front_matter_is_read_or_named(tmp_path: Path) -> None:
    front = 'summary = "For tests."'
    text = LESSON.replace(front, f"{front}\nneeds = '$x^2$ and *more*'")
    needs = read_lesson(write_lesson(tmp_path, text)).front.needs
    assert "<math" in needs and "<em>more</em>" in needs
    (found,) = problems(
        write_lesson(tmp_path, LESSON.replace(front, f"{front}\nneeds = '$\\frac$'"))
    )
    assert "formula" in found[1]


def test_the_command_line_lists_and_checks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_lesson(tmp_path)
    assert run_command(["lessons", "check", str(tmp_path)]) == 0
    assert run_command(["lessons", "list", str(tmp_path)]) == 0
    assert "A lesson" in capsys.readouterr().out
    file = write_lesson(tmp_path, LESSON.replace("K1 = 300", "K1 = 30000"))
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    line = line_of("K1 = 30000", file.read_text())
    assert f"{file}:{line}: " in capsys.readouterr().err
    assert run_command(["--lessons", str(tmp_path), "--port", "0"]) == 2
    assert run_command(["lessons", "check", str(tmp_path / "none")]) == 1


def test_a_catalogue_has_no_fault() -> None:
    for language in languages():
        own, english = messages(language), messages("en")
        written = [entry for entry in entries(language) if isinstance(entry, ast.Message)]
        assert not [entry for entry in entries(language) if isinstance(entry, ast.Junk)]
        assert len(written) == len(own), "an identifier twice"
        assert f"language-{language}" in own  # its name, in itself
        for key in own.keys() & english.keys():
            assert arguments(own[key]) == arguments(english[key]), key


def test_a_complete_language_says_everything() -> None:
    elsewhere = tuple(identifier(beginning) for beginning in (*ELSEWHERE, "language."))

    def said(language: str) -> set[str]:
        return {key for key in messages(language) if not key.startswith(elsewhere)}

    for language in COMPLETE:
        assert said(language) == said("en") and len(said("en")) > 500


FRENCH = """
language-fr = Français
lesson-next = Suivant
"""


@pytest.fixture
def begun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Words]:
    """A language of which only two messages exist."""
    for file in (ROOT / "assets" / "words").glob("*.ftl"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "fr.ftl").write_text(FRENCH, "utf-8")
    monkeypatch.setattr("onpath.assets.messages.asset_path", lambda _: tmp_path)
    yield Words("fr")
    catalogue.cache_clear()


def test_a_language_that_is_begun_says_the_rest_in_english(begun: Words) -> None:
    assert begun.language == "fr" and begun("lesson.next") == "Suivant"
    assert [language_name(each) for each in languages()] == ["Deutsch", "English", "Français"]
    values = dict.fromkeys({a for m in messages("en").values() for a in arguments(m)}, 2)
    keys = messages("en").keys() - {"lesson-next"}
    assert [key for key in keys if begun(key, **values) != Words()(key, **values)] == []
    course = built_in_course()[0]
    name = next(iter(course.lessons))
    assert course.lesson(name, "fr") == course.lesson(name, "en")


def test_a_language_without_a_name_has_its_code(begun: Words, tmp_path: Path) -> None:
    (tmp_path / "it.ftl").write_text("lesson-next = Avanti\n", "utf-8")
    assert language_name("it") == "it"


def test_a_missing_language_falls_back_to_english() -> None:
    assert Words("xx").language == "en" and Words("../en")("kind.play") == Words()("kind.play")


def test_a_side_road_leaves_the_numbers_of_the_other_lessons_as_they_are(tmp_path: Path) -> None:
    for name in ("02-second", "01b-side", "01-first", "10-last", "10c-end"):
        write_lesson(tmp_path, name=name)
    course, found = read_course([tmp_path])
    assert found == []
    assert list(course.numbers().items()) == [
        *[("01-first", "1"), ("01b-side", "1b"), ("02-second", "2")],
        *[("10-last", "3"), ("10c-end", "3c")],
    ]


def test_the_words_of_links_side_by_side_do_not_run_together(tmp_path: Path) -> None:
    links = "[one](lab:K3=1) [two](lab:K3=2), [three](lab:K3=3) and [four](lab:K3=4)."
    file = write_lesson(tmp_path, LESSON.replace("[set K3 to 100](lab:K3=100).", links))
    html = "".join(b.html for b in read_lesson(file).steps[0].blocks if isinstance(b, Text))
    bold = [f"<strong>{word}</strong>" for word in ("one", "two", "three", "four")]
    assert f"{', '.join(bold[:3])} and {bold[3]}." in html
