"""What is printed when the service starts."""

import shlex
from typing import NamedTuple

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import is_simulated
from bench.own_service import is_loopback
from bench.service.auth.token_register import Tokens
from bench.service.auth.tokens import ENVIRONMENT, TOKEN_VARIABLE, token_file
from bench.service.http.api_router import PREFIX
from bench.store.address import shown


class Place(NamedTuple):
    """Where the service listens."""

    host: str
    port: int
    encrypted: bool

    @property
    def url(self) -> str:
        """Its address."""
        name = f"[{self.host}]" if ":" in self.host else self.host
        return f"{'https' if self.encrypted else 'http'}://{name}:{self.port}"


def welcome(configuration: BenchConfiguration, place: Place, tokens: Tokens) -> list[str]:
    """The lines."""
    drive = "SIMULATED drive, no hardware moves" if is_simulated(configuration) else "REAL drive, the joint moves"
    lines = [
        f"bench  {configuration.name}: {drive}",
        f"store  {shown(configuration.store.url)}",
        f"page   {place.url}/",
        f"REST   {place.url}{PREFIX}/openapi.json",
        f"token  {_token(configuration, tokens)}",
    ]
    if not place.encrypted and not is_loopback(place.host):
        lines.append("tokens and data cross the network in the clear: see --tls-certificate and --tls-key")
    return [*lines, "Ctrl-C stops the joint and ends the service."]


def _token(configuration: BenchConfiguration, tokens: Tokens) -> str:
    if tokens.made is not None:
        return f"{tokens.made}   (the page asks for it; keep it to yourself: it is shown this once)"
    if tokens.chosen is None:
        store = shlex.quote(shown(configuration.store.url))
        return f"was shown at the first start; another one: friction-bench --store {store} token new NAME --role admin"
    name, _ = tokens.chosen
    return f"that of {TOKEN_VARIABLE if name == ENVIRONMENT else token_file(configuration.store.url)}"
