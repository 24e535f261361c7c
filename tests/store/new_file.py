"""`python -m tests.store.new_file`: keep what all migrations together make of an empty SQLite file."""

from bench.store.migration import NEW_FILE, made_by_migrations


def text_of_new_file() -> str:
    """The statements with an empty line between them."""
    made = made_by_migrations()
    assert not any("\n\n" in statement for statement in made)
    return "\n\n".join(made) + "\n"


if __name__ == "__main__":
    NEW_FILE.write_text(text_of_new_file(), encoding="utf-8")
