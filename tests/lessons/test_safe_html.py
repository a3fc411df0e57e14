"""Whatever stands in a lesson, a page gets text and harmless elements, and the author is told."""

from __future__ import annotations

import contextlib
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.lessons.adaptive.own_numbers import filled, marked
from onpath.lessons.formulas import TextError, folded, mathml, reader, to_html
from onpath.lessons.given import Answer
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.prose import read_prose
from onpath.lessons.safe_html import ALLOWED, refused, safe
from onpath.lessons.schema import Choice, Option, Step, Text
from onpath.lessons.words import ENGLISH
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lesson_texts import LESSON, write_lesson

ALERT = "alert(1)"
HARMLESS = {
    *("p", "em", "strong", "br", "hr", "blockquote", "ul", "ol", "li", "pre", "code", "a", "img"),
    *("h1", "h2", "h3", "h4", "h5", "h6", "table", "thead", "tbody", "tr", "th", "td"),
    *("details", "summary", "div", "span"),
}
"""Elements that run nothing, besides those of formulas, which begin with m."""
ADDRESS = re.compile(r"(?i)\s*(//|[a-z][a-z+.-]*\s*:)")
PICTURE = re.compile(r"data:image/(svg\+xml|png|jpeg|webp);base64,[A-Za-z0-9+/=]*")
PAYLOADS = [
    f'<img/src="x"/onerror="{ALERT}">',
    f"<img src=x onerror={ALERT}>",
    f"<script>{ALERT}</script>",
    f"<svg onload={ALERT}>",
    f"<svg><script>{ALERT}</script></svg>",
    f'<iframe src="javascript:{ALERT}">',
    f'<a href="javascript:{ALERT}">x</a>',
    f"<style>@import 'http://evil/x.css'</style><b onclick={ALERT}>",
    f"<annotation-xml encoding='text/html'><img src=x onerror={ALERT}></annotation-xml>",
    f"</mtext></math><img src=x onerror={ALERT}>",
    f"<mglyph><style><img src=x onerror={ALERT}>",
    f"&lt;img src=x onerror={ALERT}&gt;",
    f"&amp;lt;img src=x onerror={ALERT}&amp;gt;",
    f"javascript:{ALERT}",
    f"java\tscript:{ALERT}",
    "data:text/html,<script>alert(1)</script>",
    "http://evil/t.png",
    "//evil/t.png",
    "position:fixed;inset:0;background:url(http://evil/t.png)",
    f'x" onmouseover="{ALERT}',
    f"x' autofocus onfocus='{ALERT}",
]
LATEX = [
    *(r"\text{%s}", r"\mbox{%s}", r"\hbox{%s}", r"\fbox{%s}", r"\textbf{%s}", r"\tag{%s}"),
    *(r"\href{%s}{x}", r"\style{%s}{x}", r"\class{%s}{x}", r"\color{%s}{x}", r"\color{%s} x"),
    *(r"\colorbox{%s}{x}", r"\fcolorbox{%s}{red}{x}", r"\operatorname{%s}", r"\mathrm{%s}"),
    *(r"\hspace{%s}", r"\rule{%s}{1em}", r"\raisebox{%s}{x}", r"\unicode{%s}", r"\frac{%s}{2}"),
    *(r"\sqrt[%s]{x}", r"\overset{%s}{x}", r"\begin{array}{%s}a\end{array}", r"\llap{%s}"),
    *(r"\left%s x\right)", r"\genfrac{%s}{)}{1pt}{}{a}{b}", r"\xrightarrow{%s}", r"%s", r"\%s"),
    *(r"\newcommand{\evil}{%s}\evil", r"\mathop{%s}", r"\phantom{%s}", r"\substack{%s}"),
]
MARKDOWN = [
    *("$%s$", "$$%s$$", "%s", "`%s`", "![x](%s)", "[x](%s)", "[x](<%s>)", '![x](y "%s")', "<%s>"),
    *("![%s](x.png)", "[%s](https://a.b)", '[x](https://a.b "%s")', "> %s", "# %s", "- %s"),
    *(
        "|a|\n|:-:|\n|%s|",
        "```%s\nx\n```",
        "```\n%s\n```",
        "[x]: %s\n\n[x] ![x]",
        "x[^1]\n\n[^1]: %s",
    ),
    *("{{your choice or %s}}", "![{{your choice}}](%s)", "[x](%s)![x](%s)", "![![x](%s)](%s)"),
]
formulas = st.builds(
    lambda command, payload: command.replace("%s", payload),
    *map(st.sampled_from, (LATEX, PAYLOADS)),
)
nested = st.recursive(
    formulas,
    lambda inner: st.builds(lambda c, i: c.replace("%s", i), st.sampled_from(LATEX), inner),
)
texts = st.builds(
    lambda place, words: place.replace("%s", words),
    st.sampled_from(MARKDOWN),
    st.one_of(nested, st.sampled_from(PAYLOADS), st.text(max_size=20)),
)


class Elements(HTMLParser):
    """All elements of a page, with their attributes."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.found = list[tuple[str, dict[str, str]]]()
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, {name: value or "" for name, value in attrs}))


def assert_harmless(html: str) -> None:
    """Nothing runs, nothing is loaded from anywhere, nothing lies over the page."""
    for element, attributes in Elements(html).found:
        assert element in HARMLESS or re.fullmatch("m[a-z]+|none", element), html
        assert element != "mglyph"
        for name, value in attributes.items():
            assert not name.startswith("on") and name in {*ALLOWED[element], "rel"}, html
            if name == "href":
                assert element == "a" and value.startswith("https://"), html
            elif name == "src":
                assert element == "img" and PICTURE.fullmatch(value), html
            elif name == "style":
                assert re.fullmatch("text-align:[a-z]+", value), html
            elif name not in ("alt", "title", "xmlns"):
                assert "(" not in value and not ADDRESS.match(value), html


def shown(text: str, home: Path = Path("/nowhere")) -> list[str]:
    """The HTML of a text in a block of TOML, in the text of a step, and filled with an answer."""
    pieces = list[str]()
    with contextlib.suppress(TextError):
        pieces.append(to_html(text))
    for fold in ("", text):
        read = read_prose(reader(), reader().parse(text), home, "five_bar", fold)
        pieces += [read.html]
    option = Option(pieces[0], "no", key="a")
    step = Step("predict", "x", 1, (Choice(pieces[0], (option, option)), Text(read.html)))
    notes = notes_with(answers={"0": Answer(option=0)})
    pieces += [filled(read.html, [step], 0, notes, ENGLISH), marked(read.html, [step], 0)]
    return [*pieces, folded(text, read.html)]


@given(texts)
@example(rf"$\text{{{PAYLOADS[0]}}}$")
@example("![{{your choice}}](x.png) {{your choice}}")
def test_no_text_of_a_lesson_runs_or_loads_anything(text: str) -> None:
    for html in shown(text):
        assert_harmless(html)


@given(st.one_of(texts, nested, st.sampled_from(PAYLOADS), st.text()))
def test_whatever_a_converter_writes_is_harmless_once_it_is_safe(html: str) -> None:
    """The last barrier alone, as if markdown and LaTeX let everything through."""
    cleaned = safe(html)
    assert_harmless(cleaned)
    assert safe(cleaned) == cleaned
    assert not list(refused(cleaned))


@pytest.mark.parametrize("command", ["text", "mbox", "hbox", "fbox"])
def test_what_stands_in_a_formula_as_text_is_text(command: str) -> None:
    html = to_html(rf"$\{command}{{a<b and c&d}} < 3$")
    assert "a&lt;b\xa0and\xa0c&amp;d" in html.replace("&nbsp;", "\xa0")


def test_the_built_in_course_stays_as_it_is_and_its_formulas_are_not_translated() -> None:
    """All that is on the list is needed, and nothing that is needed is missing."""
    course, problems = built_in_course()
    assert problems == []
    seen = set[str]()
    for versions in course.lessons.values():
        for lesson in versions.values():
            for step in lesson.steps:
                for block in step.blocks:
                    for element, attributes in Elements(getattr(block, "html", "")).found:
                        seen.add(element)
                        if element in ("math", "code", "pre"):
                            assert attributes["translate"] == "no"
    assert {"math", "mover", "mfrac", "mtable", "img", "table", "details", "code"} <= seen


def test_a_mark_can_name_a_symbol() -> None:
    mark = '<span data-symbol="xi_1">x</span>'
    assert safe(mark) == mark
    assert safe('<span data-symbol="x onclick=y">x</span>') == "<span>x</span>"


OWN = "a file in the lesson's folder"
WRONG = {
    "![x](http://evil/t.png)": OWN,
    "![x](https://evil/t.png)": OWN,
    "![x](HTTP://evil/t.png)": OWN,
    "![x](//evil/t.png)": OWN,
    "![x](data:image/png;base64,AAAA)": OWN,
    "![x](file:///etc/passwd)": OWN,
    "[x](javascript:alert(1))": "an address begins with https://",
    "![x](data:text/html,x)": OWN,
    "![x](/etc/passwd)": OWN,
    "![x](../../secret.svg)": "not in the lesson's folder",
    "![x](%2e%2e/%2e%2e/secret.svg)": OWN,
    "[![x](http://evil/t.png)](https://a.b)": OWN,
    "[x](http://evil)": "it must begin with https://",
    r"$\href{javascript:alert(1)}{x}$": "href",
    r"$\style{position:fixed}{x}$": "style",
    r"$\class{evil}{x}$": "class",
    "```fold More\n![x](http://evil/t.png)\n```": OWN,
}


@pytest.mark.parametrize(("text", "said"), WRONG.items())
def test_what_is_removed_is_told_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    whole = LESSON.replace("Which one *waits*?", f"Which one?\n\n{text}\n\nThis")
    with pytest.raises(LessonError) as caught:
        read_lesson(write_lesson(tmp_path, whole))
    assert [said in str(problem) for problem in caught.value.problems] == [True]
    line = whole[: whole.index(text)].count("\n") + 1
    assert caught.value.problems[0].line in (line, line + 1)


@pytest.mark.parametrize("place", ["Draw the distance.", "The key H.", "And?", "yes", "Hold back."])
@pytest.mark.parametrize(
    "text",
    [
        *("![x](http://evil/t.png)", "![x](held.svg)", "![x](data:image/png;base64,AAAA)"),
        *("[x](http://evil)", "[x](lab:hold)", r"$\\href{https://evil}{x}$"),
    ],
)
def test_blocks_have_no_pictures_and_no_other_links(tmp_path: Path, place: str, text: str) -> None:
    whole = LESSON.replace(f'"{place}"', f'"{text}"')
    with pytest.raises(LessonError) as caught:
        read_lesson(write_lesson(tmp_path, whole))
    (problem,) = caught.value.problems
    begin = whole[: whole.index(text)].count("\n") + 1
    assert begin - 8 <= problem.line <= begin


@pytest.mark.parametrize("latex", ["x" * 5000 + "{", r"\bogus" * 3000, "a" * 5000 + r"\left("])
def test_a_long_formula_is_quoted_in_part(latex: str) -> None:
    with pytest.raises(TextError) as refusal:
        mathml(latex, {})
    assert len(str(refusal.value)) < 300
