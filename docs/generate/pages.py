"""Writes all generated pages: `write(folder)`. Sphinx calls it before it reads the documents."""

from pathlib import Path

from docs.generate import (
    command_line,
    effects,
    experiments,
    python_interface,
    recording_set,
    rest_interface,
    rooms,
    settings,
)


def pages() -> dict[str, str]:
    """The text of every page, by its file."""
    return {
        "bench-toml.md": settings.bench_toml(),
        "rig-toml.md": settings.rig_toml(),
        "effects.md": effects.page(),
        "experiments.md": experiments.page(),
        "command-line.md": command_line.page(),
        "mapping.txt": recording_set.mapping(),
        "rooms.txt": rooms.rooms(),
        "walls.txt": rooms.walls(),
        **rest_interface.pages(),
        **python_interface.pages(),
    }


def write(folder: Path) -> None:
    """Write every page that differs from what is there, so that only these are built again."""
    wanted = pages()
    for file, text in wanted.items():
        place = folder / file
        place.parent.mkdir(parents=True, exist_ok=True)
        if not place.is_file() or place.read_text(encoding="utf-8") != text:
            place.write_text(text, encoding="utf-8")
    for place in [*folder.rglob("*.md"), *folder.rglob("*.txt")]:
        if str(place.relative_to(folder)) not in wanted:
            place.unlink()
