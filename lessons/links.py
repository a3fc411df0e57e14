"""Links in a lesson's text that act on the lab: `lab:K3=100&path=ellipse`, `lab:hold`."""

from __future__ import annotations

from urllib.parse import unquote

from onpath.lessons.action_schema import Action, Laws, Value
from onpath.models.control.sides import SIDES

SCHEME = "lab:"
SIMPLE = {
    "hold": Action(hold=True),
    "let_go": Action(hold=False),
    "reset": Action(reset=True),
    "run": Action(run=True),
    "pause": Action(run=False),
    "identify": Action(identify=True),
}


def read_link(address: str) -> tuple[Action, ...]:
    """The actions of a link, in order; all parameters are set by one action.

    Raises:
        ValueError: the scheme or an action is unknown.
    """
    if not address.startswith(SCHEME):
        raise ValueError(f"link {address!r}: it must begin with https:// or {SCHEME}")
    actions: list[Action] = []
    values: dict[str, Value] = {}
    for part in unquote(address[len(SCHEME) :]).split("&"):
        name, equals, value = part.partition("=")
        if not equals:
            if name not in SIMPLE:
                raise ValueError(f"link {address!r}: {name!r} is none of {', '.join(SIMPLE)}")
            actions.append(SIMPLE[name])
        elif name == "path":
            actions.append(Action(path=value))
        elif name == "robot":
            actions.append(Action(robot=value))
        elif name in SIDES:
            actions.append(Action(laws=Laws(**{name: value})))
        else:
            values[name] = _value(value)
    return (*actions, Action(set=values)) if values else tuple(actions)


def _value(text: str) -> Value:
    """The text as an int, a float, or itself."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
