"""What a script does, in the words of a language."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from onpath.lessons.action_schema import Action, Script
from onpath.lessons.labels import setting_label, value_label
from onpath.lessons.sides import law_label
from onpath.lessons.words import Words
from onpath.models.systems.parameters import Parameters


def script_words(script: Script, parameters: Parameters, words: Words) -> Iterator[str]:
    """A sentence for each instant of a script.

    Args:
        parameters: of the robot; they name the settings.
    """
    for at in sorted({action.at for action in script.do}):
        descriptions = [
            action_words(action, parameters, words) for action in script.do if action.at == at
        ]
        yield words("guide.at", time=_number(at, words), what="; ".join(descriptions))


def action_words(action: Action, parameters: Parameters, words: Words) -> str:
    """What an action does."""
    what, describe = action.what, _WORDS.get(action.what)
    if what == "set":
        values = action.set or {}
        return ", ".join(
            f"{setting_label(name, parameters, words)} = {value_label(name, value, words)}"
            for name, value in values.items()
        )
    if what == "laws" and action.laws is not None:
        laws = action.laws.named.items()
        return ", ".join(f"{words(f'side.{side}')}: {law_label(law, words)}" for side, law in laws)
    text = describe(action, words) if describe else words(f"event.{what}")
    return f"{text} ({words(f'robot.{action.only}')})" if action.only else text


def _pull(action: Action, words: Words) -> str:
    right, up = action.pull or (0.0, 0.0)
    return words("guide.pull", right=_number(right, words), up=_number(up, words))


def _move(action: Action, words: Words) -> str:
    index, right, up = action.move or (0, 0.0, 0.0)
    return words("guide.move", index=index, right=_number(right, words), up=_number(up, words))


def _named(action: Action, words: Words) -> str:
    what = action.what
    return words(f"event.{what}", detail=value_label(what, getattr(action, what), words))


def _number(value: float, words: Words) -> str:
    return f"{value:g}".replace("-", "−").replace(".", words("report.point"))


_WORDS: dict[str, Callable[[Action, Words], str]] = {
    "hold": lambda action, words: words("event.hold" if action.hold else "event.let_go"),
    "run": lambda action, words: words("guide.run" if action.run else "guide.pause"),
    "rate": lambda action, words: words("guide.rate", rate=_number(action.rate or 1.0, words)),
    "start": lambda _, words: words("guide.start"),
    "pull": _pull,
    "move": _move,
    "path": _named,
    "robot": _named,
}
