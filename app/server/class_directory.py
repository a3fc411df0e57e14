"""The classes of a server, by the prefix of a page's address."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from onpath.app.classroom.admission import Admission
from onpath.app.classroom.classroom import Classroom
from onpath.app.server.class_service import ClassService
from onpath.app.server.page_context import ClassSeat
from onpath.app.viser_adapter.addresses import CLASS, class_code_in, class_link


class ClassDirectory:
    """Classes by their prefixes; pages under other prefixes are in no class.

    Args:
        serve: starts the service of a class under a prefix.
    """

    def __init__(
        self, classrooms: Iterable[Classroom], serve: Callable[[Classroom, str], ClassService]
    ) -> None:
        self._rooms = {f"{CLASS}/{room.code}": room for room in classrooms}
        self._services = {prefix: serve(room, prefix) for prefix, room in self._rooms.items()}
        self._door = Admission()

    def at(self, prefix: str) -> ClassService | None:
        """The service of the class under a prefix; None if there is none."""
        return self._services.get(prefix)

    def stored_as(self, prefix: str) -> str:
        """The name in the database of the class under a prefix; empty if it has none."""
        service = self._services.get(prefix)
        return "" if service is None else service.stored_as

    def all_stored(self) -> list[str]:
        """The names in the database of all classes."""
        return [name for service in self._services.values() if (name := service.stored_as)]

    def in_use(self) -> list[str]:
        """The names in the database of the classes with clients in this process."""
        services = [service for service in self._services.values() if service.in_use]
        return [name for service in services if (name := service.stored_as)]

    def seat_elsewhere(self, prefix: str, code: str) -> ClassSeat | None:
        """The seat of a lab outside the prefixes of classes; None if there are no classes.

        Args:
            code: code of the lab.
        """
        if not self._rooms:
            return None
        codes = {room.code: room for room in self._rooms.values()}
        keys = {room.key: room for room in self._rooms.values()}
        return ClassSeat(
            join=lambda typed, _: class_link(self._door.check_code(typed, codes, code), prefix),
            leave=lambda: None,
            teach=lambda typed: class_link(
                keys[self._door.check_key(typed, keys, code)].code, prefix
            ),
            code=class_code_in(prefix),
        )

    def stop(self) -> None:
        """Stop all services."""
        for service in self._services.values():
            service.stop()
