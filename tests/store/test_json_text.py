"""JSON as the store writes it."""

import json
from datetime import UTC, datetime

import numpy as np
import pytest

from bench.store.tables.json_text import to_json
from drivers.contract import Mode, Status


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ({"a": float("nan"), "b": float("-inf")}, {"a": None, "b": None}),
        (np.array([[1.0, np.nan]]), [[1.0, None]]),
        ([np.float64(0.1), np.int64(3), np.bool_(True)], [0.1, 3, True]),
        ((1, {2}), [1, [2]]),
        ({Mode.DUTY: Mode.CURRENT}, {"Mode.DUTY": "current"}),
        (Status.FAULT, 3),
        (datetime(2026, 1, 2, tzinfo=UTC), "2026-01-02T00:00:00+00:00"),
        ("grüße", "grüße"),
        (None, None),
    ],
)
def test_values_become_plain(value: object, expected: object) -> None:
    assert json.loads(to_json(value)) == expected


def test_what_has_no_form_is_refused() -> None:
    with pytest.raises(TypeError, match="a complex cannot be kept as JSON"):
        to_json({"impedance": 1j})
