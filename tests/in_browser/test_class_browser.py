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
from onpath.app.classroom.results import prediction_at
from onpath.app.common.access_codes import shown
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.page.teacher_page import TeacherPage
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from onpath.lessons.schema import Choice
from tests.support.axe import violations
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

LESSON = "01-path-or-timetable"
HOSTILE = "<img src=x onerror=1>"
SMALLEST = """() => Math.min(...[...document.querySelectorAll(".op-class *")]
    .filter(each => each.checkVisibility())
    .filter(each => [...each.childNodes].some(node => node.nodeType === 3 && node.data.trim()))
    .map(each => [each, each.getScreenCTM?.() ?? {a: 1, b: 0}])
    .map(([each, to]) => parseFloat(getComputedStyle(each).fontSize) * Math.hypot(to.a, to.b)))"""
IN_SIGHT = """box => {
    const {left, top, width, height} = box.getBoundingClientRect()
    return box.contains(document.elementFromPoint(left + width / 2, top + height / 2))
}"""
WINDOWS = ((1100, 700), (800, 560), (800, 560))


@dataclass
class Class:
    """The tabs of a teacher and two students."""

    room: Classroom
    teacher: Tab
    students: list[Tab]


class InLecture(LabServer):
    """A server that other devices reach."""

    @property
    def site(self) -> str:
        return "http://192.0.2.7:8080"


@pytest.fixture(scope="module")
def tabs(browser: Browser) -> Iterator[Class]:
    room = Classroom()
    loop_cache = LoopCache()
    server = InLecture("127.0.0.1", 0, loop_cache, ServerOptions(classrooms=[room]))
    made: list[Tab] = []
    for width, height in WINDOWS:
        context = browser.new_context(viewport={"width": width, "height": height})
        made.append(Tab(server, context, draws=False, path=class_address(room.code)))
        made[-1].ask(c.SetRunning(False))
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


def smallest(page: Page) -> float:
    """Size of the smallest letters in what the teacher's page shows of the class, [px]."""
    return page.evaluate(SMALLEST)


def fill(tab: Tab, label: str, text: str) -> None:
    """Type into a text field."""
    box = tab.field(label)
    box.fill(text)
    box.press("Enter")
    tab.blur()


UNCORRECTED = ["autocapitalize", "autocorrect", "spellcheck"]  # by a phone
UNCORRECTED_CODE = ["off", "off", "false"]


def test_students_join_and_the_teacher_sees_them(tabs: Class) -> None:
    for student, name in zip(tabs.students, ("Ada", HOSTILE), strict=True):
        fill(student, "Nickname", name)
        student.press("Join the class")
        student.page.get_by_text("You are in the class as").wait_for()
    teacher = tabs.teacher
    teacher.open("Teacher…")
    for label in ("Nickname", "Teacher's key"):
        assert teacher.field(label).get_attribute("aria-required") == "true"
        left = [teacher.field(label).get_attribute(name) for name in UNCORRECTED]
        assert left == (UNCORRECTED_CODE if label != "Nickname" else [None] * len(UNCORRECTED))
    fill(teacher, "Teacher's key", "2222-2222-2222")
    teacher.press("Open the teacher's page")
    refusal = teacher.page.get_by_role("alert").filter(has_text="this is not the teacher's key")
    refusal.wait_for()
    assert placed(refusal)["y"] > placed(teacher.button("Open the teacher's page"))["y"]
    wait_for(lambda: refusal.evaluate(IN_SIGHT))
    fill(teacher, "Teacher's key", shown(tabs.room.key))
    teacher.press("Open the teacher's page")
    teacher.page.get_by_text("2 in the class").first.wait_for()
    teacher.wait_until_built()
    for name in ("Ada", HOSTILE):
        teacher.page.get_by_role("cell", name=name, exact=True).wait_for()
    assert teacher.page.locator("img[src=x]").count() == 0


def test_frozen_labs_are_paused_and_say_so(tabs: Class) -> None:
    for student in tabs.students:
        student.ask(c.SetRunning(True))
    tabs.teacher.press("Freeze all labs")
    for student in tabs.students:
        wait_for(lambda student=student: "look to the front" in student.said())
        box = student.page.locator("#op-message")
        assert box.evaluate("each => parseFloat(getComputedStyle(each).fontSize)") >= 24
        dimmed = "getComputedStyle(document.body, '::before').backgroundColor"
        assert student.page.evaluate(dimmed) == "rgba(15, 23, 42, 0.6)"
        student.page.get_by_text("paused").first.wait_for()
        before = student.simulation.time
        asked = student.lab.asked
        button = student.button("Run")
        assert button.get_attribute("aria-disabled") == "true"
        assert "look to the front" in (button.get_attribute("title") or "")
        assert not student.page.locator("#op-strip .transport select").is_enabled()
        button.focus()
        student.page.keyboard.press("Enter")
        wait_for(lambda student=student, asked=asked: student.lab.asked > asked)
        assert student.simulation.running and student.simulation.time == before
        assert student.lab.notice[1] == "stop"
        assert student.page.evaluate(dimmed) == "rgba(15, 23, 42, 0.6)"
    tabs.teacher.press("Let all labs go on")
    for student in tabs.students:
        before = student.simulation.time
        wait_for(lambda student=student, before=before: student.simulation.time > before)
        student.wait_for_no_message()
        button = student.button("Pause")
        wait_for(lambda button=button: button.get_attribute("aria-disabled") is None)
        assert "look to the front" not in (button.get_attribute("title") or "")
        student.ask(c.SetRunning(False))


def test_a_pushed_step_opens_and_predictions_show_without_names(tabs: Class) -> None:
    teacher, (first, second) = tabs.teacher, tabs.students
    teacher.page.get_by_role("tab", name="Predictions").click()
    teacher.field("Step").click()
    teacher.page.get_by_role("option", name=re.compile("^2. Predict")).click()
    teacher.press("Open this step for all")
    for student in (first, second):
        student.page.get_by_role("heading", name="Draw what the tracker does").wait_for()
    for student, height in ((first, 40.0), (second, 10.0)):
        student.ask(c.Predict(times=(0.0, 4.0, 8.0), values=(0.0, height, 0.0)))
    picture = teacher.page.locator(".op-class").filter(visible=True)
    curves = picture.locator("svg:has(text) polyline")
    picture.get_by_text("2 predicted").wait_for()
    assert curves.count() == 0  # nobody follows the majority
    teacher.page.get_by_label("Show the answers").click()
    wait_for(lambda: curves.count() == 2)
    assert "Ada" not in picture.inner_text()
    assert all(not student.lab.lessons.progress.notes[LESSON].truths for student in (first, second))
    teacher.page.get_by_text("Show the truth").click()
    wait_for(lambda: curves.count() == 4)  # though nobody has run it
    teacher.page.get_by_text("Show the truth").click()
    wait_for(lambda: curves.count() == 2)


def test_one_of_the_sketches_is_picked_by_its_number(tabs: Class) -> None:
    teacher = tabs.teacher
    picture = teacher.page.locator(".op-class").filter(visible=True)
    curves = picture.locator("svg:has(text) polyline")
    fill(teacher, "Sketches to show", "2")
    wait_for(lambda: curves.count() == 1)
    assert picture.locator("svg text[font-weight='700']").all_text_contents() == ["2"]
    fill(teacher, "Sketches to show", "")
    wait_for(lambda: curves.count() == 2)


def test_a_class_is_kept_within_steps_until_the_teacher_goes_on(tabs: Class) -> None:
    teacher, (first, second) = tabs.teacher, tabs.students
    teacher.page.get_by_role("tab", name="Pace").click()
    bars = teacher.page.locator(".op-class").filter(visible=True)
    bars.get_by_text("2", exact=True).wait_for()  # students, in step 2
    teacher.field("To step").click()
    teacher.page.get_by_role("option", name=re.compile("^2. Predict")).click()
    teacher.press("Keep the class within these steps")
    for student in (first, second):
        student.page.get_by_text("The class waits here").wait_for()
        student.wait_until_built()
        assert student.button("Next").count() == student.button("Free lab").count() == 0
        assert student.button("Let it happen").count() == 0 and student.button("Back").count() == 1
    first.page.keyboard.press("PageDown")
    wait_for(lambda: "within steps 1 to 2" in first.said())
    assert first.lab.lessons.index == 1
    teacher.page.get_by_text("may go from step 1 to 2").wait_for()
    teacher.press("Let the class go anywhere")
    for student in (first, second):
        student.button("Let it happen").wait_for()
    teacher.page.get_by_text("The class may go anywhere").wait_for()


def test_gains_of_all_are_points_that_can_be_read_from_afar(tabs: Class) -> None:
    teacher, (first, second) = tabs.teacher, tabs.students
    teacher.page.get_by_role("tab", name="Gains").click()
    shown = teacher.page.get_by_role("img", name="Everyone's gains")
    first.ask(c.Set("K1", 900.0))
    wait_for(lambda: shown.locator("circle").count() == 2)
    second.ask(c.Set("K1", 900.0))
    wait_for(lambda: shown.locator("circle").count() == 1)
    page = teacher.page
    page.set_viewport_size({"width": 1920, "height": 1080})
    present(tabs, True)
    for tab in ("Gains", "Pace"):
        page.get_by_role("tab", name=tab).click()
        wait_for(lambda: smallest(page) >= 24)
    present(tabs, False)
    for student in (first, second):
        student.ask(c.BeginStepAnew())


def test_next_and_back_lead_the_whole_class_and_tell_where(tabs: Class) -> None:
    teacher, page = tabs.teacher, tabs.teacher.page
    titles = [step.title for step in tabs.students[0].lab.lessons.course.lesson(LESSON, "en").steps]
    for label, index in ((f"Next for all: 3. See: {titles[2]}", 2), ("Back for all", 1)):
        page.get_by_role("button", name=label, exact=True).click()
        for student in tabs.students:
            student.page.get_by_role("heading", name=titles[index]).wait_for()
        wait_for(
            lambda index=index: teacher.field("Step").input_value().startswith(f"{index + 1}.")
        )
        assert not page.get_by_label("Show the answers").is_checked()
    for student in tabs.students:
        student.ask(c.BeginStepAnew())
    page.get_by_label("Show the answers").click()


def test_a_demonstration_is_played_on_the_teachers_stage_which_is_put_back(tabs: Class) -> None:
    teacher, page, room = tabs.teacher, tabs.teacher.page, tabs.room
    teacher.ask(c.ChoosePath("clover"))
    play = page.get_by_role("button", name="Play the demonstration here")
    back = page.get_by_role("button", name="Put my own set-up back")
    where = room.display
    room.show(Display(LESSON, 0))
    play.wait_for(state="hidden")
    room.show(Display(LESSON, 1))
    for leave in (back, page.get_by_role("button", name=re.compile("^Next for all"))):
        play.click()
        wait_for(lambda: teacher.lab.lessons.playing)
        assert teacher.simulation.editor.design.name == "circle"
        leave.click()
        wait_for(lambda: teacher.simulation.editor.design.name == "clover")
        back.wait_for(state="hidden")
    room.push(TakeStep(LESSON, where.step))
    for student in tabs.students:
        student.ask(c.BeginStepAnew())
    room.show(where)


PROJECTORS = [(1280, 800), (1366, 768), (1920, 1080)]
SHARE = 0.55  # of a projector's width that the robots have at least
STAGE = """() => [...document.querySelectorAll("canvas[data-engine]")]
    .map(each => each.getBoundingClientRect().width / innerWidth)"""


@pytest.mark.parametrize("size", PROJECTORS)
@pytest.mark.parametrize("step", [0, 1, 4])  # a text, a drawing and options
def test_a_projection_is_stage_numbers_and_question_beside_what_leads_the_class(
    tabs: Class, size: tuple[int, int], step: int
) -> None:
    page, room = tabs.teacher.page, tabs.room
    page.set_viewport_size({"width": size[0], "height": size[1]})
    present(tabs, True)
    asked = prediction_at(tabs.students[0].lab.lessons.course.lesson(LESSON, "en"), step)
    for visible in (False, True):
        room.show(Display(LESSON, step, shown=visible))
        picture = page.locator(".op-class").filter(visible=True)
        head = picture.locator("p").first
        told = "Two robots, one circle" if asked is None else text_of(asked[1].question)
        wait_for(lambda told=told, head=head: told in head.inner_text())
        wait_for(lambda: min(page.evaluate(STAGE)) >= SHARE)
        wait_for(lambda head=head: head.evaluate(IN_SIGHT))
        wait_for(lambda: smallest(page) >= 24)
        if asked is None:
            code = page.get_by_role("img", name="QR code of this address").filter(visible=True)
            assert placed(code)["width"] >= 200 and code.evaluate(IN_SIGHT)
        elif isinstance(asked[1], Choice):
            for option in asked[1].options:
                line = picture.get_by_text(text_of(option.text))
                assert line.evaluate(IN_SIGHT)
        elif visible:
            wait_for(lambda: picture.locator("svg:has(text)").first.evaluate(IN_SIGHT))
        for name in (re.compile("^Next for all"), "Ask this again"):
            assert page.get_by_role("button", name=name).evaluate(IN_SIGHT)
        for name in ("Show the answers", "Show the truth"):
            assert page.get_by_label(name).evaluate(IN_SIGHT)
        strip = placed(page.locator("#op-strip"))
        for reading in page.locator("#op-strip .reading").all():
            box = placed(reading)
            assert box["y"] + box["height"] <= strip["y"] + strip["height"] + 1
            number = reading.locator(".number")
            assert number.evaluate("each => parseFloat(getComputedStyle(each).fontSize)") >= 60
        assert page.get_by_role("button", name="Freeze all labs").count() == 0  # folded
        assert "Ada" not in page.locator("#root").inner_text()
    present(tabs, False)


HIDDEN = """box => [...box.querySelectorAll("p:first-child, div:has(> b)")].filter(each => {
    const {left, top, bottom} = each.getBoundingClientRect()
    return ![top + 3, bottom - 3].every(y => box.contains(document.elementFromPoint(left + 5, y)))
}).map(each => each.textContent)"""  # a question and its options, from end to end


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_question_of_the_course_fits_on_a_projection(tabs: Class, language: str) -> None:
    page, room, course = tabs.teacher.page, tabs.room, tabs.teacher.lab.lessons.course
    page.set_viewport_size({"width": 1366, "height": 768})
    present(tabs, True)
    tabs.teacher.ask(c.SetLanguage(language))
    page.locator(f"html[lang={language}]").wait_for()
    picture = page.locator(".op-class").filter(visible=True).first
    for name in [*course.lessons, *course.tests]:
        lesson = course.lesson(name, language)
        for step in range(len(lesson.steps)):
            asked = prediction_at(lesson, step)
            if asked is not None and asked[0] == step:
                room.show(Display(name, step))
                told = text_of(asked[1].question)
                wait_for(lambda told=told: picture.count() and told in picture.inner_text())
                assert picture.evaluate(HIDDEN) == []
                assert smallest(page) >= 24
    tabs.teacher.ask(c.SetLanguage("en"))
    page.locator("html[lang=en]").wait_for()
    present(tabs, False)


def test_a_page_says_that_it_presents_however_that_was_chosen(tabs: Class) -> None:
    for on in (True, False):
        tabs.teacher.ask(c.Set("presenting", on))  # as the window "Language, display" does
        wait_until_presenting(tabs, on)


def present(tabs: Class, on: bool) -> None:
    """Switch large type on or off; then, the class's step is shown in a window of usual size."""
    page = tabs.teacher.page
    page.get_by_role("tab", name="Predictions").click()
    box = page.get_by_label("Presentation: large type")
    if box.is_checked() != on:
        box.click()
    wait_until_presenting(tabs, on)
    if not on:
        page.set_viewport_size({"width": WINDOWS[0][0], "height": WINDOWS[0][1]})


def wait_until_presenting(tabs: Class, on: bool) -> None:
    """Return when the whole page has large type, or none; names are not shown while it has."""
    page = tabs.teacher.page
    first = page.get_by_role("tab", name="Predictions" if on else "Class", exact=True)
    is_large = "document.documentElement.classList.contains('op-large')"
    wait_for(lambda: page.evaluate(is_large) == on)
    wait_for(lambda: first.count() == 1 and first.get_attribute("aria-selected") == "true")
    page.get_by_role("tab", name="Predictions").click()
    box = page.get_by_label("Presentation: large type")
    wait_for(lambda: box.count() == 1 and box.is_checked() == on)


def test_a_setup_that_is_sent_leaves_the_lesson_where_it_is(tabs: Class) -> None:
    teacher, (first, _) = tabs.teacher, tabs.students
    teacher.ask(c.Set("K2", 33.0))
    teacher.press("Send my set-up to all")
    wait_for(lambda: "“Set up again” restores" in first.said())
    assert first.simulation.parameters.K2 == 33.0 and first.lab.lessons.index == 1
    assert first.page.get_by_role("heading", name="Draw what the tracker does").is_visible()
    first.press("Next")
    wait_for(lambda: first.lab.lessons.index == 2)
    teacher.page.get_by_text("Sent to 2 students").last.wait_for()
    teacher.page.get_by_role("tab", name="Class").click()
    teacher.page.get_by_text("Students who join receive the set-up").wait_for()
    teacher.press("Stop sending this to students who join")
    wait_for(lambda: tabs.room.orders.push is None)
    teacher.page.get_by_text("Students who join receive").wait_for(state="hidden")


def test_the_teacher_watches_a_lab_without_changing_it(tabs: Class) -> None:
    teacher, (first, _) = tabs.teacher, tabs.students
    teacher.page.get_by_role("tab", name="Class").click()
    teacher.field("Follow").click()
    teacher.page.get_by_role("option", name="1. Ada").click()
    teacher.page.get_by_text("This is the lab of Ada").wait_for()
    feed = teacher.scheduled.display
    assert isinstance(feed, LabFeed)
    view, (ada, _) = feed.page, tabs.room.members().values()
    assert isinstance(view, TeacherPage)
    wait_for(lambda: view._built[0] == ada.number)
    assert first.lab.lessons.lesson is not None
    assert teacher.button("Hold both back").count() == 0
    teacher.page.keyboard.press("h")
    teacher.answer()
    first.ask()
    assert not first.simulation.forces.held and not teacher.simulation.forces.held
    teacher.page.get_by_label("Tube", exact=True).filter(visible=True).click()
    wait_for(lambda: teacher.client.scene.get_handle_by_name("/show/tube") is not None)
    assert first.client.scene.get_handle_by_name("/show/tube") is None


def test_a_route_is_opened_for_all(tabs: Class) -> None:
    teacher = tabs.teacher
    teacher.page.get_by_role("tab", name="Predictions").click()
    teacher.field("Route").click()
    teacher.page.get_by_role("option", name=re.compile("20 minutes")).click()
    teacher.press("Open this route for all")
    for student in tabs.students:
        student.page.get_by_text(re.compile("20 minutes.*part 1 of 3")).wait_for()
        assert student.lab.lessons.progress.route == "2-lecture-20-minutes"


def test_a_teacher_who_reloads_is_still_the_teacher_and_at_the_same_place(tabs: Class) -> None:
    teacher = tabs.teacher
    teacher.field("Step").click()
    teacher.page.get_by_role("option", name=re.compile("^5. ")).click()
    wait_for(lambda: tabs.room.display.step == 4)
    before = teacher.field("Step").input_value()
    teacher.page.reload(wait_until="commit")
    teacher.page.get_by_text("2 in the class").first.wait_for()
    assert [member.name for member in tabs.room.members().values()] == ["Ada", HOSTILE]
    teacher.page.get_by_role("tab", name="Predictions").click()
    assert teacher.field("Step").input_value() == before


def unfold(tab: Tab) -> None:
    """Open the panel, which is folded in a step that has no controls."""
    column = tab.button("Expand column")
    if column.count():
        column.click()
    tab.button("Language, display").wait_for()


def test_a_student_is_renamed_and_removed_and_comes_in_again(tabs: Class) -> None:
    teacher, (first, second) = tabs.teacher, tabs.students
    teacher.page.get_by_role("tab", name="Class").click()
    assert teacher.button("Rename").count() == teacher.button("Remove from the class").count() == 0
    teacher.field("Follow").click()
    teacher.page.get_by_role("option", name=f"2. {HOSTILE}").click()
    teacher.page.get_by_text("This is the lab of").wait_for()
    wait_for(lambda: teacher.field("Nickname").input_value() == HOSTILE)
    fill(teacher, "Nickname", "Ada")
    teacher.button("Rename").click()
    for student in tabs.students:
        unfold(student)
    second.page.get_by_text("You are in the class as Ada 2").wait_for(state="attached")
    teacher.page.get_by_text("This is the lab of Ada 2").wait_for()
    wait_for(lambda: teacher.field("Nickname").input_value() == "Ada 2")
    lab = second.lab
    teacher.button("Remove from the class").click()
    teacher.page.get_by_text("Removed.").wait_for()
    teacher.page.get_by_text("1 in the class").first.wait_for()
    second.page.get_by_text("Join the class", exact=True).wait_for(
        state="attached"
    )  # in a closed folder
    assert second.lab is lab and [m.name for m in tabs.room.members().values()] == ["Ada"]
    assert first.page.get_by_text("You are in the class as Ada").count() == 1


def test_axe_finds_nothing_serious_on_the_teachers_page(tabs: Class) -> None:
    tabs.teacher.page.get_by_role("tab", name="Predictions").wait_for()
    assert violations(tabs.teacher) == []
