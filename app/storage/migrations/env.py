"""Run by Alembic for each upgrade, on the connection that `upgrade` passes."""

from __future__ import annotations

from alembic import context

from onpath.app.storage.schema import metadata

context.configure(connection=context.config.attributes["connection"], target_metadata=metadata)
context.run_migrations()
