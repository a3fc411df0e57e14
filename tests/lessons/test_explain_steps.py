"""Every explanation has something to touch, and leads to the literature; every belief is asked."""

from __future__ import annotations

import pytest

from onpath.lessons.schema import Choice, Lesson, OpenQuestion, Quiz, Sketch, Step, Text
from tests.support.built_in import built_in_course

COURSE = built_in_course()[0]
ASKS = Choice | Sketch | Quiz | OpenQuestion
LITERATURE = {"en": "In the literature", "de": "In der Literatur"}
ASKED = {
    "the clock that waits": ("01b-let-the-clock-wait", "Nobody touches them"),
    "attractive is invariant, and invariant is robust": ("05-invariance", "What stays?"),
    "motors enough for the outputs": ("04-across-and-along", "One matrix decides"),
    "only small displacements are linear": ("04-across-and-along", "When does it work?"),
    "what goes on inside is the robot's": ("07-flexible-link", "What to take away"),
    "no memory": ("06-exact-cancellation", "A spring that learns"),
    "the shortest way to the goal": ("05-invariance", "The paper's first experiment"),
    "no controller for the speed": ("05-invariance", "What stays?"),
    "what is measured must be the distance": ("test-before", "What is measured"),
}
"""Where each common belief is asked: in a prediction or a question of this step."""


def explanations(language: str) -> list[tuple[Lesson, int, Step]]:
    """The explain steps of the course."""
    return [
        (lesson, index, step)
        for lesson in (COURSE.lesson(name, language) for name in COURSE.lessons)
        for index, step in enumerate(lesson.steps)
        if step.kind == "explain"
    ]


@pytest.mark.parametrize("language", LITERATURE)
def test_every_explanation_leads_to_the_literature(language: str) -> None:
    for lesson, _, step in explanations(language):
        texts = "".join(str(block.html) for block in step.blocks if isinstance(block, Text))
        assert LITERATURE[language] in texts, (lesson.name, step.title)


@pytest.mark.parametrize("language", LITERATURE)
def test_every_explanation_has_something_to_touch(language: str) -> None:
    for lesson, index, step in explanations(language):
        links = [link for b in step.blocks if isinstance(b, Text) for link in b.links]
        assert links or lesson.setup_at(index).controls, (lesson.name, step.title)


@pytest.mark.parametrize("belief", ASKED)
def test_every_common_belief_is_asked(belief: str) -> None:
    name, title = ASKED[belief]
    steps = [each for each in COURSE.lesson(name, "en").steps if each.title == title]
    assert any(isinstance(block, ASKS) for step in steps for block in step.blocks)


@pytest.mark.parametrize("language", LITERATURE)
def test_every_lesson_says_what_it_needs_and_what_it_teaches(language: str) -> None:
    for name in COURSE.lessons:
        front = COURSE.lesson(name, language).front
        assert front.needs and front.goals and front.takeaway and front.misconception
