"""How long what is drawn at random goes on: briefly with the other tests, long by `make fuzz`."""

import os
from typing import Any

from hypothesis import HealthCheck, Phase, settings

TIMES = int(os.environ.get("FUZZ_TIMES", "1"))
"""How many times as many examples as in the other tests."""


def effort(examples: int, times: int = TIMES, **more: Any) -> settings:
    """Settings of hypothesis; always the same examples where it is brief, else others each time.

    Args:
        examples: of the brief run.
        times: as many of them.
        more: further settings.
    """
    return settings(
        max_examples=examples * times,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        derandomize=TIMES == 1,
        database=None,
        phases=[Phase.explicit, Phase.generate],
        **more,
    )
