"""What a page's data channel tells besides samples: names, captions, messages, settings of time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from msgspec import structs

from onpath.app.channel.state_messages import Said, StateMessage
from onpath.app.lab.plot_rows import row_data
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.view.plant import plant_message
from onpath.lessons.labels import robot_label
from onpath.lessons.sides import displayed_names, law_text, side_titles
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import law_named
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.law_parameters import LEVEL_SET


@dataclass(frozen=True, slots=True)
class Projection:
    """How the picture shows the robots.

    Attributes:
        height: that the canvas shows at the distance of the robots, [m].
        cameras: one for each robot, shape (k, 3, p + 1); matrices of the
            perspective, see `app/scene/projection.py`.
        drawn: whether the picture does so already.
        above: the point of the output space that is nearest to a title's place, shape (p,), [m].
        arrow: length of the arrow of a force [m/N].
    """

    height: float
    drawn: bool
    cameras: np.ndarray
    above: np.ndarray
    arrow: float


def state_message(
    snapshot: PageSnapshot,
    words: Words,
    captions: Mapping[str, str],
    said: Said,
    seen: Projection,
) -> StateMessage:
    """The message of a lab's state.

    Args:
        words: of the page.
        captions: of the robots, by side; see `app.view.captions.Captions`.
        said: what the page says.
        seen: how the picture shows the robots, or will.
    """
    laws, run, rate = snapshot.laws, snapshot.run, snapshot.settings.rate
    plant = snapshot.plant
    titles = side_titles(laws, words)
    is_level_set = snapshot.parameters["across"] == LEVEL_SET
    names, guesses = displayed_names(laws, words), ROBOTS[snapshot.key.robot].guesses
    return StateMessage(
        language=words.language,
        robot=snapshot.key.robot,
        titles=[titles[side] for side in laws],
        names=[names[side] for side in laws] if plant is None else _beside_plant(words),
        texts=[law_text(law, words) for law in laws.values()],
        captions=[captions.get(side, "") for side in laws],
        clocks=[law_named(law).by_clock for law in laws.values()],
        stopped=[side in snapshot.stopped for side in laws],
        rate=rate,
        achieved=round(snapshot.achieved_speed / rate, 1) * rate,
        undo=run.can_undo_going_on,
        message=snapshot.message,
        level=snapshot.message_level if snapshot.message else "",
        messages=snapshot.messages,
        said=said if plant is None else structs.replace(said, replays=False, earlier=""),
        presenting=snapshot.key.presenting,
        height=round(seen.height, 3),
        cameras=np.round(seen.cameras, 5).tolist(),
        above=np.round(seen.above, 4).tolist(),
        arrow=seen.arrow,
        frozen=words("class.frozen") if run.frozen else "",
        machine=robot_label(snapshot.key.robot, words),
        drawn=seen.drawn,
        waits=words("say.waits") if run.waits else "",
        own=not snapshot.key.student,
        rows=row_data(
            snapshot.key.fields, is_level_set, words, guesses=guesses, motors=snapshot.key.motors
        ),
        laws=list(run.laws.values()),
        shared=snapshot.shared,
        sent=list(snapshot.sent),
        plant=None if plant is None else plant_message(plant, words),
    )


def _beside_plant(words: Words) -> list[str]:
    """What a simulated robot and a plant are called."""
    return [words("plant.simulated"), words("plant.name")]
