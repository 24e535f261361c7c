"""An example of what each route answers, as it was answered once: `python -m tests.service.make_examples`."""

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("examples.json")


@cache
def examples() -> dict[str, Any]:
    """By `key`."""
    found: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    return found


def key(method: str, path: str) -> str:
    """A route, whatever the numbers in its path are called: `GET /api/v1/trials/{}`."""
    return f"{method.upper()} {re.sub(r'{[a-z_]+}', '{}', path)}"
