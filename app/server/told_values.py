"""What a page has been told of the values of its forms, so that only what has changed is sent."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from onpath.app.channel.form_messages import FieldValue, ValuesMessage


class ToldValues:
    """The values, refusals and numbers of messages that one page knows."""

    def __init__(self) -> None:
        self._values, self._refused = dict[str, FieldValue](), dict[str, str]()
        self._heard = dict[str, int]()

    def news(
        self,
        values: Mapping[str, FieldValue],
        refused: Mapping[str, str],
        heard: Mapping[str, int],
    ) -> Iterator[ValuesMessage]:
        """What the page does not know yet, if there is anything.

        Args:
            values, refused: of the forms, by name of the field.
            heard: number of the last message that set a field, by its name.
        """
        changed = {name: each for name, each in values.items() if self._values.get(name) != each}
        why = {name: each for name, each in refused.items() if self._refused.get(name) != each}
        why |= {name: "" for name in self._refused if name not in refused}
        new = {name: each for name, each in heard.items() if self._heard.get(name) != each}
        self._values, self._refused, self._heard = dict(values), dict(refused), dict(heard)
        if changed or why or new:
            yield ValuesMessage(changed, why, new)
