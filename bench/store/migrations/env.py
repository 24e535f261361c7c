"""Alembic runs this file. The connection comes from `bench.store.migration`, inside its transaction."""

from alembic import context

from bench.store.schema import METADATA

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=METADATA,
    render_as_batch=True,  # SQLite changes a table by copying it
)
with context.begin_transaction():
    context.run_migrations()
