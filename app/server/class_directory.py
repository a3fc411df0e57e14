"""The classes of a server, by the place of a page."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from onpath.app.classroom.admission import Admission
from onpath.app.classroom.classroom import Classroom
from onpath.app.page.page_context import ClassSeat
from onpath.app.server.class_service import ClassService
from onpath.app.viser_adapter.addresses import CLASS, class_code_in, class_link


class ClassDirectory:
    """Classes by their places; pages at other places are in no class.

    Args:
        serve: starts the service of a class at a place.
    """

    def __init__(
        self, classrooms: Iterable[Classroom], serve: Callable[[Classroom, str], ClassService]
    ) -> None:
        self._rooms = {f"{CLASS}/{room.code}": room for room in classrooms}
        self._services = {place: serve(room, place) for place, room in self._rooms.items()}
        self._door = Admission()

    def at(self, place: str) -> ClassService | None:
        """The service of the class at a place; None if there is none."""
        return self._services.get(place)

    def stored_as(self, place: str) -> str:
        """The name in the database of the class at a place; empty if it has none."""
        service = self._services.get(place)
        return "" if service is None else service.stored_as

    def all_stored(self) -> list[str]:
        """The names in the database of all classes."""
        return [name for service in self._services.values() if (name := service.stored_as)]

    def in_use(self) -> list[str]:
        """The names in the database of the classes with clients in this process."""
        services = [service for service in self._services.values() if service.in_use]
        return [name for service in services if (name := service.stored_as)]

    def seat_elsewhere(self, place: str, code: str) -> ClassSeat | None:
        """The seat of a lab outside the places of classes; None if there are no classes.

        Args:
            code: session code of the lab.
        """
        if not self._rooms:
            return None
        codes = {room.code: room for room in self._rooms.values()}
        keys = {room.key: room for room in self._rooms.values()}
        return ClassSeat(
            join=lambda typed, _: class_link(self._door.check_code(typed, codes, code), place),
            leave=lambda: None,
            teach=lambda typed: class_link(
                keys[self._door.check_key(typed, keys, code)].code, place
            ),
            code=class_code_in(place),
        )

    def stop(self) -> None:
        """Stop all services."""
        for service in self._services.values():
            service.stop()
