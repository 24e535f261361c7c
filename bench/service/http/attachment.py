"""The header that names a file which is sent."""

from typing import Any


def attachment(name: str) -> dict[str, Any]:
    """As the description of an answer has it, with a name for example."""
    said = {
        "schema": {"type": "string"},
        "description": "name of the file",
        "example": f'attachment; filename="{name}"',
    }
    return {"Content-Disposition": said}
