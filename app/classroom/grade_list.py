"""A list of grades, for students who have identified themselves: points for taking part.

They count what was answered, whether or not it was right, so that a prediction stays a prediction.
"""

from __future__ import annotations

from collections.abc import Iterable

from onpath.app.classroom.class_record import QUESTIONS, Sheet
from onpath.app.classroom.classroom import Identification, Member
from onpath.lessons.course import Course
from onpath.lessons.progress import Notes, given_to
from onpath.lessons.schema import Lesson, Quiz

HEADINGS = {"email": "Email address", "idnumber": "ID number", "username": "Username"}
"""The columns by which Moodle finds a student, as it names them."""


def grade_sheet(
    members: Iterable[Member], course: Course, language: str, asks: Identification
) -> Sheet | None:
    """The sheet Grades, with a column for each lesson that anybody has begun, 0 to 100.

    It has the form that Moodle imports (*Import*, *Paste from spreadsheet*), by Moodle's
    documentation and source; this has not been tried in Moodle. Of two labs of one student,
    the one with more points in a lesson counts. Students without an identification are left out.

    Returns:
        None if students are not asked to identify themselves.
    """
    if not asks:
        return None
    known = [each for each in members if each.identification]
    begun = {name for each in known for name in each.progress.notes if name in course.lessons}
    lessons = {name: course.lesson(name, language) for name in course.lessons if name in begun}
    titles = {name: f"OnPath: {lesson.front.title}" for name, lesson in lessons.items()}
    rows = dict[str, dict[str, str | int | float]]()
    for member in known:
        row = rows.setdefault(member.identification, {HEADINGS[asks]: member.identification})
        for name, lesson in lessons.items():
            notes = member.progress.notes.get(name)
            points = 0 if notes is None else points_of(lesson, notes)
            row[titles[name]] = max(int(row.get(titles[name], 0)), points)
    return Sheet("Grades", (HEADINGS[asks], *titles.values()), list(rows.values()))


def points_of(lesson: Lesson, notes: Notes) -> int:
    """The share of a lesson's predictions and questions that were answered, in percent.

    A prediction that was passed over is not answered. Warm-up questions and tasks do not count.
    Points are whole, because Moodle takes no decimal comma of a pasted sheet in a new column.
    """
    items = list(_items(lesson))
    answered = sum(
        any(each.lost or not each.is_skipped for each in given_to(notes, item)) for item in items
    )
    return round(100 * answered / len(items)) if items else 0


def _items(lesson: Lesson) -> Iterable[str]:
    """What the lesson asks; see `Given.item`."""
    for index, step in enumerate(lesson.steps):
        yield from (str(index) for _ in step.predictions())
        for at, block in enumerate(step.blocks):
            if isinstance(block, QUESTIONS) and not (isinstance(block, Quiz) and block.warm_up):
                yield f"{index}.{at}"
