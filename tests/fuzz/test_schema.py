"""Every route against its own description, with requests that fit it and requests that do not."""

import pytest
from hypothesis import given
from schemathesis import GenerationMode

from tests.fuzz.asking import CHECKS, HEADERS, LONGEST_S, as_http, count, described, stand_still
from tests.fuzz.effort import effort

EXAMPLES = 4  # of a route, either way
TAGS = [
    "audit",
    "bench",
    "calibrations",
    "challenges",
    "commission",
    "effects",
    "experiments",
    "lease",
    "live",
    "queue",
    "recording sets",
    "studies",
    "trials",
]


@pytest.fixture(scope="module")
def operations(recorded):
    return [found.ok() for found in described(recorded).get_all_operations()]


def test_every_tag_is_asked_below(operations):
    assert {tag for operation in operations for tag in operation.tags} == set(TAGS)


@pytest.mark.parametrize("mode", list(GenerationMode), ids=lambda mode: mode.value)
@pytest.mark.parametrize("tag", TAGS)
def test_what_is_answered_is_declared(operations, recorded, tag, mode):
    for operation in operations:
        if tag in operation.tags:
            ask(operation, mode, recorded)


def ask(operation, mode, recorded) -> None:
    """Send what the schema says, or what it forbids; the joint stands still afterwards."""

    @given(case=operation.as_strategy(generation_mode=mode))
    @effort(EXAMPLES)
    def send(case) -> None:
        try:
            response = as_http(case).call(headers=HEADERS, timeout=LONGEST_S)
            count(response)
            case.validate_response(response, headers=HEADERS, checks=CHECKS)
        finally:
            if operation.method != "get":
                stand_still(recorded)

    send()
