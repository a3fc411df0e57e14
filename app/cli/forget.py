"""`onpath forget`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Forget:
    """Delete all stored labs. This cannot be undone."""

    database: str | None = None
    """URL of the database, also as ONPATH_DATABASE; the file in your data folder if not given."""

    def run(self) -> None:
        """Delete the labs, and print their number."""
        from onpath.app.storage.database_url import database_url
        from onpath.app.storage.forget import forget

        gone = forget(database_url(self.database))
        print(f"deleted: {gone.labs} labs, {len(gone.files)} files moved aside as broken")
