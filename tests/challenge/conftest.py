import pytest

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.difficulty import Difficulty

QUICK = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 2.0, 1, 1)


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> Difficulty:
    """As easy ones, but recorded in a second."""
    monkeypatch.setitem(difficulty.DIFFICULTIES, "easy", QUICK)
    return QUICK
