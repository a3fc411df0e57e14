"""A class in real browsers: a teacher's tab and two students'."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import unescape

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, FloatRect, Locator, Page

from onpath.app.classroom.classroom import Classroom, Display
from onpath.app.classroom.results import asked_at, prediction_at
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from onpath.lessons.progress import given_to
from onpath.lessons.schema import Choice
from tests.support.axe import violations
from tests.support.browser import Tab, wait_for

LESSON, CHOICE = "01-path-or-timetable", 4
NAMES = ("Ada", "<img src=x onerror=1>")
SMALLEST = """() => Math.min(...[...document.querySelectorAll(".op-class *")]
    .filter(each => each.checkVisibility())
    .filter(each => [...each.childNodes].some(node => node.nodeType === 3 && node.data.trim()))
    .map(each => [each, each.getScreenCTM?.() ?? {a: 1, b: 0}])
    .map(([each, to]) => [each.closest("math") ?? each, to]) // its indices are smaller
    .map(([each, to]) => parseFloat(getComputedStyle(each).fontSize) * Math.hypot(to.a, to.b)))"""
IN_SIGHT = """box => {
    const {left, top, width, height} = box.getBoundingClientRect()
    return box.contains(document.elementFromPoint(left + width / 2, top + height / 2))
}"""
CLASS = re.compile("^(Class|Klasse)$")
WINDOWS = ((1280, 800), (800, 560), (800, 560))


@dataclass
class Class:
    """The tabs of a teacher and two students."""

    room: Classroom
    teacher: Tab
    students: list[Tab]

    @property
    def page(self) -> Locator:
        """What the teacher's tab shows of the class."""
        return self.teacher.page.get_by_role("main").get_by_role("region", name=CLASS)

    def open(self, tab: str) -> None:
        """Open one of the tabs of the teacher's page."""
        found = self.page.get_by_role("tab", name=tab, exact=True)
        if found.get_attribute("aria-selected") != "true":
            found.click()

    def press(self, name: str | re.Pattern[str]) -> None:
        """Press a button of the teacher's page."""
        self.page.get_by_role("button", name=name, exact=isinstance(name, str)).click()


class InLecture(LabServer):
    """A server that other devices reach."""

    @property
    def site(self) -> str:
        return "http://192.0.2.7:8080"


@pytest.fixture(scope="module")
def tabs(browser: Browser) -> Iterator[Class]:
    room = Classroom()
    server = InLecture("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    made: list[Tab] = []
    for width, height in WINDOWS:
        context = browser.new_context(viewport={"width": width, "height": height})
        if not made:
            key = f"viser-user:onpath_teacher_{room.code}"
            context.add_init_script(f"localStorage['{key}'] = '{room.admit(room.key, 'lab')}'")
        made.append(Tab(server, context, draws=False, path=class_address(room.code)))
        made[-1].ask(c.SetRunning(False))
    for student, name in zip(made[1:], NAMES, strict=True):
        card = student.page.get_by_role("dialog", name="Class")
        card.get_by_role("textbox", name="Nickname").fill(name)
        card.get_by_role("button", name="Join the class").click()
        card.wait_for(state="detached")
    yield Class(room, made[0], made[1:])
    assert [tab.errors for tab in made] == [[], [], []]
    for tab in made:
        tab.page.context.close()
    server.stop()


def placed(what: Locator) -> FloatRect:
    """Where something is on the page, [px]."""
    box = what.bounding_box()
    assert box is not None
    return box


def text_of(html: str) -> str:
    """The text of an HTML that has no other markup than of words."""
    return unescape(re.sub("<[^>]*>", "", html))


def signs_of(html: str) -> str:
    """The text of an HTML without spaces, which a formula has only where it is drawn."""
    return "".join(text_of(html).split())


def smallest(page: Page) -> float:
    """Size of the smallest letters in what the teacher's page shows of the class, [px]."""
    return page.evaluate(SMALLEST)


def test_a_class_joins_is_frozen_led_and_watched_and_its_record_comes_down(tabs: Class) -> None:
    teacher, (first, second) = tabs.page, tabs.students
    teacher.get_by_role("tab", name="Class", exact=True).wait_for()
    assert teacher.get_by_role("tabpanel").count() == 0  # nothing but what acts on the class
    tabs.open("Class")
    for name in NAMES:
        teacher.get_by_role("cell", name=name, exact=True).wait_for()
    assert tabs.teacher.page.locator("img[src=x]").count() == 0

    tabs.press("Freeze all labs")
    for student in tabs.students:
        wait_for(lambda student=student: student.lab.frozen)
    tabs.press("Let all labs go on")
    for student in tabs.students:
        wait_for(lambda student=student: not student.lab.frozen)

    for step in (1, 2):  # nobody was sent the first one yet
        tabs.press(re.compile(f"^Next for all: {step}"))
    for student, height in ((first, 40.0), (second, 10.0)):
        student.page.get_by_role("heading", name="Draw what the tracker does").wait_for()
        student.ask(c.Predict(times=(0.0, 4.0, 8.0), values=(0.0, height, 0.0)))
    tabs.open("Predictions")
    answers = teacher.get_by_role("tabpanel", name="Predictions")
    curves = answers.locator("svg:has(text) polyline")
    teacher.get_by_text("2 of 2 here have answered").wait_for()
    assert curves.count() == 0  # nobody follows the majority
    teacher.get_by_role("switch", name="Show the answers").click()
    wait_for(lambda: curves.count() == 2)
    teacher.get_by_role("switch", name="Show the truth").click()
    wait_for(lambda: curves.count() == 4)  # though nobody has run it
    teacher.get_by_role("switch", name="Show the truth").click()
    wait_for(lambda: curves.count() == 2)

    tabs.open("Class")
    teacher.get_by_role("combobox", name="Follow").select_option(label="1. Ada")
    teacher.get_by_text("This is the lab of Ada").wait_for()
    wait_for(lambda: not tabs.teacher.page.evaluate("onpathLab.lab.own"))
    tabs.press("My own lab")
    wait_for(lambda: tabs.teacher.page.evaluate("onpathLab.lab.own"))

    tabs.open("Record")
    with tabs.teacher.page.expect_download() as coming:
        tabs.press("Class record (XLSX)")
    assert re.fullmatch(r"onpath-class-[-0-9]{10}\.xlsx", coming.value.suggested_filename)
    tabs.press("End the class")
    question = tabs.teacher.page.get_by_role("dialog", name="End the class")
    question.get_by_role("button", name="No").click()
    question.wait_for(state="detached")
    assert len(tabs.room.members()) == 2


def test_an_answer_that_got_lost_is_sent_by_the_next_page_and_counts_once(tabs: Class) -> None:
    student, room = tabs.students[0], tabs.room
    room.push(TakeStep(LESSON, CHOICE), [str(CHOICE)])
    option = student.page.get_by_role("radio").first
    option.wait_for()
    option.check()
    student.page.evaluate("onpathLab.send = () => {}")  # whatever it says gets lost
    student.page.get_by_role("button", name="Commit to this prediction").click()
    student.page.get_by_text("Sending …").wait_for()
    assert student.lab.lessons.answer() is None
    student.page.reload()
    student.page.get_by_text("Sent.").wait_for()
    run = student.lab.lessons
    assert len(given_to(run.notes, str(CHOICE))) == 1 and run.is_voting
    assert student.page.get_by_role("button", name=re.compile("^Next")).count() == 0
    room.close(room.open_votes)
    student.page.get_by_role("button", name=re.compile("^Next")).first.wait_for()


def test_who_comes_with_another_browser_gets_the_own_place_back_from_the_teacher(
    tabs: Class, browser: Browser
) -> None:
    before, room = tabs.students[0], tabs.room
    known = before.lab.lessons.progress
    before.close()
    wait_for(lambda: not next(iter(room.members().values())).connected)
    context = browser.new_context(viewport={"width": 800, "height": 560})
    tab = Tab(before.server, context, draws=False, path=class_address(room.code))
    card = tab.page.get_by_role("dialog", name="Class")
    card.get_by_role("textbox", name="Nickname").fill("ada")
    card.get_by_role("button", name="Join the class").click()
    card.get_by_text("Ada is away. Is that you?").wait_for()
    card.get_by_role("button", name="That is me: ask my teacher").click()
    card.get_by_text("Your teacher has been asked").wait_for()
    assert set(room.claims.values()) == {next(iter(room.members()))}
    tabs.open("Class")
    tabs.press("Yes, give the place back")
    wait_for(lambda: [each.name for each in room.members().values()] == list(NAMES))
    wait_for(lambda: next(iter(room.members().values())).connected)
    assert next(iter(room.members().values())).progress.notes == known.notes
    tab.page.get_by_role("button", name=re.compile("Ada · ")).first.wait_for()
    assert tab.errors == []
    tabs.students[0] = tab


def test_a_student_deletes_everything_of_their_own_from_their_browser(tabs: Class) -> None:
    student, room = tabs.students[1], tabs.room
    code = next(code for code, each in room.members().items() if each.name == NAMES[1])
    student.page.get_by_role("button", name=f"{NAMES[1]} · ").click()
    student.page.get_by_role("button", name="Delete everything that is stored of me").click()
    sure = student.page.get_by_role("dialog", name="Delete everything that is stored of me")
    sure.get_by_role("button", name="Yes").click()
    wait_for(lambda: code not in room.members())
    wait_for(lambda: student.server.registry.find(code) is None)
    wait_for(
        lambda: student.page.evaluate("onpathLab.connected && onpathLab.seat.membership") == "guest"
    )
    assert [each.name for each in room.members().values()] == [NAMES[0]]


PROJECTORS = [(1280, 800), (1366, 768), (1920, 1080)]
SHARE = 0.55  # of a projector's width that the robots have at least
STAGE = """() => [...document.querySelectorAll("canvas[data-engine]")]
    .map(each => each.getBoundingClientRect().width / innerWidth)"""


@pytest.mark.thorough
def test_a_projection_is_stage_numbers_and_question_beside_what_leads_the_class(
    tabs: Class,
) -> None:
    tabs.open("Class")
    wait_for(lambda: NAMES[0] in tabs.page.inner_text())
    present(tabs, True)
    for width, height in PROJECTORS:
        tabs.teacher.page.set_viewport_size({"width": width, "height": height})
        for step in (0, 1, 4):  # a text, a drawing and options
            assert_projected(tabs, step)
    present(tabs, False)


def assert_projected(tabs: Class, step: int) -> None:
    """Assert that all of a step that a class looks at is seen, in large type and without names."""
    page, room = tabs.teacher.page, tabs.room
    asked = prediction_at(tabs.teacher.lab.lessons.course.lesson(LESSON, "en"), step)
    for visible in (False, True):
        room.show(Display(LESSON, step, shown=visible))
        picture = tabs.page.locator(".op-class").filter(visible=True)
        head = picture.locator("p").first
        told = "Two robots, one circle" if asked is None else text_of(asked[1].question)
        wait_for(lambda told=told, head=head: told in head.inner_text())
        wait_for(lambda: min(page.evaluate(STAGE)) >= SHARE)
        wait_for(lambda head=head: head.evaluate(IN_SIGHT))
        wait_for(lambda: smallest(page) >= 24)
        if asked is None:
            code = tabs.page.get_by_role("img", name="QR code of this address")
            assert placed(code.filter(visible=True))["width"] >= 200
        elif isinstance(asked[1], Choice):
            for option in asked[1].options:
                line = picture.get_by_text(text_of(option.text))
                wait_for(lambda line=line: line.evaluate(IN_SIGHT))
        elif visible:
            wait_for(lambda: picture.locator("svg:has(text)").first.evaluate(IN_SIGHT))
        offered = [tabs.page.get_by_role("button", name=re.compile("^Next for all"))]
        if asked is not None:
            switches = "Show the answers", "Show the truth"
            offered.append(tabs.page.get_by_role("button", name="Ask this again"))
            offered += [tabs.page.get_by_role("switch", name=name) for name in switches]
        for each in offered:
            assert each.evaluate(IN_SIGHT)
        strip = placed(page.locator("#op-strip"))
        for reading in page.locator("#op-strip .reading").all():
            box = placed(reading)
            assert box["y"] + box["height"] <= strip["y"] + strip["height"] + 1
            number = reading.locator(".number")
            assert number.evaluate("each => parseFloat(getComputedStyle(each).fontSize)") >= 60
        assert NAMES[0] not in tabs.page.inner_text()


HIDDEN = """box => [...box.querySelectorAll("p:first-child, div:has(> b)")].filter(each => {
    const {left, top, bottom} = each.getBoundingClientRect()
    return ![top + 3, bottom - 3].every(y => box.contains(document.elementFromPoint(left + 5, y)))
}).map(each => each.textContent)"""  # a question and its options, from end to end


FIT = """([told, robots]) => {
    const box = name => document.querySelector(name).getBoundingClientRect()
    const asked = box(".asked"), {width, height} = box(".robots")
    if (!document.querySelector(".asked").textContent.includes(told)) return false
    const isIn = ({right, bottom}) => right <= asked.right + 1 && bottom <= asked.bottom + 1
    const all = [...document.querySelectorAll(".asked *")].map(each => each.getBoundingClientRect())
    return all.every(isIn) && height >= robots * innerHeight && width >= robots * innerWidth
}"""


def test_a_wall_shows_all_of_a_long_answer_and_large_robots(tabs: Class, browser: Browser) -> None:
    port, course = tabs.teacher.server.server.get_port(), tabs.teacher.lab.lessons.course
    page = browser.new_page()
    page.goto(f"http://127.0.0.1:{port}{class_address(tabs.room.code)}wall")
    page.locator(".join svg").wait_for()
    last = len(course.lesson(LESSON, "en").steps) - 1
    quiz = next(at for at in range(last, 0, -1) if asked_at(course.lesson(LESSON, "en"), at))
    cases = [(LESSON, CHOICE, "A ", 0.3), (LESSON, quiz, "A ", 0.3)]
    cases += [(test, 1, "Form B", 0.0) for test in course.tests]
    for lesson, step, told, robots in cases:
        tabs.room.show(Display(lesson, step, shown=True))
        for width, height in ((1280, 720), *PROJECTORS):
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_function(FIT, arg=[told, robots])
    page.close()


@pytest.mark.thorough
def test_every_question_of_the_course_fits_on_a_projection(tabs: Class) -> None:
    page, room, course = tabs.teacher.page, tabs.room, tabs.teacher.lab.lessons.course
    page.set_viewport_size({"width": 1366, "height": 768})
    present(tabs, True)
    picture = tabs.page.locator(".op-class").filter(visible=True).first

    def shown() -> str:
        return picture.inner_html() if picture.count() else ""

    for language in ("de", "en"):
        tabs.teacher.ask(c.SetLanguage(language))
        page.locator(f"html[lang={language}]").wait_for()
        for name in [*course.lessons, *course.tests]:
            lesson = course.lesson(name, language)
            for step in range(len(lesson.steps)):
                asked = prediction_at(lesson, step)
                if asked is not None and asked[0] == step:
                    room.show(Display(name, step))
                    told = signs_of(asked[1].question)
                    wait_for(lambda told=told: told in signs_of(shown()))
                    assert picture.evaluate(HIDDEN) == []
                    assert smallest(page) >= 24
    present(tabs, False)


def present(tabs: Class, on: bool) -> None:
    """Switch large type on or off; then, the class's step is shown in a window of usual size."""
    page = tabs.teacher.page
    tabs.teacher.ask(c.Set("presenting", on))
    wait_for(lambda: page.evaluate("document.documentElement.classList.contains('op-large')") == on)
    tab = tabs.page.get_by_role("tab").nth(1)
    wait_for(lambda: tab.get_attribute("aria-selected") == str(on).lower())
    if not on:
        page.set_viewport_size({"width": WINDOWS[0][0], "height": WINDOWS[0][1]})


@pytest.mark.thorough
def test_axe_finds_nothing_serious_on_the_teachers_page(tabs: Class) -> None:
    tabs.teacher.page.get_by_role("tab", name="Predictions").wait_for()
    assert violations(tabs.teacher) == []
