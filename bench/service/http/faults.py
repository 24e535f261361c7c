"""Faults of this software: answered as a problem, logged with their trace, and no reason to close the connection."""

import logging

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from bench.service.http.problems import problem_response

DETAIL = "this is a fault of the software; its log shows where. Nothing was changed on purpose"
_log = logging.getLogger("uvicorn.error")  # where the server itself says what went wrong


class Faults:
    """ASGI middleware: makes status 500 of what nobody foresaw.

    An exception that reaches the server makes it close the connection after the answer, without having said so: a
    client that keeps connections alive finds its next request reset.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and answer where nothing else has."""
        begun = False

        async def watching(message: Message) -> None:
            nonlocal begun
            begun = begun or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, watching)
        except Exception as error:
            if scope["type"] != "http" or begun:  # half an answer: to close is the only word left
                raise
            _log.exception("%s %s failed", scope["method"], scope["path"])
            await problem_response(500, DETAIL, kind=type(error).__name__)(scope, receive, send)
