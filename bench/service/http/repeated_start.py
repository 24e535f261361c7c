"""Idempotency-Key: a start that is sent twice, because its answer was lost, moves the joint once."""

import hashlib
import json
import logging
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Annotated, TypeVar

from fastapi import Header
from pydantic import BaseModel

from bench.errors import BenchError
from bench.store.errors import StoreError
from bench.store.tables.start_keys import StartKeys

M = TypeVar("M", bound=BaseModel)
_log = logging.getLogger(__name__)
Key = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        min_length=1,
        max_length=200,
        pattern=r"^[\x21-\x7e]+$",
        description="any text of your own, new for each start: the same key and body again within 24 h get the same "
        "answer, and start nothing",
        examples=["2026-05-04-first-sweep"],
    ),
]


class KeyReusedError(BenchError, ValueError):
    """Raised when a key comes with another body than the first time."""


class KeyInUseError(BenchError, RuntimeError):
    """Raised when the start with that key has not been answered yet."""


def once(
    keys: StartKeys, token: str, key: str | None, asked: Mapping[str, object], start: Callable[[], M], kind: type[M]
) -> M:
    """Start, unless this was asked for before. Returns what is answered.

    A start that was refused is not remembered: it may be sent again with the same key.

    Args:
        keys: those of the store.
        token: name of the token that sends it; each token has keys of its own.
        key: None: just start.
        asked: the request's body, JSON-able. Those of different routes differ.
        start: starts, or raises; returns what is answered.
        kind: of the answer.

    Raises:
        KeyReusedError: the key was used with another body.
        KeyInUseError: that start is still under way, or nobody knows what became of it.
    """
    if key is None:
        return start()
    digest = hashlib.sha256(json.dumps(asked, sort_keys=True).encode()).hexdigest()
    found = keys.claim(token, key, digest)
    if found is None:
        return _first(keys, token, key, start)
    if found.body_digest != digest:
        raise KeyReusedError(
            f"Idempotency-Key '{key}' was used within 24 h with another body; send a new key with a new start"
        )
    if found.answer is None:
        raise KeyInUseError(
            f"a start with Idempotency-Key '{key}' is under way, or its service ended before the answer; "
            "look at GET /experiments and GET /queue"
        )
    return kind.model_validate(found.answer)


def _first(keys: StartKeys, token: str, key: str, start: Callable[[], M]) -> M:
    try:
        answer = start()
    except BaseException:
        with suppress(StoreError):  # then the key stays in use until it is removed, and nothing has moved
            keys.forget(token, key)
        raise
    try:
        keys.answer(token, key, 201, answer.model_dump(mode="json"))
    except StoreError as error:  # it has begun: that is the answer, whatever became of the key
        _log.warning("Idempotency-Key '%s' could not be kept: %s", key, error)
    return answer
