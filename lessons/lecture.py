"""The lecture of a course: slides with live figures, and the lecturer's notes.

It is written like a lesson, in the folder `lecture` of a course. It is on the course's site, and
not among the lessons: nothing in it is answered alone, kept or graded.
"""

from __future__ import annotations

LECTURE = "lecture"
"""The folder of the lecture in a course, and its name."""
