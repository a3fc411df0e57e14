"""What a lesson's author gets wrong is met with a line and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.lessons.course import read_course
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.schema import Text
from tests.support.checkout import ROOT
from tests.support.format_texts import FORMAT_LESSON, FORMAT_REFERENCE
from tests.support.lesson_texts import LESSON, REFERENCE, write_lesson

LATEX = "$$\\dot x = v$$"
RUN = "```script\nuntil = 1.0\n```"
COMMANDS = ("\\frac", "\\theta", "\\beta", "\\rho", "\\nu", "\\sin", "\\xi")
Capture = pytest.CaptureFixture[str]


def faults(path: Path) -> list[tuple[int, str]]:
    """Line and words of all that is wrong."""
    with pytest.raises(LessonError) as caught:
        read_lesson(path)
    return [(problem.line, problem.text) for problem in caught.value.problems]


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("seconds = 2.0", "seconds = 8.0", "8 s long, and the run after it, 'And now', 2 s"),
        ("seconds = 2.0", "seconds = 1.0", "1 s long"),
        ("below = 5.0", "below = 5.0\nabove = 6.0", "no number is both"),
        ("least = 1.0", "least = 3.0\nlast = 2.0", "never so many"),
        ("hold = true }, { at = 1.5, hold = false", "pull = [9, 0]", "release = true"),
        (LATEX, "$\\alhpa$", "did you mean \\alpha"),
        (LATEX, "$\\arg z$", "\\operatorname{arg}"),
        (LATEX, "$\\begin{aligned}a\\end{aligned}$", "did you mean align?"),
        (LATEX, "so $x = 3 it is", "does not end"),
        ('"Draw the distance."', '"Draw $x"', "does not end"),
        (LATEX, "<script>alert(1)</script>", "HTML is shown as it is typed"),
        ('"Draw the distance."', "'<b>Draw</b> <img src=x>'", "HTML is shown"),
        (LATEX, "{{47 = max distanse tracker}}", "did you mean distance?"),
        (LATEX, "{{47 = max distance}}", "write it as"),
        (LATEX, "{{47 = max distance tracker for ever}}", "'for ever' is not understood"),
        (LATEX, "{{forty-seven}}", "{{ is not understood"),
        (LATEX, "{{your weight}}", "one of sketch max"),
        ('"Draw the distance."', '"{{your number}}"', "not into a block"),
        (LATEX, "```when wrogn\nNo.\n```", "did you mean wrong?"),
        ("Which one *waits*?", "```when wrong\nNo.\n```", "no question with a right answer"),
        ('controls = ["K1", "hold"]', 'plot = ["speed", "rate", "force"]', "a list of 2"),
        ('controls = ["K1", "hold"]', 'plot = ["sped"]', "did you mean speed"),
        ('controls = ["K1", "hold"]', 'show = ["tub"]', "did you mean tube?"),
        ('controls = ["K1", "hold"]', "marks = [{ at = [0, 50] }]", "has a text"),
        ('controls = ["K1", "hold"]', "start = { across = 500 }", "start: "),
        ('controls = ["K1", "hold"]', "start = { acros = 5 }", "did you mean across"),
        ('kind = "bound"', 'kind = "bound"\nstat = "setling"', "did you mean settling?"),
        ('kind = "bound"', 'kind = "bond"', "did you mean bound?"),
        (LATEX, "![](b.svg)", "what it shows"),
        (LATEX, "![A](a.svg)", "no well-formed XML"),
        ("{ at = 0.5, hold", "{ at = 1.6, run = true }, { at = 0.5, hold", "order of their times"),
        ("lab:K3=100", "lab:goto=9", "lab:goto: neither an action nor a parameter"),
        ("lab:K3=100", "lab:pth=circle", "parameter; did you mean path?"),
        ("{ at = 0.5, hold = true }", "{ at = 0.5, rate = 0.01 }", "between 0.125 and 4"),
        (LATEX, "```folds Why\nSo.\n```", "did you mean fold"),
        (LATEX, "```foldd Why\nSo.\n```", "did you mean fold"),
        (LATEX, "```Fold Why\nSo.\n```", "did you mean fold"),
        (LATEX, "```foldLiterature\nSo.\n```", "did you mean fold"),
        (LATEX, "```When right\nSo.\n```", "did you mean when"),
        (LATEX, "```tasks\nSo.\n```", "did you mean task"),
        (LATEX, "```quiz one\nSo.\n```", "nothing stands after quiz"),
        (LATEX, "- ```quiz\n  So.\n  ```", "not in a list"),
        (LATEX, "```watch\nThe arm.\n```", "a watch stands in a `run` step"),
        (LATEX, "```watsh\nThe arm.\n```", "did you mean watch"),
        (LATEX, "```notes\nAsk.\n```", "notes stand in a lecture"),
        (RUN, "```watch\n[go](lab:run)\n```\n" + RUN, "without lab links"),
        (RUN, "```watch\nSee {{your number}}.\n```\n" + RUN, "no numbers of the student"),
        (RUN, 2 * "```watch\nThe arm.\n```\n" + RUN, "a second watch"),
        (LATEX, "<b>So</b>", "HTML is shown as it is typed"),
        (LATEX, 'so <mark class="a">it</mark>', "HTML is shown as it is typed"),
        ('"Draw the distance."', "'<i>Draw</i>'", "HTML is shown as it is typed"),
        ('"For tests."', "'<i>For</i> tests.'", "HTML is shown as it is typed"),
        (LATEX, "$\\frac{K_2{2\\sqrt{K_1}}$", "a { is not closed"),
        (LATEX, "$\\sqrt{K_1}}$", "a } closes nothing"),
        (LATEX, "$\\left( x$", "1 \\left and 0 \\right"),
        ('```quiz\nquestion = "And?"', '```text\nquestion = "And?"', "has no question"),
        ("```script", "```scene\n```\n\n```scene\n```\n\n```script", "a second scene"),
        ("```script", "```step\n```\n\n```step\n```\n\n```script", "a second step"),
        ("```script", "```script\nuntil = 2.0\n```\n\n```script", "a second script"),
        (LATEX, "```script\n```", "a script stands in a `run` step"),
        ("Which one *waits*?", "{{your sketch max}}", "no prediction by a sketch is above"),
        ("Which one *waits*?", "{{your choice or *no*}}", "no prediction by choice is above"),
        (LATEX, "so\n{{your number}}", "{{your number}}: no question with a number is above"),
        (LATEX, "{{your best}}", "no task with `best = …` is above"),
        (LATEX, "{-5.2 = min across follower}", "between two braces"),
        (LATEX, "{your choice}", "between two braces"),
        (LATEX, "{{{0.0 = min distance follower}}}", "three braces"),
        (LATEX, "{{{your choice}}}", "three braces"),
        (LATEX, "{{-5.2 ± 500 = min across follower}}", "0 would be accepted as -5.2"),
        ('"For tests."', '"{{47 = max distance tracker}}"', "a mark stands in a step"),
        ('"For tests."', '"It {{stops = stops tracker}}"', "a mark stands in a step"),
        (LATEX, "It {{stops = stop tracker}}.", "did you mean stops?"),
        (LATEX, "It {{stops = stops robot}}.", "follower or tracker"),
        (LATEX, "It {{{stops = stops tracker}}}.", "three braces"),
        (LATEX, "{{A plot = plot sped}}.", "did you mean speed?"),
        (LATEX, "{{Hold = control hodl}}.", "did you mean hold?"),
        (LATEX, "{{It = says fault.bends or so}}.", "says is followed by one name"),
        (LATEX, "It is {{near = max distanse tracker < 5}}.", "did you mean distance?"),
        (LATEX, "It is {{near = max distance tracker}}.", "is not understood"),
        ('question = "Which?"', 'question = "W"\nhidden = [""]', "an empty word"),
        ('text = "b"', 'text = "a"', "two options have the text 'a'"),
        ('text = "that"', 'text = "this"', "two options have the text 'this'"),
        *(
            ('"Draw the distance."', f'"${each} x$"', "or the text stands between single")
            for each in COMMANDS
        ),
    ],
)
def test_it_is_told_with_its_line(tmp_path: Path, right: str, wrong: str, said: str) -> None:
    assert right in LESSON
    text = LESSON.replace(right, wrong, 1)
    file = write_lesson(tmp_path, text)
    file.with_name("a.svg").write_text("<svg><text>a & b</text></svg>")
    file.with_name("b.svg").write_text("<svg/>")
    found = faults(file)
    assert len(found) == 1 and said in found[0][1], found
    at = text[: text.index(wrong)].count("\n") + 1
    assert -6 <= at - found[0][0] <= 6  # its line, or that of its block, or of its step


@pytest.mark.parametrize(
    "text",
    [
        "```text\n<b>\n```",
        "```python\nfold = 1\n```",
        "```toml\na = 1\n```",
        "```c\nint a;\n```",
        "```\nscene\n```",
        "`<b>` and $a<b>c$ and <https://a.org>",
        "$\\left\\{a\\right\\}\\leftarrow b \\\\ c$",
    ],
)
def test_what_is_like_a_fault_and_is_none_is_read(tmp_path: Path, text: str) -> None:
    read_lesson(write_lesson(tmp_path, LESSON.replace(LATEX, text)))


@pytest.mark.parametrize("text", ["'$\\theta$'", '"$\\\\theta$"', '"""\na\n\tb"""', "'$a<b>c$'"])
def test_a_backslash_that_is_one_is_read(tmp_path: Path, text: str) -> None:
    read_lesson(write_lesson(tmp_path, LESSON.replace('"Draw the distance."', text)))


def test_a_prediction_stands_after_what_it_needs(tmp_path: Path) -> None:
    late = LESSON.replace("\n# run: And now", "\n```fold More\nIt is long.\n```\n\n# run: And now")
    read_lesson(write_lesson(tmp_path, late))
    late = late.replace("\n# run: And now", "\nIt is held at 3 s.\n\n# run: And now")
    ((line, words),) = faults(write_lesson(tmp_path, late))
    assert "text stands after its prediction" in words
    assert late.split("\n")[line - 1] == "# predict: Before"


def test_what_a_prediction_hides_is_not_told_before_it_except_in_a_fold(tmp_path: Path) -> None:
    text = LESSON.replace('"Draw the distance."', '"D"\nhidden = ["47 mm"]')
    text = text.replace("# run: And now", "# run: And now\n\nIt was 47 mm.")
    read_lesson(write_lesson(tmp_path, text))
    told = text.replace("Which one *waits*?", "Up to 47 mm.")
    ((line, words),) = faults(write_lesson(tmp_path, told))
    assert "'47 mm' is told before step 'Before'" in words
    assert told.split("\n")[line - 1] == "# play: Look around"
    fold = text.replace("Which one *waits*?", "```fold Tell me\nUp to 47 mm.\n```")
    read_lesson(write_lesson(tmp_path, fold))
    first = text.replace("For tests.", "Of 47 mm.")
    ((line, words),) = faults(write_lesson(tmp_path, first))
    assert "summary: '47 mm' is told before step 'Before'" in words and line == 3


def test_a_second_task_with_an_id_is_named(tmp_path: Path) -> None:
    task = LESSON[LESSON.index("```task") : LESSON.index("# quiz")]
    text = LESSON + "\n# task: Again\n\n" + task
    ((line, words),) = faults(write_lesson(tmp_path, text))
    assert "another task has it" in words and text.split("\n")[line - 1] == 'id = "hold"'
    assert line > LESSON.count("\n")


@pytest.mark.thorough
def test_a_lesson_with_all_of_the_format_is_read(tmp_path: Path, capsys: Capture) -> None:
    file = write_lesson(tmp_path, FORMAT_LESSON, FORMAT_REFERENCE)
    assert run_command(["lessons", "check", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert out == "1 lesson, 1 solution and 1 failure played, nothing wrong\n"
    explain = next(step for step in read_lesson(file).steps if step.kind == "explain")
    texts = [block for block in explain.blocks if isinstance(block, Text)]
    assert [text.when for text in texts] == ["", "wrong"] and "{{your sketch" in texts[0].html


def test_a_lesson_is_checked_by_its_own_folder(tmp_path: Path, capsys: Capture) -> None:
    file = write_lesson(tmp_path)
    assert run_command(["lessons", "check", str(file.parent)]) == 0
    assert "1 lesson, " in capsys.readouterr().out
    file.write_text(LESSON.replace("K1 = 300", "K9 = 300"))
    assert run_command(["lessons", "check", str(file.parent)]) == 1
    assert "K9" in capsys.readouterr().err
    (problem,) = read_course([file.parent])[1]
    assert "this is a lesson itself" in problem.text and str(tmp_path) in problem.text


@pytest.mark.parametrize(
    ("number", "agrees"),
    [
        ("{{0.0 = min distance follower}}", True),
        ("{{47 = max distance tracker}}", False),
        ("{{30 ± 29 = max distance tracker during held from 0.5 to 1.5}}", True),
        ("{{30 ± 1 = max distance tracker during held from 0.5 to 0.6}}", False),
    ],
)
def test_a_number_of_the_text_is_compared_with_the_run(
    tmp_path: Path, capsys: Capture, number: str, agrees: bool
) -> None:
    text = LESSON.replace("until = 2.0", "until = 2.0", 1).replace(LATEX, f"It is {number} mm.")
    text = text.replace("```script\nuntil = 1.0\n```", "```script\n" + HELD + "\n```")
    file = write_lesson(tmp_path, text)
    assert run_command(["lessons", "check", str(tmp_path)]) == (0 if agrees else 1)
    said = capsys.readouterr().err
    line = text[: text.index(number)].count("\n") + 1
    assert agrees or (f"{file}:{line}: " in said and "is stated, but max distance" in said)
    shown = number[2:].split()[0]
    html = next(step for step in read_lesson(file).steps if step.kind == "explain").blocks[0]
    assert isinstance(html, Text) and f"It is {shown} mm." in html.html


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("top = 60.0", "top = 9.0", "top = 9: the distance of the tracker goes up to 48.05 mm"),
        (
            '"distance"\nseconds',
            '"across"\nseconds',
            "bottom = 0: the across of the tracker goes down to -",
        ),
        ('"distance"\nseconds', '"energy"\nseconds', "has no energy of the tracker"),
        (
            LATEX,
            "{{4 = max distance follower during pulled}}",
            "measured: the follower is never pulled",
        ),
        (
            LATEX,
            "{{4 = max distance follower from 3 to 5}}",
            "no instant from 3 to 5 s; the run ends at",
        ),
        (LATEX, "{{4 = max energy follower}}", "robot of this run has no energy"),
    ],
)
def test_what_the_run_shows_is_told(
    tmp_path: Path, capsys: Capture, right: str, wrong: str, said: str
) -> None:
    assert right in LESSON
    file = write_lesson(tmp_path, LESSON.replace(right, wrong, 1))
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(f"{file}:") and said in told


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("minutes = 1", 'robot = "flexible"', "robot is 'flexible', and 'five_bar' in en.md"),
        (LATEX, f"{LATEX}\n\n```fold A\nB\n```", "line 51: not the same number of folds"),
        ("lab:K3=100", "lab:K3=10", "not the same lab links"),
        ("until = 1.0", "until = 1.5", "not the same script"),
        ('controls = ["K1", "hold"]', 'controls = ["K1"]', "not the same scene"),
    ],
)
def test_it_is_told_what_differs_in_a_translation(
    tmp_path: Path, right: str, wrong: str, said: str
) -> None:
    assert right in LESSON
    file = write_lesson(tmp_path).with_name("de.md")
    file.write_text(LESSON.replace(right, wrong))
    found = read_course([tmp_path])[1]
    assert [said in each.text and each.path == str(file) for each in found] == [True], found


def test_files_and_folders_that_nobody_reads_are_named(tmp_path: Path) -> None:
    home = write_lesson(tmp_path).parent
    (home / "DE.md").write_text(LESSON)
    write_lesson(tmp_path, name="01-b")
    (tmp_path / "route").mkdir()
    (tmp_path / ".git").mkdir()
    told = {Path(each.path).name: each.text for each in read_course([tmp_path])[1]}
    assert set(told) == {"DE.md", "01-b", "route"}
    assert "two small letters" in told["DE.md"] and "'01-a' has the number 01" in told["01-b"]
    assert "did you mean routes?" in told["route"]


@pytest.mark.parametrize(
    ("right", "wrong", "said", "line"),
    [
        ("[hold.failure]", "[hold.failed]", "task 'hold': .*did you mean failure?", 5),
        ("until = 1.5", "untill = 1.5", "task 'hold': .*did you mean until?", 6),
        ("[hold", "[holt", "there is no task 'holt'; did you mean hold?", 2),
    ],
)
def test_what_is_wrong_in_the_references_is_named(
    tmp_path: Path, right: str, wrong: str, said: str, line: int
) -> None:
    write_lesson(tmp_path, reference=REFERENCE.replace(right, wrong))
    found = [each for each in read_course([tmp_path])[1] if "no solution" not in each.text]
    first, _, last = said.partition(".*")
    assert [(first in each.text and last in each.text, each.line) for each in found] == [
        (True, line)
    ], found


HELD = "until = 2.0\ndo = [{ at = 0.5, hold = true }, { at = 1.5, hold = false }]"


def test_the_whole_lesson_of_the_readme_passes(tmp_path: Path, capsys: Capture) -> None:
    readme = (ROOT / "lessons" / "README.md").read_text("utf-8")
    lesson, reference = (part.partition("````")[0] for part in readme.split("````\n")[1:4:2])
    write_lesson(tmp_path, lesson, reference)
    assert run_command(["lessons", "check", str(tmp_path)]) == 0, capsys.readouterr().err
    assert "1 lesson, 1 solution and 1 failure played" in capsys.readouterr().out


def curly(part: str) -> str:
    """The lesson with curly quotes around a text, as a Mac types them."""
    return LESSON.replace(f'"{part}"', f"“{part}”")


@pytest.mark.parametrize("part", ["A lesson", "Draw the distance.", "The key H.", "H", "ellipse"])
def test_curly_quotes_are_told_once_and_at_their_line(tmp_path: Path, part: str) -> None:
    text = curly(part)
    told = faults(write_lesson(tmp_path, text))
    line = text[: text.index("“")].count("\n") + 1
    assert [(at, said) for at, said in told if "straight quotes" in said] == [
        (line, '“: in TOML a text stands between straight quotes, "…"')
    ]
    assert not [said for _, said in told if "Invalid value" in said or "at line" in said]


def test_curly_quotes_within_a_text_are_text(tmp_path: Path) -> None:
    text = LESSON.replace('"Draw the distance."', '"Draw “the” distance: it’s easy. # “"')
    read_lesson(write_lesson(tmp_path, text))


def test_a_fault_of_toml_has_one_line(tmp_path: Path) -> None:
    """That of the file, and not also that of the block."""
    text = LESSON.replace("below = 5.0", "below = = 5.0")
    ((line, said),) = [each for each in faults(write_lesson(tmp_path, text)) if "TOML" in each[1]]
    assert line == text[: text.index("below = =")].count("\n") + 1
    assert "column 9" in said and "line" not in said


@pytest.mark.parametrize(
    ("encoding", "said"),
    [("utf-16", "this is UTF-16"), ("utf-16-le", "this is UTF-16"), ("latin-1", "not in UTF-8")],
)
@pytest.mark.parametrize("name", ["01-a/en.md", "01-a/reference.toml", "routes/1.toml"])
def test_another_encoding_is_told_as_an_author_can_mend_it(
    tmp_path: Path, encoding: str, said: str, name: str
) -> None:
    write_lesson(tmp_path)
    file = tmp_path / name
    file.parent.mkdir(exist_ok=True)
    text = file.read_text() if file.exists() else "[title]\n"
    file.write_bytes((text + "\n# Maß\n").encode(encoding))
    (problem,) = read_course([tmp_path])[1]
    assert problem.path == str(file) and said in problem.text and "save it as UTF-8" in problem.text
    assert problem.line == (1 if "16" in encoding else text.count("\n") + 2)
    assert "codec" not in problem.text


def test_what_a_system_puts_beside_the_files_is_ignored(tmp_path: Path, capsys: Capture) -> None:
    lesson = write_lesson(tmp_path)
    (tmp_path / "routes").mkdir()
    for folder in (tmp_path, lesson.parent, tmp_path / "routes"):
        for name in ("._en.md", ".DS_Store", "Thumbs.db", "._1.toml", "desktop.ini"):
            (folder / name).write_bytes(b"\x00\x05\x16\x07\x00\x02\x00\x00Mac OS X")
    (tmp_path / "__MACOSX" / "01-a").mkdir(parents=True)
    (tmp_path / "__MACOSX" / "01-a" / "._en.md").write_bytes(b"\x00\x05")
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "notes.md").write_bytes(b"x")
    course, problems = read_course([tmp_path])
    assert problems == [] and list(course.lessons) == ["01-a"]
    assert read_course([tmp_path / "01-a" / ".."])[1] == []
    assert run_command(["lessons", "check", str(lesson.parent)]) == 0


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("K1 = 300", 'K1 = "300"'),
        ("K1 = 300", 'torque_limit = "2"'),
        ("K1 = 300", 'control_rate = "200"'),
        ("until = 1.0", 'until = 1.0\ndo = [{ at = 0.5, set = { K1 = "300" } }]'),
        (
            "below = 5.0\n",
            'below = 5.0\n[[check]]\nkind = "setting"\nname = "K1"\nequals = "300"\n',
        ),
    ],
)
def test_a_number_in_quotes_is_told_with_its_line(tmp_path: Path, right: str, wrong: str) -> None:
    text = LESSON.replace(right, wrong)
    ((line, said),) = faults(write_lesson(tmp_path, text))
    assert "a number stands without quotes" in said
    name = said.split(" = ")[0]
    lines = text.split("\n")
    assert name in lines[line - 1]


def test_a_choice_and_a_law_are_texts(tmp_path: Path) -> None:
    read_lesson(write_lesson(tmp_path, LESSON.replace("K1 = 300", 'at_limit = "cut"')))
