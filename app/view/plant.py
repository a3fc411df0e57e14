"""What a page says of a plant elsewhere."""

from __future__ import annotations

from onpath.app.channel.plant_messages import PlantMessage
from onpath.app.lab.plant_state import PlantState
from onpath.lessons.words import Words

PHASES = {"off": "plant.off", "starting": "plant.starting", "running": "plant.running"}
TORQUES = {"zero": "plant.zero", "hold": "plant.hold", "damp": "plant.damp"}
"""Keys of the catalogues."""


def plant_message(plant: PlantState, words: Words) -> PlantMessage:
    """What is known of a plant, in words."""
    return PlantMessage(
        phase=plant.phase,
        text=_text(plant, words),
        late=_late(plant, words),
        live=plant.is_live,
        ready=plant.can_start,
        at_fault=plant.at_fault,
    )


def _text(plant: PlantState, words: Words) -> str:
    if plant.phase == "waiting":
        return words("plant.waiting", address=plant.address)
    if plant.cause is None:
        return words(PHASES[plant.phase])
    ended = words("plant.ended", cause=words.sentence(plant.cause).rstrip("."))
    if not plant.sends:
        return ended
    torque = words(TORQUES[plant.at_fault])
    return f"{ended} {words('plant.sends', torque=torque)}"


def _late(plant: PlantState, words: Words) -> str:
    if not plant.answered:
        return ""
    late, latest = (f"{1e3 * each:.1f}" for each in (plant.late, plant.latest))
    return words("plant.late", late=late, latest=latest)
