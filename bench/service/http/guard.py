"""Before and after every request: no foreign web page may move the machine, nothing foreign runs in ours."""

from urllib.parse import SplitResult, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from bench.service.http.api_router import PREFIX
from bench.service.http.problems import problem_response

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
SECURITY_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class Guard:
    """ASGI middleware: checks Host and Origin, adds the security headers."""

    def __init__(self, app: ASGIApp, hosts: frozenset[str]) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse or pass on."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in SECURITY_HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        refusal = self._refusal(scope["method"], scope["path"], Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, send_with_headers)
        else:
            status, detail = refusal
            await problem_response(status, detail)(scope, receive, send_with_headers)

    def _refusal(self, method: str, path: str, headers: Headers) -> tuple[int, str] | None:
        host = headers.get("host", "")
        # a foreign name that was made to resolve to this machine (DNS rebinding) shows in Host
        if _parts(f"//{host}").hostname not in self._hosts:
            allowed = ", ".join(sorted(self._hosts))
            return 421, f"Host is '{host}'; this service answers to {allowed}. Add a name with --allow-host"
        site = headers.get("sec-fetch-site", "same-origin")  # as a browser says, whatever the page would have it say
        if site == "cross-site" and path.startswith(PREFIX) and not _opened_by_a_person(headers):
            return 403, "a page of another site asks for this; only a page of this service may. Open it by itself"
        if method in SAFE_METHODS:
            return None
        origin = headers.get("origin")
        if origin is not None and _parts(origin).netloc != host:
            return 403, f"Origin is '{origin}'; a page from another origin than '{host}' may not change the bench"
        if site not in {"same-origin", "none"}:
            return 403, f"the request comes from another site ({site}); use the page of this service"
        return None


def _opened_by_a_person(headers: Headers) -> bool:
    """Whether a browser shows what it asks for as a page of its own, as after a click on a link."""
    return headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"


def _parts(address: str) -> SplitResult:
    """The parts of an address; all empty where it is none."""
    try:
        return urlsplit(address)
    except ValueError:  # such as "http://["
        return SplitResult("", "", "", "", "")
