"""Requests one after the other, each with what the one before has answered: what was made is read, changed, removed."""

from typing import Any

import hypothesis
from hypothesis.errors import FlakyFailure, FlakyStrategyDefinition, UnsatisfiedAssumption

from tests.fuzz.asking import CHECKS, HEADERS, LONGEST_S, count, described, stand_still
from tests.fuzz.effort import TIMES, effort

WAYS, STEPS = 4, 12
LEAST_LINKS = 60  # from one answer to another request; schemathesis finds them by names in the description


def test_what_one_request_has_made_is_asked_for_by_the_next(recorded):
    machine, wrong = described(recorded).as_state_machine(), []
    assert sum("___2" in name for name in dir(machine)) >= LEAST_LINKS

    class Way(machine):  # type: ignore[misc, valid-type]
        """One request after the other."""

        def get_call_kwargs(self, case: Any) -> dict[str, Any]:
            return {"headers": HEADERS, "timeout": LONGEST_S}

        def validate_response(self, response: Any, case: Any, additional_checks: Any = None, **_words: Any) -> None:
            count(response)
            try:
                case.validate_response(response, headers=HEADERS, checks=CHECKS)
            except Exception as error:  # kept: the same way, gone again, meets what it has left in the store
                wrong.append(f"{case.method} {case.formatted_path}: {error}")

        def teardown(self) -> None:
            stand_still(recorded)

    for number in range(WAYS * TIMES):
        # each by itself: hypothesis minds that the service remembers what the way before has made
        try:
            hypothesis.seed(number)(Way).run(settings=effort(2, 1, stateful_step_count=STEPS))
        except FlakyStrategyDefinition:
            continue
        except FlakyFailure as error:
            if not all(isinstance(one, UnsatisfiedAssumption) for one in error.exceptions):
                raise
    assert not wrong, "\n".join(wrong)
